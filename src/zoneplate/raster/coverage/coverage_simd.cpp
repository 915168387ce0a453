// SPDX-License-Identifier: Apache-2.0
#include <hwy/highway.h>

#include "zoneplate/raster/coverage/coverage.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using DF = hn::CappedTag<float, 8>;
using DI = hn::Rebind<std::int32_t, DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;

int least(int p, int q) { return p < q ? p : q; }
int greatest(int p, int q) { return p > q ? p : q; }

/// Constants of a tile triangle for all blocks: the range of its edge constants over the samples.
struct Spread {
  std::int32_t c_least[3], c_greatest[3];
  float z_least, z_greatest;
};

/// The least and the greatest value of each edge in a square of pixels, less a x + b y at its first one.
struct Reach {
  std::int32_t least[3], greatest[3];
};

Spread spread_of(const TileTriangle& t, int samples) {
  Spread r;
  r.z_least = r.z_greatest = t.z[0];
  for (int s = 1; s < samples; ++s) {
    r.z_greatest = t.z[s] > r.z_greatest ? t.z[s] : r.z_greatest;
    r.z_least = t.z[s] < r.z_least ? t.z[s] : r.z_least;
  }
  for (int k = 0; k < 3; ++k) {
    std::int32_t low = t.c[k][0], high = low;
    for (int s = 0; s < samples; ++s) low = least(low, t.c[k][s]), high = greatest(high, t.c[k][s]);
    r.c_least[k] = low, r.c_greatest[k] = high;
  }
  return r;
}

Reach reach_of(const TileTriangle& t, const Spread& spread, int size) {
  Reach r;
  for (int k = 0; k < 3; ++k) {
    r.greatest[k] = (greatest(t.a[k], 0) + greatest(t.b[k], 0)) * (size - 1) + spread.c_greatest[k];
    r.least[k] = (least(t.a[k], 0) + least(t.b[k], 0)) * (size - 1) + spread.c_least[k];
  }
  return r;
}

enum class Block { Outside, Partial, Inside };

/// Classifies the square at pixel (x, y): inside, outside or partly covered.
HWY_INLINE Block classify(const TileTriangle& t, const Reach& reach, int x, int y) {
  bool inside = true;
  for (int k = 0; k < 3; ++k) {
    const std::int32_t corner = t.a[k] * x + t.b[k] * y;
    if (corner + reach.greatest[k] < 0) return Block::Outside;
    inside = inside && corner + reach.least[k] >= 0;
  }
  return inside ? Block::Inside : Block::Partial;
}

/// depth_at, for a sample where the depth at the origin is `base`.
float depth_from(const TileTriangle& t, float base, int x, int y) {
  const float row = base + t.dzdy * static_cast<float>(y - t.origin_y);
  const float z = row + t.dzdx * static_cast<float>(x - t.origin_x);
  const float raised = z > t.z_low ? z : t.z_low;
  return raised < t.z_high ? raised : t.z_high;
}

/// The greatest depth that `depth_at` gives in the block: rounding is monotone, so it is the value at one corner.
float max_depth(const TileTriangle& t, const Spread& spread, int x, int y) {
  return depth_from(t, spread.z_greatest, t.dzdx > 0 ? x + 7 : x, t.dzdy > 0 ? y + 7 : y);
}

float min_depth(const TileTriangle& t, const Spread& spread, int x, int y) {
  return depth_from(t, spread.z_least, t.dzdx > 0 ? x : x + 7, t.dzdy > 0 ? y : y + 7);
}

/// One vector of pixels of one sample: where the triangle is inside and wins, and its depth there.
struct Step {
  DF d;
  DI di;
  VI ramp[3];  ///< a_k × lane
  VF lane;     ///< 0, 1, 2 ...
  VF dzdx, z_low, z_high;
  VI id;

