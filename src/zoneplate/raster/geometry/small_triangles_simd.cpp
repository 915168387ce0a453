// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/raster/geometry/small_triangle_simd.h"
#include "zoneplate/raster/geometry/small_triangles.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// The active lanes whose bounds, of that size, contain a sample of the pattern.
HWY_INLINE MI may_cover_a_sample(const Extent& e, VI width, VI height, const SmallTriangleRun& run, MI active) {
  MI found = hn::MaskFromVec(hn::Zero(i32));
  for (std::int32_t s = 0; s < run.sample_count; ++s) {
    const MI none =
        hn::Or(hn::Gt(up_to(run.sample_x[s], e.low_x), width), hn::Gt(up_to(run.sample_y[s], e.low_y), height));
    found = hn::Or(found, hn::AndNot(none, active));
    if (hn::AllFalse(i32, hn::AndNot(found, active))) break;
  }
  return found;
}

/// Lanes with a pixel of the rectangle within the bounds.
HWY_INLINE MI meets_rectangle(const Extent& e, const SmallTriangleRun& run) {
  const VI beside =
      hn::Or(hn::Or(hn::Sub(set(run.right * 256 + 255), e.low_x), hn::Sub(e.high_x, set(run.left * 256))),
             hn::Or(hn::Sub(set(run.bottom * 256 + 255), e.low_y), hn::Sub(e.high_y, set(run.top * 256))));
  return hn::Not(hn::MaskFromVec(hn::BroadcastSignBit(beside)));
}

/// The work on one run, a vector of triangles at a time.
class Front {
 public:
  Front(const SmallTriangleRun& run, SampleBinWriter& sink, SmallTriangleResult& result)
      : run_(run), sink_(sink), result_(result) {
    for (std::int32_t s = 0; s < run.sample_count && s < SampleBin::max_samples; ++s)
      sample_x_[s] = run.sample_x[s], sample_y_[s] = run.sample_y[s];
  }

  HWY_INLINE void run() {
    result_.deferred_count = result_.visible_count = 0, result_.drawn = 0;
    std::int32_t t = 0;
    for (; t + lanes <= run_.count; t += lanes) select(run_.index + 3 * t, t, hn::Eq(hn::Zero(i32), hn::Zero(i32)));
    if (t < run_.count) {
      // The last triangles are copied into an array of a whole vector.
      std::uint32_t index[3 * lanes];
      for (std::int32_t k = 0; k < 3 * lanes; ++k)
        index[k] = run_.index[3 * t + (3 * t + k < 3 * run_.count ? k : k % 3)];
      select(index, t, hn::FirstN(i32, static_cast<std::size_t>(run_.count - t)));
    }
    draw_queue(true);
    draw_samples(true);
  }

 private:
  HWY_INLINE void list(MI mask, VI number, std::int32_t* to, std::int32_t& count) {
    const Packing<DI> packing(mask);
    packing.store(number, to + count);
    count += packing.count();
  }

