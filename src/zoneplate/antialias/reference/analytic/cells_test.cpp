// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "zoneplate/antialias/reference/analytic/flat_triangles_for_test.h"
#include "zoneplate/antialias/reference/analytic/regions.h"

namespace zoneplate::antialias {
namespace {

struct Corner {
  double x, y, z;
};

/// A triangle relative to a pixel, which is the unit square; the corners are in any order.
PixelTriangle make(std::array<Corner, 3> c, std::int32_t id, AlphaMode alpha_mode = AlphaMode::Opaque) {
  const double area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
  if (area < 0) std::swap(c[1], c[2]);
  PixelTriangle t;
  t.id = id, t.alpha_mode = alpha_mode;
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner p = c[k], q = c[(k + 1) % 3];
    const double dx = q.x - p.x, dy = q.y - p.y, length = std::sqrt(dx * dx + dy * dy);
    t.edge[k] = {-dy / length, dx / length, (dy * p.x - dx * p.y) / length};
  }
  const double x1 = c[1].x - c[0].x, y1 = c[1].y - c[0].y, z1 = c[1].z - c[0].z;
  const double x2 = c[2].x - c[0].x, y2 = c[2].y - c[0].y, z2 = c[2].z - c[0].z;
  const double inverse = 1 / (x1 * y2 - x2 * y1);
  t.zx = (z1 * y2 - z2 * y1) * inverse, t.zy = (z2 * x1 - z1 * x2) * inverse;
  t.z = c[0].z - t.zx * c[0].x - t.zy * c[0].y;
  return t;
}

/// Triangles of all kinds: large, small, needles, adjacent along an edge, duplicates, and intersecting planes.
std::vector<PixelTriangle> soup(std::uint32_t seed, int count, bool has_layers) {
  Numbers random(seed);
  std::vector<PixelTriangle> out;
  std::array<Corner, 3> c{};
  for (int i = 0; i < count; ++i) {
    const int kind = static_cast<int>(random(0, 5));
    if (kind == 1 && i > 0) {
      c[0] = {random(-1, 2), random(-1, 2), random(0.1, 0.9)};  // shares the edge 1 2 of the last triangle
    } else if (kind == 2) {
      for (Corner& p : c) p = {random(0.3, 0.7), random(0.3, 0.7), random(0.1, 0.9)};
    } else if (kind == 3) {
      c[0] = {random(-1, 2), random(-1, 2), random(0.1, 0.9)};
      c[1] = {random(-1, 2), random(-1, 2), random(0.1, 0.9)};
      c[2] = {c[1].x + random(0, 1e-6), c[1].y + 1e-7, random(0.1, 0.9)};
    } else if (kind != 4 || i == 0) {
      for (Corner& p : c) p = {random(-1, 2), random(-1, 2), random(0.1, 0.9)};
    }
    const AlphaMode alpha_mode = !has_layers || random(0, 1) < 0.5 ? AlphaMode::Opaque : AlphaMode::Blend;
    out.push_back(make(c, i, alpha_mode));
  }
  return out;
}

PixelCells cells_of(const std::vector<PixelTriangle>& triangles) {
  PixelCells cells;
  cells.clear(unit_square());
  for (const PixelTriangle& t : triangles) cells.insert(t);
  return cells;
}

double total_area(const PixelCells& cells) {
  double sum = 0;
  for (const PixelCells::Cell& cell : cells.cells()) sum += area_moments(cell.polygon).area;
  return sum;
}

TEST(PixelCells, AreasSumToOneForAnySoup) {
  double worst = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    const PixelCells cells = cells_of(soup(seed, 4 + static_cast<int>(seed % 25), seed % 2 == 1));
    worst = std::max(worst, std::abs(total_area(cells) - 1));
    for (const PixelCells::Cell& cell : cells.cells()) ASSERT_GE(area_moments(cell.polygon).area, -1e-15) << seed;
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(PixelCells, EveryPlaceHasTheLayersThatItsDepthsSay) {
  int tested = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    const std::vector<PixelTriangle> triangles = soup(1000 + seed, 12, seed % 2 == 1);
    const PixelCells cells = cells_of(triangles);
    Numbers random(seed + 7000);
    for (int k = 0; k < 40; ++k) {
      const Place p{random(0, 1), random(0, 1)};
      // The expected layers at a point, near to far, by testing each triangle; points too close to any border are
      // skipped.
      std::vector<std::int32_t> expected;
      bool is_clear = true;
      const auto depth = [&](const PixelTriangle& t) { return (t.z + t.zx * p.x) + t.zy * p.y; };
      std::vector<const PixelTriangle*> there;
      for (const PixelTriangle& t : triangles) {
        const double d = std::min({t.edge[0].distance(p), t.edge[1].distance(p), t.edge[2].distance(p)});
        is_clear = is_clear && std::abs(d) > 1e-6;
        if (d > 0) there.push_back(&t);
      }
      std::sort(there.begin(), there.end(), [&](const PixelTriangle* a, const PixelTriangle* b) {
        return depth(*a) != depth(*b) ? depth(*a) > depth(*b) : a->id < b->id;
      });
      for (std::size_t i = 0; i < there.size(); ++i) {
        is_clear =
            is_clear && (i == 0 || there[i]->zx == there[i - 1]->zx || depth(*there[i - 1]) - depth(*there[i]) > 1e-6);
        expected.push_back(there[i]->id);
        if (there[i]->alpha_mode == AlphaMode::Opaque) break;
      }
      if (!is_clear) continue;
      ++tested;
      int holders = 0;
      for (const PixelCells::Cell& cell : cells.cells()) {
        bool holds = true;
        for (int i = 0; i < cell.polygon.count; ++i) {
          const Place a = cell.polygon[i], b = cell.polygon[(i + 1) % cell.polygon.count];
          holds = holds && (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) >= 0;
        }
        if (!holds) continue;
        ++holders;
        std::vector<std::int32_t> found;
        for (const std::uint32_t n : cells.layers_of(cell)) found.push_back(cells.triangle(n).id);
        EXPECT_EQ(found, expected) << "seed " << seed << " at " << p.x << ", " << p.y;
      }
      EXPECT_EQ(holders, 1) << "seed " << seed << " at " << p.x << ", " << p.y;
    }
  }
  EXPECT_GT(tested, 3000);
}

TEST(PixelCells, TrianglesThatPassThroughEachOtherMeetAlongTheirLine) {
  // Depths x and 1 - x: equal at x = 1/2; and x against 1/4.
  const std::array<Corner, 3> rising{Corner{-4, -4, -4}, {6, -4, 6}, {1, 9, 1}};
  const std::array<Corner, 3> falling{Corner{-4, -4, 5}, {6, -4, -5}, {1, 9, 0}};
  const std::array<Corner, 3> flat{Corner{-4, -4, 0.25}, {6, -4, 0.25}, {1, 9, 0.25}};
  const auto seen_of = [](const PixelCells& cells, std::int32_t id) {
    double area = 0;
    for (const PixelCells::Cell& c : cells.cells())
      if (c.layers > 0 && cells.triangle(cells.layers_of(c)[0]).id == id) area += area_moments(c.polygon).area;
    return area;
  };
  EXPECT_NEAR(seen_of(cells_of({make(rising, 0), make(falling, 1)}), 0), 0.5, 1e-12);
  EXPECT_NEAR(seen_of(cells_of({make(flat, 0), make(rising, 1)}), 0), 0.25, 1e-12);
}

TEST(PixelCells, OfEqualDepthsTheLowerNumberIsSeen) {
  const std::array<Corner, 3> c{Corner{-4, -4, 0.3}, {6, -4, 0.4}, {1, 9, 0.5}};
  for (const auto& order : {std::array{3, 5}, {5, 3}}) {
    const PixelCells cells = cells_of({make(c, order[0]), make(c, order[1])});
    ASSERT_EQ(cells.cells().size(), 1u);
    EXPECT_EQ(cells.triangle(cells.layers_of(cells.cells()[0])[0]).id, 3);
  }
  // Pieces of one triangle form one layer.
  PixelTriangle piece = make(c, 1, AlphaMode::Blend);
  piece.is_piece = true;
  const PixelCells pieces = cells_of({piece, piece});
  EXPECT_EQ(pieces.layers_of(pieces.cells()[0]).size(), 1u);
}

/// The area in which each layer is the nearest, by its index (-1: no layer).
using SeenAreas = std::map<std::int32_t, double>;
void add_areas(const PixelCells& cells, SeenAreas& out) {
  for (const PixelCells::Cell& c : cells.cells())
    out[c.layers > 0 ? cells.triangle(cells.layers_of(c)[0]).id : -1] += area_moments(c.polygon).area;
}

TEST(PixelRegions, CrowdedPixelsShowTheSameAsOneRegionWould) {
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    std::vector<PixelTriangle> triangles = soup(500 + seed, 40 + 20 * static_cast<int>(seed), seed % 3 == 1);
    SeenAreas expected, found;
    add_areas(cells_of(triangles), expected);
    PixelRegions regions;
    int regions_used = 0;
    EXPECT_TRUE(regions.find(triangles, [&](const PixelCells& cells) {
      add_areas(cells, found), ++regions_used;
      return true;
    }));
    EXPECT_GT(regions_used, 4) << seed;
    for (const auto& [id, area] : expected) {
      if (id < 0) continue;
      EXPECT_NEAR(found[id], area, 1e-9) << seed << ": " << id;
    }
    double sum = 0;
    for (const auto& [id, area] : found) sum += area;
    EXPECT_LT(sum, 1 + 1e-9);  // regions without triangles are not passed
  }
}