  explicit Step(const TileTriangle& t)
      : ramp{hn::Mul(hn::Iota(di, 0), hn::Set(di, t.a[0])), hn::Mul(hn::Iota(di, 0), hn::Set(di, t.a[1])),
             hn::Mul(hn::Iota(di, 0), hn::Set(di, t.a[2]))},
        lane(hn::Iota(d, 0)),
        dzdx(hn::Set(d, t.dzdx)),
        z_low(hn::Set(d, t.z_low)),
        z_high(hn::Set(d, t.z_high)),
        id(hn::Set(di, t.id)) {}

  HWY_INLINE hn::Mask<DF> wins(const TileTriangle& t, const TileVisibility& tile, int s, int x, int y, VF& z) const {
    VI outside = hn::Add(ramp[0], hn::Set(di, t.a[0] * x + t.b[0] * y + t.c[0][s]));
    outside = hn::Or(outside, hn::Add(ramp[1], hn::Set(di, t.a[1] * x + t.b[1] * y + t.c[1][s])));
    outside = hn::Or(outside, hn::Add(ramp[2], hn::Set(di, t.a[2] * x + t.b[2] * y + t.c[2][s])));
    const auto inside = hn::Not(hn::MaskFromVec(hn::BitCast(d, hn::BroadcastSignBit(outside))));

    const float row = t.z[s] + t.dzdy * static_cast<float>(y - t.origin_y);
    const VF column = hn::Add(hn::Set(d, static_cast<float>(x - t.origin_x)), lane);
    z = hn::Min(hn::Max(hn::Add(hn::Set(d, row), hn::Mul(dzdx, column)), z_low), z_high);
    const int at = s * sample_stride + y * tile_size + x;
    const VF held = hn::Load(d, tile.depth + at);
    const auto lower_id = hn::RebindMask(d, hn::Lt(id, hn::Load(di, tile.id + at)));
    return hn::And(inside, hn::Or(hn::Gt(z, held), hn::And(hn::Eq(z, held), lower_id)));
  }
};

/// The least depth of the block's samples, none of which is below `bound`: a sample at `bound` ends the search.
float farthest(const TileVisibility& tile, int x, int y, float bound) {
  const DF d;
  const float* plane = tile.depth + y * tile_size + x;
  VF low = hn::Load(d, plane);
  for (int s = 0; s < tile.sample_count; ++s, plane += sample_stride) {
    for (int row = 0; row < 8; ++row)
      for (int column = 0; column < 8; column += static_cast<int>(hn::Lanes(d)))
        low = hn::Min(low, hn::Load(d, plane + row * tile_size + column));
    if (!hn::AllTrue(d, hn::Gt(low, hn::Set(d, bound)))) return bound;
  }
  return hn::GetLane(hn::MinOfLanes(d, low));
}

/// Draws into an empty block that the triangle covers: it wins everywhere.
void fill_block(const TileTriangle& t, const TileVisibility& tile, int bx, int by) {
  const DF d;
  const DI di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const VF lane = hn::Iota(d, 0), dzdx = hn::Set(d, t.dzdx);
  const VF z_low = hn::Set(d, t.z_low), z_high = hn::Set(d, t.z_high);
  const VI id = hn::Set(di, t.id);
  const float dzdy = t.dzdy;
  const int first_y = by - t.origin_y;
  for (int x = bx; x < bx + 8; x += lanes) {
    const VF across = hn::Mul(dzdx, hn::Add(hn::Set(d, static_cast<float>(x - t.origin_x)), lane));
    for (int s = 0; s < tile.sample_count; ++s) {
      const float base = t.z[s];
      float* const depth = tile.depth + s * sample_stride + by * tile_size + x;
      std::int32_t* const ids = tile.id + s * sample_stride + by * tile_size + x;
      for (int y = 0; y < 8; ++y) {
        const VF row = hn::Set(d, base + dzdy * static_cast<float>(first_y + y));
        hn::Store(hn::Min(hn::Max(hn::Add(row, across), z_low), z_high), d, depth + y * tile_size);
        hn::Store(id, di, ids + y * tile_size);
      }
    }
  }
}

