// SPDX-License-Identifier: Apache-2.0
// Properties of methods with several samples per pixel, on rendered scenes.
#include <gtest/gtest.h>

#include "zoneplate/antialias/shots_for_test.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::antialias {
namespace {

using antialias::shot;
LinearImage shot_of(const char* name, const std::string& method) { return shot(*make_builtin_scene(name), method); }

std::uint64_t shaded(const Scene& scene, const char* method) {
  RenderCounts counts;
  shot(scene, method, {.width = 160, .height = 120}, &counts);
  return counts.shaded;
}

double max_channel_difference(const LinearImage& a, const LinearImage& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    const Linear p = a.values()[i], q = b.values()[i];
    for (const float d : {p.r - q.r, p.g - q.g, p.b - q.b, p.a - q.a}) most = std::max(most, std::abs(double{d}));
  }
  return most;
}

/// One quad over the whole image with constant alpha.
Scene veil(float alpha) {
  Material material;
  material.alpha_mode = AlphaMode::Mask;
  material.base_color = {1, 1, 1, alpha};
  Mesh mesh;
  mesh.position = {{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}};
  mesh.index = {0, 1, 2, 0, 2, 3};
  return facing_scene(std::move(mesh), material);
}

TEST(Ssaa, ABoxOverThePixelIsThePlainMean) {
  // 64 samples in four rounds: their footprint is that of all samples together.
  for (const char* scene : {"cyclic", "checkerboard"})
    EXPECT_LT(max_channel_difference(shot_of(scene, "ssaa:n=8"), shot_of(scene, "ssaa:n=8,filter=box,radius=0.5")),
              2e-6);
  const Scene scene = *make_builtin_scene("cyclic");
  EXPECT_EQ(shaded(scene, "ssaa:n=8"), shaded(scene, "ssaa:n=8,filter=tent"));
}

TEST(Ssaa, FiltersNeedARadiusOfTheirOwn) {
  EXPECT_THROW(make_resolver(methods(), "ssaa:radius=2"), Error);
  EXPECT_THROW(make_resolver(methods(), "ssaa:filter=tent,radius=5"), Error);
  EXPECT_THROW(make_resolver(methods(), "ssaa:filter=tent,radius=1.234"), Error);
  EXPECT_NO_THROW(make_resolver(methods(), "ssaa:filter=tent,radius=1.25"));
}

TEST(Adaptive, IsSupersampledWhereSamplesDisagreeAndOnlyThere) {
  const Scene scene = *make_builtin_scene("cyclic");
  const LinearImage own = shot(scene, "adaptive"), fine = shot(scene, "ssaa:n=4");
  const LinearImage coarse = shot(scene, "ssaa:pattern=rotated,samples=4");
  int refined = 0, plain = 0;
  for (std::size_t i = 0; i < own.values().size(); ++i) {
    const Linear c = own.values()[i];
    if (c == fine.values()[i] && !(c == coarse.values()[i])) ++refined;
    // The coarse samples' sums have another order than those of the rotated grid.
    else if (c == fine.values()[i] || std::abs(c.g - coarse.values()[i].g) < 1e-6f)
      ++plain;
  }
  EXPECT_EQ(refined + plain, 160 * 120);
  EXPECT_GT(refined, 300);
  EXPECT_LT(shaded(scene, "adaptive"), shaded(scene, "ssaa:n=4") / 2);
  EXPECT_GT(shaded(scene, "adaptive"), shaded(scene, "ssaa:pattern=rotated,samples=4"));
  EXPECT_LT(mean_error(own, fine), mean_error(coarse, fine) / 4);
}

TEST(Adaptive, WhereNothingDisagreesOneRoundIsEnough) {
  const Scene scene = veil(1);
  EXPECT_EQ(shaded(scene, "adaptive"), shaded(scene, "ssaa:pattern=rotated,samples=4"));
}

TEST(Csaa, WithASlotForEachSurfaceItIsMultisampling) {
  EXPECT_LT(max_channel_difference(shot_of("cyclic", "csaa:n=8,slots=8"), shot_of("cyclic", "msaa:n=8")), 1e-6);
  // With two slots, only pixels of three or more surfaces differ.
  const LinearImage two = shot_of("cyclic", "csaa:n=8,slots=2"), all = shot_of("cyclic", "msaa:n=8");
  int differing = 0;
  for (std::size_t i = 0; i < all.values().size(); ++i)
    differing += std::abs(all.values()[i].g - two.values()[i].g) > 1e-5f;
  EXPECT_GT(differing, 0);
  EXPECT_LT(differing, 100);
  EXPECT_THROW(make_resolver(methods(), "csaa:n=4,slots=8"), Error);
}

