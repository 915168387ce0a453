// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/coverage/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "zoneplate/base/aligned_array.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr Viewport coverage_viewport{1024, 768};

ScreenVertex vertex(std::int32_t x, std::int32_t y, float z = 0.5f) { return {x, y, z, 1}; }

/// The definition, in 64-bit integers (differences are below 2^24, so products stay below 2^48): the sample lies
/// inside, or on a top or left edge.
bool covers(const ScreenVertex (&v)[3], std::int64_t x, std::int64_t y, EdgeRule rule) {
  const auto side = [&](const ScreenVertex& p, const ScreenVertex& q) -> std::int64_t {
    return static_cast<std::int64_t>(q.x - p.x) * (y - p.y) - static_cast<std::int64_t>(q.y - p.y) * (x - p.x);
  };
  const std::int64_t area = static_cast<std::int64_t>(v[1].x - v[0].x) * (v[2].y - v[0].y) -
                            static_cast<std::int64_t>(v[1].y - v[0].y) * (v[2].x - v[0].x);
  for (int k = 0; k < 3; ++k) {
    const ScreenVertex& p = area > 0 ? v[k] : v[(k + 1) % 3];
    const ScreenVertex& q = area > 0 ? v[(k + 1) % 3] : v[k];
    const std::int64_t e = side(p, q);
    const bool is_owned = q.y < p.y || (q.y == p.y && q.x > p.x);  // left: upwards; top: to the right
    if (e < 0 || (e == 0 && rule == EdgeRule::TopLeft && !is_owned)) return false;
  }
  return true;
}

struct Buffers {
  explicit Buffers(int samples)
      : z(static_cast<std::size_t>(samples) * sample_stride), id(static_cast<std::size_t>(samples) * sample_stride) {
    visibility = {
        .sample_count = samples, .depth = z.data(), .id = id.data(), .block_min_depth = far, .block_primitive = owner};
    visibility.clear();
  }
  AlignedArray<float> z;
  AlignedArray<std::int32_t> id;
  float far[TileVisibility::blocks];
  std::int32_t owner[TileVisibility::blocks];
  TileVisibility visibility;
};

std::int32_t spread(std::uint32_t word, std::int32_t range) {
  return static_cast<std::int32_t>(word % static_cast<std::uint32_t>(2 * range + 1)) - range;
}

/// How often triangles of many tiles are made: as often as each of the smaller sizes, or a thirty-second as often.
enum class SizeMix { Even, FewLarge };

/// Random corners of a size class, some snapped to the lattice of the samples so that edges pass through them.
void random_corners(std::uint32_t seed, ScreenVertex (&v)[3], SizeMix mix = SizeMix::Even) {
  static constexpr std::int32_t sizes[] = {100, 256, 768, 1280, 10000, 30000, 100000, 1 << 22};
  const std::uint32_t kind = hash(seed, 1);
  const bool is_made_small = kind % 8 > 5 && mix == SizeMix::FewLarge && kind / 8 % 32 != 0;
  const std::int32_t size = sizes[kind % 8 - (is_made_small ? 6 : 0)];
  const std::int32_t x = spread(hash(seed, 2), 512 * 256), y = spread(hash(seed, 3), 384 * 256);
  const int snap = (kind >> 8) % 3 == 0 ? 128 : (kind >> 8) % 3 == 1 ? 16 : 1;
  for (std::uint32_t k = 0; k < 3; ++k) {
    std::int32_t vx = x + spread(hash(seed, 4, k), size), vy = y + spread(hash(seed, 5, k), size);
    if ((kind >> 16) % 5 == 0 && k == 2) {  // a sliver: the third corner near the line of the others
      vx = (v[0].x + v[1].x) / 2 + spread(hash(seed, 6), 3);
      vy = (v[0].y + v[1].y) / 2 + spread(hash(seed, 7), 3);
    }
    vx = std::min(std::max(vx, -guard_band), guard_band) / snap * snap;
    vy = std::min(std::max(vy, -guard_band), guard_band) / snap * snap;
    v[k] = vertex(vx, vy, unit_float(hash(seed, 8, k)));
  }
}