  HWY_INLINE void select(const std::uint32_t* index, std::int32_t t, MI active) {
    Corners c;
    const MI clipped = load(run_.screen, index, run_.viewport, c);
    const Extent e = extent_of(c);
    const VI width = hn::Sub(e.high_x, e.low_x), height = hn::Sub(e.high_y, e.low_y), size = hn::Max(width, height);
    const VI number = hn::Add(hn::Iota(i32, 0), set(t));
    const MI deferred = hn::And(active, hn::Or(clipped, hn::Gt(size, set(large_extent))));
    if (!hn::AllFalse(i32, deferred)) list(deferred, number, result_.deferred, result_.deferred_count);

    // The area of a deferred lane may be wrong; it is not used.
    const VI area = hn::Sub(hn::Mul(hn::Sub(c.x[1], c.x[0]), hn::Sub(c.y[2], c.y[0])),
                            hn::Mul(hn::Sub(c.y[1], c.y[0]), hn::Sub(c.x[2], c.x[0])));
    const MI backward = hn::Lt(area, hn::Zero(i32)), forward = hn::Gt(area, hn::Zero(i32));
    const MI facing = run_.facing > 0 ? forward : run_.facing < 0 ? backward : hn::Or(forward, backward);
    MI kept = hn::And(hn::AndNot(deferred, active), facing);
    if (hn::AllFalse(i32, kept)) return;
    kept = may_cover_a_sample(e, width, height, run_, hn::And(kept, meets_rectangle(e, run_)));
    if (hn::AllFalse(i32, kept)) return;
    const MI small = hn::AndNot(hn::Gt(size, set(run_.small_extent)), kept);

    // The vertices are ordered clockwise.
    if (run_.facing <= 0) {
      swap_where(backward, c.x[1], c.x[2]);
      swap_where(backward, c.y[1], c.y[2]);
      swap_where(hn::RebindMask(f, backward), c.z[1], c.z[2]);
    }
    c.id = hn::Add(number, set(run_.first_id));
    keep(c, e, number, hn::AndNot(small, kept));
    if (hn::AllFalse(i32, small)) return;
    result_.drawn += hn::CountTrue(i32, small);
    if (run_.sample_count == 1 && cover(c, e, width, height, hn::Abs(area), small)) return;
    queue_.add(c, Packing<DI>(small));
    if (queue_.count >= TriangleQueue::threshold) draw_queue(false);
  }

  HWY_INLINE void keep(const Corners& c, const Extent& e, VI number, MI mask) {
    if (hn::AllFalse(i32, mask)) return;
    if (run_.records)
      record(c, e, mask);
    else
      list(mask, number, result_.visible, result_.visible_count);
  }

  // For one sample per pixel: finds the covered samples before setup, since half of the tiny triangles cover none.
  // False if there may be many.
  HWY_INLINE bool cover(const Corners& c, const Extent& e, VI width, VI height, VI area, MI small) {
    const VI to_x = up_to(run_.sample_x[0], e.low_x), to_y = up_to(run_.sample_y[0], e.low_y);
    const VI more = hn::IfThenElseZero(small, hn::Max(hn::Sub(width, to_x), hn::Sub(height, to_y)));
    if (!hn::AllFalse(i32, hn::Gt(more, set(767)))) return false;
    SetUp t;
    set_up_edges(c, run_.edge_rule, t);
    const VI px = hn::Add(e.low_x, to_x), py = hn::Add(e.low_y, to_y);
    t.area = area;
    const Edges first = edges_at(c, t, px, py);
    const VI dead = hn::VecFromMask(i32, hn::Not(small));
    const MI is_wide = hn::Gt(more, set(511));
    add_samples(c, px, py, hn::AllFalse(i32, is_wide) ? covered<2>(t, first, dead) : covered<3>(t, first, dead));
    if (samples_.count >= TriangleQueue::threshold) draw_samples(false);
    return true;
  }

  static HWY_INLINE Edges edges_at(const Corners& c, const SetUp& t, VI px, VI py) {
    const VI e1 = edge_at<1>(c, t, px, py), e2 = edge_at<2>(c, t, px, py);
    return {hn::Add(hn::Sub(hn::Sub(t.area, e1), e2), t.bias[0]), hn::Add(e1, t.bias[1]), hn::Add(e2, t.bias[2])};
  }

  // A bit (4 j + i) << shift for each of the first pixels (i, j) whose sample is covered. Pixels beyond the bounds are
  // outside.
  template <int n, int shift = 0>
  static HWY_INLINE VI covered(const SetUp& t, const Edges& first, VI dead) {
    VI bits = hn::Zero(i32);
    Edges row = first;
    for (int j = 0; j < n; ++j, row = row.down(t)) {
      Edges at = row;
      for (int i = 0; i < n; ++i, at = at.right(t))
        bits = hn::Or(bits, hn::AndNot(hn::BroadcastSignBit(at.outside(dead)), set(1 << ((4 * j + i) << shift))));
    }
    return bits;
  }

  // The exponent of a power of two.
  static HWY_INLINE VI exponent_of(VI power) {
    return hn::Sub(hn::ShiftRight<23>(hn::BitCast(i32, hn::ConvertTo(f, power))), set(127));
  }

