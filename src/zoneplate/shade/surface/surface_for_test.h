// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <memory>

#include "zoneplate/math/transform.h"
#include "zoneplate/shade/surface/material_plan.h"
#include "zoneplate/shade/surface/surface.h"

namespace zoneplate {

/// A scene of one triangle with corners (0,0,0), (1,0,0), (0,1,0), that faces +Z, u to the right and v downwards.
inline Scene flat_triangle(ShadingModel model = ShadingModel::MetallicRoughness, float4 base_color = {1, 1, 1, 1},
                           float3 specular = {0, 0, 0}) {
  Scene scene;
  Mesh mesh;
  mesh.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normal = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.uv0 = {{0, 1}, {1, 1}, {0, 0}};
  mesh.index = {0, 1, 2};
  scene.meshes = {mesh};
  scene.instances = {{0, 0, {}}};
  scene.objects = {"triangle"};
  scene.materials = {{}};
  scene.materials[0].model = model;
  scene.materials[0].base_color = base_color;
  scene.materials[0].specular = specular;
  return scene;
}

inline Light sun(float3 direction, float3 color = {1, 1, 1}) {
  Light light;
  light.direction = direction;
  light.color = color;
  return light;
}

inline Rgba8Image one_texel(Rgba8 value) { return Rgba8Image(1, 1, value); }

/// ShadingState of the scene's triangle, by their barycentric weights.
struct Hand {
  FragmentBatch batch;

  Hand() { std::memset(static_cast<void*>(&batch), 0, sizeof batch); }
  Hand(std::initializer_list<float3> weights) : Hand() {
    for (const float3 w : weights) add(w);
    pad();
  }
  void add(float3 w, std::uint32_t instance = 0, bool is_front = true) {
    const auto i = static_cast<std::size_t>(batch.count++);
    batch.triangle[i] = instance;
    batch.instance[i] = instance;
    for (std::uint32_t k = 0; k < 3; ++k) batch.vertex[k][i] = k;
    batch.is_front[i] = is_front ? 1 : 0;
    batch.b[0][i] = w.y, batch.b[1][i] = w.z;
  }
  /// Entries after the last repeat it.
  void pad() {
    const auto last = static_cast<std::size_t>(batch.count - 1);
    for (auto i = static_cast<std::size_t>(batch.count); i < static_cast<std::size_t>(batch.padded()); ++i) {
      batch.triangle[i] = batch.triangle[last], batch.instance[i] = batch.instance[last];
      batch.is_front[i] = batch.is_front[last];
      for (std::size_t k = 0; k < 3; ++k) batch.vertex[k][i] = batch.vertex[k][last];
      for (std::size_t k = 0; k < 2; ++k) {
        batch.b[k][i] = batch.b[k][last];
        batch.dbdx[k][i] = batch.dbdx[k][last], batch.dbdy[k][i] = batch.dbdy[k][last];
      }
    }
  }
};

/// A scene with all that its shader refers to.
struct Surfaces {
  TextureSet textures;
  InterleavedVertices vertices;
  SurfaceShader shader;
  Surfaces(const Scene& scene, ViewUniforms view)
      : textures(scene, {.raw_colors = view.raw_colors}),
        vertices(scene),
        shader(scene, with_lights(view, scene), textures, vertices) {}
  static ViewUniforms& with_lights(ViewUniforms& view, const Scene& scene) {
    view.lights = scene.lights;
    return view;
  }
};

struct Outcome {
  FragmentOutputs shaded;
  float4 color(std::size_t i = 0) const { return {shaded.r[i], shaded.g[i], shaded.b[i], shaded.a[i]}; }
  float3 normal(std::size_t i = 0) const { return {shaded.normal[0][i], shaded.normal[1][i], shaded.normal[2][i]}; }
};

inline std::unique_ptr<Outcome> shade(const Scene& scene, const ViewUniforms& surroundings, const Hand& hand) {
  auto outcome = std::make_unique<Outcome>();
  std::memset(static_cast<void*>(outcome.get()), 0, sizeof *outcome);
  FragmentOutputs& shaded = outcome->shaded;
  Surfaces(scene, surroundings).shader.shade(hand.batch, {.normal = true, .uv = true, .albedo = true}, shaded);
  // What lies behind the points within a vector means nothing.
  const int end = hand.batch.padded(),
            whole = (end + FragmentBatch::max_lanes - 1) / FragmentBatch::max_lanes * FragmentBatch::max_lanes;
  auto* const arrays = reinterpret_cast<float*>(&shaded);
  for (std::size_t a = 0; a < sizeof shaded / (FragmentBatch::padded_capacity * sizeof(float)); ++a)
    std::fill(arrays + a * FragmentBatch::padded_capacity + end, arrays + a * FragmentBatch::padded_capacity + whole,
              0.0f);
  return outcome;
}

inline float4 color_of(const Scene& scene, const ViewUniforms& surroundings, float3 weights = {0.5f, 0.25f, 0.25f}) {
  return shade(scene, surroundings, Hand{weights})->color();
}

inline void expect_near(float4 actual, float4 expected, float tolerance) {
  EXPECT_NEAR(actual.x, expected.x, tolerance);
  EXPECT_NEAR(actual.y, expected.y, tolerance);
  EXPECT_NEAR(actual.z, expected.z, tolerance);
  EXPECT_NEAR(actual.w, expected.w, tolerance);
}

}  // namespace zoneplate
