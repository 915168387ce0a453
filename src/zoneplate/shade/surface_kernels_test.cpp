#include "zoneplate/shade/surface_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

const SurfaceKernels& kernels(Isa isa) {
  return pick(isa, scalar::surface_kernels, N_SSE4::surface_kernels, N_AVX2::surface_kernels);
}

/// Everything the stages touch, filled with numbers: mostly usual ones, some zeros, some large.
struct Bench {
  Batch batch;
  Corners corners;
  Points points;
  Coordinates coordinates;
  Shaded shaded;
  Placement placements[5];
  float texel[4][Points::capacity];

  explicit Bench(int count) {
    std::memset(static_cast<void*>(this), 0, sizeof *this);
    batch.count = count;
    points.count = batch.padded();
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
    fill(batch.b), fill(batch.dbdx), fill(batch.dbdy), fill(corners.block), fill(placements), fill(texel);
    Points& p = points;
    fill(p.position), fill(p.normal), fill(p.tangent), fill(p.color), fill(p.uv), fill(p.uv_dx), fill(p.uv_dy);
    fill(p.to_viewer), fill(p.is_lit), fill(p.base), fill(p.metallic), fill(p.roughness), fill(p.occlusion);
    fill(p.emissive), fill(p.to_light), fill(p.strength), fill(p.diffuse), fill(p.specular), fill(p.sum);
    for (std::uint32_t i = 0; i < Batch::capacity; ++i) {
      batch.is_front[i] = static_cast<std::int32_t>(hash(i) & 1);
      batch.instance[i] = i / 8 % 3 == 0 ? hash(i, 1) % 5 : hash(i / 8) % 5;
    }
    for (int g = 0; g < Corners::groups; ++g) {
      corners.one_triangle[g] = g % 2 == 0;
      corners.one_instance[g] = g % 3 != 0;
    }
  }
};

struct Stage {
  std::string name;
  std::function<void(const SurfaceKernels&, Bench&)> run;
};

std::vector<Stage> stages() {
  PreparedLight sun, bulb, spot, lamp;
  sun.radiance[0] = 1, sun.radiance[1] = 2, sun.radiance[2] = 0.5f;
  bulb = sun, bulb.is_directional = false, bulb.position[1] = 3, bulb.inverse_range4 = 0.002f;
  spot = bulb, spot.is_spot = true, spot.cone_scale = 3, spot.cone_offset = -1;
  lamp = bulb, lamp.is_quadratic = true, lamp.attenuation[1] = 0.3f, lamp.attenuation[2] = 0.1f;
  static const float color[3] = {0.5f, 0.25f, 1};
  using K = const SurfaceKernels&;
  using B = Bench&;
  std::vector<Stage> all = {
      {"scale", [](K k, B b) { k.scale(b.points.base[0], b.texel[0], 0.7f, 0.1f, b.points.count); }},
      {"multiply", [](K k, B b) { k.multiply(b.points.base[0], b.texel[0], b.points.count); }},
      {"fill", [](K k, B b) { k.fill(b.points.base[0], 0.7f, b.points.count); }},
      {"saturate", [](K k, B b) { k.saturate(b.points.base[0], b.points.count); }},
      {"interpolate",
       [](K k, B b) {
         Interpolation what;
         what.channels = 6;
         for (int c = 0; c < 4; ++c) what.value[c] = b.points.color[c];
         for (int c = 0; c < 2; ++c) {
           what.value[4 + c] = b.points.uv[0][c];
           what.dx[4 + c] = b.points.uv_dx[0][c], what.dy[4 + c] = b.points.uv_dy[0][c];
         }
         k.interpolate(b.batch, b.corners, what, b.points.count);
       }},
      {"map_coordinates",
       [](K k, B b) {
         k.map_coordinates({{1, 2, 3, -0.5f, 0.25f, 7}}, b.points, 1, b.coordinates);
       }},
      {"place_positions", [](K k, B b) { k.place_positions(b.batch, b.corners, b.placements, b.points); }},
      {"place_normals", [](K k, B b) { k.place_normals(b.batch, b.corners, b.placements, b.points); }},
      {"place_tangents", [](K k, B b) { k.place_tangents(b.batch, b.corners, b.placements, b.points); }},
      {"look_back",
       [](K k, B b) {
         k.look_back({{1, 2, 3}, {0, 0, 1}, false}, b.points);
       }},
      {"look_back orthographic",
       [](K k, B b) {
         k.look_back({{1, 2, 3}, {0, 0, 1}, true}, b.points);
       }},
      {"face_normals", [](K k, B b) { k.face_normals(b.batch, b.points); }},
      {"bend_normals",
       [](K k, B b) {
         const float* const texel[4] = {b.texel[0], b.texel[1], b.texel[2], b.texel[3]};
         k.bend_normals(b.batch, texel, 0.8f, b.points);
       }},
      {"default_normals", [](K k, B b) { k.default_normals(b.points); }},
      {"add_environment", [](K k, B b) { k.add_environment(color, b.points); }},
      {"combine_diffuse", [](K k, B b) { k.combine_diffuse(color, b.points); }},
      {"add_specular", [](K k, B b) { k.add_specular(color, b.points); }},
      {"add_emissive", [](K k, B b) { k.add_emissive(b.points); }},
      {"keep_unlit", [](K k, B b) { k.keep_unlit(b.points); }},
      {"finish",
       [](K k, B b) {
         const float* const channels[3] = {b.points.sum[0], b.points.sum[1], b.points.sum[2]};
         k.finish(channels, b.points.base[3], b.shaded, b.points.count);
       }},
  };
  for (const PreparedLight& light : {sun, bulb, spot, lamp}) {
    all.push_back({"reach_light", [light](K k, B b) { k.reach_light(light, b.points); }});
  }
  all.push_back({"add_lambert", [sun](K k, B b) { k.add_lambert(sun, b.points); }});
  all.push_back({"add_blinn_phong", [sun](K k, B b) { k.add_blinn_phong(sun, 17.5f, b.points); }});
  all.push_back({"add_phong", [sun](K k, B b) { k.add_phong(sun, 17.5f, b.points); }});
  all.push_back({"add_metallic", [sun](K k, B b) { k.add_metallic(sun, b.points); }});
  return all;
}