HWY_INLINE hn::Mask<DF> inside(VI e0, VI e1, VI e2) {
  return hn::Not(hn::MaskFromVec(hn::BitCast(DF(), hn::BroadcastSignBit(hn::Or(hn::Or(e0, e1), e2)))));
}

/// A triangle's constants by sample, each a vector of one number.
struct SampleVectors {
  static constexpr int lanes = static_cast<int>(hn::MaxLanes(DI()));
  alignas(64) std::int32_t c[3][TileTriangle::max_samples][lanes];
  alignas(64) float z[TileTriangle::max_samples][lanes];

  HWY_INLINE SampleVectors(const TileTriangle& t, int samples) {
    const DF d;
    const DI di;
    for (int s = 0; s < samples; ++s) {
      for (int k = 0; k < 3; ++k) hn::Store(hn::Set(di, t.c[k][s]), di, c[k][s]);
      hn::Store(hn::Set(d, t.z[s]), d, z[s]);
    }
  }
};

/// Draws rows [top, bottom] of a block. Returns true if the triangle won every sample.
///
/// The same computation as Step::wins, with the terms that all samples share moved out of the loop over samples.
bool draw_block(const TileTriangle& t, const Spread& spread, const Step& step, const SampleVectors& by_sample,
                const TileVisibility& tile, int bx, int top, int bottom) {
  const DF d;
  const DI di;
  bool all = true;
  for (int x = bx; x < bx + 8; x += static_cast<int>(hn::Lanes(d))) {
    const VF across = hn::Mul(step.dzdx, hn::Add(hn::Set(d, static_cast<float>(x - t.origin_x)), step.lane));
    VI e0 = hn::Add(step.ramp[0], hn::Set(di, t.a[0] * x + t.b[0] * top));
    VI e1 = hn::Add(step.ramp[1], hn::Set(di, t.a[1] * x + t.b[1] * top));
    VI e2 = hn::Add(step.ramp[2], hn::Set(di, t.a[2] * x + t.b[2] * top));
    for (int y = top; y <= bottom; ++y) {
      const auto some =
          inside(hn::Add(e0, hn::Set(di, spread.c_greatest[0])), hn::Add(e1, hn::Set(di, spread.c_greatest[1])),
                 hn::Add(e2, hn::Set(di, spread.c_greatest[2])));
      const int samples = hn::AllFalse(d, some) ? 0 : tile.sample_count;
      all = all && samples > 0;
      const VF down = hn::Set(d, t.dzdy * static_cast<float>(y - t.origin_y));
      float* depth = tile.depth + y * tile_size + x;
      std::int32_t* id = tile.id + y * tile_size + x;
      for (int s = 0; s < samples; ++s, depth += sample_stride, id += sample_stride) {
        const auto covered =
            inside(hn::Add(e0, hn::Load(di, by_sample.c[0][s])), hn::Add(e1, hn::Load(di, by_sample.c[1][s])),
                   hn::Add(e2, hn::Load(di, by_sample.c[2][s])));
        const VF base = hn::Add(hn::Load(d, by_sample.z[s]), down);
        const VF z = hn::Min(hn::Max(hn::Add(base, across), step.z_low), step.z_high);
        const VF held = hn::Load(d, depth);
        const VI owner = hn::Load(di, id);
        const auto lower_id = hn::RebindMask(d, hn::Lt(step.id, owner));
        const auto mask = hn::And(covered, hn::Or(hn::Gt(z, held), hn::And(hn::Eq(z, held), lower_id)));
        all = all && hn::AllTrue(d, mask);
        hn::Store(hn::IfThenElse(mask, z, held), d, depth);
        hn::Store(hn::IfThenElse(hn::RebindMask(di, mask), step.id, owner), di, id);
      }
      e0 = hn::Add(e0, hn::Set(di, t.b[0]));
      e1 = hn::Add(e1, hn::Set(di, t.b[1]));
      e2 = hn::Add(e2, hn::Set(di, t.b[2]));
    }
  }
  return all;
}

