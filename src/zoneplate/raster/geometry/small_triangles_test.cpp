// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/small_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <tuple>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/raster/coverage/coverage.h"
#include "zoneplate/raster/geometry/clip.h"
#include "zoneplate/raster/geometry/setup.h"
#include "zoneplate/raster/geometry/triangle_facing.h"
#include "zoneplate/raster/tile/rasterize.h"

namespace zoneplate {
namespace {

constexpr Viewport small_viewport{301, 203};

/// Triangles of many sizes on the screen, some of them slivers, points, or in need of the clipper.
struct Soup {
  std::vector<ScreenVertex> screen;
  std::vector<std::uint32_t> index;
  Soup(std::uint32_t seed, std::int32_t triangles) {
    for (std::int32_t t = 0; t < triangles; ++t) {
      const std::uint32_t at = hash(seed, static_cast<std::uint32_t>(t));
      const std::int32_t spread = (t % 5 == 4 ? 120000 : 16 << (at % 9)) + 1;
      // Some of the vertices lie on whole sixteenths of a pixel, so that edges and corners run through samples.
      const std::int32_t grid = at & 0x100 ? 16 : 1;
      const auto random = [&](std::uint32_t axis, std::int32_t range) {
        return static_cast<std::int32_t>(hash(at, axis) % static_cast<std::uint32_t>(2 * range)) - range;
      };
      const std::int32_t x = random(0, 44000), y = random(1, 31000);
      for (std::uint32_t k = 0; k < 3; ++k) {
        ScreenVertex v{(x + random(3 + 2 * k, spread)) / grid * grid, (y + random(4 + 2 * k, spread)) / grid * grid,
                       unit_float(hash(at, 10 + k)), 1};
        if (at % 37 == k) v = {};
        if (at % 41 == 0 && k > 0) v.x = screen.back().x + 256 * static_cast<std::int32_t>(k), v.y = screen.back().y;
        if (at % 43 == 0) v.z = 0.5f;
        if (t > 0 && at % 11 == k) v = screen[hash(at, 20) % screen.size()].inv_w == 0 ? v : screen.back();
        screen.push_back(v);
        index.push_back(static_cast<std::uint32_t>(screen.size() - 1));
      }
    }
  }
};

using Found = std::tuple<std::int32_t, std::uint32_t, std::int32_t, float>;  ///< tile, at, id, depth

/// Lists of fragments with a memory of their own.
class Lists {
 public:
  Lists(std::int32_t first_column, std::int32_t first_row, std::int32_t columns, std::int32_t rows)
      : last_(static_cast<std::size_t>(columns * rows)), sink{first_column, first_row, columns,
                                                              last_.data(), this,      grow} {}

  std::vector<Found> sorted() const {
    std::vector<Found> out;
    for (std::size_t tile = 0; tile < last_.size(); ++tile)
      for (const SampleBin* p = last_[tile]; p; p = p->previous)
        for (std::int32_t i = 0; i < p->count; ++i)
          out.emplace_back(static_cast<std::int32_t>(tile), SampleBin::at(p->packed[i]), p->id(p->packed[i]),
                           p->depth[i]);
    std::sort(out.begin(), out.end());
    return out;
  }

 private:
  static SampleBin* grow(SampleBinWriter& sink, std::int32_t tile, std::int32_t first_id) {
    auto& lists = *static_cast<Lists*>(sink.owner);
    lists.parts_.emplace_back();
    lists.parts_.back().previous = sink.last[tile];
    lists.parts_.back().count = 0;
    lists.parts_.back().first_id = first_id;
    return sink.last[tile] = &lists.parts_.back();
  }
  std::deque<SampleBin> parts_;
  std::vector<SampleBin*> last_;

