#include "zoneplate/raster/front.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// One triangle a lane.
using F = hn::CappedTag<float, 8>;
using I = hn::Rebind<std::int32_t, F>;
using H = hn::Half<F>;
using D = hn::Rebind<double, H>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
using VD = hn::Vec<D>;
using MI = hn::Mask<I>;
constexpr std::int32_t lanes = static_cast<std::int32_t>(hn::MaxLanes(F()));
constexpr F f;
constexpr I i32;
constexpr D f64;

HWY_INLINE VI set(std::int32_t v) { return hn::Set(i32, v); }

/// For every mask of lanes: the lanes that are set, in order, then the others. (Highway's own table is copied to the
/// stack at each use by GCC 12.)
struct Orders {
  alignas(64) std::uint8_t lane[256][8];
};
constexpr Orders make_orders() {
  Orders out{};
  for (int mask = 0; mask < 256; ++mask) {
    int n = 0;
    for (int bit = 0; bit < 8; ++bit)
      if (mask >> bit & 1) out.lane[mask][n++] = static_cast<std::uint8_t>(bit);
    for (int bit = 0; bit < 8; ++bit)
      if (!(mask >> bit & 1)) out.lane[mask][n++] = static_cast<std::uint8_t>(bit);
  }
  return out;
}
constexpr Orders orders = make_orders();

/// Moves the lanes of a mask to the front.
class Packing {
 public:
  HWY_INLINE explicit Packing(MI mask) : bits_(bits_of(mask)), order_(order_of(bits_)) {}
  HWY_INLINE void store(VI v, std::int32_t* to) const { hn::StoreU(hn::TableLookupLanes(v, order_), i32, to); }
  HWY_INLINE void store(VF v, float* to) const { store(hn::BitCast(i32, v), reinterpret_cast<std::int32_t*>(to)); }
  HWY_INLINE std::int32_t count() const { return __builtin_popcount(bits_); }

 private:
  static HWY_INLINE std::uint32_t bits_of(MI mask) {
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(i32, mask, bits);
    return bits[0];
  }
  static HWY_INLINE decltype(hn::IndicesFromVec(i32, hn::Zero(i32))) order_of(std::uint32_t bits) {
    const hn::Rebind<std::uint8_t, I> bytes;
    return hn::IndicesFromVec(i32, hn::PromoteTo(i32, hn::LoadU(bytes, orders.lane[bits])));
  }
  std::uint32_t bits_;
  decltype(hn::IndicesFromVec(i32, hn::Zero(i32))) order_;
};

/// The corners of a vector of triangles: x and y in 1/256 pixel from the picture's top-left corner.
struct Corners {
  VI x[3], y[3];
  VF z[3];
  VI id;
};

struct Extent {
  VI low_x, high_x, low_y, high_y;
};

HWY_INLINE Extent extent_of(const Corners& c) {
  return {hn::Min(hn::Min(c.x[0], c.x[1]), c.x[2]), hn::Max(hn::Max(c.x[0], c.x[1]), c.x[2]),
          hn::Min(hn::Min(c.y[0], c.y[1]), c.y[2]), hn::Max(hn::Max(c.y[0], c.y[1]), c.y[2])};
}

HWY_INLINE hn::Vec<hn::CappedTag<float, 4>> vertex(const ScreenVertex* screen, std::uint32_t i) {
  return hn::LoadU(hn::CappedTag<float, 4>(), reinterpret_cast<const float*>(screen + i));
}

/// Vertex i, and beside it the one that is four triangles on where a vector has room for it.
template <class V>
HWY_INLINE void load_row(const ScreenVertex* screen, const std::uint32_t* index, std::int32_t i, V& row) {
  const hn::DFromV<V> d;
  if constexpr (hn::MaxLanes(d) == 8)
    row = hn::Combine(d, vertex(screen, index[3 * i + 12]), vertex(screen, index[3 * i]));
  else
    row = vertex(screen, index[3 * i]);
}

