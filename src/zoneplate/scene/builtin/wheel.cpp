// SPDX-License-Identifier: Apache-2.0
// A wagon wheel with any number of equal spokes, so that a rotation by one spoke gives the same image.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "zoneplate/math/angle.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/scene/builtin/make.h"

namespace zoneplate {
namespace wheel_scene {
namespace {

constexpr double two_pi = 6.283185307179586;

// A wheel of one metre on the ground, with its axle along z and its front towards the viewer.
constexpr float3 axle{0, 0.5f, 0};
constexpr float hub_radius = 0.078f, spoke_from = 0.06f, spoke_to = 0.44f;
constexpr float max_spoke_radius = 0.017f;
constexpr float spoke_share = 0.36f;  // maximum ratio of a spoke's radius to the space per spoke at the hub
constexpr int spoke_sides = 16;
constexpr std::size_t min_segments = 240;  // of all surfaces of revolution

struct Direction {
  float cosine = 1, sine = 0;
};
Direction direction(double share_of_turn) {
  const SineCosine a = sine_cosine(two_pi * share_of_turn);
  return {static_cast<float>(a.cosine), static_cast<float>(a.sine)};
}

/// A point of a profile: its distance from the axle, and its position along the axle.
struct ProfilePoint {
  float r = 0, z = 0;
};

// Each profile is oriented so that its outside is on the right: (dz, -dr) points outwards. The last point is the first.
constexpr std::array<ProfilePoint, 9> tyre = {{{0.486f, -0.034f},
                                               {0.497f, -0.034f},
                                               {0.5f, -0.030f},
                                               {0.5f, 0.030f},
                                               {0.497f, 0.034f},
                                               {0.486f, 0.034f},
                                               {0.484f, 0.030f},
                                               {0.484f, -0.030f},
                                               {0.486f, -0.034f}}};
constexpr std::array<ProfilePoint, 9> rim = {{{0.432f, -0.029f},
                                              {0.4845f, -0.029f},
                                              {0.4845f, 0.029f},
                                              {0.432f, 0.029f},
                                              {0.424f, 0.023f},
                                              {0.420f, 0.012f},
                                              {0.420f, -0.012f},
                                              {0.424f, -0.023f},
                                              {0.432f, -0.029f}}};
constexpr std::array<ProfilePoint, 13> hub = {{{0, -0.10f},
                                               {0.050f, -0.10f},
                                               {0.056f, -0.094f},
                                               {0.062f, -0.06f},
                                               {hub_radius, -0.045f},
                                               {hub_radius + 0.003f, 0},
                                               {hub_radius, 0.045f},
                                               {0.066f, 0.055f},
                                               {0.062f, 0.075f},
                                               {0.058f, 0.094f},
                                               {0.052f, 0.10f},
                                               {0.036f, 0.10f},
                                               {0, 0.10f}}};
constexpr std::array<ProfilePoint, 9> cap = {{{0.036f, 0.09f},
                                              {0.036f, 0.118f},
                                              {0.034f, 0.123f},
                                              {0.030f, 0.126f},
                                              {0.020f, 0.128f},
                                              {0.018f, 0.134f},
                                              {0.014f, 0.139f},
                                              {0.008f, 0.142f},
                                              {0, 0.143f}}};

/// The outward normals at both ends of each side of a profile: smooth over blunt corners, split at sharp ones.
std::vector<std::array<ProfilePoint, 2>> profile_normals(std::span<const ProfilePoint> profile) {
  // Cosine of the greatest angle between adjacent sides that count as one surface.
  constexpr float min_cosine = 0.75f;
  const std::size_t sides = profile.size() - 1;
  const bool is_closed = profile.front().r == profile.back().r && profile.front().z == profile.back().z;
  std::vector<ProfilePoint> flat(sides);
  for (std::size_t i = 0; i < sides; ++i) {
    const float dr = profile[i + 1].r - profile[i].r, dz = profile[i + 1].z - profile[i].z;
    const float length = std::sqrt(dr * dr + dz * dz);
    flat[i] = {dz / length, -dr / length};
  }
  const auto shared = [&](std::size_t i, std::size_t j) {
    const ProfilePoint a = flat[i], b = flat[j];
    if (a.r * b.r + a.z * b.z < min_cosine) return a;
    const float r = a.r + b.r, z = a.z + b.z, length = std::sqrt(r * r + z * z);
    return ProfilePoint{r / length, z / length};
  };
  std::vector<std::array<ProfilePoint, 2>> normals(sides);
  for (std::size_t i = 0; i < sides; ++i) {
    normals[i] = {flat[i], flat[i]};
    if (i > 0 || is_closed) normals[i][0] = shared(i, (i + sides - 1) % sides);
    if (i + 1 < sides || is_closed) normals[i][1] = shared(i, (i + 1) % sides);
  }
  return normals;
}

/// Adds the triangles of a closed strip of columns with `rows` vertices each; front faces are on the outside.
void add_strip(Mesh& mesh, std::uint32_t first, std::uint32_t columns, std::uint32_t rows) {
  const auto add_triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const float3 pa = mesh.position[a], pb = mesh.position[b], pc = mesh.position[c];
    if (pa == pb || pb == pc || pc == pa) return;  // degenerate at a point of the axis
    for (const std::uint32_t v : {a, b, c}) mesh.index.push_back(v);
  };
  for (std::uint32_t c = 0; c < columns; ++c)
    for (std::uint32_t r = 0; r + 1 < rows; ++r) {
      const std::uint32_t here = first + c * rows + r, next = first + ((c + 1) % columns) * rows + r;
      add_triangle(here, next, next + 1);
      add_triangle(here, next + 1, here + 1);
    }
}

Mesh turned(std::span<const ProfilePoint> profile, std::size_t segments, int material) {
  Mesh mesh;
  mesh.material = material;
  const auto normals = profile_normals(profile);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.position.size());
    for (std::size_t s = 0; s < segments; ++s) {
      const Direction d = direction(static_cast<double>(s) / static_cast<double>(segments));
      for (std::size_t end = 0; end < 2; ++end) {
        const ProfilePoint p = profile[i + end], n = normals[i][end];
        mesh.position.push_back({p.r * d.cosine, p.r * d.sine, p.z});
        mesh.normal.push_back(normalize({n.r * d.cosine, n.r * d.sine, n.z}));
      }
    }
    add_strip(mesh, first, static_cast<std::uint32_t>(segments), 2);
  }
  return mesh;
}