 public:
  SampleBinWriter sink;
};

struct Outcome {
  std::vector<Found> fragments;
  std::vector<std::int32_t> deferred, visible;
  std::vector<Triangle> records;
  std::uint64_t drawn = 0;
};

auto members_of(const Triangle& t) {
  const auto array = [](const auto& a) { return std::array{a[0], a[1], a[2]}; };
  return std::tuple(array(t.a), array(t.b), array(t.c),
                    std::array{t.min_x, t.min_y, t.max_x, t.max_y, t.x0, t.y0, t.id}, std::array{t.z0, t.dzdx, t.dzdy},
                    std::array{t.z_low, t.z_high});
}

struct Case {
  SamplePattern pattern;
  std::int32_t left = 0, top = 0, right = small_viewport.width - 1, bottom = small_viewport.height - 1;
  std::int32_t facing = 0;
  EdgeRule edge_rule = EdgeRule::TopLeft;
  std::int32_t small_extent = 2047;
  bool lists_visible = false;
};

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const int n : {1, 2, 4, 8, 16})
    out.push_back({.pattern = standard_pattern(n), .facing = n % 3 - 1, .small_extent = n == 4 ? 511 : 2047});
  out.push_back({.pattern = grid_pattern(3), .facing = 1});
  out.push_back({.pattern = standard_pattern(4), .left = 61, .top = 33, .right = 200, .bottom = 127});
  out.push_back({.pattern = standard_pattern(1), .left = 64, .top = 64, .right = 64, .bottom = 64});
  out.push_back({.pattern = standard_pattern(2), .edge_rule = EdgeRule::Inside});
  out.push_back({.pattern = standard_pattern(1), .facing = -1, .small_extent = -1});
  out.push_back({.pattern = standard_pattern(4), .small_extent = -1, .lists_visible = true});
  return out;
}

Outcome outcome_of(const Soup& soup, const Case& c, Isa isa) {
  std::vector<std::int32_t> sample_x, sample_y;
  for (const SamplePosition s : c.pattern) sample_x.push_back(s.x), sample_y.push_back(s.y);
  const std::int32_t column = c.left / tile_size, row = c.top / tile_size;
  Lists lists(column, row, c.right / tile_size - column + 1, c.bottom / tile_size - row + 1);
  Outcome out;
  SmallTriangleResult result;
  std::vector<Triangle> records(SmallTriangleRun::capacity);
  const auto triangles = static_cast<std::int32_t>(soup.index.size() / 3);
  for (std::int32_t first = 0; first < triangles; first += SmallTriangleRun::capacity) {
    const SmallTriangleRun run{.screen = soup.screen.data(),
                               .index = soup.index.data() + 3 * first,
                               .count = std::min(SmallTriangleRun::capacity, triangles - first),
                               .first_id = first,
                               .viewport = small_viewport,
                               .left = c.left,
                               .top = c.top,
                               .right = c.right,
                               .bottom = c.bottom,
                               .sample_x = sample_x.data(),
                               .sample_y = sample_y.data(),
                               .sample_count = static_cast<std::int32_t>(sample_x.size()),
                               .facing = c.facing,
                               .edge_rule = c.edge_rule,
                               .small_extent = c.small_extent,
                               .records = c.lists_visible ? nullptr : records.data()};
    SmallTriangleKernels::of(isa).run(run, lists.sink, result);
    for (std::int32_t i = 0; i < result.deferred_count; ++i) out.deferred.push_back(first + result.deferred[i]);
    for (std::int32_t i = 0; i < result.visible_count; ++i) {
      out.visible.push_back(c.lists_visible ? first + result.visible[i] : records[static_cast<std::size_t>(i)].id);
      if (!c.lists_visible) out.records.push_back(records[static_cast<std::size_t>(i)]);
    }
    out.drawn += result.drawn;
  }
  out.fragments = lists.sorted();
  return out;
}

TEST(Front, EveryInstructionSetFindsTheSame) {
  for (std::uint32_t seed = 0; seed < 3; ++seed) {
    const Soup soup(seed, 5003);
    for (const Case& c : cases()) {
      const Outcome expected = outcome_of(soup, c, Isa::Scalar);
      EXPECT_GT(expected.deferred.size(), 100u);
      for (const Isa isa : supported_isas()) {
        const Outcome found = outcome_of(soup, c, isa);
        EXPECT_EQ(found.deferred, expected.deferred) << name_of(isa);
        EXPECT_EQ(found.visible, expected.visible) << name_of(isa);
        EXPECT_EQ(found.drawn, expected.drawn) << name_of(isa);
        EXPECT_EQ(found.fragments, expected.fragments) << name_of(isa) << ", " << c.pattern.size() << " samples";
        ASSERT_EQ(found.records.size(), expected.records.size());
        for (std::size_t i = 0; i < found.records.size(); ++i)
          EXPECT_EQ(members_of(found.records[i]), members_of(expected.records[i])) << name_of(isa);
      }
    }
  }
}