/// The vertices index[0], index[3], index[6] ..., by member.
HWY_INLINE void load(const ScreenVertex* screen, const std::uint32_t* index, VI& x, VI& y, VF& z, VF& w) {
  VF r0, r1, r2, r3;
  load_row(screen, index, 0, r0);
  load_row(screen, index, 1, r1);
  load_row(screen, index, 2, r2);
  load_row(screen, index, 3, r3);
  const VF xy02 = hn::InterleaveLower(f, r0, r2), xy13 = hn::InterleaveLower(f, r1, r3);
  const VF zw02 = hn::InterleaveUpper(f, r0, r2), zw13 = hn::InterleaveUpper(f, r1, r3);
  x = hn::BitCast(i32, hn::InterleaveLower(f, xy02, xy13));
  y = hn::BitCast(i32, hn::InterleaveUpper(f, xy02, xy13));
  z = hn::InterleaveLower(f, zw02, zw13);
  w = hn::InterleaveUpper(f, zw02, zw13);
}

HWY_INLINE void swap_where(MI mask, VI& p, VI& q) {
  const VI t = hn::IfThenElse(mask, q, p);
  q = hn::IfThenElse(mask, p, q);
  p = t;
}

/// Lanes with a sample of the pattern within the bounds.
HWY_INLINE MI may_cover_a_sample(const Extent& e, const FrontRun& run) {
  MI found = hn::MaskFromVec(hn::Zero(i32));
  for (std::int32_t s = 0; s < run.sample_count; ++s) {
    const VI sx = set(run.sample_x[s]), sy = set(run.sample_y[s]), up = set(255);
    const VI first_x = hn::ShiftRight<8>(hn::Add(hn::Sub(e.low_x, sx), up));
    const VI first_y = hn::ShiftRight<8>(hn::Add(hn::Sub(e.low_y, sy), up));
    const MI none = hn::Or(hn::Gt(first_x, hn::ShiftRight<8>(hn::Sub(e.high_x, sx))),
                           hn::Gt(first_y, hn::ShiftRight<8>(hn::Sub(e.high_y, sy))));
    found = hn::Or(found, hn::Not(none));
    if (hn::AllTrue(i32, found)) break;
  }
  return found;
}

/// A vector of triangles that are set up: what small ones and records share.
struct SetUp {
  VI dx[3], dy[3];  ///< the edges opposite to the corners, clockwise
  VI bias[3];       ///< -1 where a point on the edge is outside
  VI area;          ///< doubled
  VI origin_x, origin_y;
  VD z0[2], dzdx[2], dzdy[2];  ///< depth at corner 0 and its gradients per 1/256 pixel: lower and upper lanes
  VF step_x, step_y;           ///< gradients per pixel
  VF z_low, z_high;
};

template <int half, class V>
HWY_INLINE VD widened(V v) {
  const hn::Half<hn::DFromV<V>> d;
  if constexpr (half == 0) return hn::PromoteTo(f64, hn::LowerHalf(d, v));
  return hn::PromoteTo(f64, hn::UpperHalf(d, v));
}

HWY_INLINE VF narrowed(VD lower, VD upper) {
  const H h;
  return hn::Combine(f, hn::DemoteTo(h, upper), hn::DemoteTo(h, lower));
}

/// The gradients of make_triangle, in its order of operations.
template <int half>
HWY_INLINE void set_up_depth(const Corners& c, SetUp& t) {
  const VD z0 = widened<half>(c.z[0]);
  const VD dz1 = hn::Sub(widened<half>(c.z[1]), z0), dz2 = hn::Sub(widened<half>(c.z[2]), z0);
  // From corner 0 to corner 1 goes the edge opposite to 2; to corner 2, against its direction, the one opposite to 1.
  const VD dx1 = widened<half>(t.dx[2]), dy1 = widened<half>(t.dy[2]);
  const VD dx2 = widened<half>(hn::Sub(c.x[2], c.x[0])), dy2 = widened<half>(hn::Sub(c.y[2], c.y[0]));
  const VD inverse_area = hn::Div(hn::Set(f64, 1.0), widened<half>(t.area));
  t.z0[half] = z0;
  t.dzdx[half] = hn::Mul(hn::Sub(hn::Mul(dz1, dy2), hn::Mul(dz2, dy1)), inverse_area);
  t.dzdy[half] = hn::Mul(hn::Sub(hn::Mul(dz2, dx1), hn::Mul(dz1, dx2)), inverse_area);
}

