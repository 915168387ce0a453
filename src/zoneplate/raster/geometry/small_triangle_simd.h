// SPDX-License-Identifier: Apache-2.0
// The coverage of a vector of small triangles, one triangle a lane. Included by *_simd.cpp files only.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

#include "zoneplate/raster/geometry/packing_simd.h"
#include "zoneplate/raster/geometry/setup_simd.h"
#include "zoneplate/raster/geometry/small_triangles.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// The vector from vertex 0 to the triangle's first pixel.
struct Way {
  VD x[2], y[2];
  HWY_INLINE Way(const Corners& c, const SetUp& t) {
    const VI dx = hn::Sub(hn::ShiftLeft<8>(t.origin_x), c.x[0]), dy = hn::Sub(hn::ShiftLeft<8>(t.origin_y), c.y[0]);
    x[0] = widened<0>(dx), x[1] = widened<1>(dx);
    y[0] = widened<0>(dy), y[1] = widened<1>(dy);
  }
  /// Depth of a sample of the first pixel. Integers as doubles add exactly.
  template <int half>
  HWY_INLINE VD depth(const SetUp& t, VD sx, VD sy) const {
    return hn::Add(hn::Add(t.z0[half], hn::Mul(t.dzdx[half], hn::Add(x[half], sx))),
                   hn::Mul(t.dzdy[half], hn::Add(y[half], sy)));
  }
};

/// The distance from coordinate `from` to the first sample at offset s within its pixel, in [0, 255].
HWY_INLINE VI up_to(std::int32_t s, VI from) { return hn::And(hn::Sub(set(s), from), set(255)); }

/// The candidate pixels of one sample: the edge values at the first pixel whose sample lies within the bounds.
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

HWY_INLINE Candidates candidates_of(const Corners& c, const Extent& e, const SetUp& t, const Way& way, std::int32_t sx,
                                    std::int32_t sy) {
  Candidates out;
  const VI px = hn::Add(e.low_x, up_to(sx, e.low_x)), py = hn::Add(e.low_y, up_to(sy, e.low_y));
  out.pixel_x = hn::ShiftRight<8>(px);
  out.pixel_y = hn::ShiftRight<8>(py);
  const VI e1 = edge_at<1>(c, t, px, py), e2 = edge_at<2>(c, t, px, py);
  out.e[0] = hn::Add(hn::Sub(hn::Sub(t.area, e1), e2), t.bias[0]);
  out.e[1] = hn::Add(e1, t.bias[1]);
  out.e[2] = hn::Add(e2, t.bias[2]);
  const VD x = hn::Set(f64, static_cast<double>(sx)), y = hn::Set(f64, static_cast<double>(sy));
  out.z = narrowed(way.depth<0>(t, x, y), way.depth<1>(t, x, y));
  out.x0 = hn::ConvertTo(f, hn::Sub(out.pixel_x, t.origin_x));
  out.y0 = hn::ConvertTo(f, hn::Sub(out.pixel_y, t.origin_y));
  return out;
}

/// Depth in row j of the candidates, at the triangle's first column.
HWY_INLINE VF row_depth(const SetUp& t, const Candidates& c, int j) {
  return hn::Add(c.z, hn::Mul(t.step_y, hn::Add(c.y0, hn::Set(f, static_cast<float>(j)))));
}

/// Calls emit(mask, i, j, depth) if the candidate pixel (i, j) has lanes inside.
template <class Emit>
HWY_INLINE void cover_pixel(const SetUp& t, const Candidates& c, VI outside, VF base, int i, int j, const Emit& emit) {
  const MI inside = hn::Not(hn::MaskFromVec(hn::BroadcastSignBit(outside)));
  if (hn::AllFalse(i32, inside)) return;
  const VF z = hn::Add(base, hn::Mul(t.step_x, hn::Add(c.x0, hn::Set(f, static_cast<float>(i)))));
  emit(inside, i, j, hn::Min(hn::Max(z, t.z_low), t.z_high));
}

/// The values of the edge functions at a pixel.
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