/// True if the point is inside by the definition: exact edge functions, top-left rule.
bool covers(std::array<std::array<std::int64_t, 2>, 3> v, std::int64_t px, std::int64_t py, EdgeRule rule) {
  const auto cross = [](std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by) {
    return ax * by - ay * bx;
  };
  const std::int64_t area = cross(v[1][0] - v[0][0], v[1][1] - v[0][1], v[2][0] - v[0][0], v[2][1] - v[0][1]);
  if (area < 0) std::swap(v[1], v[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto &p = v[k], &q = v[(k + 1) % 3];
    const std::int64_t dx = q[0] - p[0], dy = q[1] - p[1];
    const std::int64_t side = cross(dx, dy, px - p[0], py - p[1]);
    const bool is_left = dy < 0, is_top = dy == 0 && dx > 0;
    if (side < 0 || (side == 0 && rule == EdgeRule::TopLeft && !is_left && !is_top)) return false;
  }
  return true;
}

TEST(Front, FragmentsAreTheSamplesInsideSmallTriangles) {
  const Soup soup(7, 20011);
  for (const Case& c : cases()) {
    if (c.small_extent < 0) continue;
    const Outcome found = outcome_of(soup, c, best_isa());
    std::vector<std::uint8_t> listed(soup.index.size() / 3);
    for (const std::int32_t t : found.deferred) listed[static_cast<std::size_t>(t)] = 1;
    for (const std::int32_t t : found.visible) listed[static_cast<std::size_t>(t)] = 1;
    const std::int32_t columns = c.right / tile_size - c.left / tile_size + 1;
    std::vector<Found> expected;
    for (std::size_t t = 0; t < listed.size(); ++t) {
      const ScreenVertex* v[3];
      std::array<std::array<std::int64_t, 2>, 3> corner;
      for (std::size_t k = 0; k < 3; ++k) {
        v[k] = &soup.screen[soup.index[3 * t + k]];
        corner[k] = {v[k]->x + small_viewport.width * 128, v[k]->y + small_viewport.height * 128};
      }
      const std::int64_t area = doubled_area(*v[0], *v[1], *v[2]);
      if (listed[t] || area == 0 || (c.facing && (area > 0) != (c.facing > 0))) continue;
      const Triangle triangle =
          make_triangle(*v[0], *v[1], *v[2], static_cast<std::int32_t>(t), small_viewport, {.edge_rule = c.edge_rule});
      if (triangle.min_x > c.right || triangle.max_x < c.left || triangle.min_y > c.bottom || triangle.max_y < c.top)
        continue;
      constexpr int last = tile_size - 1;
      for (int y = std::max(triangle.min_y, c.top & ~last); y <= std::min(triangle.max_y, c.bottom | last); ++y)
        for (int x = std::max(triangle.min_x, c.left & ~last); x <= std::min(triangle.max_x, c.right | last); ++x)
          for (std::size_t s = 0; s < c.pattern.size(); ++s) {
            if (!covers(corner, x * 256 + c.pattern[s].x, y * 256 + c.pattern[s].y, c.edge_rule)) continue;
            const int tile_x = x / tile_size * tile_size, tile_y = y / tile_size * tile_size;
            TileTriangle seen;
            make_tile_triangle(triangle, c.pattern.data(), static_cast<int>(c.pattern.size()), tile_x, tile_y, seen);
            const int i = x - tile_x, j = y - tile_y;
            expected.emplace_back((y / tile_size - c.top / tile_size) * columns + x / tile_size - c.left / tile_size,
                                  static_cast<std::uint32_t>(static_cast<int>(s) * tile_pixels + j * tile_size + i),
                                  static_cast<std::int32_t>(t), depth_at(seen, static_cast<int>(s), i, j));
          }
    }
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(found.fragments, expected) << c.pattern.size() << " samples";
    if (c.right - c.left > 200) {
      EXPECT_GT(expected.size(), 400 * c.pattern.size());
    }
  }
}

TEST(Front, ASheetOfTinyTrianglesCoversEverySampleOnce) {
  // A grid of corners jittered by less than half a cell, each cell cut in two.
  constexpr int n = 90;
  std::vector<ScreenVertex> screen;
  std::vector<std::uint32_t> index;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const auto at = static_cast<std::uint32_t>(j * (n + 1) + i);
      const auto jitter = [&](std::uint32_t axis) { return static_cast<std::int32_t>(hash(at, axis) % 81) - 40; };
      screen.push_back({(i - n / 2) * 181 + jitter(0), (j - n / 2) * 173 + jitter(1), unit_float(hash(at, 2)), 1});
      if (i == n || j == n) continue;
      const std::uint32_t next = at + n + 1;
      for (const std::uint32_t v : {at, at + 1, next + 1, at, next + 1, next}) index.push_back(v);
    }
  Soup sheet(0, 0);
  sheet.screen = screen, sheet.index = index;
  for (const Case& c : {Case{.pattern = standard_pattern(1)}, Case{.pattern = standard_pattern(16)}}) {
    const Outcome found = outcome_of(sheet, c, best_isa());
    EXPECT_TRUE(found.visible.empty() && found.deferred.empty());
    int inside = 0;
    for (std::size_t i = 1; i < found.fragments.size(); ++i) {
      const auto& [tile, at, id, depth] = found.fragments[i];
      EXPECT_FALSE(tile == std::get<0>(found.fragments[i - 1]) && at == std::get<1>(found.fragments[i - 1]));
    }
    // The sheet's inner rectangle has no hole.
    for (const auto& [tile, at, id, depth] : found.fragments) {
      const int x = tile % 5 * tile_size + static_cast<int>(at % 64),
                y = tile / 5 * tile_size + static_cast<int>(at / 64 % 64);
      inside += x >= 120 && x < 180 && y >= 72 && y < 130;
    }
    EXPECT_EQ(inside, 60 * 58 * static_cast<int>(c.pattern.size()));
  }
}