/// The edge opposite to corner k.
template <int k>
HWY_INLINE void set_up_edge(const Corners& c, bool is_top_left, SetUp& t) {
  constexpr int from = (k + 1) % 3, to = (k + 2) % 3;
  t.dx[k] = hn::Sub(c.x[to], c.x[from]);
  t.dy[k] = hn::Sub(c.y[to], c.y[from]);
  // An edge owns its points if dy < 0, or dy = 0 and dx > 0: the sign of one number, since |dx| < 2^15.
  const VI order = hn::Sub(hn::ShiftLeft<15>(t.dy[k]), t.dx[k]);
  t.bias[k] = is_top_left ? hn::Not(hn::BroadcastSignBit(order)) : hn::Zero(i32);
}

HWY_INLINE void set_up(const Corners& c, const Extent& e, bool is_top_left, SetUp& t) {
  set_up_edge<0>(c, is_top_left, t);
  set_up_edge<1>(c, is_top_left, t);
  set_up_edge<2>(c, is_top_left, t);
  t.area = hn::Sub(hn::Mul(t.dx[1], t.dy[2]), hn::Mul(t.dy[1], t.dx[2]));
  t.origin_x = hn::ShiftRight<8>(e.low_x);
  t.origin_y = hn::ShiftRight<8>(e.low_y);
  set_up_depth<0>(c, t);
  set_up_depth<1>(c, t);
  const VD pixel = hn::Set(f64, 256.0);
  t.step_x = narrowed(hn::Mul(t.dzdx[0], pixel), hn::Mul(t.dzdx[1], pixel));
  t.step_y = narrowed(hn::Mul(t.dzdy[0], pixel), hn::Mul(t.dzdy[1], pixel));
  t.z_low = hn::Min(hn::Min(c.z[0], c.z[1]), c.z[2]);
  t.z_high = hn::Max(hn::Max(c.z[0], c.z[1]), c.z[2]);
}

template <int half>
HWY_INLINE VD depth_at_origin(const SetUp& t, VI dx, VI dy) {
  return hn::Add(hn::Add(t.z0[half], hn::Mul(t.dzdx[half], widened<half>(dx))),
                 hn::Mul(t.dzdy[half], widened<half>(dy)));
}

/// The candidates of one sample: the edges at the first pixel where the bounds hold it, and their steps.
struct Candidates {
  VI pixel_x, pixel_y;
  VI e[3];
  VF z;       ///< depth of the sample at the triangle's first pixel, not clamped
  VF x0, y0;  ///< from the triangle's first pixel to the first candidate
};

template <int k>
HWY_INLINE VI edge_at(const Corners& c, const SetUp& t, VI px, VI py) {
  constexpr int from = (k + 1) % 3;
  return hn::Sub(hn::Mul(t.dx[k], hn::Sub(py, c.y[from])), hn::Mul(t.dy[k], hn::Sub(px, c.x[from])));
}

HWY_INLINE Candidates candidates_of(const Corners& c, const Extent& e, const SetUp& t, std::int32_t sx,
                                    std::int32_t sy) {
  Candidates out;
  out.pixel_x = hn::ShiftRight<8>(hn::Add(e.low_x, set(255 - sx)));
  out.pixel_y = hn::ShiftRight<8>(hn::Add(e.low_y, set(255 - sy)));
  const VI px = hn::Add(hn::ShiftLeft<8>(out.pixel_x), set(sx)), py = hn::Add(hn::ShiftLeft<8>(out.pixel_y), set(sy));
  const VI e1 = edge_at<1>(c, t, px, py), e2 = edge_at<2>(c, t, px, py);
  out.e[0] = hn::Add(hn::Sub(hn::Sub(t.area, e1), e2), t.bias[0]);
  out.e[1] = hn::Add(e1, t.bias[1]);
  out.e[2] = hn::Add(e2, t.bias[2]);
  const VI dx = hn::Sub(hn::Add(hn::ShiftLeft<8>(t.origin_x), set(sx)), c.x[0]);
  const VI dy = hn::Sub(hn::Add(hn::ShiftLeft<8>(t.origin_y), set(sy)), c.y[0]);
  out.z = narrowed(depth_at_origin<0>(t, dx, dy), depth_at_origin<1>(t, dx, dy));
  out.x0 = hn::ConvertTo(f, hn::Sub(out.pixel_x, t.origin_x));
  out.y0 = hn::ConvertTo(f, hn::Sub(out.pixel_y, t.origin_y));
  return out;
}

