// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstring>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/antialias/reference/analytic/flat_triangles_for_test.h"
#include "zoneplate/antialias/shots_for_test.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/fit.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate::antialias {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr Linear white{1, 1, 1, 1}, red{0.8f, 0.1f, 0.1f, 1}, blue{0.1f, 0.2f, 0.9f, 1};

/// The area of the pixel's part where dot(normal, p) < distance from its centre: the distribution of a sum of two
/// uniform variables.
double half_plane(double nx, double ny, double distance) {
  const double m = std::max(std::abs(nx), std::abs(ny)), n = std::min(std::abs(nx), std::abs(ny));
  const double d = std::abs(distance);
  double far = 0;
  if (d <= (m - n) / 2)
    far = 0.5 - d / m;
  else if (d < (m + n) / 2)
    far = ((m + n) / 2 - d) * ((m + n) / 2 - d) / (2 * m * n);
  return distance > 0 ? 1 - far : far;
}

double snapped(double v) { return std::floor(v * 256 + 0.5) / 256; }

/// A half-plane over an image, with its edge through snapped positions.
struct HalfPlane {
  double nx, ny, offset;  ///< nx x + ny y < offset, in pixels
  FlatTriangles scene;

  HalfPlane(int side, double angle, double shift, bool is_level_at_all = false) : scene(side, side) {
    const double dx = is_level_at_all ? 1 : std::cos(angle), dy = is_level_at_all ? 0 : std::sin(angle);
    const double cx = side / 2.0 - dy * shift, cy = side / 2.0 + dx * shift;
    const FlatCorner p{snapped(cx - 900 * dx), snapped(cy - 900 * dy)};
    const FlatCorner q{snapped(cx + 900 * dx), snapped(cy + 900 * dy)};
    scene.add(p, q, {snapped(cx + 3000 * dy), snapped(cy - 3000 * dx)}, white);
    const double ex = q.x - p.x, ey = q.y - p.y, length = std::sqrt(ex * ex + ey * ey);
    nx = -ey / length, ny = ex / length, offset = nx * p.x + ny * p.y;
  }
  double area(int x, int y) const { return half_plane(nx, ny, offset - nx * (x + 0.5) - ny * (y + 0.5)); }
};

/// Triangles of all sizes that overlap and intersect each other, with snapped vertices.
FlatTriangles soup(std::uint32_t seed, int count, int side) {
  Numbers random(seed);
  FlatTriangles scene(side, side);
  for (int i = 0; i < count; ++i) {
    const double size = random(0, 1) < 0.5 ? 3 : side;
    const double x = random(0, side), y = random(0, side);
    FlatCorner c[3];
    for (FlatCorner& p : c)
      p = {snapped(x + random(-size, size)), snapped(y + random(-size, size)), static_cast<float>(random(0.1, 0.9))};
    if (i % 5 == 0) c[2] = {c[1].x + 1.0 / 256, c[1].y + 1.0 / 256, c[1].z};
    const auto channel = [&] { return static_cast<float>(random(0, 1)); };
    scene.add(c[0], c[1], c[2], {channel(), channel(), channel(), 1});
  }
  return scene;
}

TEST(Analytic, HalfPlanesHaveTheirAreaInClosedForm) {
  double worst = 0;
  for (int k = 0; k < 60; ++k) {
    const HalfPlane edge(16, 2 * pi * k / 60 + 0.003, 5.0 * (k % 7) / 7 - 2);
    const LinearImage image = edge.scene.analytic();
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        worst = std::max(worst, std::abs(image(x, y).a - edge.area(x, y)));
        EXPECT_EQ(image(x, y).r, image(x, y).a);
      }
  }
  EXPECT_LT(worst, 1e-7);
}

TEST(Analytic, CoverageIsTheAreaItself) {
  Plane<float> coverage;
  const HalfPlane edge(16, 0.3, 0.4);
  const LinearImage image = edge.scene.analytic({.filter = "mitchell"}, {}, &coverage);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) EXPECT_NEAR(coverage(x, y), edge.area(x, y), 1e-7);
}

