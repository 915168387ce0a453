// SPDX-License-Identifier: Apache-2.0
// Properties of methods whose geometry has a higher sampling rate than shading, on rendered scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "zoneplate/antialias/geometric/bilateral.h"
#include "zoneplate/antialias/geometric/gbaa.h"
#include "zoneplate/antialias/shots_for_test.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/golden_for_test.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::antialias {
namespace {

/// A white half-plane below the line y = 60 + slope (x - 80) of an image of 160 × 120.
Scene half_plane(float slope) {
  Mesh mesh;
  const float run = 400, rise = slope * run;
  mesh.position = {{-run, rise, 0}, {-run, -900, 0}, {run, -900, 0}, {run, -rise, 0}};
  mesh.index = {0, 1, 2, 0, 2, 3};
  Scene scene = facing_scene(std::move(mesh));
  scene.cameras[0].half_height = 60;
  return scene;
}

/// The fraction of the pixel's middle column that is below the line.
float one_dimensional_coverage(float slope, int x, int y) {
  const float line = 60 + slope * (static_cast<float>(x) + 0.5f - 80);
  return std::clamp(static_cast<float>(y) + 1 - line, 0.0f, 1.0f);
}

/// Compares a half-plane's alpha with its one-dimensional coverage.
void expect_one_dimensional_coverage(const char* method, float slope, float tolerance) {
  const LinearImage own = shot(half_plane(slope), method);
  int partial = 0;
  for (int y = 5; y < 115; ++y)
    for (int x = 5; x < 155; ++x) {
      const float share = one_dimensional_coverage(slope, x, y);
      ASSERT_NEAR(own(x, y).a, share, tolerance) << method << " " << slope << " at " << x << "," << y;
      partial += share > 0 && share < 1;
    }
  if (slope > 0) {
    EXPECT_GT(partial, 100);
  }
}

TEST(Gbaa, AHalfPlaneIsItsOneDimensionalCoverage) {
  // Distances below one have errors of at most 2^-12 in 16-bit floats; snapping does not move this line's ends.
  for (const float slope : {0.0f, 0.05f, 0.3f, 0.8f}) expect_one_dimensional_coverage("gbaa", slope, 0x1p-12f + 1e-5f);
}

TEST(Gbaa, ATriangleIsItsOneDimensionalCoverageButAtItsCorners) {
  const double p[3][2] = {{20.25, 10.5}, {61.5, 109.75}, {140.75, 33.125}};  // counter-clockwise in the image, y down
  Mesh mesh;
  for (const auto& c : p) mesh.position.push_back({static_cast<float>(c[0] - 80), static_cast<float>(60 - c[1]), 0});
  mesh.index = {0, 1, 2};
  Scene scene = facing_scene(std::move(mesh));
  scene.cameras[0].half_height = 60;
  const LinearImage own = shot(scene, "gbaa");
  int partial[3] = {};
  for (int y = 1; y < 119; ++y)
    for (int x = 1; x < 159; ++x) {
      // The distances from the centre to the edges, positive inside, along the axis nearest to each edge's normal.
      double inside[3];
      for (int k = 0; k < 3; ++k) {
        const double *a = p[k], *b = p[(k + 1) % 3], dx = b[0] - a[0], dy = b[1] - a[1];
        inside[k] = -(dx * (y + 0.5 - a[1]) - dy * (x + 0.5 - a[0])) / std::max(std::abs(dx), std::abs(dy));
      }
      std::ranges::sort(inside);
      // Near a corner, a second edge is near.
      if (inside[1] < 4) continue;
      const double share = std::clamp(inside[0] + 0.5, 0.0, 1.0);
      ASSERT_NEAR(own(x, y).a, share, 0x1p-12 + 1e-5) << x << "," << y;
      for (int k = 0; k < 3; ++k) {
        const double *a = p[k], *b = p[(k + 1) % 3], dx = b[0] - a[0], dy = b[1] - a[1];
        const double own_inside =
            -(dx * (y + 0.5 - a[1]) - dy * (x + 0.5 - a[0])) / std::max(std::abs(dx), std::abs(dy));
        partial[k] += own_inside == inside[0] && share > 0 && share < 1;
      }
    }
  for (const int count : partial) EXPECT_GT(count, 60);
}

TEST(Gbaa, TheDistancesOfNeighboursAreLookedUpAsPublished) {
  constexpr float none = Frame::no_edge;
  const auto offset = [](float2 own, float2 left, float2 right, float2 above, float2 below) {
    Plane<float2> distance(3, 3, float2{none, none});
    distance(1, 1) = own, distance(0, 1) = left, distance(2, 1) = right, distance(1, 0) = above, distance(1, 2) = below;
    return gbaa_offset(distance, 1, 1);
  };
  const float2 no{none, none};
  EXPECT_EQ(offset(no, no, no, no, no), no);
  // The pixel's own edge takes precedence.
  EXPECT_EQ(offset({-0.25f, none}, {0.75f, none}, no, no, no), (float2{-0.25f, none}));
  EXPECT_EQ(offset({none, 0.125f}, no, no, {none, 0.75f}, no), (float2{none, 0.125f}));
  // An edge of its own beyond the pixel does not count.
  EXPECT_EQ(offset({0.625f, none}, no, no, no, no), no);
  // A neighbour's edge counts if it is on the pixel's side of the neighbour and within the pixel.
  EXPECT_EQ(offset(no, {0.75f, none}, no, no, no), (float2{-0.25f, none}));
  EXPECT_EQ(offset(no, no, {-0.875f, none}, no, no), (float2{0.125f, none}));
  EXPECT_EQ(offset(no, no, no, {none, 0.625f}, no), (float2{none, -0.375f}));
  EXPECT_EQ(offset(no, no, no, no, {none, -0.75f}), (float2{none, 0.25f}));
  EXPECT_EQ(offset(no, {0.25f, none}, no, no, no), no);
  EXPECT_EQ(offset(no, {1.25f, none}, no, no, no), no);
  EXPECT_EQ(offset(no, {-0.75f, none}, no, no, no), no);
  EXPECT_EQ(offset(no, {none, 0.75f}, no, no, no), no);
  // The last of left, right, above and below takes precedence.
  EXPECT_EQ(offset(no, {0.75f, none}, {-0.875f, none}, no, no), (float2{0.125f, none}));
  EXPECT_EQ(offset(no, {0.75f, none}, {-0.875f, none}, {none, 0.625f}, {none, -0.75f}), (float2{none, 0.25f}));
}

TEST(Gbaa, AlphaTestedEdgesAreSmoothed) {
  // A square whose alpha decreases along x: visible up to x = 80.3.
  Mesh mesh;
  mesh.position = {{-80, 60, 0}, {-80, -60, 0}, {80, -60, 0}, {80, 60, 0}};
  mesh.color = {{1, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 1, 0}, {1, 1, 1, 0}};
  mesh.index = {0, 1, 2, 0, 2, 3};
  Material material;
  material.alpha_mode = AlphaMode::Mask;
  material.alpha_cutoff = 1 - 80.3f / 160;
  Scene scene = facing_scene(std::move(mesh), material);
  scene.cameras[0].half_height = 60;
  const LinearImage own = shot(scene, "gbaa"), none = shot(scene, "none");
  for (int y = 3; y < 50; ++y) {
    EXPECT_EQ(none(80, y).a, 0);
    EXPECT_EQ(own(79, y).a, 1);
    EXPECT_NEAR(own(80, y).a, 0.3f, 5e-3f);
    EXPECT_EQ(own(81, y).a, 0);
  }
}

TEST(Axial, AHalfPlaneIsItsOneDimensionalCoverage) {
  // 1/64 is half the distance between two samples.
  for (const float slope : {0.0f, 0.05f, 0.3f, 0.8f})
    for (const char* method : {"axial", "axial:edges=triangles"})
      expect_one_dimensional_coverage(method, slope, 1 / 64.0f + 1e-4f);
}

TEST(Axial, EdgesWithinASurfaceDoNotHideWhereItEnds) {
  // A sphere of triangles smaller than pixels, with constant colour, so that only its outline needs smoothing.
  Scene scene = *make_builtin_scene("sphere:triangles=20000");
  scene.cameras.push_back(fit_camera(scene.bounds(), 4 / 3.0f, {}));
  for (Material& material : scene.materials) material.model = ShadingModel::Unlit;
  const LinearImage truth = shot(scene, "ssaa:n=16");
  const double of_triangles = mean_error(shot(scene, "axial:edges=triangles"), truth);
  EXPECT_LT(mean_error(shot(scene, "axial:edges=surfaces"), truth), 0.8 * of_triangles);
}

TEST(Gbaa, IsForTrianglesLargerThanPixels) {
  const auto gain = [](const char* sphere) {
    Scene scene = *make_builtin_scene(sphere);
    scene.cameras.push_back(fit_camera(scene.bounds(), 4 / 3.0f, {}));
    for (Material& material : scene.materials) material.model = ShadingModel::Unlit;
    const LinearImage truth = shot(scene, "ssaa:n=16");
    return mean_error(shot(scene, "gbaa"), truth) / mean_error(shot(scene, "none"), truth);
  };
  EXPECT_LT(gain("sphere:triangles=200"), 0.8);
  // The weakness of the method: inner edges of smaller triangles hide the outline.
  EXPECT_GT(gain("sphere:triangles=20000"), 1);
}

TEST(Sraa, OfOneSurfaceOnNothingItIsMultisampling) {
  for (const float slope : {0.05f, 0.3f, 0.8f}) {
    const Scene scene = half_plane(slope);
    for (const auto& [own, multi] : {std::pair{"sraa:n=2", "msaa:n=2"},
                                     {"sraa", "msaa:n=4"},
                                     {"sraa:n=8", "msaa:n=8"},
                                     {"sraa:n=16", "msaa:n=16"}}) {
      const LinearImage a = shot(scene, own), b = shot(scene, multi);
      int partial = 0;
      for (std::size_t i = 0; i < a.values().size(); ++i) {
        ASSERT_NEAR(a.values()[i].a, b.values()[i].a, 1e-5f) << own;
        ASSERT_NEAR(a.values()[i].g, b.values()[i].g, 1e-5f) << own;
        partial += b.values()[i].a > 0 && b.values()[i].a < 1;
      }
      if (slope < 0.8f) {
        EXPECT_GT(partial, 50) << own << " " << slope;
      }
    }
  }
}

/// Two walls that meet at pixel column 80, one black and one white, with given normals and depths.
Scene two_walls(float3 left_normal, float3 right_normal, float right_z) {
  Mesh mesh;
  for (const float left : {-400.0f, 0.0f}) {
    const float right = left + 400, z = left < 0 ? 0 : right_z;
    for (const float3 p :
         {float3{left, 400, z}, float3{left, -400, z}, float3{right, -400, z}, float3{right, 400, z}}) {
      mesh.position.push_back(p);
      const float c = left < 0 ? 0.0f : 1.0f;
      mesh.color.push_back({c, c, c, 1});
    }
  }
  mesh.index = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
  Scene scene = facing_scene(std::move(mesh));
  for (std::size_t v = 0; v < 8; ++v) scene.meshes[0].normal[v] = v < 4 ? left_normal : right_normal;
  scene.cameras[0].half_height = 60;
  return scene;
}

/// The expected row of pixels across two such walls, if the weight of one wall's colour on the other is `across`.
std::vector<double> reconstructed_row(const SamplePattern& pattern, double radius, double across) {
  std::vector<double> out;
  for (int x = 0; x < 160; ++x) {
    double sum = 0;
    for (const SamplePosition s : pattern) {
      double color = 0, weight = 0;
      for (int j = -1; j <= 1; ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, 159); ++i) {
          const double dx = i + 0.5 - (x + s.x / 256.0), dy = j + 0.5 - s.y / 256.0;
          if (std::hypot(dx, dy) > radius) continue;
          const double w = (x >= 80) == (i >= 80) ? 1 : across;
          color += w * (i >= 80 ? 1 : 0), weight += w;
        }
      sum += color / weight;
    }
    out.push_back(sum / static_cast<double>(pattern.size()));
  }
  return out;
}

