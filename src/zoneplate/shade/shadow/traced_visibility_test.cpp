// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/traced_visibility.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "zoneplate/math/random.h"
#include "zoneplate/ray/casters_for_test.h"
#include "zoneplate/scene/environment.h"
#include "zoneplate/shade/environment/prepared_environment.h"

namespace zoneplate {
namespace {

constexpr double shadow_pi = 3.14159265358979323846;

/// A sphere of radius 1 that stands on the plane y = 0, of 2 × n × n triangles.
TestMesh standing_sphere(std::uint32_t n) {
  TestMesh mesh = bumpy_sphere(n);
  for (float3& p : mesh.position) p = normalize(p) + float3{0, 1, 0};
  return mesh;
}

/// A square grid of n × n points of the plane y = 0 around the origin.
struct PlanePoints {
  std::vector<float3> points;
  PlanePoints(int n, float half_side) {
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const float step = 2 * half_side / static_cast<float>(n);
        points.push_back(
            {(static_cast<float>(i) + 0.5f) * step - half_side, 0, (static_cast<float>(j) + 0.5f) * step - half_side});
      }
  }
  std::vector<float> visible(const LightVisibility& visibility, bool is_environment = false) const {
    std::vector<float> all;
    for (std::size_t first = 0; first < points.size(); first += 256) {
      Receivers r{};
      r.count = static_cast<int>(std::min<std::size_t>(256, points.size() - first));
      for (std::size_t i = 0; i < static_cast<std::size_t>(r.count); ++i) {
        const float3 p = points[first + i];
        r.position[0][i] = p.x, r.position[1][i] = p.y, r.position[2][i] = p.z;
        r.face[1][i] = r.normal[1][i] = 1;
        r.margin[i] = 1e-6f;
        r.seed[i] = hash(static_cast<std::uint32_t>(first + i), 7);
      }
      float out[Receivers::capacity];
      if (is_environment)
        visibility.of_environment(r, out);
      else
        visibility.of_light(0, r, out);
      all.insert(all.end(), out, out + r.count);
    }
    return all;
  }
};

/// The part of a cone of directions that another cone hides, their axes at `between`.
double hidden_part(double cone, double other, double between) {
  if (between >= cone + other) return 0;
  const double whole = 2 * shadow_pi * (1 - std::cos(cone));
  if (between <= std::abs(cone - other)) return 2 * shadow_pi * (1 - std::cos(std::min(cone, other))) / whole;
  const double a = std::cos(cone), b = std::cos(other), c = std::cos(between);
  const double sa = std::sin(cone), sb = std::sin(other), sc = std::sin(between);
  const double common = 2 * (shadow_pi - std::acos((c - a * b) / (sa * sb)) - a * std::acos((b - c * a) / (sc * sa)) -
                             b * std::acos((a - c * b) / (sc * sb)));
  return common / whole;
}

/// What a point of the plane sees of a light's cone behind the sphere.
double exact_visibility(float3 point, float3 to_light, double cone) {
  const double x = -point.x, y = 1, z = -point.z, distance = std::sqrt(x * x + y * y + z * z);
  const double cosine = (x * to_light.x + y * to_light.y + z * to_light.z) / distance / length(to_light);
  return 1 - hidden_part(cone, std::asin(1 / distance), std::acos(cosine));
}

double rms(const PlanePoints& plane, const std::vector<float>& found, const std::function<double(float3)>& exact) {
  double sum = 0;
  for (std::size_t i = 0; i < found.size(); ++i) sum += std::pow(found[i] - exact(plane.points[i]), 2);
  return std::sqrt(sum / static_cast<double>(found.size()));
}

Light sun_from(float3 to_light) {
  Light light;
  light.direction = -normalize(to_light);
  return light;
}

// The shadow of a sphere is an ellipse: the points whose line to the light passes the centre at less than the radius.
TEST(TracedVisibility, HardShadowOfASphereIsItsEllipse) {
  const TestMesh sphere = standing_sphere(300);
  const Bvh bvh(std::vector{sphere.caster()});
  const float3 to_light = normalize({1, 1.5f, -0.4f});
  const TracedVisibility visibility(bvh, {}, {sun_from(to_light)}, {.method = ShadowMethod::Hard}, {});
  const PlanePoints plane(300, 3);
  const std::vector<float> found = plane.visible(visibility);
  int dark = 0, on_edge = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double x = -plane.points[i].x, z = -plane.points[i].z;
    const double along = x * to_light.x + to_light.y + z * to_light.z,
                 off = std::sqrt(x * x + 1 + z * z - along * along);
    // The polyhedron lies within 2e-4 of the sphere.
    if (std::abs(off - 1) < 2e-4) {
      ++on_edge;
      continue;
    }
    ASSERT_EQ(found[i], off < 1 ? 0 : 1) << plane.points[i].x << ", " << plane.points[i].z;
    dark += off < 1;
  }
  // The ellipse has the area shadow_pi / sin(elevation).
  EXPECT_NEAR(dark, shadow_pi / to_light.y * 2500, 20);
  EXPECT_LT(on_edge, 20);
}