/// The same for the pixels (i, j) and (i + 1, j); returns the edge values at the second.
template <class Emit>
HWY_INLINE Edges cover_pair(const SetUp& t, const Candidates& c, Edges e, VI dead, int i, int j, const Emit& emit) {
  const VF base = row_depth(t, c, j);
  const Edges next = e.right(t);
  cover_pixel(t, c, e.outside(dead), base, i, j, emit);
  cover_pixel(t, c, next.outside(dead), base, i + 1, j, emit);
  return next;
}

/// The same for a whole row, two pixels at a time; pixels beyond the bounds are outside.
template <class Emit>
HWY_INLINE void cover_row(const SetUp& t, const Candidates& c, Edges e, VI dead, int columns, int j, const Emit& emit) {
  for (int i = 0; i < columns; i += 2) e = cover_pair(t, c, e, dead, i, j, emit).right(t);
}

/// The last part of a tile's list, with capacity for `count` more fragments of the run's triangles.
HWY_INLINE SampleBin* part_with_capacity(const SmallTriangleRun& run, SampleBinWriter& sink, std::int32_t tile,
                                         std::int32_t count) {
  SampleBin* const part = sink.last[tile];
  if (part && part->count <= SampleBin::capacity - count &&
      static_cast<std::uint32_t>(run.first_id - part->first_id) < 0x10000 - SmallTriangleRun::capacity)
    return part;
  return sink.grow(sink, tile, run.first_id);
}

/// Appends whole vectors to a list's last part, which must have the capacity.
struct Append {
  SampleBin* part;
  VI first;  ///< SampleBin::packed of the fragments at the first candidates

  HWY_INLINE void operator()(MI mask, int i, int j, VF z) const {
    const Packing<DI> packing(mask);
    const std::int32_t at = part->count;
    packing.store(z, part->depth + at);
    packing.store(hn::Add(first, set(j * 64 + i)), reinterpret_cast<std::int32_t*>(part->packed) + at);
    part->count = at + packing.count();
  }
};

/// Appends lanes to the list of a tile. `packed` is without the list's first id.
HWY_INLINE void store_in_tile(const SmallTriangleRun& run, SampleBinWriter& sink, std::int32_t tile, MI mask, VF z,
                              VI packed) {
  SampleBin* const part = part_with_capacity(run, sink, tile, lanes);
  const Packing<DI> packing(mask);
  const std::int32_t at = part->count;
  packing.store(z, part->depth + at);
  packing.store(hn::Sub(packed, set(static_cast<std::int32_t>(static_cast<std::uint32_t>(part->first_id) << 16))),
                reinterpret_cast<std::int32_t*>(part->packed) + at);
  part->count = at + packing.count();
}

/// Appends lanes to the lists of their tiles, if these are drawn. `packed` is without the list's first id.
HWY_INLINE void store_by_tile(const SmallTriangleRun& run, SampleBinWriter& sink, MI mask, VI pixel_x, VI pixel_y, VF z,
                              VI packed) {
  const VI column = hn::ShiftRight<6>(pixel_x), row = hn::ShiftRight<6>(pixel_y);
  const VI beyond = hn::Or(hn::Or(hn::Sub(column, set(run.left >> 6)), hn::Sub(set(run.right >> 6), column)),
                           hn::Or(hn::Sub(row, set(run.top >> 6)), hn::Sub(set(run.bottom >> 6), row)));
  mask = hn::AndNot(hn::MaskFromVec(hn::BroadcastSignBit(beyond)), mask);
  const VI tile =
      hn::Add(hn::Mul(hn::Sub(row, set(sink.first_row)), set(sink.columns)), hn::Sub(column, set(sink.first_column)));
  const auto in_list = [&](const SampleBin& part) HWY_ATTR {
    return hn::Sub(packed, set(static_cast<std::int32_t>(static_cast<std::uint32_t>(part.first_id) << 16)));
  };
  if (const std::int32_t first = hn::GetLane(tile); hn::AllTrue(i32, hn::And(mask, hn::Eq(tile, set(first))))) {
    SampleBin* const part = part_with_capacity(run, sink, first, lanes);
    const std::int32_t at = part->count;
    hn::StoreU(z, f, part->depth + at);
    hn::StoreU(in_list(*part), i32, reinterpret_cast<std::int32_t*>(part->packed) + at);
    part->count = at + lanes;
    return;
  }
  alignas(64) std::int32_t tiles[lanes];
  hn::Store(tile, i32, tiles);
  for (auto first = hn::FindFirstTrue(i32, mask); first >= 0; first = hn::FindFirstTrue(i32, mask)) {
    const MI here = hn::And(mask, hn::Eq(tile, set(tiles[first])));
    store_in_tile(run, sink, tiles[first], here, z, packed);
    mask = hn::AndNot(here, mask);
  }
}