void expect_row(const LinearImage& image, const std::vector<double>& expected) {
  for (int x = 0; x < 160; ++x) ASSERT_NEAR(image(x, 60).g, expected[static_cast<std::size_t>(x)], 2e-5) << x;
}

TEST(Sraa, WeightsAreThePublishedOnes) {
  const float cosine = 0.98f, sine = std::sqrt(1 - cosine * cosine);
  const float3 front{0, 0, 1}, turned{sine, 0, cosine};
  const SamplePattern four = standard_pattern(4);
  // Equal surfaces: a border between colours is blurred by the radius.
  expect_row(shot(two_walls(front, front, 0), "sraa"), reconstructed_row(four, 1, 1));
  expect_row(shot(two_walls(front, front, 0), "sraa:radius=1.5"), reconstructed_row(four, 1.5, 1));
  // Normals: exp(-scale (1 - N·N')).
  expect_row(shot(two_walls(front, turned, 0), "sraa"), reconstructed_row(four, 1, std::exp(-40 * 0.02)));
  expect_row(shot(two_walls(front, turned, 0), "sraa:scale=100"), reconstructed_row(four, 1, std::exp(-100 * 0.02)));
  // Depths: the walls are at distances 5 and 4.9; exp(-scale depth 0.1 / 4.9).
  expect_row(shot(two_walls(front, front, 0.1f), "sraa"), reconstructed_row(four, 1, std::exp(-40 * 10 * 0.1 / 4.9)));
  expect_row(shot(two_walls(front, front, 0.1f), "sraa:depth=1"),
             reconstructed_row(four, 1, std::exp(-40 * 0.1 / 4.9)));
  // The greater of both dissimilarities counts.
  expect_row(shot(two_walls(front, turned, 0.1f), "sraa:depth=1"),
             reconstructed_row(four, 1, std::exp(-40 * 0.1 / 4.9)));
}

