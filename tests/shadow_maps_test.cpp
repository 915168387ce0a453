// SPDX-License-Identifier: Apache-2.0
// Shadow maps against the shadows of a sheet over a floor, whose edges are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/scene_shadows.h"
#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace {

constexpr int size = 256;
constexpr float sheet_height = 0.5f, half_side = 0.6f;  // of the sheet

/// A floor of 4 × 4 units in the plane y = 0, under a square sheet.
PreparedScene sheet_scene() {
  Scene scene;
  Mesh floor, sheet;
  add_quad(floor, {{-2, 0, 2}, {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}});
  constexpr float s = half_side;
  add_quad(sheet, {{-s, sheet_height, s}, {s, sheet_height, s}, {s, sheet_height, -s}, {-s, sheet_height, -s}});
  add_part(scene, unlit("floor", {1, 1, 1}), std::move(floor));
  add_part(scene, unlit("sheet", {1, 1, 1}), std::move(sheet));
  return PreparedScene(std::move(scene));
}

/// Where a point of the floor lies relative to the edge of the shadow: positive inside, in world units.
float inside_shadow(float3 point, const Light& light) {
  const float3 to_light = light.kind == LightKind::Directional ? -light.direction : light.position - point;
  const float t = sheet_height / to_light.y;
  const float x = point.x + to_light.x * t, z = point.z + to_light.z * t;
  // On the floor the shadow of a light at y = p is p / (p - sheet_height) times as large as the sheet.
  const float scale = light.kind == LightKind::Directional ? 1 : light.position.y / (light.position.y - sheet_height);
  return (half_side - std::max(std::abs(x), std::abs(z))) * scale;
}

struct Comparison {
  float farthest = 0;  ///< the distance from the edge, in texels, of the farthest wrong point
  double rms = 0;      ///< against the shadow of a point
};

Comparison compare(const Light& light, const ShadowOptions& options) {
  const PreparedScene scene = sheet_scene();
  const std::vector<std::vector<ShadowMap>> maps = make_shadow_maps(scene, {light}, size);
  const MappedVisibility visibility({light}, maps, options, nullptr);
  Comparison out;
  int count = 0;
  for (int j = 0; j < 200; ++j) {
    Receivers r{};
    r.count = 200;
    for (int i = 0; i < r.count; ++i) {
      r.position[0][i] = 0.019f * (static_cast<float>(i) - 99.5f),
      r.position[2][i] = 0.019f * (static_cast<float>(j) - 99.5f);
      r.face[1][i] = r.normal[1][i] = 1;
      r.seed[i] = static_cast<std::uint32_t>(200 * j + i);
    }
    float found[Receivers::capacity];
    visibility.of_light(0, r, found);
    for (int i = 0; i < r.count; ++i) {
      const float3 point{r.position[0][i], 0, r.position[2][i]};
      const float inside = inside_shadow(point, light), exact = inside > 0 ? 0 : 1;
      // Texels are as large on the floor as light slants to it.
      const ShadowMap& map = maps[0].size() == 1 ? maps[0][0] : maps[0][3];
      const float3 to_light = light.kind == LightKind::Directional ? -light.direction : light.position - point;
      const float distance = map.is_perspective ? length(to_light) : 1;
      const float texel = distance / (map.scale * normalize(to_light).y);
      if (std::abs(found[i] - exact) > 0.01f) out.farthest = std::max(out.farthest, std::abs(inside) / texel);
      out.rms += std::pow(found[i] - exact, 2), ++count;
    }
  }
  out.rms = std::sqrt(out.rms / count);
  return out;
}

Light sun() {
  Light light;
  light.direction = normalize({-0.4f, -1, 0.25f});
  return light;
}

Light lamp(LightKind kind) {
  Light light;
  light.kind = kind;
  light.position = {0.2f, 2.5f, -0.1f};
  light.direction = {0, -1, 0};
  light.outer_cone = 1;
  return light;
}

ShadowOptions map_with(ShadowFilter filter, float radius = 1.5f) {
  return {.method = ShadowMethod::Map, .map = {.filter = filter, .size = size, .radius = radius}};
}

TEST(ShadowMaps, EdgesAreWithinATexel) {
  for (const Light& light : {sun(), lamp(LightKind::Spot), lamp(LightKind::Point)}) {
    // The diagonal of a texel, and as much for the bias.
    const Comparison nearest = compare(light, map_with(ShadowFilter::Nearest));
    EXPECT_LT(nearest.farthest, 1.5f);
    EXPECT_GT(nearest.farthest, 0.1f);
    // A filter adds its radius.
    const Comparison pcf = compare(light, map_with(ShadowFilter::Pcf, 2));
    EXPECT_LT(pcf.farthest, 3.5f);
    EXPECT_GT(pcf.farthest, 1.0f);
  }
}

// The root mean square difference from the shadow of a point, whose edge all filters but the first blur.
TEST(ShadowMaps, FiltersHaveTheirErrors) {
  const double nearest = compare(sun(), map_with(ShadowFilter::Nearest)).rms;
  const double pcf = compare(sun(), map_with(ShadowFilter::Pcf)).rms;
  const double pcss = compare(sun(), map_with(ShadowFilter::Pcss)).rms;
  const double evsm = compare(sun(), map_with(ShadowFilter::Evsm)).rms;
  EXPECT_NEAR(nearest, 0.0316, 0.002);
  EXPECT_NEAR(pcf, 0.0390, 0.002);
  EXPECT_NEAR(pcss, 0.0411, 0.002);
  EXPECT_NEAR(evsm, 0.0364, 0.002);
}

}  // namespace
}  // namespace zoneplate