  // Most triangles have no sample or one.
  HWY_INLINE void add_samples(const Corners& c, VI px, VI py, VI bits) {
    const VI zero = hn::Zero(i32), step = set(0x300);
    for (MI mask = hn::Gt(bits, zero); !hn::AllFalse(i32, mask); mask = hn::Gt(bits, zero)) {
      const VI rest = hn::And(bits, hn::Sub(bits, set(1)));
      const VI place = exponent_of(hn::Xor(bits, rest));
      const VI x = hn::Add(px, hn::And(hn::ShiftLeft<8>(place), step));
      const VI y = hn::Add(py, hn::And(hn::ShiftLeft<6>(place), step));
      samples_.add(c, x, y, Packing<DI>(mask));
      bits = rest;
    }
  }

  HWY_NOINLINE void draw_samples(bool is_end) {
    samples_.take(is_end, [&](std::int32_t i, MI alive) HWY_ATTR { draw_samples_at(i, alive); });
  }

  HWY_INLINE void draw_samples_at(std::int32_t i, MI alive) {
    const Corners c = samples_.get(i);
    const VI px = hn::Load(i32, samples_.sample_x + i), py = hn::Load(i32, samples_.sample_y + i);
    const VI pixel_x = hn::ShiftRight<8>(px), pixel_y = hn::ShiftRight<8>(py);
    SetUp t;
    t.dx[2] = hn::Sub(c.x[1], c.x[0]), t.dy[2] = hn::Sub(c.y[1], c.y[0]);
    set_up_plane(c, hn::Min(hn::Min(c.x[0], c.x[1]), c.x[2]), hn::Min(hn::Min(c.y[0], c.y[1]), c.y[2]), t);
    const VI way_x = hn::Sub(hn::ShiftLeft<8>(t.origin_x), c.x[0]),
             way_y = hn::Sub(hn::ShiftLeft<8>(t.origin_y), c.y[0]);
    const VF z =
        depth_of(t, hn::Add(way_x, set(run_.sample_x[0])), hn::Add(way_y, set(run_.sample_y[0])), pixel_x, pixel_y);
    store_by_tile(run_, sink_, alive, pixel_x, pixel_y, z, packed_at(c.id, pixel_x, pixel_y));
  }

  HWY_NOINLINE void draw_queue(bool is_end) {
    queue_.take(is_end, [&](std::int32_t i, MI alive) HWY_ATTR {
      const Corners c = queue_.get(i);
      draw(c, extent_of(c), alive);
    });
  }

  // The same as make_triangle.
  HWY_NOINLINE void record(Corners c, Extent e, MI mask) {
    SetUp t;
    set_up(c, e, run_.edge_rule, t);
    RecordLanes r;
    r.store_edge<0>(c, t);
    r.store_edge<1>(c, t);
    r.store_edge<2>(c, t);
    r.store_rest(c, e, t);
    for (std::uint32_t left = bits_of(i32, mask); left; left &= left - 1)
      r.copy(__builtin_ctz(left), run_.records[result_.visible_count++]);
  }

  HWY_NOINLINE void draw(const Corners& c, const Extent& e, MI alive) {
    SetUp t;
    set_up(c, e, run_.edge_rule, t);
    const VI dead = hn::VecFromMask(i32, hn::Not(alive));
    const VI width = hn::AndNot(dead, hn::Sub(e.high_x, e.low_x));
    const VI height = hn::AndNot(dead, hn::Sub(e.high_y, e.low_y));
    const Work work{c, e, t, Way(c, t), dead};
    const std::int32_t tile = tile_of_all(e, dead);
    const VI size = hn::Max(width, height);
    if (hn::AllFalse(i32, hn::Gt(size, set(511)))) return draw_few<2, 2>(work, tile);
    if (hn::AllFalse(i32, hn::Gt(size, set(767)))) return draw_few<3, 1>(work, tile);
    // A sample has at most one candidate more in each direction than the bounds have whole pixels.
    if (tile < 0) {
      scatter(work, candidates(width), candidates(height));
    } else {
      append_many(work, tile, candidates(width), candidates(height));
    }
  }

