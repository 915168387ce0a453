// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/cast/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/shadow/light_visibility.h"
#include "zoneplate/shade/shadow/receivers.h"
#include "zoneplate/shade/surface/lighting_lanes.h"

namespace zoneplate {
namespace {

constexpr std::uint32_t triangles_of_square[] = {0, 1, 2, 0, 2, 3};

/// How far the square reaches from its centre, in diagonals of the scene: the shadow of a light 10° above the horizon.
constexpr float reach = 6;
/// How far below the scene it lies, in diagonals: a floor that belongs to the scene hides it.
constexpr float clearance = 0x1p-13f;

/// Rec.709.
float luminance(float3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

}  // namespace

GroundSquare::GroundSquare(const Scene& scene) : up(normalize(scene.up, {0, 1, 0})) {
  Box box = scene.bounds();
  if (box.empty()) box.add(float3{0, 0, 0});
  const float diagonal = length(box.size());
  float lowest = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 8; ++i) lowest = std::min(lowest, dot(box.corner(i), up));
  const float3 centre = box.centre() + up * (lowest - clearance * diagonal - dot(box.centre(), up));
  const float3 right = normalize(cross(up, std::abs(up.x) < 0.9f ? float3{1, 0, 0} : float3{0, 0, 1}));
  const float3 x = right * (reach * diagonal), y = cross(up, x);
  corner = {centre - x - y, centre + x - y, centre + x + y, centre - x + y};
  for (const float3 p : corner)
    margin = std::max({margin, std::abs(p.x) * 0x1p-20f, std::abs(p.y) * 0x1p-20f, std::abs(p.z) * 0x1p-20f});
}

Camera GroundSquare::enclosing(Camera camera) const {
  const float3 ahead = -xyz(camera.world_from_camera.column[2]), eye = xyz(camera.world_from_camera.column[3]);
  float farthest = camera.far;
  for (const float3 p : corner) farthest = std::max(farthest, dot(p - eye, ahead) * 1.001f);
  camera.far = farthest;
  camera.near = std::min(camera.near, farthest * 0x1p-12f);
  return camera;
}

Ground::Ground(const Scene& scene, const ViewUniforms& view)
    : visibility_(*view.visibility), environment_(luminance(view.environment)), square_(scene) {
  if (view.map) {
    using F = scalar::Float;
    const auto light = diffuse_light(*view.map, Vector<F>{F(square_.up.x), F(square_.up.y), F(square_.up.z)});
    environment_ = luminance({light.x.v, light.y.v, light.z.v});
  }
  // A white surface reflects 1/π of the illuminance; the diffuse term of (Blinn-)Phong, whose environment is the
  // ambient light, lacks this factor.
  if (environment_ == 0) environment_ = luminance(view.ambient_light), reflectance_ = 1;
  for (const Light& light : view.lights) lights_.push_back(prepare(light));
}

Draw Ground::draw(const float4x4& clip_from_world, std::uint32_t instance, int material) const {
  Draw draw;
  draw.position = square_.corner;
  draw.index = triangles_of_square;
  draw.clip_from_object = clip_from_world;
  draw.alpha_mode = AlphaMode::Blend;
  draw.culls_back_faces = true;
  draw.instance = instance, draw.material = material;
  return draw;
}

bool Ground::needs_derivatives() const { return visibility_.needs_footprint(); }

void Ground::shade(const FragmentBatch& batch, FragmentOutputs& out) const {
  Receivers receivers;
  ShadingState p;
  p.count = receivers.count = batch.count;
  receivers.is_ground = true, receivers.coverage = batch.coverage;
  for (std::size_t i = 0; i < static_cast<std::size_t>(p.count); ++i) {
    const std::size_t leader = batch.leader(i);
    const auto corner = [&](std::size_t k) { return square_.corner[batch.vertex[k][leader]]; };
    const float3 at = corner(0) + ((corner(1) - corner(0)) * batch.b[0][i] + (corner(2) - corner(0)) * batch.b[1][i]);
    const auto store = [&](float3 from, float(&to)[3][Receivers::capacity]) {
      to[0][i] = from.x, to[1][i] = from.y, to[2][i] = from.z;
    };
    store(at, p.position), store(at, receivers.position);
    store(square_.up, receivers.face), store(square_.up, receivers.normal);
    receivers.margin[i] = square_.margin;
    if (visibility_.needs_footprint())
      store_footprint(batch, i, corner(1) - corner(0), corner(2) - corner(0), receivers);
    store_image_position(batch.x[i], batch.y[i], receivers, i);
    receivers.surface[i] = 0;
  }

  // The radiance of a white diffuse surface under the lights, and the part of it that arrives.
  alignas(64) ShadingState::Array all, arriving, visible;
  std::fill_n(visible, p.count, 1.0f);
  if (visibility_.has_occlusion()) visibility_.of_environment(receivers, visible);
  for (int i = 0; i < p.count; ++i) all[i] = environment_, arriving[i] = environment_ * visible[i];
  for (std::size_t k = 0; k < lights_.size(); ++k) {
    visibility_.of_light(static_cast<int>(k), receivers, visible);
    for (int i = 0; i < p.count; ++i) {
      const auto light = stages::arriving<scalar::Float>(lights_[k], false, p, i);
      const float cosine = dot(float3{light.from.x.v, light.from.y.v, light.from.z.v}, square_.up);
      const float3 radiance{light.radiance.x.v, light.radiance.y.v, light.radiance.z.v};
      const float illuminance = std::max(0.0f, cosine) * luminance(radiance) * reflectance_;
      all[i] += illuminance, arriving[i] += illuminance * visible[i];
    }
  }
  for (int i = 0; i < p.count; ++i) {
    out.r[i] = out.g[i] = out.b[i] = 0;
    out.a[i] = all[i] > 0 ? std::clamp(1 - arriving[i] / all[i], 0.0f, 1.0f) : 0;
  }
}

}  // namespace zoneplate