/// The definition of `covers` at all samples of one tile: edge functions are linear, so they are stepped along rows.
class TileDefinition {
 public:
  TileDefinition(const ScreenVertex (&v)[3], EdgeRule rule) {
    const std::int64_t area = static_cast<std::int64_t>(v[1].x - v[0].x) * (v[2].y - v[0].y) -
                              static_cast<std::int64_t>(v[1].y - v[0].y) * (v[2].x - v[0].x);
    for (std::size_t k = 0; k < 3; ++k) {
      const ScreenVertex& p = area > 0 ? v[k] : v[(k + 1) % 3];
      const ScreenVertex& q = area > 0 ? v[(k + 1) % 3] : v[k];
      const bool is_owned = rule == EdgeRule::Inside || q.y < p.y || (q.y == p.y && q.x > p.x);
      by_x[k] = p.y - q.y, by_y[k] = q.x - p.x;
      at_origin[k] = -(by_x[k] * p.x + by_y[k] * p.y) - (is_owned ? 0 : 1);  // covered where all three are >= 0
    }
  }

  /// Samples whose owner is 7 outside of the triangle, or another inside.
  std::uint64_t differing(const SamplePattern& pattern, int tile_x, int tile_y, const TileVisibility& drawn) const {
    std::uint64_t wrong = 0;
    for (std::size_t s = 0; s < pattern.size(); ++s) {
      const std::int32_t* id = drawn.id + s * sample_stride;
      const std::int64_t x = (tile_x - 512) * 256 + pattern[s].x, y = (tile_y - 384) * 256 + pattern[s].y;
      const std::int64_t step = 256 * (tile_size - 1);
      bool is_inside = true, is_outside = false;  // by the tile's corners
      for (std::size_t k = 0; k < 3; ++k) {
        const auto corners = {at(k, x, y), at(k, x + step, y), at(k, x, y + step), at(k, x + step, y + step)};
        is_inside = is_inside && std::min(corners) >= 0;
        is_outside = is_outside || std::max(corners) < 0;
      }
      if (is_inside || is_outside) {
        const auto owned = static_cast<std::uint64_t>(std::count(id, id + tile_pixels, 7));
        wrong += is_inside ? tile_pixels - owned : owned;
        continue;
      }
      for (int row = 0; row < tile_size; ++row) {
        std::int64_t e[3] = {at(0, x, y + 256 * row), at(1, x, y + 256 * row), at(2, x, y + 256 * row)};
        for (int column = 0; column < tile_size; ++column) {
          wrong += ((e[0] | e[1] | e[2]) >= 0) != (id[row * tile_size + column] == 7);
          for (std::size_t k = 0; k < 3; ++k) e[k] += 256 * by_x[k];
        }
      }
    }
    return wrong;
  }

 private:
  std::int64_t at(std::size_t k, std::int64_t x, std::int64_t y) const {
    return by_x[k] * x + by_y[k] * y + at_origin[k];
  }
  std::int64_t by_x[3], by_y[3], at_origin[3];
};

/// The tiles, of 0 to `count` - 1, that hold any of the coordinates from `low` to `high` or a pixel beside them.
struct TileRange {
  int first, end;
  TileRange(std::int32_t low, std::int32_t high, int pixels)
      : first(std::clamp((low >> 8) - 1 + pixels / 2, 0, pixels) / tile_size),
        end((std::clamp((high >> 8) + 2 + pixels / 2, 0, pixels) + tile_size - 1) / tile_size) {}
};

/// Draws random triangles into every tile that their boxes touch and counts the samples that differ from the
/// definition.
std::uint64_t differing_samples(const SamplePattern& pattern, Isa isa, int triangles, std::uint32_t seed,
                                EdgeRule rule) {
  const RasterRules rules{.edge_rule = rule};
  const int samples = static_cast<int>(pattern.size());
  Buffers buffers(samples);
  TileTriangle tile;
  std::uint64_t wrong = 0;
  for (int i = 0; i < triangles; ++i) {
    ScreenVertex v[3];
    random_corners(seed + static_cast<std::uint32_t>(i), v, SizeMix::FewLarge);
    if (doubled_area(v[0], v[1], v[2]) == 0) continue;
    const Triangle t = make_triangle(v[0], v[1], v[2], 7, coverage_viewport, rules);
    const TileDefinition definition(v, rule);
    const TileRange columns(std::min({v[0].x, v[1].x, v[2].x}), std::max({v[0].x, v[1].x, v[2].x}),
                            coverage_viewport.width);
    const TileRange rows(std::min({v[0].y, v[1].y, v[2].y}), std::max({v[0].y, v[1].y, v[2].y}),
                         coverage_viewport.height);
    for (int row = rows.first; row < rows.end; ++row)
      for (int column = columns.first; column < columns.end; ++column) {
        const int tile_x = column * tile_size, tile_y = row * tile_size;
        make_tile_triangle(t, pattern.data(), samples, tile_x, tile_y, tile);
        buffers.visibility.clear();
        CoverageKernels::of(isa).draw(tile, buffers.visibility);
        buffers.visibility.materialize_all();
        wrong += definition.differing(pattern, tile_x, tile_y, buffers.visibility);
      }
  }
  return wrong;
}