/// A fan of `parts` triangles around (0.3, 0.2) whose colour is a linear function of the position.
Scene slope_of(int parts) {
  Mesh mesh;
  const auto add = [&](float x, float y) {
    mesh.position.push_back({x, y, 0});
    mesh.color.push_back({0.5f + x / 20, 0.5f + y / 20, 0.5f, 1});
  };
  add(0.3f, 0.2f);
  for (int i = 0; i < parts; ++i) {  // around the square from -9 to 9
    const float at = 4 * static_cast<float>(i) / static_cast<float>(parts), side = 18 * (at - std::floor(at)) - 9;
    const int of = static_cast<int>(at);
    add(of == 0 ? side : of == 1 ? 9 : of == 2 ? -side : -9, of == 0 ? -9 : of == 1 ? side : of == 2 ? 9 : -side);
    const auto n = static_cast<std::uint32_t>(i);
    mesh.index.insert(mesh.index.end(), {0, 1 + n, 1 + (n + 1) % static_cast<std::uint32_t>(parts)});
  }
  return facing_scene(std::move(mesh));
}

TEST(Msaa, APlaneLooksTheSameHoweverManyTrianglesItIsMadeOf) {
  // In pixels with several triangles, the only difference is the rounding of positions to 1/256 pixel: two pixels of
  // the image are 1e-3.
  for (const char* n : {"4", "8"}) {
    const std::string mean = std::string("msaa:n=") + n, first = mean + ",centroid=first";
    EXPECT_LT(max_channel_difference(shot(slope_of(4), mean), shot(slope_of(40), mean)), 5e-6) << n;
    EXPECT_GT(max_channel_difference(shot(slope_of(4), first), shot(slope_of(40), first)), 5e-5) << n;
  }
  // With shading at the pixel's centre, the triangles of a plane are not visible either, except at the plane's own
  // sides.
  const std::string centre = "msaa:n=4,centroid=centre";
  EXPECT_LT(max_channel_difference(shot(slope_of(4), centre), shot(slope_of(8), centre)), 5e-4);
}

TEST(SharedSamples, SmoothEdgesAndKeepFlatColours) {
  const LinearImage none = shot_of("cyclic", "none"), truth = shot_of("cyclic", "ssaa:n=16");
  for (const char* method : {"quincunx", "flipquad"}) {
    const LinearImage own = shot_of("cyclic", method);
    EXPECT_LT(mean_error(own, truth), 0.75 * mean_error(none, truth)) << method;
    // Away from edges, which is most of the image, nothing changes.
    int same = 0;
    for (std::size_t i = 0; i < own.values().size(); ++i)
      same += std::abs(own.values()[i].g - none.values()[i].g) < 1e-6f;
    EXPECT_GT(same, 160 * 120 * 9 / 10) << method;
  }
}

/// The least squares shift of an image against another, in pixels, from the latter's gradients.
float2 shift_between(const LinearImage& image, const LinearImage& truth) {
  double xx = 0, xy = 0, yy = 0, xe = 0, ye = 0;
  for (int y = 2; y < truth.height() - 2; ++y)
    for (int x = 2; x < truth.width() - 2; ++x) {
      const double dx = static_cast<double>(truth(x + 1, y).g - truth(x - 1, y).g) / 2,
                   dy = static_cast<double>(truth(x, y + 1).g - truth(x, y - 1).g) / 2,
                   e = static_cast<double>(image(x, y).g - truth(x, y).g);
      xx += dx * dx, xy += dx * dy, yy += dy * dy, xe += dx * e, ye += dy * e;
    }
  const double scale = -1 / (xx * yy - xy * xy);
  return {static_cast<float>((yy * xe - xy * ye) * scale), static_cast<float>((xx * ye - xy * xe) * scale)};
}