  static HWY_INLINE int candidates(VI extent) { return (hn::GetLane(hn::MaxOfLanes(i32, extent)) >> 8) + 1; }

  /// A vector of triangles while their samples are found.
  struct Work {
    const Corners& c;
    const Extent& e;
    const SetUp& t;
    Way way;
    VI dead;
  };

  // If n × n pixels contain all candidates: the coverage of several samples is found first, as one bit mask a lane.
  // Then the covered samples are drawn: the first of every triangle together, then the second, and so on.
  template <int n, int shift>
  HWY_INLINE void draw_few(const Work& w, std::int32_t tile) {
    constexpr std::int32_t group = 1 << shift;
    for (std::int32_t first = 0; first < run_.sample_count; first += group) {
      VI bits = hn::Zero(i32);
      for (std::int32_t k = 0; k < group && first + k < run_.sample_count; ++k) {
        const VI px = hn::Add(w.e.low_x, up_to(run_.sample_x[first + k], w.e.low_x));
        const VI py = hn::Add(w.e.low_y, up_to(run_.sample_y[first + k], w.e.low_y));
        bits = hn::Or(bits, hn::ShiftLeftSame(covered<n, shift>(w.t, edges_at(w.c, w.t, px, py), w.dead), k));
      }
      draw_covered<shift>(w, tile, first, bits);
    }
  }

  template <int shift>
  HWY_INLINE void draw_covered(const Work& w, std::int32_t tile, std::int32_t first, VI bits) {
    const VI sample_x = hn::LoadU(i32, sample_x_ + first), sample_y = hn::LoadU(i32, sample_y_ + first);
    const VI way_x = hn::Sub(hn::ShiftLeft<8>(w.t.origin_x), w.c.x[0]),
             way_y = hn::Sub(hn::ShiftLeft<8>(w.t.origin_y), w.c.y[0]);
    const VI zero = hn::Zero(i32), pixels = set(0x300), fraction = set(255);
    for (MI mask = hn::Gt(bits, zero); !hn::AllFalse(i32, mask); mask = hn::Gt(bits, zero)) {
      const VI rest = hn::And(bits, hn::Sub(bits, set(1)));
      const VI place = exponent_of(hn::Xor(bits, rest));
      bits = rest;
      const VI k = hn::And(place, set((1 << shift) - 1));
      const auto lane = hn::IndicesFromVec(i32, k);
      const VI sx = hn::TableLookupLanes(sample_x, lane), sy = hn::TableLookupLanes(sample_y, lane);
      const VI to_x =
          hn::Add(hn::And(hn::Sub(sx, w.e.low_x), fraction), hn::And(hn::ShiftLeft<8 - shift>(place), pixels));
      const VI to_y =
          hn::Add(hn::And(hn::Sub(sy, w.e.low_y), fraction), hn::And(hn::ShiftLeft<6 - shift>(place), pixels));
      const VI pixel_x = hn::ShiftRight<8>(hn::Add(w.e.low_x, to_x)),
               pixel_y = hn::ShiftRight<8>(hn::Add(w.e.low_y, to_y));
      const VF z = depth_of(w.t, hn::Add(way_x, sx), hn::Add(way_y, sy), pixel_x, pixel_y);
      const VI packed = hn::Add(packed_at(w.c.id, pixel_x, pixel_y), hn::ShiftLeft<12>(hn::Add(k, set(first))));
      if (tile >= 0)
        store_in_tile(run_, sink_, tile, mask, z, packed);
      else
        store_by_tile(run_, sink_, mask, pixel_x, pixel_y, z, packed);
    }
  }