struct Case {
  const char* name;
  SamplePattern pattern;
  int triangles;
};

std::vector<Case> cases() {
  return {{"1", standard_pattern(1), 4000}, {"2", standard_pattern(2), 2000},  {"4", standard_pattern(4), 2000},
          {"8", standard_pattern(8), 1000}, {"16", standard_pattern(16), 500}, {"4x4", grid_pattern(4), 500}};
}

TEST(Coverage, EqualsTheDefinitionInWideIntegers) {
  for (const Isa isa : supported_isas())
    for (const Case& c : cases())
      EXPECT_EQ(differing_samples(c.pattern, isa, c.triangles, 12345, EdgeRule::TopLeft), 0u)
          << c.name << " samples, " << name_of(isa);
}

// What the stepped definition of a tile is, in its plainest form.
TEST(Coverage, TheDefinitionOfATileIsThatOfItsSamples) {
  const SamplePattern pattern = standard_pattern(2);
  for (std::uint32_t i = 0; i < 300; ++i) {
    ScreenVertex v[3];
    random_corners(hash(i, 31), v);
    if (doubled_area(v[0], v[1], v[2]) == 0) continue;
    const EdgeRule rule = i % 2 ? EdgeRule::TopLeft : EdgeRule::Inside;
    const int tile_x = static_cast<int>(hash(i, 32) % 16) * 64, tile_y = static_cast<int>(hash(i, 33) % 12) * 64;
    Buffers expected(2);
    expected.visibility.materialize_all();
    for (int s = 0; s < 2; ++s)
      for (int p = 0; p < tile_pixels; ++p) {
        const SamplePosition at = pattern[static_cast<std::size_t>(s)];
        const bool is_in = covers(v, (tile_x + p % 64 - 512) * 256 + at.x, (tile_y + p / 64 - 384) * 256 + at.y, rule);
        expected.visibility.id[s * sample_stride + p] = is_in ? 7 : -1;
      }
    const TileDefinition definition(v, rule);
    ASSERT_EQ(definition.differing(pattern, tile_x, tile_y, expected.visibility), 0u) << i;
    for (const int p : {0, 4095, sample_stride + 777})  // one wrong sample is one
      expected.visibility.id[p] = expected.visibility.id[p] == 7 ? -1 : 7;
    ASSERT_EQ(definition.differing(pattern, tile_x, tile_y, expected.visibility), 3u) << i;
  }
}

TEST(Coverage, TeachingRuleOwnsEveryEdge) {
  for (const Isa isa : supported_isas())
    EXPECT_EQ(differing_samples(standard_pattern(4), isa, 2000, 777, EdgeRule::Inside), 0u) << name_of(isa);
}

/// A million triangles a pattern: minutes, which `ctest -C Long` adds to the other tests.
class Million : public testing::TestWithParam<int> {};
TEST_P(Million, DISABLED_TrianglesEqualTheDefinition) {
  const Case c = cases()[static_cast<std::size_t>(GetParam())];
  EXPECT_EQ(differing_samples(c.pattern, best_isa(), 1000000, 99, EdgeRule::TopLeft), 0u) << c.name;
}
INSTANTIATE_TEST_SUITE_P(Coverage, Million, testing::Range(0, 6));