// Samples of a pixel and of its neighbours have the pixel's centre as their mean, but not as their middle: details of
// few pixels are moved by some hundredths. Shading at the centre would move all by 0.13 to 0.28 pixels.
TEST(SharedSamples, TexturesStayWhereTheyAre) {
  const RenderOptions options{.width = 320, .height = 240};
  for (const char* name : {"tiles", "checkerboard"}) {
    const Scene scene = *make_builtin_scene(name);
    const LinearImage truth = shot(scene, "ssaa:n=8", options);
    for (const char* method : {"none", "msaa:n=4", "quincunx", "flipquad"}) {
      const float2 shift = shift_between(shot(scene, method, options), truth);
      EXPECT_LT(std::max(std::abs(shift.x), std::abs(shift.y)), 0.06f)
          << method << " " << name << ": " << shift.x << " " << shift.y;
    }
  }
}

TEST(SharedSamples, ACropWithItsHaloIsThePartOfTheWhole) {
  const Scene scene = *make_builtin_scene("cyclic");
  for (const char* method : {"quincunx", "flipquad", "msaa:n=8,filter=mitchell", "ssaa:n=2,filter=tent", "adaptive"}) {
    const int halo = make_resolver(methods(), method)->request({}).halo;
    const LinearImage whole = shot(scene, method);
    RenderOptions options{.width = 160, .height = 120};
    options.crop = Crop{51 - halo, 40 - halo, 30 + 2 * halo, 21 + 2 * halo};
    const LinearImage part = shot(scene, method, options);
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 30; ++x) ASSERT_EQ(part(x + halo, y + halo), whole(51 + x, 40 + y)) << method;
  }
}

TEST(AlphaToCoverage, AsManySamplesAsAlphaSays) {
  const auto coverage = [](float alpha, const char* method) { return shot(veil(alpha), method)(80, 60).a; };
  EXPECT_EQ(coverage(0.3f, "msaa:n=8"), 0);
  EXPECT_EQ(coverage(0.3f, "msaa:n=8,alpha=samples"), 0);
  EXPECT_EQ(coverage(0.3f, "msaa:n=8,alpha=coverage"), 0.25f);  // 2.4 of 8
  EXPECT_EQ(coverage(0.7f, "msaa:n=8,alpha=coverage"), 0.75f);  // 5.6 of 8
  EXPECT_EQ(coverage(0.7f, "msaa:n=16,alpha=coverage"), 0.6875f);
  EXPECT_EQ(coverage(1.0f, "msaa:n=4,alpha=coverage"), 1);
  EXPECT_EQ(coverage(0.3f, "msaa:n=8,alpha=sharp"), 0);  // no slope: a step at the cutoff
  EXPECT_EQ(coverage(0.7f, "msaa:n=8,alpha=sharp"), 1);
}

TEST(AlphaToCoverage, SamplesAndSharpAreNearerToSupersamplingThanATestAPixelAndPlainCoverageIsNot) {
  const LinearImage reference = shot_of("foliage", "ssaa:n=8");
  const auto error = [&](const std::string& method) { return mean_error(shot_of("foliage", method), reference); };
  const double tested = error("msaa:n=8");
  EXPECT_LT(error("msaa:n=8,alpha=samples"), 0.85 * tested);
  EXPECT_LT(error("msaa:n=8,alpha=sharp"), 0.95 * tested);
  // Alpha between 0 and 1 near a leaf's outline becomes partial coverage, which the reference's alpha test does not
  // have.
  const double coverage = error("msaa:n=8,alpha=coverage");
  EXPECT_GT(coverage, 1.3 * tested);
  EXPECT_LT(coverage, 1.7 * tested);
}

TEST(Sampling, ThreadsAndInstructionSetsLeaveNoTrace) {
  const Scene scene = *make_builtin_scene("foliage");
  for (const char* method : {"adaptive", "csaa", "quincunx", "flipquad", "msaa:n=4,resolve=max3,alpha=sharp",
                             "ssaa:n=2,filter=mitchell,resolve=karis"}) {
    const RenderOptions options{.width = 96, .height = 72};
    LinearImage one;
    with_threads(1, [&] { one = shot(scene, method, options); });
    for (const Isa isa : supported_isas())
      with_isa(isa, [&] {
        with_threads(3, [&] { EXPECT_EQ(shot(scene, method, options), one) << method << " " << name_of(isa); });
      });
  }
}

}  // namespace
}  // namespace zoneplate::antialias