/// A ring of a spoke: its distance from the axle and its radius. Spokes have rings at the hub, in the middle and at the
/// rim.
struct SpokeRing {
  float at, radius;
};

Mesh spokes(std::int64_t count, int material) {
  const float room = static_cast<float>(two_pi) * hub_radius / static_cast<float>(count);
  const float radius = std::min(max_spoke_radius, spoke_share * room);
  const std::array<SpokeRing, 5> rings = {{{spoke_from, radius},
                                           {0.16f, radius},
                                           {0.22f, 0.94f * radius},
                                           {0.36f, 0.76f * radius},
                                           {spoke_to, 0.72f * radius}}};
  Mesh mesh;
  mesh.material = material;
  for (std::int64_t spoke = 0; spoke < count; ++spoke) {
    const Direction along = direction(static_cast<double>(spoke) / static_cast<double>(count));
    const auto first = static_cast<std::uint32_t>(mesh.position.size());
    for (int side = 0; side < spoke_sides; ++side) {
      const Direction around = direction(static_cast<double>(side) / spoke_sides);
      const float3 out{-along.sine * around.cosine, along.cosine * around.cosine, around.sine};
      for (const SpokeRing& ring : rings) {
        mesh.position.push_back(float3{along.cosine, along.sine, 0} * ring.at + out * ring.radius);
        mesh.normal.push_back(normalize(out));
      }
    }
    add_strip(mesh, first, spoke_sides, static_cast<std::uint32_t>(rings.size()));
  }
  return mesh;
}

Material paint(const char* name, float3 color, float metallic, float roughness) {
  Material material;
  material.name = name;
  material.base_color = {color.x, color.y, color.z, 1};
  material.metallic = metallic;
  material.roughness = roughness;
  return material;
}

constexpr std::int64_t micro = 1'000'000;  // units of the parameter `turn`

Scene make(std::span<const std::int64_t> values) {
  const std::int64_t count = values[0];
  const auto n = static_cast<std::size_t>(count);
  const std::size_t segments = n * ((min_segments + n - 1) / n);
  Scene scene;
  scene.materials = {paint("cream", {0.80f, 0.62f, 0.34f}, 0, 0.45f), paint("red", {0.42f, 0.045f, 0.03f}, 0, 0.4f),
                     paint("iron", {0.10f, 0.11f, 0.13f}, 0, 0.35f), paint("brass", {0.85f, 0.60f, 0.22f}, 1, 0.35f)};
  add_object(scene, "spokes", spokes(count, 0));
  add_object(scene, "rim", turned(rim, segments, 1));
  add_object(scene, "hub", turned(hub, segments, 1));
  add_object(scene, "tyre", turned(tyre, segments, 2));
  add_object(scene, "cap", turned(cap, segments, 3));

  // Whole spokes are removed from the angle, so that the wheel is the same to the last bit. Clockwise, as a wheel that
  // rolls to the right.
  const double spokes_turned = static_cast<double>(values[1] % micro) / static_cast<double>(micro);
  const float4x4 turn = rotation({0, 0, 1}, static_cast<float>(-two_pi * spokes_turned / static_cast<double>(count)));
  for (Instance& instance : scene.instances) instance.world_from_object = translation(axle) * turn;
  scene.cameras.push_back(camera_at({0.95f, 0.85f, 2.9f}, axle, 0.3577925f, 0.1f, 10));
  return scene;
}

constexpr Param params[] = {{"spokes", "how many", 12, 1, 360},
                            {.name = "turn",
                             .meaning = "how far it has turned clockwise, in spokes",
                             .value = 0,
                             .low = -1000,
                             .high = 1000,
                             .decimals = 6}};

}  // namespace
}  // namespace wheel_scene

BuiltinMaker builtin_wheel() {
  return {"wheel", "a wagon's wheel of any number of equal spokes", wheel_scene::params, wheel_scene::make};
}

}  // namespace zoneplate