TEST(SurfaceKernels, EveryInstructionSetGivesTheSameBits) {
  for (const Stage& stage : stages())
    for (int count = 0; count <= Batch::capacity; count += count < 16 ? 1 : 28) {
      const auto expected = std::make_unique<Bench>(count);
      stage.run(kernels(Isa::Scalar), *expected);
      for (const Isa isa : supported_isas()) {
        const auto actual = std::make_unique<Bench>(count);
        stage.run(kernels(isa), *actual);
        ASSERT_EQ(std::memcmp(actual.get(), expected.get(), sizeof(Bench)), 0)
            << stage.name << " " << name_of(isa) << " " << count;
      }
    }
}

TEST(SurfaceKernels, NothingIsWrittenPastTheCount) {
  for (const Stage& stage : stages()) {
    const auto untouched = std::make_unique<Bench>(24), actual = std::make_unique<Bench>(24);
    stage.run(kernels(best_isa()), *actual);
    const auto* before = reinterpret_cast<const float*>(&untouched->points.position);
    const auto* after = reinterpret_cast<const float*>(&actual->points.position);
    const std::size_t arrays = (sizeof(Points) - offsetof(Points, position)) / sizeof(Points::Array);
    for (std::size_t a = 0; a < arrays; ++a)
      for (std::size_t i = 24; i < Points::capacity; ++i)
        ASSERT_EQ(std::memcmp(before + a * Points::capacity + i, after + a * Points::capacity + i, sizeof(float)), 0)
            << stage.name;
  }
}

TEST(SurfaceKernels, TheFinishedColourIsFinite) {
  Bench b(8);
  const float wild[8] = {std::nanf(""), INFINITY, -INFINITY, -1, -0.0f, 0.5f, 1e30f, 2};
  const float alpha[8] = {1, 1, 1, 1, 1, 0.5f, 0.25f, 0};
  const float* const channels[3] = {wild, wild, wild};
  const float expected[8] = {0, 1e9f, 0, 0, 0, 0.25f, 0.25e9f, 0};
  for (const Isa isa : supported_isas()) {
    kernels(isa).finish(channels, alpha, b.shaded, 8);
    for (int i = 0; i < 8; ++i) {
      EXPECT_EQ(b.shaded.r[i], expected[i]);
      EXPECT_FALSE(std::signbit(b.shaded.r[i]));
      EXPECT_EQ(b.shaded.a[i], alpha[i]);
    }
  }
}

}  // namespace
}  // namespace zoneplate