bool draw(const TileTriangle& t, TileVisibility& tile) {
  const Spread spread = spread_of(t, tile.sample_count);
  const Reach reach = reach_of(t, spread, 8);
  const Step step(t);
  const SampleVectors by_sample(t, tile.sample_count);
  const bool covers_tile = classify(t, reach_of(t, spread, tile_size), 0, 0) == Block::Inside;
  bool has_risen = false;
  for (int by = t.first_y & ~7; by <= t.last_y; by += 8)
    for (int bx = t.first_x & ~7; bx <= t.last_x; bx += 8) {
      const Block place = covers_tile ? Block::Inside : classify(t, reach, bx, by);
      const int block = by + bx / 8;
      if (place == Block::Outside) continue;
      const std::uint64_t bit = std::uint64_t{1} << block;
      const float nearest = max_depth(t, spread, bx, by);
      if (nearest < tile.block_min_depth[block]) continue;
      if (tile.dirty & bit) {
        tile.dirty &= ~bit;
        tile.block_min_depth[block] = farthest(tile, bx, by, tile.block_min_depth[block]);
        has_risen = true;
        if (nearest < tile.block_min_depth[block]) continue;
      }
      if (place == Block::Inside && tile.block_primitive[block] == no_primitive) {
        fill_block(t, tile, bx, by);
        tile.block_min_depth[block] = min_depth(t, spread, bx, by);
        tile.block_primitive[block] = t.id;
        has_risen = true;
        continue;
      }
      tile.materialize_block(block);
      const int top = greatest(by, t.first_y), bottom = least(by + 7, t.last_y);
      const bool all = draw_block(t, spread, step, by_sample, tile, bx, top, bottom);
      tile.dirty |= bit;
      if (place == Block::Inside && all) tile.block_primitive[block] = t.id;
    }
  return has_risen;
}

/// Calls use(step, bx, y) for the groups of eight pixels of these blocks that the triangle may touch.
template <class Use>
HWY_INLINE void for_groups(const TileTriangle& t, const TileVisibility& tile, std::uint64_t blocks, Use use) {
  const Spread spread = spread_of(t, tile.sample_count);
  const Reach reach = reach_of(t, spread, 8);
  const Step step(t);
  for (int y = t.first_y; y <= t.last_y; ++y)
    for (int bx = t.first_x & ~7; bx <= t.last_x; bx += 8)
      if ((blocks >> ((y & ~7) + bx / 8) & 1) && classify(t, reach, bx, y & ~7) != Block::Outside) use(step, bx, y);
}

int collect(const TileTriangle& t, const TileVisibility& tile, CoveredPixel* out) {
  const DF d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int count = 0;
  for_groups(t, tile, ~std::uint64_t{0}, [&](const Step& step, int bx, int y) HWY_ATTR {
    std::uint64_t samples[8] = {};
    for (int s = 0; s < tile.sample_count; ++s)
      for (int x = 0; x < 8; x += lanes) {
        VF z;
        std::uint8_t bits[8] = {};
        hn::StoreMaskBits(d, step.wins(t, tile, s, bx + x, y, z), bits);
        for (int lane = 0; lane < lanes; ++lane)
          samples[x + lane] |= static_cast<std::uint64_t>((bits[0] >> lane) & 1) << s;
      }
    for (int x = 0; x < 8; ++x)
      if (samples[x]) out[count++] = {samples[x], static_cast<std::uint32_t>(y * tile_size + bx + x)};
  });
  return count;
}

