// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/shading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/environment/level_mix.h"
#include "zoneplate/shade/environment/random_map_for_test.h"

namespace zoneplate {
namespace {

const SurfaceKernels& kernels(Isa isa) { return SurfaceKernels::of(isa); }

/// Everything the stages touch, filled with numbers: mostly usual ones, some zeros, some large.
struct Bench {
  FragmentBatch batch;
  TriangleVertices vertices;
  ShadingState state;
  LayerState layers;
  Coordinates coordinates;
  FragmentOutputs shaded;
  InstanceTransform transforms[5];
  float texel[4][ShadingState::capacity];
  float records[FragmentBatch::capacity][24];
  PreparedLight lights[4];
  ShadingUniforms light;

  explicit Bench(int count) {
    std::memset(static_cast<void*>(this), 0, sizeof *this);
    batch.count = count;
    state.count = batch.padded();
    std::uint32_t key = 1;
    const auto fill = [&](auto& array) {
      auto* numbers = reinterpret_cast<float*>(&array);
      constexpr std::size_t bytes = sizeof array;
      for (std::size_t i = 0; i < bytes / sizeof(float); ++i) {
        const std::uint32_t word = hash(static_cast<std::uint32_t>(i), key);
        numbers[i] = word % 13 == 0 ? 0.0f : word % 31 == 0 ? 1e20f : 4 * unit_float(word) - 2;
      }
      ++key;
    };
    fill(batch.b), fill(batch.dbdx), fill(batch.dbdy), fill(records);
    // What the kernels read of each transform.
    constexpr std::size_t instances = std::extent_v<decltype(transforms)>;
    float numbers[instances][offsetof(InstanceTransform, scale_along) / sizeof(float)];
    fill(numbers), fill(texel);
    for (std::size_t i = 0; i < instances; ++i) std::memcpy(&transforms[i], numbers[i], sizeof numbers[i]);
    ShadingState& p = state;
    fill(p.position), fill(p.normal), fill(p.tangent), fill(p.color), fill(p.uv), fill(p.uv_dx), fill(p.uv_dy);
    fill(p.is_lit), fill(p.base), fill(p.metallic), fill(p.roughness), fill(p.occlusion);
    fill(p.emissive), fill(p.specular), fill(p.exponent), fill(layers);
    for (std::uint32_t i = 0; i < FragmentBatch::capacity; ++i) {
      batch.is_front[i] = static_cast<std::int32_t>(hash(i) & 1);
      batch.instance[i] = i / 8 % 3 == 0 ? hash(i, 1) % 5 : hash(i / 8) % 5;
    }
    for (std::uint32_t i = 0; i < FragmentBatch::capacity; ++i) {
      batch.x[i] = static_cast<std::int32_t>(hash(i, 2) % 400000),
      batch.y[i] = static_cast<std::int32_t>(hash(i, 3) % 300000);
      for (std::uint32_t k = 0; k < 3; ++k) vertices.record[k][i] = records[hash(i, 4 + k) % FragmentBatch::capacity];
    }
    for (int g = 0; g < FragmentBatch::groups; ++g) {
      batch.is_flat_run[g] = g % 4 != 3;
      batch.run_begin[g] = static_cast<std::uint8_t>(g % 4 == 3 ? g : g / 4 * 4);
      batch.run_end[g] = static_cast<std::uint8_t>(std::min(g / 4 * 4 + 3, batch.padded() / FragmentBatch::group));
      batch.has_uniform_derivatives[g] = g / 4 % 2 == 1 && (g % 4 == 1 || g % 4 == 2);
      if (batch.has_uniform_derivatives[g])
        repeat_derivatives(batch.run_begin[g] * FragmentBatch::group, g * FragmentBatch::group);
      vertices.one_instance[g] = batch.is_flat_run[g] || g % 3 != 0;
    }
    for (InstanceTransform& placement : transforms) placement.keeps_normals = &placement == transforms ? 1 : 0;
    make_lights();
  }