TEST(TracedVisibility, PenumbraOfADiscLightIsThatOfTheFormula) {
  const TestMesh sphere = standing_sphere(200);
  const Bvh bvh(std::vector{sphere.caster()});
  const float3 to_light = normalize({1, 1.5f, -0.4f});
  for (const float angle : {0.02f, 0.1f, 0.3f}) {
    Light light = sun_from(to_light);
    light.radius = angle;
    const TracedVisibility visibility(bvh, {}, {light}, {.method = ShadowMethod::Soft, .samples = 256}, {});
    const PlanePoints plane(48, 3);
    const auto exact = [&](float3 p) { return exact_visibility(p, to_light, angle); };
    const double error = rms(plane, plane.visible(visibility), exact);
    EXPECT_LT(error, 1.0 / 255);
    EXPECT_GT(error, 1e-5);
  }
}

TEST(TracedVisibility, SphericalLightIsSeenAsACone) {
  const TestMesh sphere = standing_sphere(200);
  const Bvh bvh(std::vector{sphere.caster()});
  Light light;
  light.kind = LightKind::Point;
  light.position = {2, 4, 1};
  light.radius = 0.5f;
  const TracedVisibility visibility(bvh, {}, {light}, {.method = ShadowMethod::Soft, .samples = 256}, {});
  const PlanePoints plane(48, 3);
  const auto exact = [&](float3 p) {
    const float3 path = light.position - p;
    return exact_visibility(p, path, std::asin(0.5 / length(path)));
  };
  EXPECT_LT(rms(plane, plane.visible(visibility), exact), 1.0 / 255);
}

// A sphere that touches the plane hides sin^3 of the elevation of its centre.
TEST(TracedVisibility, OcclusionByASphereIsThatOfTheFormula) {
  const TestMesh sphere = standing_sphere(200);
  const Bvh bvh(std::vector{sphere.caster()});
  const TracedVisibility visibility(bvh, {}, {}, {}, {.samples = 256, .distance = 1e6f});
  const auto exact = [&](float3 p) {
    return 1 - std::pow(1 / std::sqrt(double{p.x} * p.x + double{p.z} * p.z + 1), 3);
  };
  const auto codes_off = [&](float half_side) {
    const PlanePoints plane(48, half_side);
    return 255 * rms(plane, plane.visible(visibility, true), exact);
  };
  // The nearer to the sphere, the longer is the outline of what it hides.
  EXPECT_LT(codes_off(4), 0.45);
  EXPECT_LT(codes_off(3), 0.56);
  EXPECT_LT(codes_off(2), 0.78);
}