/// Colours nothing: the samples' owners and depths are looked at.
class Blank : public FragmentShader {
 public:
  void shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const override {
    for (int i = 0; i < batch.count; ++i) out.r[i] = out.g[i] = out.b[i] = out.a[i] = 1;
  }
  float alpha(const FragmentBatch&, float*) const override { return 0; }
};

/// Clip positions of triangles from a hundredth of a pixel to beyond the guard band, some across the eye's plane.
std::vector<float4> clip_soup(std::uint32_t seed, int triangles) {
  std::vector<float4> out;
  for (std::uint32_t t = 0; t < static_cast<std::uint32_t>(triangles); ++t) {
    const auto at = [&](std::uint32_t axis) { return unit_float(hash(seed, t, axis)) * 2 - 1; };
    const float size = t % 50 == 0 ? 1500.0f : 0.002f * static_cast<float>(1 << (hash(seed, t) % 11));
    const float w = t % 3 ? 1.0f : 0.05f + 2 * (at(0) + 1);
    for (std::uint32_t k = 0; k < 3; ++k) {
      // Every seventh is a sliver along a diagonal.
      const float along = at(10 + k), across = t % 7 ? at(20 + k) : along + 0.01f * at(20 + k);
      const float depth = std::clamp(0.5f + 0.4f * at(3) + 0.1f * at(30 + k), 0.0f, 1.0f);
      const float vertex_w = t % 23 ? w : w * (0.4f + at(40 + k));
      out.push_back({(at(1) + size * along) * w, (at(2) + size * across) * w, depth * w, vertex_w});
    }
  }
  return out;
}