TEST(Coverage, TwoTrianglesOfAQuadShareNoSampleAndLeaveNone) {
  const SamplePattern pattern = grid_pattern(4);
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    // Corners on the lattice of the samples, so that edges pass through many of them; convex by construction.
    ScreenVertex v[4];
    const std::int32_t sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (std::uint32_t k = 0; k < 4; ++k)
      v[k] = vertex(sign[k][0] * (2000 + static_cast<std::int32_t>(hash(seed, k) % 40) * 32),
                    sign[k][1] * (2000 + static_cast<std::int32_t>(hash(seed, k + 9) % 40) * 32));
    Buffers first(16), second(16);
    TileTriangle tile;
    make_tile_triangle(make_triangle(v[0], v[1], v[2], 1, coverage_viewport), pattern.data(), 16, 448, 320, tile);
    CoverageKernels::scalar.draw(tile, first.visibility);
    make_tile_triangle(make_triangle(v[0], v[2], v[3], 2, coverage_viewport), pattern.data(), 16, 448, 320, tile);
    CoverageKernels::scalar.draw(tile, second.visibility);
    first.visibility.materialize_all();
    second.visibility.materialize_all();
    for (int i = 0; i < 16 * tile_pixels; ++i) {
      const std::uint32_t place = sample_place(static_cast<std::uint32_t>(i));
      const SamplePosition at = pattern[static_cast<std::size_t>(i / tile_pixels)];
      const std::int64_t x = (448 + i % 64) * 256 + at.x - 512 * 256,
                         y = (320 + i % tile_pixels / 64) * 256 + at.y - 384 * 256;
      const ScreenVertex whole[2][3] = {{v[0], v[1], v[2]}, {v[0], v[2], v[3]}};
      const bool is_inside = covers(whole[0], x, y, EdgeRule::Inside) || covers(whole[1], x, y, EdgeRule::Inside);
      const bool is_strictly_inside = is_inside && [&] {
        for (int k = 0; k < 4; ++k) {
          const ScreenVertex &p = v[k], &q = v[(k + 1) % 4];
          if ((q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x) <= 0) return false;
        }
        return true;
      }();
      const int owners = (first.visibility.id[place] == 1) + (second.visibility.id[place] == 2);
      ASSERT_LE(owners, 1);
      ASSERT_GE(owners, is_strictly_inside ? 1 : 0) << "seed " << seed;
      ASSERT_LE(owners, is_inside ? 1 : 0) << "seed " << seed;
    }
  }
}

TEST(Coverage, KernelsGiveTheScalarTwinsBits) {
  for (const int samples : {1, 2, 4, 8, 16}) {
    const SamplePattern pattern = standard_pattern(samples);
    for (const Isa isa : supported_isas()) {
      Buffers a(samples), b(samples);
      std::vector<CoveredPixel> fa(tile_pixels), fb(tile_pixels);
      TileTriangle tile;
      for (std::uint32_t i = 0; i < 600; ++i) {
        ScreenVertex v[3];
        random_corners(hash(i, 5), v);
        for (ScreenVertex& c : v) c.x /= 8, c.y /= 8, c.z = std::floor(c.z * 8) / 8;  // near, with ties in depth
        if (doubled_area(v[0], v[1], v[2]) == 0) continue;
        make_tile_triangle(
            make_triangle(v[0], v[1], v[2], static_cast<std::int32_t>(hash(i) % 1000), coverage_viewport),
            pattern.data(), samples, 512, 384, tile);
        if (i % 3 == 0) {
          a.visibility.materialize_all();
          b.visibility.materialize_all();
          std::vector<SpanLayer> ra(tile_pixels / 8), rb(tile_pixels / 8);
          std::vector<std::uint8_t> pa(tile_pixels / 8), pb(tile_pixels / 8);
          const std::uint64_t blocks = i % 2 == 0 ? ~std::uint64_t{0} : 0x0f3355aa5533f00full;
          const int rows = CoverageKernels::scalar.collect_rows(tile, a.visibility, blocks, ra.data(), pa.data());
          ASSERT_EQ(rows, CoverageKernels::of(isa).collect_rows(tile, b.visibility, blocks, rb.data(), pb.data()));
          ASSERT_EQ(pa, pb);
          for (std::size_t k = 0; k < static_cast<std::size_t>(rows); ++k)
            ASSERT_TRUE(ra[k].row == rb[k].row && ra[k].least == rb[k].least && ra[k].greatest == rb[k].greatest);
          const int n = CoverageKernels::scalar.collect(tile, a.visibility, fa.data());
          ASSERT_EQ(n, CoverageKernels::of(isa).collect(tile, b.visibility, fb.data()));
          for (int k = 0; k < n; ++k) {
            ASSERT_EQ(fa[static_cast<std::size_t>(k)].pixel, fb[static_cast<std::size_t>(k)].pixel);
            ASSERT_EQ(fa[static_cast<std::size_t>(k)].samples, fb[static_cast<std::size_t>(k)].samples);
          }
          continue;
        }
        CoverageKernels::scalar.draw(tile, a.visibility);
        CoverageKernels::of(isa).draw(tile, b.visibility);
      }
      std::vector<std::int32_t> owners_a(tile_pixels / 8), owners_b(tile_pixels / 8);
      CoverageKernels::scalar.fetch_owners(a.visibility, owners_a.data());
      CoverageKernels::of(isa).fetch_owners(b.visibility, owners_b.data());
      EXPECT_EQ(owners_a, owners_b);
      a.visibility.materialize_all();
      b.visibility.materialize_all();
      const auto bytes = static_cast<std::size_t>(samples) * sample_stride * 4;
      EXPECT_EQ(std::memcmp(a.visibility.depth, b.visibility.depth, bytes), 0) << name_of(isa) << " " << samples;
      EXPECT_EQ(std::memcmp(a.visibility.id, b.visibility.id, bytes), 0) << name_of(isa) << " " << samples;
    }
  }
}