// An environment that shines from one side only is hidden by what stands on that side.
TEST(TracedVisibility, OcclusionCountsTheEnvironmentsLight) {
  const TestMesh sphere = standing_sphere(40);
  const Bvh bvh(std::vector{sphere.caster()});
  Plane<float4> all(64, 32, {2, 2, 2, 1}), half(64, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) half(x, y) = {1, 1, 1, 1};
  const PreparedEnvironment uniform = prepare_equirectangular(TexelImage(std::move(all)));
  const PreparedEnvironment one_side = prepare_equirectangular(TexelImage(std::move(half)));
  const OcclusionOptions options{.samples = 128, .distance = 1e6f};
  PlanePoints plane(1, 0);
  const auto seen = [&](float3 point, const PreparedEnvironment* environment) {
    plane.points = {point};
    EnvironmentView view;
    if (environment != nullptr) view = environment->view({.color = {1, 1, 1}}, {0, 1, 0});
    const TracedVisibility visibility(bvh, {}, {}, {}, options, environment != nullptr ? &view : nullptr);
    return plane.visible(visibility, true)[0];
  };
  EXPECT_NEAR(seen({2, 0, 0}, &uniform), seen({2, 0, 0}, nullptr), 1e-5f);
  float least = 1, greatest = 0;
  for (const float3 point : {float3{2, 0, 0}, {-2, 0, 0}, {0, 0, 2}, {0, 0, -2}}) {
    const float part = seen(point, &one_side);
    least = std::min(least, part), greatest = std::max(greatest, part);
  }
  EXPECT_LT(least, seen({2, 0, 0}, nullptr) - 0.03f);
  EXPECT_GT(greatest, 0.97f);
}

/// Dim walls and a lamp of 11 degrees, 35 degrees above the horizon, that is 1000 times brighter.
PreparedEnvironment room_with_a_lamp() {
  Plane<float4> image(64, 32, {0.5f, 0.5f, 0.5f, 1});
  for (int y = 9; y < 11; ++y)
    for (int x = 15; x < 17; ++x) image(x, y) = {500, 500, 500, 1};
  return prepare_equirectangular(TexelImage(std::move(image)));
}

// Most rays go where most light comes from.
TEST(TracedVisibility, FewRaysFindALampOfTheEnvironment) {
  const TestMesh sphere = standing_sphere(60);
  const Bvh bvh(std::vector{sphere.caster()});
  const PreparedEnvironment room = room_with_a_lamp();
  const EnvironmentView view = room.view({.color = {1, 1, 1}}, {0, 1, 0});
  const PlanePoints plane(16, 4);
  const auto seen = [&](int samples) {
    return plane.visible(TracedVisibility(bvh, {}, {}, {}, {.samples = samples, .distance = 1e6f}, &view), true);
  };
  const std::vector<float> exact = seen(2048);
  const auto error = [&](int samples) {
    const std::vector<float> found = seen(samples);
    double sum = 0;
    for (std::size_t i = 0; i < found.size(); ++i) sum += std::pow(found[i] - exact[i], 2);
    return std::sqrt(sum / static_cast<double>(found.size()));
  };
  const double few = error(32), many = error(256);
  EXPECT_LT(few, 0.04);
  EXPECT_LT(many, few / 3);
  EXPECT_LT(*std::min_element(exact.begin(), exact.end()), 0.3f) << "the lamp's shadow";
}

TEST(TracedVisibility, NothingOccludesBeyondTheDistance) {
  const TestMesh sphere = standing_sphere(20);
  const Bvh bvh(std::vector{sphere.caster()});
  const TracedVisibility visibility(bvh, {}, {}, {}, {.samples = 16, .distance = 0.25f});
  const PlanePoints plane(32, 3);
  const std::vector<float> found = plane.visible(visibility, true);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_TRUE(found[i] == 1 || length(plane.points[i]) < 1.3f);
}

