// What a vector of small triangles covers, one triangle a lane. Included by *_simd.cpp files only.
#pragma once

#include <hwy/highway.h>

#include <cstdint>

#include "zoneplate/raster/front.h"
#include "zoneplate/raster/packing_simd.h"
#include "zoneplate/raster/setup_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

/// From corner 0 to the triangle's first pixel.
struct Way {
  VD x[2], y[2];
  HWY_INLINE Way(const Corners& c, const SetUp& t) {
    const VI dx = hn::Sub(hn::ShiftLeft<8>(t.origin_x), c.x[0]), dy = hn::Sub(hn::ShiftLeft<8>(t.origin_y), c.y[0]);
    x[0] = widened<0>(dx), x[1] = widened<1>(dx);
    y[0] = widened<0>(dy), y[1] = widened<1>(dy);
  }
  /// Depth of a sample there. Integers as doubles add exactly.
  template <int half>
  HWY_INLINE VD depth(const SetUp& t, VD sx, VD sy) const {
    return hn::Add(hn::Add(t.z0[half], hn::Mul(t.dzdx[half], hn::Add(x[half], sx))),
                   hn::Mul(t.dzdy[half], hn::Add(y[half], sy)));
  }
};

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

HWY_INLINE Candidates candidates_of(const Corners& c, const Extent& e, const SetUp& t, const Way& way, std::int32_t sx,
                                    std::int32_t sy) {
  Candidates out;
  out.pixel_x = hn::ShiftRight<8>(hn::Add(e.low_x, set(255 - sx)));
  out.pixel_y = hn::ShiftRight<8>(hn::Add(e.low_y, set(255 - sy)));
  const VI px = hn::Add(hn::ShiftLeft<8>(out.pixel_x), set(sx)), py = hn::Add(hn::ShiftLeft<8>(out.pixel_y), set(sy));
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

/// The same for the pixels (i, j) and (i + 1, j); gives the edges at the second.
template <class Emit>
HWY_INLINE Edges cover_pair(const SetUp& t, const Candidates& c, Edges e, VI dead, int i, int j, const Emit& emit) {
  const VF base = row_depth(t, c, j);
  const Edges next = e.right(t);
  cover_pixel(t, c, e.outside(dead), base, i, j, emit);
  cover_pixel(t, c, next.outside(dead), base, i + 1, j, emit);
  return next;
}

/// The same for a whole row, two at a time: what lies beyond the bounds is outside.
template <class Emit>
HWY_INLINE void cover_row(const SetUp& t, const Candidates& c, Edges e, VI dead, int columns, int j, const Emit& emit) {
  for (int i = 0; i < columns; i += 2) e = cover_pair(t, c, e, dead, i, j, emit).right(t);
}

/// The same for all pixels where few columns and rows hold all candidates: most triangles of a dense mesh.
template <int columns, int rows, class Emit>
HWY_INLINE void cover_few(const SetUp& t, const Candidates& c, VI dead, const Emit& emit) {
  const Edges first{c.e[0], c.e[1], c.e[2]};
  if constexpr (columns == 1) {
    cover_pixel(t, c, first.outside(dead), row_depth(t, c, 0), 0, 0, emit);
    if constexpr (rows == 2) cover_pixel(t, c, first.down(t).outside(dead), row_depth(t, c, 1), 0, 1, emit);
  } else {
    cover_pair(t, c, first, dead, 0, 0, emit);
    cover_pair(t, c, first.down(t), dead, 0, 1, emit);
  }
}

/// The last part of a tile's list, with room for so many more fragments of the run's triangles.
HWY_INLINE SampleFragments* part_with_room(const FrontRun& run, FragmentSink& sink, std::int32_t tile,
                                           std::int32_t room) {
  SampleFragments* const part = sink.last[tile];
  if (part && part->count <= SampleFragments::capacity - room &&
      static_cast<std::uint32_t>(run.first_id - part->first_id) < 0x10000 - FrontRun::capacity)
    return part;
  return sink.grow(sink, tile, run.first_id);
}

/// Puts whole vectors into a list's last part, which has room for them.
struct Append {
  SampleFragments* part;
  VI first;  ///< what is said of fragments at the first candidates

  HWY_INLINE void operator()(MI mask, int i, int j, VF z) const {
    const Packing packing(mask);
    const std::int32_t at = part->count;
    packing.store(z, part->depth + at);
    packing.store(hn::Add(first, set(j * 64 + i)), reinterpret_cast<std::int32_t*>(part->what) + at);
    part->count = at + packing.count();
  }
};

/// Puts lanes one by one into the lists of their tiles, as far as these are drawn.
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
      if (px < (run.left & ~63) || px > (run.right | 63) || py < (run.top & ~63) || py > (run.bottom | 63)) continue;
      const std::int32_t tile = ((py >> 6) - sink.first_row) * sink.columns + (px >> 6) - sink.first_column;
      SampleFragments* const part = part_with_room(run, sink, tile, 1);
      part->depth[part->count] = depth[lane];
      part->what[part->count++] = static_cast<std::uint32_t>(((ids[lane] - part->first_id) << 16) + (sample << 12) +
                                                             ((py & 63) << 6) + (px & 63));
    }
  }
};

}  // namespace
}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