/// Calls emit(mask, i, j, depth) if the candidate pixel (i, j) has lanes inside.
template <class Emit>
HWY_INLINE void cover_pixel(const SetUp& t, const Candidates& c, VI outside, VF base, int i, int j, const Emit& emit) {
  const MI inside = hn::Not(hn::MaskFromVec(hn::BroadcastSignBit(outside)));
  if (hn::AllFalse(i32, inside)) return;
  const VF z = hn::Add(base, hn::Mul(t.step_x, hn::Add(c.x0, hn::Set(f, static_cast<float>(i)))));
  emit(inside, i, j, hn::Min(hn::Max(z, t.z_low), t.z_high));
}

/// The edges' values at a pixel.
struct Edges {
  VI e0, e1, e2;
  HWY_INLINE Edges right(const SetUp& t) const {
    return {hn::Sub(e0, hn::ShiftLeft<8>(t.dy[0])), hn::Sub(e1, hn::ShiftLeft<8>(t.dy[1])),
            hn::Sub(e2, hn::ShiftLeft<8>(t.dy[2]))};
  }
  HWY_INLINE Edges down(const SetUp& t) const {
    return {hn::Add(e0, hn::ShiftLeft<8>(t.dx[0])), hn::Add(e1, hn::ShiftLeft<8>(t.dx[1])),
            hn::Add(e2, hn::ShiftLeft<8>(t.dx[2]))};
  }
  HWY_INLINE VI outside(VI dead) const { return hn::Or(hn::Or(e0, e1), hn::Or(e2, dead)); }
};

/// The same for the two pixels from (i, j) on; gives the edges at the second.
template <class Emit>
HWY_INLINE Edges cover_pair(const SetUp& t, const Candidates& c, Edges e, VI dead, int i, int j, const Emit& emit) {
  const VF base = hn::Add(c.z, hn::Mul(t.step_y, hn::Add(c.y0, hn::Set(f, static_cast<float>(j)))));
  const Edges next = e.right(t);
  cover_pixel(t, c, e.outside(dead), base, i, j, emit);
  cover_pixel(t, c, next.outside(dead), base, i + 1, j, emit);
  return next;
}

/// The same for all candidates, two columns at a time: what lies beyond the bounds is outside.
template <class Emit>
HWY_INLINE void cover(const SetUp& t, const Candidates& c, VI dead, int columns, int rows, const Emit& emit) {
  Edges row{c.e[0], c.e[1], c.e[2]};
  for (int j = 0; j < rows; ++j, row = row.down(t)) {
    Edges e = cover_pair(t, c, row, dead, 0, j, emit);
    for (int i = 2; i < columns; i += 2) e = cover_pair(t, c, e.right(t), dead, i, j, emit);
  }
}

/// The same where two columns and two rows hold all candidates: most triangles of a dense mesh.
template <class Emit>
HWY_INLINE void cover_2x2(const SetUp& t, const Candidates& c, VI dead, const Emit& emit) {
  const Edges row{c.e[0], c.e[1], c.e[2]};
  cover_pair(t, c, row, dead, 0, 0, emit);
  cover_pair(t, c, row.down(t), dead, 0, 1, emit);
}

/// Puts whole vectors into the list of one tile.
struct Append {
  FragmentSink& sink;
  std::int32_t tile;
  VI first;  ///< where the first candidates lie
  VI id;