TEST(TracedVisibility, MoreRaysComeNearerToTheFormula) {
  const TestMesh sphere = standing_sphere(100);
  const Bvh bvh(std::vector{sphere.caster()});
  const float3 to_light = normalize({1, 1.5f, -0.4f});
  double last = 1;
  for (const int samples : {4, 16, 64, 256}) {
    const TracedVisibility visibility(bvh, {}, {sun_from(to_light)},
                                      {.method = ShadowMethod::Soft, .samples = samples, .angle = 0.2f}, {});
    const PlanePoints plane(32, 3);
    const auto exact = [&](float3 p) { return exact_visibility(p, to_light, static_cast<double>(0.2f)); };
    const double error = rms(plane, plane.visible(visibility), exact);
    EXPECT_LT(error, last / 1.8) << samples;
    last = error;
  }
}

TEST(TracedVisibilityBits, AreTheSameForAllInstructionSets) {
  const TestMesh sphere = standing_sphere(20);
  const Bvh bvh(std::vector{sphere.caster()});
  const PlanePoints plane(24, 3);
  const PreparedEnvironment room = room_with_a_lamp();
  const EnvironmentView view = room.view({.color = {1, 1, 1}}, {0, 1, 0});
  std::vector<float> first;
  for (const Isa isa : supported_isas()) {
    with_isa(isa, [&] {
      const TracedVisibility visibility(bvh, {}, {sun_from({1, 1, 1})}, {.method = ShadowMethod::Soft, .angle = 0.2f},
                                        {.samples = 8, .distance = 2});
      const TracedVisibility adaptive(bvh, {}, {}, {}, {.samples = 192, .distance = 2});
      const TracedVisibility in_room(bvh, {}, {}, {}, {.samples = 8, .distance = 2}, &view);
      std::vector<float> found = plane.visible(visibility);
      for (const TracedVisibility* const v : {&visibility, &adaptive, &in_room}) {
        const std::vector<float> occluded = plane.visible(*v, true);
        found.insert(found.end(), occluded.begin(), occluded.end());
      }
      if (first.empty()) first = found;
      EXPECT_EQ(found, first);
    });
  }
}

/// The receivers `from` and on of those at points of a plane.
Receivers receivers_at(const PlanePoints& plane, int from, int count, bool is_half = false) {
  static constexpr auto once = [] {
    std::array<std::uint8_t, Receivers::capacity> halvings{};
    halvings.fill(1);
    return halvings;
  }();
  Receivers r{};
  r.count = count;
  if (is_half) r.halvings = once.data();
  for (int i = 0; i < count; ++i) {
    const float3 p = plane.points[static_cast<std::size_t>(from + i)];
    r.position[0][i] = p.x, r.position[1][i] = p.y, r.position[2][i] = p.z;
    r.face[1][i] = r.normal[1][i] = 1, r.margin[i] = 1e-6f;
    r.seed[i] = hash(static_cast<std::uint32_t>(from + i), 7);
  }
  return r;
}

// Rays of several receivers are traced together.
TEST(TracedVisibilityBits, DoNotDependOnTheOtherReceivers) {
  const TestMesh sphere = standing_sphere(40);
  const Bvh bvh(std::vector{sphere.caster()});
  Light light = sun_from({1, 1.5f, -0.4f});
  light.radius = 0.2f;
  const PlanePoints plane(15, 3);
  for (const int samples : {1, 5, 64, 100})
    for (const bool is_half : {false, true}) {
      const TracedVisibility visibility(bvh, {}, {light}, {.method = ShadowMethod::Soft, .samples = samples}, {});
      float together[Receivers::capacity], alone[Receivers::capacity];
      visibility.of_light(0, receivers_at(plane, 0, 225, is_half), together);
      for (int i = 0; i < 225; ++i) {
        visibility.of_light(0, receivers_at(plane, i, 1, is_half), alone);
        ASSERT_EQ(alone[0], together[i]) << samples << ' ' << is_half;
      }
    }
}