TEST(PixelRegions, LayersInOneOrderAreNoCrowdAndLinesSideBySideAreQuarteredButTwice) {
  // Forty layers, the nearest first; those of `cut` end at nearly identical lines, beyond which the pixel's lower left
  // remains uncovered.
  const auto layers = [](bool cut) {
    std::vector<PixelTriangle> out;
    for (int i = 0; i < 40; ++i) {
      const double z = 0.9 - 0.01 * i, off = 1e-4 * i;
      out.push_back(make({Corner{-9, -9 + off, z}, {9, 9 + off, z}, {-9, 9 + off, z}}, i, AlphaMode::Blend));
      out.back().covers_all = !cut;
    }
    return out;
  };
  for (const bool cut : {false, true}) {
    const std::vector<PixelTriangle> triangles = layers(cut);
    SeenAreas expected, found;
    add_areas(cells_of(triangles), expected);
    PixelRegions regions;
    int regions_used = 0;
    std::size_t most = 0;
    EXPECT_TRUE(regions.find(triangles, [&](const PixelCells& cells) {
      add_areas(cells, found), ++regions_used;
      for (const PixelCells::Cell& cell : cells.cells()) most = std::max<std::size_t>(most, cell.layers);
      return true;
    }));
    EXPECT_EQ(most, 40u);
    if (cut) {
      EXPECT_GT(regions_used, 4);
      EXPECT_LE(regions_used, 64);  // without the limit there would be 4096
    } else {
      EXPECT_EQ(regions_used, 1);
    }
    for (const auto& [id, area] : expected) {
      EXPECT_NEAR(found[id], id < 0 ? found[id] : area, 1e-12);  // regions without triangles are not passed
    }
  }
}

TEST(PixelRegions, PixelsWithTooManyPolygonsAreGivenUp) {
  // Blended triangles of all kinds around the pixel's centre, which exceed the limits of one region long before the
  // last one.
  Numbers random(3);
  std::vector<PixelTriangle> triangles;
  for (int i = 0; i < 1000; ++i) {
    std::array<Corner, 3> c{};
    for (Corner& p : c) p = {random(-1, 2), random(-1, 2), random(0.1, 0.9)};
    triangles.push_back(make(c, i, AlphaMode::Blend));
  }
  PixelRegions regions;
  EXPECT_FALSE(regions.find(triangles, [](const PixelCells& cells) {
    EXPECT_LE(cells.cells().size(), PixelCells::max_cells);
    return true;
  }));
  // The next pixel is not affected; the callback may give up too.
  EXPECT_TRUE(regions.find(std::span(triangles).first(5), [](const PixelCells&) { return true; }));
  EXPECT_FALSE(regions.find(std::span(triangles).first(5), [](const PixelCells&) { return false; }));
}

}  // namespace
}  // namespace zoneplate::antialias