  HWY_INLINE void operator()(MI mask, int i, int j, VF z) const {
    SampleFragments* part = sink.last[tile];
    if (!part || part->count > SampleFragments::capacity - lanes) part = sink.grow(sink, tile);
    const Packing packing(mask);
    const std::int32_t at = part->count;
    packing.store(z, part->depth + at);
    packing.store(id, part->id + at);
    packing.store(hn::Add(first, set(j * 64 + i)), reinterpret_cast<std::int32_t*>(part->at) + at);
    part->count = at + packing.count();
  }
};

/// Puts lanes one by one into the lists of their tiles, where they lie in the rectangle.
struct Scatter {
  const FrontRun& run;
  FragmentSink& sink;
  const Candidates& candidates;
  VI id;
  std::int32_t sample;

  HWY_NOINLINE void operator()(MI mask, int i, int j, VF z) const {
    alignas(64) std::int32_t x[lanes], y[lanes], ids[lanes];
    alignas(64) float depth[lanes];
    hn::Store(hn::Add(candidates.pixel_x, set(i)), i32, x);
    hn::Store(hn::Add(candidates.pixel_y, set(j)), i32, y);
    hn::Store(id, i32, ids);
    hn::Store(z, f, depth);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(i32, mask, bits);
    for (std::uint32_t left = bits[0]; left; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      const std::int32_t px = x[lane], py = y[lane];
      if (px < run.left || px > run.right || py < run.top || py > run.bottom) continue;
      const std::int32_t tile = ((py >> 6) - sink.first_row) * sink.columns + (px >> 6) - sink.first_column;
      SampleFragments* part = sink.last[tile];
      if (!part || part->count == SampleFragments::capacity) part = sink.grow(sink, tile);
      part->depth[part->count] = depth[lane];
      part->id[part->count] = ids[lane];
      part->at[part->count++] = static_cast<std::uint32_t>((sample << 12) + ((py & 63) << 6) + (px & 63));
    }
  }
};

/// The members of a vector of Triangles, structure of arrays.
struct RecordLanes {
  alignas(64) std::int32_t a[3][lanes], b[3][lanes], bias[3][lanes];
  alignas(64) std::int64_t c[3][lanes];  ///< without the bias; the even lanes, then the odd ones
  alignas(64) std::int32_t min_x[lanes], min_y[lanes], max_x[lanes], max_y[lanes], x0[lanes], y0[lanes], id[lanes];
  alignas(64) double z0[lanes], dzdx[lanes], dzdy[lanes];
  alignas(64) float z_low[lanes], z_high[lanes];

  static HWY_INLINE VI odd(VI v) {
    const hn::Repartition<std::int64_t, I> i64;
    return hn::BitCast(i32, hn::ShiftRight<32>(hn::BitCast(i64, v)));
  }

  template <int k>
  HWY_INLINE void store_edge(const Corners& corners, const SetUp& t) {
    constexpr int from = (k + 1) % 3;
    const hn::Repartition<std::int64_t, I> i64;
    const VI dx = t.dx[k], dy = t.dy[k], x = corners.x[from], y = corners.y[from];
    hn::Store(hn::Neg(dy), i32, a[k]);
    hn::Store(dx, i32, b[k]);
    hn::Store(t.bias[k], i32, bias[k]);
    hn::Store(hn::Sub(hn::MulEven(dy, x), hn::MulEven(dx, y)), i64, c[k]);
    hn::Store(hn::Sub(hn::MulEven(odd(dy), odd(x)), hn::MulEven(odd(dx), odd(y))), i64, c[k] + lanes / 2);
  }

  HWY_INLINE void store_rest(const Corners& corners, const Extent& e, const SetUp& t) {
    hn::Store(t.origin_x, i32, min_x);
    hn::Store(t.origin_y, i32, min_y);
    hn::Store(hn::ShiftRight<8>(e.high_x), i32, max_x);
    hn::Store(hn::ShiftRight<8>(e.high_y), i32, max_y);
    hn::Store(corners.x[0], i32, x0);
    hn::Store(corners.y[0], i32, y0);
    hn::Store(corners.id, i32, id);
    store_halves(t.z0, z0);
    store_halves(t.dzdx, dzdx);
    store_halves(t.dzdy, dzdy);
    hn::Store(t.z_low, f, z_low);
    hn::Store(t.z_high, f, z_high);
  }