TEST(Front, PicturesOfSoupsAreThoseOfTheDefinition) {
  constexpr int size = 100;
  constexpr Viewport square{size, size};
  for (const int n : {1, 2, 4, 8, 16}) {
    const std::vector<float4> clip = clip_soup(static_cast<std::uint32_t>(n), 900);
    std::vector<std::uint32_t> index(clip.size());
    for (std::size_t i = 0; i < index.size(); ++i) index[i] = static_cast<std::uint32_t>(i);
    Draw draw;
    draw.clip = clip, draw.index = index;
    const SamplePattern pattern = standard_pattern(n);
    const auto samples = static_cast<std::size_t>(n);
    LinearImage color(size, size, Linear{0, 0, 0, 0});
    std::vector<LinearImage> sample_color(samples, color);
    std::vector<Plane<float>> depth(samples, Plane<float>(size, size)), expected_depth(samples, {size, size, 0.0f});
    std::vector<Plane<std::uint32_t>> id(samples, Plane<std::uint32_t>(size, size)),
        expected_id(samples, {size, size, Target::no_id});
    Target target;
    target.viewport = square, target.width = target.height = size;
    target.samples = pattern;
    target.color = &color, target.sample_color = &sample_color, target.sample_depth = &depth,
    target.sample_triangle = &id;
    rasterize(std::span(&draw, 1), Blank(), {}, target);

    // By the definition: every triangle at every sample, the nearest wins, of equals the first.
    const ProjectedDraws projected = project_draws(std::span(&draw, 1), square);
    const auto draw_piece = [&](const ScreenVertex& p, const ScreenVertex& q, const ScreenVertex& r, std::int32_t t) {
      const Triangle triangle = make_triangle(p, q, r, t, square);
      for (int tile_y = 0; tile_y < size; tile_y += tile_size)
        for (int tile_x = 0; tile_x < size; tile_x += tile_size) {
          TileTriangle seen;
          make_tile_triangle(triangle, pattern.data(), n, tile_x, tile_y, seen);
          for (int y = std::max(triangle.min_y, tile_y); y <= std::min({triangle.max_y, tile_y + 63, size - 1}); ++y)
            for (int x = std::max(triangle.min_x, tile_x); x <= std::min({triangle.max_x, tile_x + 63, size - 1}); ++x)
              for (std::size_t s = 0; s < samples; ++s) {
                bool is_covered = true;
                for (int k = 0; k < 3; ++k)
                  is_covered =
                      is_covered && static_cast<std::int64_t>(triangle.a[k]) * (x * 256 + pattern[s].x) +
                                            static_cast<std::int64_t>(triangle.b[k]) * (y * 256 + pattern[s].y) +
                                            triangle.c[k] >=
                                        0;
                const float z = depth_at(seen, static_cast<int>(s), x - tile_x, y - tile_y);
                const auto own = static_cast<std::uint32_t>(t);
                if (!is_covered || z < expected_depth[s](x, y)) continue;
                if (z == expected_depth[s](x, y) && own > expected_id[s](x, y)) continue;
                expected_depth[s](x, y) = z, expected_id[s](x, y) = own;
              }
        }
    };
    int clipped = 0;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(clip.size() / 3); ++t) {
      const auto i = 3 * static_cast<std::size_t>(t);
      const TriangleFacing facing = face_of(projected, 0, t, square);
      if (facing.is_degenerate) continue;
      if (!facing.needs_clipping) {
        draw_piece(project(clip[i], square), project(clip[i + 1], square), project(clip[i + 2], square), t);
        continue;
      }
      const ClippedPolygon polygon = clip_triangle(clip[i], clip[i + 1], clip[i + 2], square);
      for (std::size_t k = 2; static_cast<int>(k) < polygon.count; ++k) {
        const std::int64_t area = doubled_area(polygon.vertex[0], polygon.vertex[k - 1], polygon.vertex[k]);
        if (area == 0 || (area > 0) != facing.is_clockwise) continue;
        draw_piece(polygon.vertex[0], polygon.vertex[k - 1], polygon.vertex[k], t);
        ++clipped;
      }
    }
    EXPECT_GT(clipped, 20);
    EXPECT_EQ(id, expected_id) << n << " samples";
    EXPECT_EQ(depth, expected_depth) << n << " samples";
  }
}

}  // namespace
}  // namespace zoneplate