// Each receiver of a batch has its own number of rays, no fewer than 8 of 64.
TEST(TracedVisibility, HalvedRaysAreTheFirstOfALattice) {
  const TestMesh sphere = standing_sphere(40);
  const Bvh bvh(std::vector{sphere.caster()});
  Light light = sun_from({1, 1.5f, -0.4f});
  light.radius = 0.2f;
  const PlanePoints plane(15, 1.5f);
  const auto rays_of = [&](int samples) {
    return TracedVisibility(bvh, {}, {light}, {.method = ShadowMethod::Soft, .samples = samples},
                            {.samples = samples, .distance = 1e6f});
  };
  std::array<std::uint8_t, Receivers::capacity> halvings{};
  for (std::size_t i = 0; i < 225; ++i) halvings[i] = static_cast<std::uint8_t>(i % 6);
  Receivers mixed = receivers_at(plane, 0, 225);
  mixed.halvings = halvings.data();
  float of_light[Receivers::capacity], of_environment[Receivers::capacity];
  rays_of(64).of_light(0, mixed, of_light);
  rays_of(64).of_environment(mixed, of_environment);
  int partly = 0;
  for (int times = 0; times < 6; ++times) {
    const int samples = std::max(64 >> times, 8);
    EXPECT_EQ(Receivers::halved(64, times), samples);
    float light_alone[Receivers::capacity], environment_alone[Receivers::capacity];
    const Receivers all = receivers_at(plane, 0, 225);
    rays_of(samples).of_light(0, all, light_alone);
    rays_of(samples).of_environment(all, environment_alone);
    for (int i = times; i < 225; i += 6) {
      EXPECT_EQ(of_environment[i], environment_alone[i]);
      // A quarter of the rays decides alone where they agree: of fewer rays, fewer.
      if (light_alone[i] == 0 || light_alone[i] == 1) continue;
      EXPECT_EQ(of_light[i], light_alone[i]);
      ++partly;
    }
  }
  EXPECT_GT(partly, 20);
}

// Fewer rays have the same mean and a greater error.
TEST(TracedVisibility, HalfOfTheRaysHaveNoBias) {
  const TestMesh sphere = standing_sphere(40);
  const Bvh bvh(std::vector{sphere.caster()});
  Light light = sun_from({1, 1.5f, -0.4f});
  light.radius = 0.2f;
  Plane<float4> half(64, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) half(x, y) = {1, 1, 1, 1};
  const PreparedEnvironment one_side = prepare_equirectangular(TexelImage(std::move(half)));
  const EnvironmentView view = one_side.view({.color = {1, 1, 1}}, {0, 1, 0});
  const PlanePoints plane(15, 2);
  for (const EnvironmentView* environment : {static_cast<const EnvironmentView*>(nullptr), &view})
    for (const bool is_occlusion : {false, true}) {
      const auto seen = [&](int samples, bool is_half) {
        const TracedVisibility visibility(bvh, {}, {light}, {.method = ShadowMethod::Soft, .samples = samples},
                                          {.samples = samples, .distance = 1e6f}, environment);
        std::vector<float> out(Receivers::capacity);
        const Receivers receivers = receivers_at(plane, 0, 225, is_half);
        is_occlusion ? visibility.of_environment(receivers, out.data()) : visibility.of_light(0, receivers, out.data());
        out.resize(225);
        return out;
      };
      const std::vector<float> reference = seen(4096, false);
      double last = 0;
      for (const bool is_half : {false, true}) {
        const std::vector<float> found = seen(64, is_half);
        double sum = 0, squares = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
          sum += found[i] - reference[i], squares += std::pow(found[i] - reference[i], 2);
        EXPECT_LT(std::abs(sum) / 225, 0.005) << is_half;
        const double error = std::sqrt(squares / 225);
        EXPECT_GT(error, last) << is_half;
        EXPECT_LT(error, 0.06) << is_half;
        last = error;
      }
    }
}

}  // namespace
}  // namespace zoneplate