  static HWY_INLINE void store_halves(const VD* v, double* to) {
    hn::Store(v[0], f64, to);
    hn::Store(v[1], f64, to + lanes / 2);
  }

  HWY_INLINE void copy(int lane, Triangle& t) const {
    const int place = (lane & 1) * (lanes / 2) + lane / 2;
    for (int k = 0; k < 3; ++k) {
      t.a[k] = a[k][lane], t.b[k] = b[k][lane];
      t.c[k] = c[k][place] + bias[k][lane];
    }
    t.min_x = min_x[lane], t.min_y = min_y[lane], t.max_x = max_x[lane], t.max_y = max_y[lane];
    t.x0 = x0[lane], t.y0 = y0[lane];
    t.z0 = z0[lane], t.dzdx = dzdx[lane], t.dzdy = dzdy[lane];
    t.z_low = z_low[lane], t.z_high = z_high[lane];
    t.id = id[lane];
  }
};

class Front {
 public:
  Front(const FrontRun& run, FragmentSink& sink, FrontResult& result) : run_(run), sink_(sink), result_(result) {}

  HWY_INLINE void run() {
    result_.general_count = result_.kept_count = 0, result_.drawn = 0;
    std::int32_t t = 0;
    for (; t + lanes <= run_.count; t += lanes) select(run_.index + 3 * t, t, hn::Eq(hn::Zero(i32), hn::Zero(i32)));
    if (t < run_.count) {
      // The last triangles are copied into a whole vector's room.
      std::uint32_t index[3 * lanes];
      for (std::int32_t k = 0; k < 3 * lanes; ++k)
        index[k] = run_.index[3 * t + (3 * t + k < 3 * run_.count ? k : k % 3)];
      select(index, t, hn::FirstN(i32, static_cast<std::size_t>(run_.count - t)));
    }
    if (queued_ > 0) draw_queued(queued_);
  }

 private:
  HWY_INLINE void list(MI mask, VI number, std::int32_t* to, std::int32_t& count) {
    const Packing packing(mask);
    packing.store(number, to + count);
    count += packing.count();
  }