TEST(Analytic, OfGridsTheErrorFallsAsTheirNumberToThreeHalves) {
  // Root mean square errors over all half-planes that cross a pixel: 0.0887, 0.0315, 0.0112 for grids of 2, 4, 8.
  constexpr int side = 32, lines = 60;
  for (const auto& [n, expected] : {std::pair{2, 0.0887}, {4, 0.0315}, {8, 0.0112}}) {
    double squares = 0;
    int count = 0;
    for (int k = 0; k < lines; ++k) {
      const HalfPlane edge(side, 2 * pi * (k + 0.37) / lines, 3.0 * ((k * 17) % 60) / 60);
      const LinearImage exact = edge.scene.analytic(), sampled = edge.scene.sampled(grid_pattern(n));
      for (std::size_t i = 0; i < exact.values().size(); ++i) {
        const double a = exact.values()[i].a, off = sampled.values()[i].a - a;
        if (a > 0 && a < 1) squares += off * off, ++count;
      }
    }
    EXPECT_NEAR(std::sqrt(squares / count), expected, 0.05 * expected) << n;
  }
}

TEST(Analytic, GridsOf64x64ComeToIt) {
  // A single edge: the error of the grid is at most a row and its ends.
  for (int k = 0; k < 6; ++k) {
    const HalfPlane edge(16, 2 * pi * (k + 0.21) / 6, 0.7 * k);
    const LinearImage exact = edge.scene.analytic(), grid = edge.scene.sampled(grid_pattern(64));
    for (std::size_t i = 0; i < exact.values().size(); ++i)
      EXPECT_NEAR(exact.values()[i].a, grid.values()[i].a, 1.0 / 128);
  }
  // Scenes of many triangles that occlude and intersect each other.
  double squares = 0;
  int count = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const FlatTriangles scene = soup(seed, 20, 16);
    const LinearImage exact = scene.analytic(), grid = scene.sampled(grid_pattern(64));
    for (std::size_t i = 0; i < exact.values().size(); ++i) {
      const Linear p = exact.values()[i], q = grid.values()[i];
      for (const float off : {p.r - q.r, p.g - q.g, p.b - q.b, p.a - q.a})
        squares += static_cast<double>(off) * off, ++count;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 6e-4);
  EXPECT_GT(std::sqrt(squares / count), 1e-5);  // the scene has edges
}

TEST(Analytic, NeitherOrderNorThreadsNorCropsLeaveATrace) {
  const FlatTriangles scene = soup(3, 60, 128);
  for (const char* filter : {"box", "mitchell"}) {
    const AnalyticOptions options{.filter = filter, .shading = filter[0] == 'b' ? 1 : 2};
    const LinearImage image = scene.analytic(options);
    EXPECT_TRUE(same_bits(scene.reversed().analytic(options), image)) << filter;
    for (const int threads : {1, 2, 3, 7})
      with_threads(threads, [&] { EXPECT_TRUE(same_bits(scene.analytic(options), image)) << filter << threads; });
    const Crop crop{50, 60, 30, 21};
    const LinearImage part = scene.analytic(options, crop);
    for (int y = 0; y < crop.height; ++y)
      for (int x = 0; x < crop.width; ++x) ASSERT_EQ(part(x, y), image(crop.x + x, crop.y + y)) << filter;
  }
}

TEST(Analytic, WhatIsSeenOfAPixelSumsToAllOfIt) {
  // In front of a backdrop, all pixels of a soup of triangles are covered completely, to the last bit of a float:
  // coverage has no gaps and no overlaps. The soup includes duplicates, adjacent triangles, and many slivers in one
  // pixel.
  for (std::uint32_t seed = 20; seed < 24; ++seed) {
    FlatTriangles scene = soup(seed, 80, 16);
    Numbers random(seed);
    for (int i = 0; i < 150; ++i) {
      const double x = snapped(7 + random(-1, 1)), y = snapped(7 + random(-1, 1));
      const auto z = [&] { return static_cast<float>(random(0.1, 0.9)); };
      scene.add({x, y, z()}, {x + 2.5, y + 1 / 256.0, z()}, {x + 2.0, y + 2 / 256.0, z()}, red);
      scene.add({x, y, 0.5f}, {x + 0.5, y, 0.5f}, {x, y + 0.5, 0.5f}, blue);
      scene.add({x, y, 0.5f}, {x + 0.5, y, 0.5f}, {x, y + 0.5, 0.5f}, red);
    }
    scene.add_quad({-8, -8, 0.05f}, {24, -8, 0.05f}, {24, 24, 0.05f}, {-8, 24, 0.05f}, white);
    Plane<float> coverage;
    const LinearImage image = scene.analytic({}, {}, &coverage);
    for (std::size_t i = 0; i < image.values().size(); ++i) {
      EXPECT_EQ(image.values()[i].a, 1.0f) << seed;
      EXPECT_EQ(coverage.values()[i], 1.0f) << seed;
    }
  }
}