TEST(Sraa, KernelsAddWhatTheirTwinsAdd) {
  constexpr std::size_t n = 211;
  std::vector<float> sample(4 * n), centre(4 * n), color(4 * n);
  const auto random = [](std::uint32_t i) { return static_cast<float>(hash(i) >> 8) * 0x1p-24f; };
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto geometry = [&](std::vector<float>& out, std::uint32_t seed, bool is_empty) {
      const float3 v{random(seed) - 0.5f, random(seed + 1) - 0.5f, 0.2f};
      const float3 normal = is_empty ? float3{} : normalize(v, {0, 0, 1});
      out[4 * i] = normal.x, out[4 * i + 1] = normal.y, out[4 * i + 2] = normal.z;
      out[4 * i + 3] = is_empty ? 0 : 1 + random(seed + 2) * (i % 3 == 0 ? 0.01f : 10.0f);
    };
    geometry(sample, 10 * i, i % 7 == 0), geometry(centre, 10 * i + 5, i % 5 == 0);
    for (std::uint32_t c = 0; c < 4; ++c) color[4 * i + c] = random(4 * i + c + 10000) * 3;
  }
  const auto added = [&](const SraaKernels& kernels, std::size_t count) {
    std::vector<float> sum(4 * n, 0.125f), weight(n, 0.25f);
    kernels.add(sample.data(), centre.data(), color.data(), {4, 1}, sum.data(), weight.data(), count);
    return std::pair(sum, weight);
  };
  for (const Isa isa : supported_isas())
    for (std::size_t count = 0; count <= n; count += count < 20 ? 1 : 37)
      ASSERT_EQ(added(SraaKernels::of(isa), count), added(SraaKernels::scalar, count)) << name_of(isa);
}