  HWY_INLINE void select(const std::uint32_t* index, std::int32_t t, MI asked) {
    Corners c;
    VF w[3];
    load(run_.screen, index, c.x[0], c.y[0], c.z[0], w[0]);
    load(run_.screen, index + 1, c.x[1], c.y[1], c.z[1], w[1]);
    load(run_.screen, index + 2, c.x[2], c.y[2], c.z[2], w[2]);
    const VI centre_x = set(run_.viewport.width * 128), centre_y = set(run_.viewport.height * 128);
    c.x[0] = hn::Add(c.x[0], centre_x), c.y[0] = hn::Add(c.y[0], centre_y);
    c.x[1] = hn::Add(c.x[1], centre_x), c.y[1] = hn::Add(c.y[1], centre_y);
    c.x[2] = hn::Add(c.x[2], centre_x), c.y[2] = hn::Add(c.y[2], centre_y);
    const Extent e = extent_of(c);
    const VI size = hn::Max(hn::Sub(e.high_x, e.low_x), hn::Sub(e.high_y, e.low_y));
    const VI number = hn::Add(hn::Iota(i32, 0), set(t));
    const MI clipped = hn::RebindMask(i32, hn::Eq(hn::Min(hn::Min(w[0], w[1]), w[2]), hn::Zero(f)));
    const MI general = hn::And(asked, hn::Or(clipped, hn::Gt(size, set(large_extent))));
    if (!hn::AllFalse(i32, general)) list(general, number, result_.general, result_.general_count);

    // A wrong area of a general lane does no harm: it is not looked at.
    const VI area = hn::Sub(hn::Mul(hn::Sub(c.x[1], c.x[0]), hn::Sub(c.y[2], c.y[0])),
                            hn::Mul(hn::Sub(c.y[1], c.y[0]), hn::Sub(c.x[2], c.x[0])));
    const VI zero = hn::Zero(i32);
    const MI backward = hn::Lt(area, zero), forward = hn::Gt(area, zero);
    const MI facing = run_.facing > 0 ? forward : run_.facing < 0 ? backward : hn::Or(forward, backward);
    MI kept = hn::And(hn::AndNot(general, asked), facing);
    if (hn::AllFalse(i32, kept)) return;
    const MI beside =
        hn::Or(hn::Or(hn::Gt(e.low_x, set(run_.right * 256 + 255)), hn::Lt(e.high_x, set(run_.left * 256))),
               hn::Or(hn::Gt(e.low_y, set(run_.bottom * 256 + 255)), hn::Lt(e.high_y, set(run_.top * 256))));
    kept = hn::And(hn::AndNot(beside, kept), may_cover_a_sample(e, run_));

    const MI small = hn::AndNot(hn::Gt(size, set(run_.small_extent)), kept);
    const MI larger = hn::AndNot(small, kept);
    // Corners are taken clockwise.
    if (run_.facing <= 0) {
      swap_where(backward, c.x[1], c.x[2]);
      swap_where(backward, c.y[1], c.y[2]);
      const VF z = hn::IfThenElse(hn::RebindMask(f, backward), c.z[2], c.z[1]);
      c.z[2] = hn::IfThenElse(hn::RebindMask(f, backward), c.z[1], c.z[2]);
      c.z[1] = z;
    }
    c.id = hn::Add(number, set(run_.first_id));
    if (!hn::AllFalse(i32, larger)) {
      if (run_.records)
        record(c, e, larger);
      else
        list(larger, number, result_.kept, result_.kept_count);
    }
    const auto count = static_cast<std::int32_t>(hn::CountTrue(i32, small));
    if (count == 0) return;
    result_.drawn += static_cast<std::uint64_t>(count);

    if (8 * count >= 5 * lanes) {
      draw(c, e, small);
    } else {
      enqueue(c, small);
    }
  }

  // Few survivors of a vector wait until they are enough for one.
  HWY_INLINE void enqueue(const Corners& c, MI mask) {
    const Packing packing(mask);
    store_corner<0>(c, packing);
    store_corner<1>(c, packing);
    store_corner<2>(c, packing);
    packing.store(c.id, queue_id_ + queued_);
    queued_ += packing.count();
    if (queued_ < lanes) return;
    draw_queued(lanes);
    for (int k = 0; k < 3; ++k) {
      hn::Store(hn::Load(i32, queue_x_[k] + lanes), i32, queue_x_[k]);
      hn::Store(hn::Load(i32, queue_y_[k] + lanes), i32, queue_y_[k]);
      hn::Store(hn::Load(f, queue_z_[k] + lanes), f, queue_z_[k]);
    }
    hn::Store(hn::Load(i32, queue_id_ + lanes), i32, queue_id_);
    queued_ -= lanes;
  }

  template <int k>
  HWY_INLINE void store_corner(const Corners& c, const Packing& packing) {
    packing.store(c.x[k], queue_x_[k] + queued_);
    packing.store(c.y[k], queue_y_[k] + queued_);
    packing.store(c.z[k], queue_z_[k] + queued_);
  }

  template <int k>
  HWY_INLINE void load_corner(Corners& c) {
    c.x[k] = hn::Load(i32, queue_x_[k]);
    c.y[k] = hn::Load(i32, queue_y_[k]);
    c.z[k] = hn::Load(f, queue_z_[k]);
  }

  HWY_INLINE void draw_queued(std::int32_t count) {
    Corners c;
    load_corner<0>(c);
    load_corner<1>(c);
    load_corner<2>(c);
    c.id = hn::Load(i32, queue_id_);
    draw(c, extent_of(c), hn::FirstN(i32, static_cast<std::size_t>(count)));
  }