TEST(Analytic, NeighboursLeaveNoSeamHoweverSmall) {
  // A fan of four hundred slivers over the whole image, in one colour.
  FlatTriangles scene(32, 32);
  const FlatCorner centre{snapped(15.3), snapped(17.7)};
  const auto rim = [](int i) {
    const double angle = 2 * pi * (i % 400) / 400;
    return FlatCorner{snapped(16 + 60 * std::cos(angle)), snapped(16 + 60 * std::sin(angle))};
  };
  for (int i = 0; i < 400; ++i) scene.add(centre, rim(i), rim(i + 1), white);
  for (const char* filter : {"box", "quadratic", "catmull-rom"}) {
    const LinearImage image = scene.analytic({.filter = filter});
    for (const Linear& c : image.values()) {
      EXPECT_NEAR(c.a, 1, 1e-6) << filter;
      EXPECT_NEAR(c.r, 1, 1e-6) << filter;
    }
  }
}

TEST(Analytic, WideFiltersAreTheirIntegralsOverAnEdge) {
  // A vertical edge at x = 7.3 and a horizontal one at 5.7: the result is the product of two integrals of the kernel.
  constexpr int side = 16;
  const double ex = snapped(7.3), ey = snapped(5.7);
  FlatTriangles scene(side, side);
  scene.add_quad({-20, -20}, {ex, -20}, {ex, ey}, {-20, ey}, white);
  for (const char* name : {"tent", "b-spline", "mitchell", "catmull-rom"}) {
    const Kernel kernel = make_kernel(name);
    const LinearImage image = scene.analytic({.filter = name});
    for (int y = 2; y < side - 2; ++y)
      for (int x = 2; x < side - 2; ++x)
        EXPECT_NEAR(image(x, y).a, kernel.integral(ex - x - 0.5) * kernel.integral(ey - y - 0.5), 1e-6) << name;
  }
}

TEST(Analytic, BlendedSurfacesAreLaidOverInTheirOrderWhereTheyAre) {
  // Half of a pixel: glass in front of paint; the glass intersects a second one at x = 4.5, so that both orders are
  // visible.
  FlatTriangles scene(8, 8);
  const Linear glass{0.5f, 0, 0, 0.5f}, smoke{0, 0.25f, 0, 0.25f};
  scene.add_quad({0, 0, 0.2f}, {8, 0, 0.2f}, {8, 4.5, 0.2f}, {0, 4.5, 0.2f}, blue);
  scene.add_quad({0, 0, 0.1f}, {8, 0, 0.9f}, {8, 8, 0.9f}, {0, 8, 0.1f}, glass, AlphaMode::Blend);
  scene.add_quad({0, 0, 0.55f}, {8, 0, 0.55f}, {8, 8, 0.55f}, {0, 8, 0.55f}, smoke, AlphaMode::Blend);
  const LinearImage image = scene.analytic();
  const auto over = [](Linear front, Linear behind) { return front + behind * (1 - front.a); };
  const auto expect_near = [](Linear a, Linear b) {
    EXPECT_NEAR(a.r, b.r, 1e-6);
    EXPECT_NEAR(a.g, b.g, 1e-6);
    EXPECT_NEAR(a.b, b.b, 1e-6);
    EXPECT_NEAR(a.a, b.a, 1e-6);
  };
  const Linear nothing{0, 0, 0, 0};
  expect_near(image(0, 1), over(smoke, blue));  // the glass is behind the paint up to x = 1
  expect_near(image(2, 1), over(smoke, over(glass, blue)));
  expect_near(image(6, 1), over(glass, over(smoke, blue)));
  expect_near(image(4, 1), (over(smoke, over(glass, blue)) + over(glass, over(smoke, blue))) * 0.5f);
  expect_near(image(6, 4), (over(glass, over(smoke, blue)) + over(glass, over(smoke, nothing))) * 0.5f);
  expect_near(image(6, 6), over(glass, over(smoke, nothing)));
}