int collect_rows(const TileTriangle& t, const TileVisibility& tile, std::uint64_t blocks, SpanLayer* out,
                 std::uint8_t* is_partial) {
  const DF d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int count = 0;
  for_groups(t, tile, blocks, [&](const Step& step, int bx, int y) HWY_ATTR {
    VF low = step.z_high, high = step.z_low;
    bool all = true, any = false;
    for (int s = 0; s < tile.sample_count; ++s)
      for (int x = bx; x < bx + 8; x += lanes) {
        VF z;
        const auto mask = step.wins(t, tile, s, x, y, z);
        all = all && hn::AllTrue(d, mask);
        any = any || !hn::AllFalse(d, mask);
        low = hn::Min(low, z);
        high = hn::Max(high, z);
      }
    const auto row = static_cast<std::uint32_t>(y * 8 + bx / 8);
    if (all)
      out[count++] = {t.id, row, hn::GetLane(hn::MinOfLanes(d, low)), hn::GetLane(hn::MaxOfLanes(d, high))};
    else if (any)
      is_partial[row] = 1;
  });
  return count;
}

void compute_nearest(const TileVisibility& tile, float* nearest) {
  const DF d;
  for (int block = 0; block < TileVisibility::blocks; ++block) {
    nearest[block] = 0;
    if (tile.block_primitive[block] == no_primitive) continue;
    const float* const corner = tile.depth + block / 8 * 8 * tile_size + block % 8 * 8;
    VF high = hn::Zero(d);
    for (int s = 0; s < tile.sample_count; ++s)
      for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; x += static_cast<int>(hn::Lanes(d)))
          high = hn::Max(high, hn::Load(d, corner + s * sample_stride + y * tile_size + x));
    nearest[block] = hn::GetLane(hn::MaxOfLanes(d, high));
  }
}

int collect_blocks(const TileTriangle& t, const TileVisibility& tile, const float* nearest, BlockLayer* out,
                   std::uint64_t& others) {
  const Spread spread = spread_of(t, tile.sample_count);
  const Reach reach = reach_of(t, spread, 8);
  int count = 0;
  for (int by = t.first_y & ~7; by <= t.last_y; by += 8)
    for (int bx = t.first_x & ~7; bx <= t.last_x; bx += 8) {
      const Block place = classify(t, reach, bx, by);
      const int block = by + bx / 8;
      if (place == Block::Outside || max_depth(t, spread, bx, by) < tile.block_min_depth[block]) continue;
      const float low = min_depth(t, spread, bx, by);
      if (place == Block::Inside && low > nearest[block])
        out[count++] = {t.id, static_cast<std::uint32_t>(block), low, max_depth(t, spread, bx, by)};
      else
        others |= std::uint64_t{1} << block;
    }
  return count;
}

void fetch_owners(const TileVisibility& tile, std::int32_t* owners) {
  const DI d;
  const int lanes = static_cast<int>(hn::Lanes(d)), samples = tile.sample_count;
  for (int block = 0; block < TileVisibility::blocks; ++block) {
    const int first_row = block / 8 * 64 + block % 8;
    const std::int32_t owner = tile.block_primitive[block];
    for (int row = first_row; row < first_row + 64; row += 8) owners[row] = owner;
    if (owner != mixed_primitives) continue;
    for (int row = first_row; row < first_row + 64; row += 8) {
      const std::int32_t* const id = tile.id + row * 8;
      const VI first = hn::Set(d, id[0]);
      VI differs = hn::Zero(d);
      for (int s = 0; s < samples; ++s)
        for (int x = 0; x < 8; x += lanes)
          differs = hn::Or(differs, hn::Xor(first, hn::Load(d, id + s * sample_stride + x)));
      if (hn::AllTrue(d, hn::Eq(differs, hn::Zero(d)))) owners[row] = id[0];
    }
  }
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const CoverageKernels PerIsa<CoverageKernels>::HWY_NAMESPACE = {.draw = HWY_NAMESPACE::draw,
                                                                .collect = HWY_NAMESPACE::collect,
                                                                .collect_rows = HWY_NAMESPACE::collect_rows,
                                                                .compute_nearest = HWY_NAMESPACE::compute_nearest,
                                                                .collect_blocks = HWY_NAMESPACE::collect_blocks,
                                                                .fetch_owners = HWY_NAMESPACE::fetch_owners};
}  // namespace zoneplate