  // What make_triangle does.
  HWY_NOINLINE void record(const Corners& c, const Extent& e, MI mask) {
    SetUp t;
    set_up(c, e, run_.is_top_left, t);
    RecordLanes r;
    r.store_edge<0>(c, t);
    r.store_edge<1>(c, t);
    r.store_edge<2>(c, t);
    r.store_rest(c, e, t);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(i32, mask, bits);
    for (std::uint32_t left = bits[0]; left; left &= left - 1)
      r.copy(__builtin_ctz(left), run_.records[result_.kept_count++]);
  }

  HWY_NOINLINE void draw(const Corners& c, const Extent& e, MI alive) {
    SetUp t;
    set_up(c, e, run_.is_top_left, t);
    const VI dead = hn::VecFromMask(i32, hn::Not(alive));
    // A sample of one kind has at most so many candidates among the pixels.
    const VI extent_x = hn::AndNot(dead, hn::Sub(e.high_x, e.low_x)),
             extent_y = hn::AndNot(dead, hn::Sub(e.high_y, e.low_y));
    const int columns = (hn::GetLane(hn::MaxOfLanes(i32, extent_x)) >> 8) + 1;
    const int rows = (hn::GetLane(hn::MaxOfLanes(i32, extent_y)) >> 8) + 1;

    // Where all lanes lie in one tile and in the rectangle, whole vectors go to one list.
    alignas(64) std::int32_t column[lanes], row[lanes];
    hn::Store(hn::ShiftRight<14>(e.low_x), i32, column);
    hn::Store(hn::ShiftRight<14>(e.low_y), i32, row);
    const auto first = static_cast<std::size_t>(hn::FindFirstTrue(i32, alive));
    const std::int32_t left = greatest(column[first] * 64, run_.left), top = greatest(row[first] * 64, run_.top);
    const std::int32_t right = least(column[first] * 64 + 63, run_.right),
                       bottom = least(row[first] * 64 + 63, run_.bottom);
    const VI beyond = hn::Or(hn::Or(hn::Sub(e.low_x, set(left * 256)), hn::Sub(set(right * 256 + 255), e.high_x)),
                             hn::Or(hn::Sub(e.low_y, set(top * 256)), hn::Sub(set(bottom * 256 + 255), e.high_y)));
    const bool is_one_tile = hn::AllFalse(i32, hn::And(alive, hn::Lt(beyond, hn::Zero(i32))));
    const std::int32_t tile = (row[first] - sink_.first_row) * sink_.columns + column[first] - sink_.first_column;
    for (std::int32_t s = 0; s < run_.sample_count; ++s) {
      const Candidates n = candidates_of(c, e, t, run_.sample_x[s], run_.sample_y[s]);
      if (!is_one_tile) {
        cover(t, n, dead, columns, rows, Scatter{run_, sink_, n, c.id, s});
        continue;
      }
      const VI in_tile = set(63);
      const VI place = hn::Add(hn::ShiftLeft<6>(hn::And(n.pixel_y, in_tile)), hn::And(n.pixel_x, in_tile));
      const Append append{sink_, tile, hn::Add(place, set(s << 12)), c.id};
      if (columns <= 2 && rows <= 2)
        cover_2x2(t, n, dead, append);
      else
        cover(t, n, dead, columns, rows, append);
    }
  }

  static std::int32_t least(std::int32_t p, std::int32_t q) { return p < q ? p : q; }
  static std::int32_t greatest(std::int32_t p, std::int32_t q) { return p > q ? p : q; }

  const FrontRun& run_;
  FragmentSink& sink_;
  FrontResult& result_;
  std::int32_t queued_ = 0;
  alignas(64) std::int32_t queue_x_[3][3 * lanes], queue_y_[3][3 * lanes], queue_id_[3 * lanes];
  alignas(64) float queue_z_[3][3 * lanes];
};

void run_front(const FrontRun& run, FragmentSink& sink, FrontResult& result) { Front(run, sink, result).run(); }

}  // namespace

extern const FrontKernels front_kernels;
const FrontKernels front_kernels = {.run = run_front};

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