/// An alpha-tested red surface, which ends at y = 4.5, over a blue one.
FlatTriangles masked_over_blue() {
  FlatTriangles scene(8, 8);
  scene.add_quad({0, 0, 0.2f}, {8, 0, 0.2f}, {8, 8, 0.2f}, {0, 8, 0.2f}, blue);
  scene.add_quad({0, 0, 0.6f}, {8, 0, 0.6f}, {8, 4.5, 0.6f}, {0, 4.5, 0.6f}, red, AlphaMode::Mask);
  return scene;
}
/// The red fraction of a pixel of that scene.
double red_share(Linear c) { return (c.b - blue.b) / (red.b - blue.b); }

TEST(Analytic, MasksEndAlongTheLineWhereAlphaCrossesTheCutoff) {
  constexpr double end = 3 * 256 + 100.3;
  FlatTriangles scene = masked_over_blue();
  scene.alpha_at = [](std::int32_t x, std::int32_t, float, std::uint32_t) {
    return static_cast<float>(0.5 + (end - x) / 512);
  };
  const LinearImage smooth = scene.analytic();
  EXPECT_EQ(smooth(2, 2), red);
  EXPECT_EQ(smooth(4, 2), blue);
  EXPECT_NEAR(red_share(smooth(3, 2)), 100.3 / 256, 1e-5);
  EXPECT_NEAR(red_share(smooth(2, 4)), 0.5, 1e-6);  // its own edge is exact
  EXPECT_NEAR(red_share(smooth(3, 4)), 100.3 / 512, 1e-5);
  // If alpha is discontinuous, the contour has an uncertainty of half a lattice step on either side.
  scene.alpha_at = [](std::int32_t x, std::int32_t, float, std::uint32_t) { return x < end ? 1.0f : 0.0f; };
  EXPECT_NEAR(red_share(scene.analytic()(3, 2)), 100.3 / 256, 1.0 / 512 + 1e-6);
  // The texture's level of detail for alpha is that of a footprint of 1/16 of a part.
  scene.alpha_at = [](std::int32_t, std::int32_t, float dbdx, std::uint32_t) {
    return std::abs(dbdx) > 1.01f / 64 ? 0.0f : 1.0f;
  };
  EXPECT_EQ(scene.analytic()(2, 2), red);
}

TEST(Analytic, MasksWithCurvedEdgesHaveTheirArea) {
  // A disc, whose area in each pixel is counted at 256 × 256 positions.
  constexpr double cx = 4.13 * 256, cy = 2.2 * 256, radius = 1.7 * 256;
  const auto inside = [](double x, double y) { return radius - std::sqrt((x - cx) * (x - cx) + (y - cy) * (y - cy)); };
  FlatTriangles scene = masked_over_blue();
  for (const bool is_smooth : {true, false}) {
    scene.alpha_at = [&](std::int32_t x, std::int32_t y, float, std::uint32_t) {
      return is_smooth ? static_cast<float>(0.5 + inside(x, y) / 1024) : inside(x, y) >= 0 ? 1.0f : 0.0f;
    };
    const LinearImage image = scene.analytic(), coarse = scene.analytic({.mask = 2});
    double worst = 0, worst_coarse = 0;
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 8; ++x) {
        int count = 0;
        for (int i = 0; i < 65536; ++i) count += inside(x * 256 + i % 256 + 0.5, y * 256 + i / 256 + 0.5) >= 0;
        worst = std::max(worst, std::abs(red_share(image(x, y)) - count / 65536.0));
        worst_coarse = std::max(worst_coarse, std::abs(red_share(coarse(x, y)) - count / 65536.0));
      }
    EXPECT_LT(worst, is_smooth ? 5e-4 : 2e-3);
    EXPECT_GT(worst_coarse, is_smooth ? 7e-4 : 0.0);  // `mask` determines the resolution of the contour
  }
}