// A first scene, with half of the tile empty; then triangles that reach over it, in front, behind and through.
TEST(Coverage, WholeBlocksAreThoseWhereEverySampleIsWon) {
  int whole = 0, left_out = 0;
  for (const int samples : {1, 4, 8}) {
    const SamplePattern pattern = standard_pattern(samples);
    for (const Isa isa : supported_isas()) {
      const CoverageKernels& kernels = CoverageKernels::of(isa);
      Buffers held(samples);
      TileTriangle tile;
      for (std::uint32_t i = 0; i < 60; ++i) {
        ScreenVertex v[3];
        random_corners(hash(i, 5), v);
        const int shrink = i < 6 ? 8 : 1;
        for (ScreenVertex& c : v) c.x /= shrink, c.y /= shrink;
        if (doubled_area(v[0], v[1], v[2]) == 0) continue;
        make_tile_triangle(make_triangle(v[0], v[1], v[2], static_cast<std::int32_t>(i), coverage_viewport),
                           pattern.data(), samples, 512, 384, tile);
        if (i < 6) {
          kernels.draw(tile, held.visibility);
          continue;
        }
        float nearest[2][TileVisibility::blocks];
        CoverageKernels::scalar.compute_nearest(held.visibility, nearest[0]);
        kernels.compute_nearest(held.visibility, nearest[1]);
        ASSERT_TRUE(std::equal(nearest[0], nearest[0] + TileVisibility::blocks, nearest[1]));
        BlockLayer a[TileVisibility::blocks], b[TileVisibility::blocks];
        std::uint64_t others_a = 0, others_b = 0;
        const int n = CoverageKernels::scalar.collect_blocks(tile, held.visibility, nearest[0], a, others_a);
        ASSERT_EQ(n, kernels.collect_blocks(tile, held.visibility, nearest[0], b, others_b)) << i;
        std::uint64_t listed = 0;
        for (int k = 0; k < n; ++k) {
          ASSERT_TRUE(a[k].block == b[k].block && a[k].least == b[k].least && a[k].greatest == b[k].greatest);
          listed |= std::uint64_t{1} << a[k].block;
        }
        whole += n;
        held.visibility.materialize_all();
        std::vector<CoveredPixel> found(tile_pixels);
        const int won = kernels.collect(tile, held.visibility, found.data());
        for (int k = 0; k < won; ++k) {
          const std::uint32_t pixel = found[static_cast<std::size_t>(k)].pixel;
          ASSERT_TRUE((listed | others_b) >> (pixel / 512 * 8 + pixel % 64 / 8) & 1) << i;
        }
        ASSERT_EQ(listed & others_b, 0u);
        left_out += listed == 0 && others_b == 0;
      }
    }
  }
  EXPECT_GT(whole, 100);
  EXPECT_GT(left_out, 0);
}

}  // namespace
}  // namespace zoneplate