  /// Gives the fragments of the group from `leader` on, and of the one from `first` on, one derivative.
  void repeat_derivatives(int leader, int first) {
    for (auto* derivatives : {&batch.dbdx, &batch.dbdy})
      for (float(&derivative)[FragmentBatch::padded_capacity] : *derivatives)
        for (const int group : {leader, first})
          std::fill_n(derivative + group, FragmentBatch::group, derivative[leader]);
  }

  StateArray array(const float* of) const {
    return {static_cast<std::int32_t>(reinterpret_cast<const unsigned char*>(of) -
                                      reinterpret_cast<const unsigned char*>(&state))};
  }

  void make_lights() {
    auto& [sun, bulb, spot, lamp] = lights;
    sun = {};
    sun.radiance[0] = 1, sun.radiance[1] = 2, sun.radiance[2] = 0.5f;
    bulb = sun, bulb.is_directional = false, bulb.position[1] = 3, bulb.inverse_range4 = 0.002f;
    spot = bulb, spot.is_spot = true, spot.cone_scale = 3, spot.cone_offset = -1;
    lamp = bulb, lamp.is_quadratic = true, lamp.attenuation[1] = 0.3f, lamp.attenuation[2] = 0.1f;
    light = {};
    light.light = lights, light.lights = 4;
    light.needs_viewer = light.has_emissive = light.has_specular = light.has_environment = true;
    for (int c = 0; c < 3; ++c) {
      const auto k = static_cast<float>(c);
      light.viewpoint.eye[c] = 1 + k, light.emissive[c] = 0.1f * k, light.ambient[c] = 0.2f, light.specular[c] = k;
      light.environment[c] = 0.5f, light.viewpoint.ray[c] = 1 - k, light.viewpoint.ray_dx[c] = 1e-5f * k;
      light.viewpoint.ray_dy[c] = -2e-5f;
    }
    light.exponent = {17.5f, 0};
  }
};

/// The part of each of four lights that reaches each fragment.
const std::vector<float>& visibility() {
  static const std::vector<float> weights = [] {
    std::vector<float> out(4 * FragmentBatch::padded_capacity);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = static_cast<float>(hash(static_cast<std::uint32_t>(i), 77) % 5) / 4;
    return out;
  }();
  return weights;
}

struct Stage {
  std::string name;
  std::function<void(const SurfaceKernels&, Bench&)> run;
};

std::vector<Stage> stages() {
  using K = const SurfaceKernels&;
  using B = Bench&;
  std::vector<Stage> all = {
      {"scale", [](K k, B b) { k.scale(b.state.base[0], b.texel[0], 0.7f, 0.1f, b.state.count); }},
      {"multiply", [](K k, B b) { k.multiply(b.state.base[0], b.texel[0], b.state.count); }},
      {"fill", [](K k, B b) { k.fill(b.state.base[0], 0.7f, b.state.count); }},
      {"saturate", [](K k, B b) { k.saturate(b.state.base[0], b.state.count); }},
      {"interpolate",
       [](K k, B b) {
         Interpolation what;
         what.quads = 2;
         what.quad[0].offset = 4, what.quad[1].offset = 20;
         for (int c = 0; c < 4; ++c) what.quad[0].value[c] = b.array(b.state.color[c]);
         for (int c = 0; c < 2; ++c) {
           what.quad[1].value[2 * c] = b.array(b.state.uv[0][c]);
           what.quad[1].dx[2 * c] = b.array(b.state.uv_dx[0][c]);
           what.quad[1].dy[2 * c] = b.array(b.state.uv_dy[0][c]);
         }
         k.interpolate(b.batch, b.vertices, what, b.state);
       }},
      {"map_coordinates",
       [](K k, B b) {
         k.map_coordinates({{1, 2, 3, -0.5f, 0.25f, 7}}, b.batch, b.state, 1, b.coordinates);
       }},
      {"transform_positions", [](K k, B b) { k.transform_positions(b.batch, b.vertices, b.transforms, b.state); }},
      {"transform_normals", [](K k, B b) { k.transform_normals(b.batch, b.vertices, b.transforms, b.state); }},
      {"transform_tangents", [](K k, B b) { k.transform_tangents(b.batch, b.vertices, b.transforms, b.state); }},
      {"compute_normals", [](K k, B b) { k.compute_normals(b.batch, b.vertices, b.transforms, b.state); }},
      {"bend_normals",
       [](K k, B b) {
         const float* const texel[4] = {b.texel[0], b.texel[1], b.texel[2], b.texel[3]};
         k.bend_normals(b.batch, texel, 0.8f, b.state);
       }},
      {"compute_normal_variance",
       [](K k, B b) { k.compute_normal_variance(b.batch, b.vertices, b.transforms, b.state); }},
      {"widen_roughness", [](K k, B b) { k.widen_roughness(b.state); }},
      {"tilt_normals",
       [](K k, B b) {
         const float* const gradient[3] = {b.texel[0], b.texel[1], b.texel[2]};
         k.tilt_normals(b.batch, gradient, b.state);
       }},
      {"default_normals", [](K k, B b) { k.default_normals(b.light.viewpoint, b.batch, b.state); }},
      {"unlit", [](K k, B b) { k.unlit(true, b.state, b.shaded); }},
  };
  // Every way to be lit, with all kinds of light.
  for (int bits = 0; bits < 64; ++bits) {
    const auto bit = [bits](int k) { return (bits >> k & 1) != 0; };
    const auto light = [bit](B b) {
      ShadingUniforms& s = b.light;
      s.has_specular = bit(0), s.is_phong = s.has_occlusion = bit(1), s.has_emissive_texture = s.is_blended = bit(2);
      s.viewpoint.has_rays = bit(3), s.viewpoint.is_orthographic = bit(4), s.has_material_texture = bit(5);
      s.has_bare_meshes = bit(3) != bit(5), s.has_specular_texture = bit(2) != bit(4);
      s.has_turning_normals = bit(0) != bit(2);
      s.has_exponent_texture = bit(4), s.exponent = bit(5) ? Exponent{40, 40} : Exponent{17.5f, 0};
      b.state.light_visibility = bit(1) != bit(4) ? visibility().data() : nullptr;
    };
    all.push_back({"light_phong", [light](K k, B b) { light(b), k.light_phong(b.light, b.batch, b.state, b.shaded); }});
    all.push_back(
        {"light_metallic", [light](K k, B b) { light(b), k.light_metallic(b.light, b.batch, b.state, b.shaded); }});
    LayeredUniforms layers;
    layers.has_clearcoat = bit(0), layers.has_sheen = bit(1), layers.has_anisotropy = bit(2);
    layers.has_iridescence = bit(3), layers.has_transmission = bit(4), layers.has_diffuse_transmission = bit(5);
    layers.has_volume = bit(0) != bit(5), layers.half_spread = bit(1) ? 0.0f : 0.1f;
    layers.absorption[0] = 0.5f, layers.absorption[2] = 7;
    all.push_back({"light_layered", [light, layers](K k, B b) {
                     light(b), k.light_layered(b.light, layers, b.batch, b.state, b.layers, b.shaded);
                   }});
    // In a map: of one roughness, with mixed levels and without, and of roughness that differs.
    const auto in_map = [light, bit](B b) {
      static const RandomMap map;
      static LevelMix mixes[] = {{map.view, 0.1f}, {map.view, 0.8f}};
      light(b);
      b.light.map = &map.view, b.light.roughness = b.light.layered_roughness = bit(1) ? 0.1f : 0.8f;
      b.light.coat_roughness = bit(1) ? 0.8f : 0.1f;
      const auto level = [](LevelMix& mix) { return mix.for_lookups(10000), mix.for_lookups(1); };
      if (bit(3)) b.state.mixed = level(mixes[bit(1) ? 0 : 1]), b.state.coat_mixed = level(mixes[bit(1) ? 1 : 0]);
      for (int i = 0; i < b.state.count; ++i) {
        float &roughness = b.state.roughness[i], &coat = b.layers.clearcoat_roughness[i];
        roughness = std::clamp(std::abs(roughness), 0.0f, 1.0f), coat = std::clamp(std::abs(coat), 0.0f, 1.0f);
        if (bit(2)) roughness = b.light.roughness, coat = b.light.coat_roughness;
      }
      if (!bit(2)) b.light.layered_roughness = b.light.coat_roughness = -1, b.state.mixed = b.state.coat_mixed = {};
      b.light.metallic = bit(4) ? 0.0f : 0.5f;
    };
    all.push_back({"light_phong in a map",
                   [in_map](K k, B b) { in_map(b), k.light_phong(b.light, b.batch, b.state, b.shaded); }});
    all.push_back({"light_metallic_in_map",
                   [in_map](K k, B b) { in_map(b), k.light_metallic_in_map(b.light, b.batch, b.state, b.shaded); }});
    all.push_back({"light_layered_in_map", [in_map, layers, bit](K k, B b) {
                     LayeredUniforms some = layers;
                     if (bit(5)) some = {.has_clearcoat = bit(0), .has_grey_interface = true};
                     in_map(b), k.light_layered(b.light, some, b.batch, b.state, b.layers, b.shaded);
                   }});
  }
  return all;
}

/// Sets what stands behind the count within a vector, which means nothing, to 0.
void clear_rest(Bench& b) {
  const int first = b.batch.padded(),
            whole = (first + FragmentBatch::max_lanes - 1) / FragmentBatch::max_lanes * FragmentBatch::max_lanes;
  const auto clear = [&](float* arrays, std::size_t bytes) {
    for (std::size_t a = 0; a < bytes / sizeof(ShadingState::Array); ++a)
      std::fill(arrays + a * FragmentBatch::padded_capacity + first,
                arrays + a * FragmentBatch::padded_capacity + whole, 0.0f);
  };
  clear(b.state.position[0], sizeof(ShadingState) - offsetof(ShadingState, position));
  clear(b.shaded.r, sizeof(FragmentOutputs)), clear(b.coordinates.uv[0], sizeof(Coordinates));
}

TEST(SurfaceKernels, EveryInstructionSetGivesTheSameBits) {
  for (const Stage& stage : stages())
    for (int count = 0; count <= FragmentBatch::capacity; count += count < 16 ? 1 : 28) {
      const auto expected = std::make_unique<Bench>(count);
      stage.run(kernels(Isa::Scalar), *expected);
      clear_rest(*expected);
      for (const Isa isa : supported_isas()) {
        const auto actual = std::make_unique<Bench>(count);
        stage.run(kernels(isa), *actual);
        clear_rest(*actual);
        const auto same = [&](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
        ASSERT_TRUE(same(actual->state, expected->state) && same(actual->shaded, expected->shaded) &&
                    same(actual->coordinates, expected->coordinates))
            << stage.name << " " << name_of(isa) << " " << count;
      }
    }
}

TEST(SurfaceKernels, NothingIsWrittenPastTheCountsVector) {
  for (const Isa isa : supported_isas())
    for (const Stage& stage : stages()) {
      const auto untouched = std::make_unique<Bench>(24), actual = std::make_unique<Bench>(24);
      stage.run(kernels(isa), *actual);
      const auto* before = reinterpret_cast<const float*>(&untouched->state.position);
      const auto* after = reinterpret_cast<const float*>(&actual->state.position);
      const std::size_t arrays =
          (sizeof(ShadingState) - offsetof(ShadingState, position)) / sizeof(ShadingState::Array);
      const std::size_t end = isa == Isa::Avx512 ? 2 * FragmentBatch::max_lanes : 24;
      for (std::size_t a = 0; a < arrays; ++a)
        for (std::size_t i = end; i < FragmentBatch::padded_capacity; ++i)
          ASSERT_EQ(std::memcmp(before + a * FragmentBatch::padded_capacity + i,
                                after + a * FragmentBatch::padded_capacity + i, sizeof(float)),
                    0)
              << stage.name << " " << name_of(isa);
    }
}

TEST(SurfaceKernels, SparseNormalsBecomeTheSameNormals) {
  const auto normals = [](const SurfaceKernels& k, bool is_sparse) {
    auto b = std::make_unique<Bench>(FragmentBatch::capacity);
    // Every second triangle is flat; of another one, only two floats are equal.
    for (std::size_t leader = 0; leader < FragmentBatch::capacity; leader += 8 * FragmentBatch::group)
      for (int vertex = 1; vertex < 3; ++vertex) b->vertices.record[vertex][leader] = b->vertices.record[0][leader];
    float nearly[24];
    std::copy_n(b->vertices.record[0][4 * FragmentBatch::group], 24, nearly);
    nearly[2] += 1;
    b->vertices.record[1][4 * FragmentBatch::group] = nearly;
    b->vertices.record[2][4 * FragmentBatch::group] = b->vertices.record[0][4 * FragmentBatch::group];
    Interpolation what;
    what.quads = 1;
    what.quad[0].has_sparse_normals = is_sparse;
    for (int c = 0; c < 3; ++c) what.quad[0].value[c] = b->array(b->state.normal[c]);
    what.quad[0].value[3] = b->array(b->state.position[0]);
    k.interpolate(b->batch, b->vertices, what, b->state);
    k.compute_normals(b->batch, b->vertices, b->transforms, b->state);
    return b;
  };
  for (const Isa isa : supported_isas()) {
    const auto all = normals(kernels(isa), false), sparse = normals(kernels(isa), true);
    EXPECT_EQ(std::memcmp(all->state.normal, sparse->state.normal, sizeof all->state.normal), 0) << name_of(isa);
    EXPECT_EQ(std::memcmp(all->state.position, sparse->state.position, sizeof all->state.position), 0);
  }
}

TEST(SurfaceKernels, AShadowedLightCountsByItsVisibility) {
  // Light k is seen by all fragments, by none, or by a quarter: what each gives adds up to the whole.
  for (const Isa isa : supported_isas())
    for (const bool is_metallic : {true, false}) {
      const auto color_under = [&](std::vector<float> weights) {
        const auto b = std::make_unique<Bench>(16);
        b->light.has_environment = b->light.has_emissive = b->light.has_specular = false;
        std::fill_n(b->light.ambient, 3, 0.0f);
        std::vector<float> visibility;
        for (const float w : weights) visibility.insert(visibility.end(), FragmentBatch::padded_capacity, w);
        b->state.light_visibility = weights.empty() ? nullptr : visibility.data();
        (is_metallic ? kernels(isa).light_metallic : kernels(isa).light_phong)(b->light, b->batch, b->state, b->shaded);
        return std::vector<float>(b->shaded.g, b->shaded.g + 16);
      };
      const std::vector<float> all = color_under({}), same = color_under({1, 1, 1, 1}),
                               none = color_under({0, 0, 0, 0});
      EXPECT_EQ(all, same);
      EXPECT_EQ(none, std::vector<float>(16, 0.0f));
      const std::vector<float> first = color_under({1, 0, 0, 0}), quarter = color_under({0.25f, 0, 0, 0}),
                               rest = color_under({0, 1, 1, 1});
      float sum = 0;
      for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(quarter[i], first[i] / 4);
        EXPECT_NEAR(first[i] + rest[i], all[i], 1e-5f * (1 + all[i]));
        sum += first[i];
      }
      EXPECT_GT(sum, 0);
    }
}

TEST(SurfaceKernels, TheFinishedColourIsFinite) {
  Bench b(8);
  const float wild[8] = {std::nanf(""), INFINITY, -INFINITY, -1, -0.0f, 0.5f, 1e30f, 2};
  const float alpha[8] = {1, 1, 1, 1, 1, 0.5f, 0.25f, 0};
  const float expected[8] = {0, 1e9f, 0, 0, 0, 0.25f, 0.25e9f, 0};
  for (int c = 0; c < 3; ++c) std::copy_n(wild, 8, b.state.base[c]);
  std::copy_n(alpha, 8, b.state.base[3]);
  for (const Isa isa : supported_isas()) {
    kernels(isa).unlit(true, b.state, b.shaded);
    for (int i = 0; i < 8; ++i) {
      EXPECT_EQ(b.shaded.r[i], expected[i]);
      EXPECT_FALSE(std::signbit(b.shaded.r[i]));
      EXPECT_EQ(b.shaded.a[i], alpha[i]);
    }
  }
}

}  // namespace
}  // namespace zoneplate