TEST(Analytic, AHoleWithinOnePartOfAMaskIsFoundByItsMean) {
  // Alpha for the footprint of a part is its mean, as texture filtering gives it; the corners do not detect the hole.
  constexpr double cx = 2.44 * 256, cy = 2.44 * 256, radius = 0.04 * 256, area = pi * 0.04 * 0.04;
  FlatTriangles scene = masked_over_blue();
  scene.alpha_at = [](std::int32_t x, std::int32_t y, float dbdx, std::uint32_t) {
    const bool is_for_part = std::abs(dbdx) > 0.99f / 64;  // the barycentric weight changes by 1/8 per pixel
    const double off = std::sqrt((x - cx) * (x - cx) + (y - cy) * (y - cy)) - radius;
    const bool is_its_part = x / 32 == 19 && y / 32 == 19;
    if (is_for_part) return static_cast<float>(is_its_part ? 1 - area * 64 : 1.0);
    return static_cast<float>(std::clamp(0.5 + off / 8, 0.0, 1.0));
  };
  EXPECT_NEAR(red_share(scene.analytic()(2, 2)), 1 - area, 1e-3);
}

/// Alpha-tested triangles, each with its own pattern of round holes, so many that they hide nearly all surfaces behind
/// them.
FlatTriangles masked_crowd(int count, int side) {
  Numbers random(77);
  FlatTriangles scene(side, side);
  scene.add_quad({0, 0, 0.05f}, {0.0 + side, 0, 0.05f}, {0.0 + side, 0.0 + side, 0.05f}, {0, 0.0 + side, 0.05f}, blue);
  for (int i = 0; i < count; ++i) {
    const double x = random(0, side), y = random(0, side);
    FlatCorner c[3];
    for (FlatCorner& p : c)
      p = {snapped(x + random(-3, 3)), snapped(y + random(-3, 3)), static_cast<float>(random(0.1, 0.9))};
    const auto channel = [&] { return static_cast<float>(random(0, 1)); };
    scene.add(c[0], c[1], c[2], {channel(), channel(), channel(), 1}, AlphaMode::Mask);
  }
  scene.alpha_at = [](std::int32_t x, std::int32_t y, float, std::uint32_t number) {
    const auto dx = static_cast<float>((x + 37 * static_cast<std::int32_t>(number)) % 200 - 100) / 100;
    const auto dy = static_cast<float>((y + 91 * static_cast<std::int32_t>(number)) % 200 - 100) / 100;
    return 1 - (dx * dx + dy * dy);
  };
  return scene;
}

TEST(Analytic, MaskedCrowdsAgreeWithManySamplesAsTheirErrorSays) {
  const FlatTriangles scene = masked_crowd(400, 16);
  Plane<float> error;
  const LinearImage image = scene.analytic({}, {}, nullptr, &error), grid = scene.sampled(grid_pattern(64));
  double squares = 0, estimated = 0, worst = 0;
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    const Linear p = image.values()[i], q = grid.values()[i];
    const double off = std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)});
    squares += off * off, worst = std::max(worst, off);
    estimated += static_cast<double>(error.values()[i]) * error.values()[i];
    EXPECT_EQ(p.a, 1.0f);
  }
  const double n = static_cast<double>(image.values().size());
  EXPECT_GT(std::sqrt(estimated / n), 5e-4);  // pixels are sampled and have an error estimate
  EXPECT_LT(std::sqrt(squares / n), 1.5 * std::sqrt(estimated / n));
  EXPECT_LT(worst, 0.012);
}

