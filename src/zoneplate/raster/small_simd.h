// What a vector of small triangles covers, one triangle a lane. Included by *_simd.cpp files only.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

#include "zoneplate/raster/front.h"
#include "zoneplate/raster/setup_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

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

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