TEST(GeometryMethods, ShadeOnceAPixel) {
  for (const char* name : {"cyclic", "near-axis", "city"}) {
    const Scene scene = *make_builtin_scene(name);
    const auto count = [&](const char* method) {
      RenderCounts counts;
      shot(scene, method, {.width = 160, .height = 120}, &counts);
      return counts;
    };
    const std::uint64_t once = count("none").shaded;
    EXPECT_LE(once, 160u * 120u) << name;
    for (const char* method : {"sraa", "sraa:n=16", "idsraa", "gbaa", "axial", "axial:edges=triangles"})
      EXPECT_EQ(count(method).shaded, once) << name << " " << method;
    EXPECT_GT(count("msaa:n=4").shaded, once) << name;
    // The geometry of each sample and of the centre is evaluated once.
    EXPECT_LE(count("sraa").geometric, 5u * 160 * 120) << name;
    EXPECT_LE(count("gbaa").geometric, 160u * 120) << name;
    EXPECT_EQ(count("idsraa").geometric, 0u) << name;
  }
}

TEST(GeometryMethods, ComeNearToTheTruth) {
  const Scene scene = *make_builtin_scene("cyclic");
  const LinearImage truth = shot(scene, "analytic");
  const double none = mean_error(shot(scene, "none"), truth);
  for (const char* method : {"sraa", "sraa:n=8", "idsraa", "gbaa", "axial"})
    EXPECT_LT(mean_error(shot(scene, method), truth), 0.5 * none) << method;
}