TEST(Analytic, CrowdsLeaveNoTraceOfThreadsInstructionsOrdersOrCrops) {
  const FlatTriangles scene = masked_crowd(60, 8);
  for (const char* filter : {"box", "mitchell"}) {
    const AnalyticOptions options{.filter = filter};
    const LinearImage image = scene.analytic(options);
    for (const int threads : {1, 2, 7})
      with_threads(threads, [&] { EXPECT_TRUE(same_bits(scene.analytic(options), image)) << filter << threads; });
    for (const Isa isa : supported_isas())
      with_isa(isa, [&] { EXPECT_TRUE(same_bits(scene.analytic(options), image)) << filter << name_of(isa); });
    const Crop crop{2, 3, 5, 4};
    const LinearImage part = scene.analytic(options, crop);
    for (int y = 0; y < crop.height; ++y)
      for (int x = 0; x < crop.width; ++x) ASSERT_EQ(part(x, y), image(crop.x + x, crop.y + y)) << filter;
  }
}

TEST(Analytic, TheWorkOfACrowdIsThatOfItsSamples) {
  // Ten times the triangles: queries and shaded samples are bounded by the number of samples, which is at most 4,096
  // per pixel.
  std::uint64_t shaded[2] = {};
  for (const int k : {0, 1}) {
    const FlatTriangles scene = masked_crowd(k == 0 ? 300 : 3000, 4);
    scene.analytic();
    shaded[k] = scene.counts.shaded;
  }
  EXPECT_LT(shaded[1], 2 * shaded[0]);
  EXPECT_LT(shaded[1], 16u * 4096 * 8);
}

TEST(Analytic, BlendedCrowdsPastTheLimitsAreSampled) {
  // Two thousand blended slivers through a pixel would be cut into millions of polygons.
  FlatTriangles scene(4, 4);
  Numbers random(5);
  scene.add_quad({0, 0, 0.05f}, {4, 0, 0.05f}, {4, 4, 0.05f}, {0, 4, 0.05f}, blue);
  for (int i = 0; i < 2000; ++i) {
    FlatCorner c[3];
    for (FlatCorner& p : c) p = {snapped(random(0, 4)), snapped(random(0, 4)), static_cast<float>(random(0.1, 0.9))};
    scene.add(c[0], c[1], c[2], {0.1f * static_cast<float>(random(0, 1)), 0.05f, 0.02f, 0.1f}, AlphaMode::Blend);
  }
  Plane<float> error;
  const LinearImage image = scene.analytic({}, Crop{1, 1, 2, 2}, nullptr, &error);
  const LinearImage grid = scene.sampled(grid_pattern(32));
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      EXPECT_GT(error(x, y), 0);
      EXPECT_NEAR(image(x, y).r, grid(1 + x, 1 + y).r, 2e-3);
      EXPECT_EQ(image(x, y).a, 1.0f);
    }
}

TEST(Analytic, LightBehindManyLayersKeepsItsValue) {
  // Layers of alpha 1/2 in front of a lamp transmit 2^-n of it, which a float represents exactly. They are tested once
  // with polygons, and once with samples, for which nine alpha-tested triangles that are absent everywhere make the
  // pixel crowded.
  for (const int masked : {0, 9})
    for (const int layers : {25, 40, 60})
      for (const float lamp : {1.0f, 1e4f, 1e8f}) {
        FlatTriangles scene(4, 4);
        scene.alpha_at = [](std::int32_t, std::int32_t, float, std::uint32_t) { return 0.0f; };
        scene.add_quad({0, 0, 0.05f}, {4, 0, 0.05f}, {4, 4, 0.05f}, {0, 4, 0.05f}, {lamp, lamp, lamp, 1});
        for (int i = 0; i < layers; ++i) {
          const float z = 0.1f + 0.01f * static_cast<float>(i);
          scene.add_quad({0, 0, z}, {4, 0, z}, {4, 4, z}, {0, 4, z}, {0, 0, 0.25f, 0.5f}, AlphaMode::Blend);
        }
        for (int i = 0; i < masked; ++i)
          scene.add_quad({0, 0, 0.8f}, {4, 0, 0.8f}, {4, 4, 0.8f}, {0, 4, 0.8f}, red, AlphaMode::Mask);
        const LinearImage image = scene.analytic();
        const double left = std::ldexp(1.0, -layers), expected = lamp * left;
        for (const Linear& c : image.values()) {
          EXPECT_NEAR(c.r, expected, 1e-6 * expected);
          EXPECT_NEAR(c.b, 0.5 * (1 - left) + expected, 1e-6 * (0.5 + expected));
          EXPECT_NEAR(c.a, 1, 1e-6);
        }
      }
}