/// SampleBin::packed of a fragment, without its sample and its list's first id.
HWY_INLINE VI packed_at(VI id, VI pixel_x, VI pixel_y) {
  const VI in_tile = set(63);
  return hn::Add(hn::ShiftLeft<16>(id),
                 hn::Add(hn::ShiftLeft<6>(hn::And(pixel_y, in_tile)), hn::And(pixel_x, in_tile)));
}

/// Appends samples of one index to the lists of their tiles.
struct Scatter {
  const SmallTriangleRun& run;
  SampleBinWriter& sink;
  const Candidates& candidates;
  VI id;
  std::int32_t sample;

  HWY_NOINLINE void operator()(MI mask, int i, int j, VF z) const {
    const VI x = hn::Add(candidates.pixel_x, set(i)), y = hn::Add(candidates.pixel_y, set(j));
    store_by_tile(run, sink, mask, x, y, z, hn::Add(packed_at(id, x, y), set(sample << 12)));
  }
};

/// Small triangles, or samples of them, that are queued until they fill vectors. The queue holds several vectors,
/// because reading a vector that was just written in parts stalls the processor.
struct TriangleQueue {
  static constexpr std::int32_t threshold = 128, capacity = threshold + 10 * lanes;
  std::int32_t count = 0;
  alignas(64) std::int32_t x[3][capacity], y[3][capacity], id[capacity];
  alignas(64) std::int32_t sample_x[capacity], sample_y[capacity];  ///< 1/256 pixel; only for samples
  alignas(64) float z[3][capacity];

  HWY_INLINE void add(const Corners& c, const Packing<DI>& packing) {
    const std::int32_t at = count;
    packing.store(c.x[0], x[0] + at), packing.store(c.y[0], y[0] + at), packing.store(c.z[0], z[0] + at);
    packing.store(c.x[1], x[1] + at), packing.store(c.y[1], y[1] + at), packing.store(c.z[1], z[1] + at);
    packing.store(c.x[2], x[2] + at), packing.store(c.y[2], y[2] + at), packing.store(c.z[2], z[2] + at);
    packing.store(c.id, id + at);
    count = at + packing.count();
  }
  HWY_INLINE void add(const Corners& c, VI px, VI py, const Packing<DI>& packing) {
    packing.store(px, sample_x + count), packing.store(py, sample_y + count);
    add(c, packing);
  }
  HWY_INLINE Corners get(std::int32_t i) const {
    return {{hn::Load(i32, x[0] + i), hn::Load(i32, x[1] + i), hn::Load(i32, x[2] + i)},
            {hn::Load(i32, y[0] + i), hn::Load(i32, y[1] + i), hn::Load(i32, y[2] + i)},
            {hn::Load(f, z[0] + i), hn::Load(f, z[1] + i), hn::Load(f, z[2] + i)},
            hn::Load(i32, id + i)};
  }
  /// Calls draw(i, mask) for whole vectors, and at the end for the remaining lanes.
  template <class Draw>
  HWY_INLINE void take(bool is_end, const Draw& draw) {
    std::int32_t i = 0;
    for (; i + lanes <= count; i += lanes) draw(i, hn::FirstN(i32, lanes));
    if (is_end && i < count) draw(i, hn::FirstN(i32, static_cast<std::size_t>(count - i)));
    count = is_end ? 0 : count - i;
    if (count == 0) return;
    for (int k = 0; k < 3; ++k) to_front(x[k], i), to_front(y[k], i), to_front(z[k], i);
    to_front(id, i), to_front(sample_x, i), to_front(sample_y, i);
  }

 private:
  template <class T>
  static HWY_INLINE void to_front(T* values, std::int32_t i) {
    const hn::CappedTag<T, lanes> d;
    hn::Store(hn::Load(d, values + i), d, values);
  }
};

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