TEST(GeometryMethods, CropsThreadsAndInstructionSetsLeaveNoTrace) {
  for (const char* name : {"cyclic", "foliage"}) {
    const Scene scene = *make_builtin_scene(name);
    for (const char* method : {"sraa", "idsraa", "gbaa", "axial", "axial:edges=triangles"}) {
      LinearImage whole;
      with_threads(1, [&] { whole = shot(scene, method); });
      RenderOptions options{.width = 160, .height = 120};
      options.crop = Crop{50, 39, 32, 23};  // with an apron of 1
      LinearImage part;
      with_threads(3, [&] { part = shot(scene, method, options); });
      for (int y = 1; y < 22; ++y)
        for (int x = 1; x < 31; ++x) ASSERT_EQ(part(x, y), whole(50 + x, 39 + y)) << method;
      options.crop.reset();
      for (const Isa isa : supported_isas())
        with_isa(isa, [&] { EXPECT_EQ(shot(scene, method, options), whole) << method << " " << name_of(isa); });
    }
  }
}

/// Golden hashes: a change of bits has to be reviewed.
TEST(GeometryMethods, PicturesHaveTheirBits) {
  struct Golden {
    const char *scene, *method;
    std::uint64_t hash;
  };
  constexpr Golden goldens[] = {
      {"cyclic", "sraa", 0xb27a9dade3c8561u},     {"foliage", "sraa", 0x25a5c7c17da1dcf5u},
      {"cyclic", "idsraa", 0x2b87e3a845876392u},  {"foliage", "idsraa", 0xf9415bf1ba0d7259u},
      {"cyclic", "gbaa", 0xa1e17a04e62efb0du},    {"foliage", "gbaa", 0xeb695f870ffc735eu},
      {"cyclic", "axial", 0x2dc4becb456b18b7u},   {"foliage", "axial", 0x8af0a55dc6109306u},
      {"near-axis", "gbaa", 0x5f84563c13140fc8u}, {"city", "sraa:n=16", 0x93b4cbd52fbb472fu},
  };
  for (const Golden& golden : goldens)
    expect_golden(std::string(golden.scene) + ' ' + golden.method,
                  shot(*make_builtin_scene(golden.scene), golden.method), golden.hash);
}

}  // namespace
}  // namespace zoneplate::antialias