TEST(Analytic, BothTruthsOfBrightEdges) {
  // Half of a pixel is 10 times as bright as white: the scene-linear mean is 5.5, displayed as white; the mean of
  // display-referred values is half of white.
  FlatTriangles scene(8, 8);
  scene.add_quad({0, 0}, {8, 0}, {8, 8}, {0, 8}, {0.2f, 0.2f, 0.2f, 1});
  scene.add_quad({0, 0, 0.6f}, {3.5, 0, 0.6f}, {3.5, 8, 0.6f}, {0, 8, 0.6f}, {10, 10, 10, 1});
  EXPECT_NEAR(scene.analytic()(3, 3).r, 5.1, 1e-6);
  EXPECT_NEAR(scene.analytic({.order = FilterOrder::Display})(3, 3).r, 0.6, 1e-6);
  scene.render_options.display = {.mapping = ToneMapping::Aces, .exposure = 0.5f};
  const float expected =
      (tone_map({5, 5, 5}, ToneMapping::Aces).x + tone_map({0.1f, 0.1f, 0.1f}, ToneMapping::Aces).x) / 2;
  EXPECT_NEAR(scene.analytic({.order = FilterOrder::Display})(3, 3).r, expected, 1e-6);
}

TEST(Analytic, ScenesAgreeWithManySamples) {
  // Clipping, lighting, textures and alpha tests, which flat triangles do not have. The remaining differences are the
  // errors of the samples: 3e-4 at edges for 1,024 scrambled ones, 0.0112 at edges for a grid of 8 × 8, where the city
  // has few edge pixels; and the effect of the texture level for their footprint. The samples of a grid have the
  // footprint of the parts.
  // The diagonals of 32 layers are nearly parallel within their pixels and cut each other into hundreds of polygons.
  struct Expected {
    const char *scene, *sampled;
    double bound;
  };
  for (const auto& [name, method, bound] : {Expected{"teapot:divisions=6", "converged:samples=1024", 3.5e-4},
                                            {"crossing", "converged:samples=1024", 3.5e-4},
                                            {"fillblend", "ssaa:n=8", 5e-5},
                                            {"city-trilinear", "ssaa:n=8", 2.8e-3},
                                            {"foliage", "converged:samples=1024", 1e-3}}) {
    Scene scene = *make_builtin_scene(name);
    RenderOptions options;
    options.width = 64, options.height = 48;
    scene.environment.color = {0.5f, 0.5f, 0.5f};
    const Camera camera = scene.cameras.empty() ? fit_camera(scene.bounds(), 4.0f / 3, {}) : scene.cameras[0];
    const auto shot = [&](const char* by) {
      const auto resolver = make_resolver(methods(), by);
      Frame frame = render(PreparedScene(scene), camera, resolver->request({}), options);
      return resolver->resolve(frame);
    };
    const LinearImage exact = shot("analytic:shading=8"), sampled = shot(method);
    double squares = 0;
    for (std::size_t i = 0; i < exact.values().size(); ++i) {
      const Linear p = exact.values()[i], q = sampled.values()[i];
      for (const float off : {p.r - q.r, p.g - q.g, p.b - q.b, p.a - q.a}) squares += static_cast<double>(off) * off;
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(4 * exact.values().size())), bound) << name;
  }
}

TEST(Analytic, KeptScreenVerticesLeaveNoTrace) {
  for (const char* name : {"near-axis", "city", "foliage"}) {
    const Scene scene = *make_builtin_scene(name);
    const RenderOptions all{.width = 64, .height = 48};
    RenderOptions none = all;
    none.capacity.screen_vertices = 0;
    const LinearImage expected = shot(scene, "analytic", all), image = shot(scene, "analytic", none);
    EXPECT_EQ(std::memcmp(image.values().data(), expected.values().data(), expected.values().size_bytes()), 0) << name;
  }
}

}  // namespace
}  // namespace zoneplate::antialias