  // Depth of a sample of each triangle, at the given distance from vertex 0 in the triangle's first pixel.
  static HWY_INLINE VF depth_of(const SetUp& t, VI x, VI y, VI pixel_x, VI pixel_y) {
    const auto at = [&](VD z0, VD dzdx, VD dzdy, VD dx, VD dy)
                        HWY_ATTR { return hn::Add(hn::Add(z0, hn::Mul(dzdx, dx)), hn::Mul(dzdy, dy)); };
    const VF first = narrowed(at(t.z0[0], t.dzdx[0], t.dzdy[0], widened<0>(x), widened<0>(y)),
                              at(t.z0[1], t.dzdx[1], t.dzdy[1], widened<1>(x), widened<1>(y)));
    const VF row = hn::Add(first, hn::Mul(t.step_y, hn::ConvertTo(f, hn::Sub(pixel_y, t.origin_y))));
    const VF z = hn::Add(row, hn::Mul(t.step_x, hn::ConvertTo(f, hn::Sub(pixel_x, t.origin_x))));
    return hn::Min(hn::Max(z, t.z_low), t.z_high);
  }

  HWY_NOINLINE void append_many(const Work& w, std::int32_t tile, int columns, int rows) {
    for (std::int32_t s = 0; s < run_.sample_count; ++s) {
      const Candidates n = candidates_of(w.c, w.e, w.t, w.way, run_.sample_x[s], run_.sample_y[s]);
      Edges row{n.e[0], n.e[1], n.e[2]};
      for (int j = 0; j < rows; ++j, row = row.down(w.t))
        cover_row(w.t, n, row, w.dead, columns, j, append_at(w, n, s, tile, columns + 1));
    }
  }

  HWY_INLINE Append append_at(const Work& w, const Candidates& n, std::int32_t s, std::int32_t tile, int places) {
    SampleBin* const part = part_with_capacity(run_, sink_, tile, places * lanes);
    const auto rest = (static_cast<std::uint32_t>(s) << 12) - (static_cast<std::uint32_t>(part->first_id) << 16);
    return {part, hn::Add(packed_at(w.c.id, n.pixel_x, n.pixel_y), set(static_cast<std::int32_t>(rest)))};
  }

  HWY_NOINLINE void scatter(const Work& w, int columns, int rows) {
    for (std::int32_t s = 0; s < run_.sample_count; ++s) {
      const Candidates n = candidates_of(w.c, w.e, w.t, w.way, run_.sample_x[s], run_.sample_y[s]);
      Edges row{n.e[0], n.e[1], n.e[2]};
      for (int j = 0; j < rows; ++j, row = row.down(w.t))
        cover_row(w.t, n, row, w.dead, columns, j, Scatter{run_, sink_, n, w.c.id, s});
    }
  }

  // The tile that contains all lanes, so that whole vectors go to one list; or -1.
  HWY_INLINE std::int32_t tile_of_all(const Extent& e, VI dead) const {
    const auto first = hn::FindFirstTrue(i32, hn::Eq(dead, hn::Zero(i32)));
    const auto lane = hn::IndicesFromVec(i32, set(static_cast<std::int32_t>(first)));
    const VI x = hn::TableLookupLanes(e.low_x, lane), y = hn::TableLookupLanes(e.low_y, lane);
    const VI beyond =
        hn::Or(hn::Or(hn::Xor(e.low_x, x), hn::Xor(e.high_x, x)), hn::Or(hn::Xor(e.low_y, y), hn::Xor(e.high_y, y)));
    if (!hn::AllTrue(i32, hn::Eq(hn::ShiftRight<14>(hn::AndNot(dead, beyond)), hn::Zero(i32)))) return -1;
    const std::int32_t column = hn::GetLane(x) >> 14, row = hn::GetLane(y) >> 14;
    return (row - sink_.first_row) * sink_.columns + column - sink_.first_column;
  }

  const SmallTriangleRun& run_;
  SampleBinWriter& sink_;
  SmallTriangleResult& result_;
  std::int32_t sample_x_[SampleBin::max_samples + lanes], sample_y_[SampleBin::max_samples + lanes];
  TriangleQueue queue_;    ///< triangles
  TriangleQueue samples_;  ///< samples that are covered
};

void run_front(const SmallTriangleRun& run, SampleBinWriter& sink, SmallTriangleResult& result) {
  Front(run, sink, result).run();
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const SmallTriangleKernels PerIsa<SmallTriangleKernels>::HWY_NAMESPACE = {.run = HWY_NAMESPACE::run_front};
}  // namespace zoneplate
