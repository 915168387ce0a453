// SPDX-License-Identifier: Apache-2.0
// Images do not depend on how much of a tile's layers, or of the screen vertices, is held at once.
#include "zoneplate/raster/types/raster_rules.h"

#include <gtest/gtest.h>

#include <cstring>

#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/raster/tile/rasterize.h"

namespace zoneplate {
namespace {

/// Gives every point of a triangle another colour and alpha, so that a point that lies elsewhere is noticed.
class Noisy : public FragmentShader {
 public:
  void shade(const FragmentBatch& batch, OutputMask wanted, FragmentOutputs& out) const override {
    for (int i = 0; i < batch.count; ++i) {
      const auto at = [&](std::uint32_t channel) { return noise(batch, i, channel); };
      out.a[i] = at(3);
      out.r[i] = at(0) * out.a[i], out.g[i] = at(1) * out.a[i], out.b[i] = at(2) * out.a[i] + batch.b[0][i] * 0x1p-9f;
      for (int k = 0; k < 2; ++k) {
        if (wanted.uv) out.uv[k][i] = batch.b[k][i];
        if (wanted.normal) out.normal[k][i] = batch.dbdx[k][i], out.normal[2][i] = 0;
        if (wanted.albedo) out.albedo[k][i] = batch.dbdy[k][i], out.albedo[2][i] = 0;
      }
    }
  }
  float alpha(const FragmentBatch& batch, float* out) const override {
    for (int i = 0; i < batch.count; ++i) out[i] = noise(batch, i, 3);
    return 0.5f;
  }

 private:
  static float noise(const FragmentBatch& batch, int i, std::uint32_t channel) {
    const std::uint32_t triangle = batch.triangle[batch.leader(static_cast<std::size_t>(i))];
    return unit_float(
        hash(static_cast<std::uint32_t>(batch.x[i]), static_cast<std::uint32_t>(batch.y[i]), 4 * triangle + channel));
  }
};

/// Scattered triangles, some of them across the eye, and sheets over the whole image; a draw each, all of one mesh.
struct Layered {
  std::vector<float3> position;
  std::vector<std::uint32_t> index;
  std::vector<Draw> draws;
  Layered() {
    constexpr std::uint32_t scattered = 90, sheets = 12, draw_count = 6;
    const auto add = [&](float3 p) {
      index.push_back(static_cast<std::uint32_t>(position.size()));
      position.push_back(p);
    };
    for (std::uint32_t i = 0; i < draw_count * scattered; ++i)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto at = [&](std::uint32_t axis, float spread, float size) {
          return (unit_float(hash(i, axis)) - 0.5f) * spread +
                 (unit_float(hash(i, 3 + axis, k)) - 0.5f) * (i % 5 ? size : 9.0f);
        };
        add({at(0, 4, 0.7f), at(1, 4, 0.7f), at(2, 6, 0.7f) - 2});
      }
    for (std::uint32_t i = 0; i < draw_count * sheets; ++i) {
      const float z = -1.5f - 0.05f * static_cast<float>(i * 29 % 71), tilt = i % 4 ? 0.0f : 0.3f;
      add({-50, -40, z}), add({50, -40, z + tilt}), add({0.5f, 90, z - tilt});
    }
    const auto all = std::span<const std::uint32_t>(index);
    for (std::uint32_t d = 0; d < 2 * draw_count; ++d) {
      Draw draw;
      draw.position = position;
      draw.clip_from_object = perspective(1.0f, 1.0f, 0.1f, 50.0f);
      draw.index = d < draw_count ? all.subspan(d * 3 * scattered, 3 * scattered)
                                  : all.subspan((draw_count * scattered + (d - draw_count) * sheets) * 3, 3 * sheets);
      draw.alpha_mode = d == draw_count ? AlphaMode::Blend : static_cast<AlphaMode>(d % 3);
      draw.culls_back_faces = d % 4 == 1;
      draw.instance = d;
      draw.material = static_cast<int>(d % 3);
      draws.push_back(draw);
    }
  }
};

/// All that a target can hold.
struct RulePlanes {
  LinearImage color;
  Plane<float> depth, coverage;
  Plane<float3> normal, albedo;
  Plane<float2> uv;
  Plane<std::uint32_t> instance, material, primitive;
  std::vector<LinearImage> sample_color;
  std::vector<Plane<float>> sample_depth;
  std::vector<Plane<std::uint32_t>> sample_triangle;
};

enum class Route { Color, Data, SampleColors, Samples };

constexpr int size = 72;

Target target_of(RulePlanes& p, Route route, const SamplePattern& samples) {
  Target t;
  t.viewport = {size, size};
  t.width = t.height = size;
  t.samples = samples;
  const auto make = [](auto& plane, auto empty) {
    plane = {size, size, empty};
    return &plane;
  };
  t.color = make(p.color, Linear{0, 0, 0, 0});
  if (route == Route::Data) {
    t.reversed_depth = make(p.depth, 0.0f), t.coverage = make(p.coverage, 0.0f);
    t.normal = make(p.normal, float3{}), t.albedo = make(p.albedo, float3{}), t.uv = make(p.uv, float2{});
    t.instance = make(p.instance, Target::no_id), t.material = make(p.material, Target::no_id);
    t.primitive = make(p.primitive, Target::no_id);
  }
  if (route == Route::Samples || route == Route::SampleColors) {
    p.sample_color.assign(samples.size(), LinearImage(size, size, Linear{0, 0, 0, 0}));
    t.sample_color = &p.sample_color;
  }
  if (route == Route::Samples) {
    p.sample_depth.assign(samples.size(), Plane<float>(size, size, 0.0f));
    p.sample_triangle.assign(samples.size(), Plane<std::uint32_t>(size, size, Target::no_id));
    t.sample_depth = &p.sample_depth, t.sample_triangle = &p.sample_triangle;
  }
  return t;
}

template <class T>
void expect_bits(const Plane<T>& a, const Plane<T>& b, const char* name) {
  ASSERT_EQ(a.values().size(), b.values().size()) << name;
  if (a.empty()) return;
  EXPECT_EQ(std::memcmp(a.values().data(), b.values().data(), a.values().size() * sizeof(T)), 0) << name;
}

void expect_same(const RulePlanes& a, const RulePlanes& b) {
  expect_bits(a.color, b.color, "color");
  expect_bits(a.depth, b.depth, "depth"), expect_bits(a.coverage, b.coverage, "coverage");
  expect_bits(a.normal, b.normal, "normal"), expect_bits(a.albedo, b.albedo, "albedo"), expect_bits(a.uv, b.uv, "uv");
  expect_bits(a.instance, b.instance, "instance"), expect_bits(a.material, b.material, "material");
  expect_bits(a.primitive, b.primitive, "primitive");
  for (std::size_t s = 0; s < a.sample_color.size(); ++s) expect_bits(a.sample_color[s], b.sample_color[s], "samples");
  for (std::size_t s = 0; s < a.sample_depth.size(); ++s) {
    expect_bits(a.sample_depth[s], b.sample_depth[s], "sample depth");
    expect_bits(a.sample_triangle[s], b.sample_triangle[s], "sample triangle");
  }
}

struct Case {
  Route route;
  SamplePattern samples;
  bool is_per_sample = false;
  AlphaTest alpha = AlphaTest::Pixel;
};

std::vector<Case> cases() {
  return {{Route::Color, standard_pattern(1)},
          {Route::Color, standard_pattern(4)},
          {Route::Color, standard_pattern(8), false, AlphaTest::Coverage},
          {Route::Color, standard_pattern(4), false, AlphaTest::Samples},
          {Route::Color, standard_pattern(4), true},
          {Route::Color, named_pattern("halton", 18), true},
          {Route::Data, standard_pattern(4)},
          {Route::SampleColors, standard_pattern(4)},
          {Route::Samples, standard_pattern(2), false, AlphaTest::Sharp},
          {Route::Samples, standard_pattern(4), true}};
}

RulePlanes drawn(const Layered& scene, const Case& of, const RasterCapacity& capacity) {
  RulePlanes planes;
  Target target = target_of(planes, of.route, of.samples);
  target.is_per_sample = of.is_per_sample;
  target.alpha = of.alpha;
  rasterize(scene.draws, Noisy(), {.capacity = capacity}, target);
  return planes;
}

TEST(RasterCapacity, LayersAreTheSameInOnePartAndInMany) {
  const Layered scene;
  for (const Case& c : cases()) {
    const RulePlanes expected = drawn(scene, c, {});
    // One layer at a time: every pixel with layers is peeled; then rows, parts of strips, and strips fit.
    for (const std::size_t share :
         {std::size_t{1}, std::size_t{2}, std::size_t{7}, std::size_t{60}, std::size_t{900}}) {
      SCOPED_TRACE(testing::Message() << "share " << share);
      expect_same(drawn(scene, c, {.layer_samples = share}), expected);
    }
  }
}

TEST(RasterCapacity, ScreenVerticesAreTheSameKeptAndFoundAgain) {
  const Layered scene;
  for (const Case& c : cases()) {
    const RulePlanes expected = drawn(scene, c, {});
    for (const std::size_t kept : {std::size_t{0}, 5 * scene.position.size() + 1})
      expect_same(drawn(scene, c, {.screen_vertices = kept}), expected);
  }
}

// Instances of one mesh, more than memory would hold the screen vertices of: the draws without area cost time alone.
TEST(RasterCapacity, ScreenVerticesOfManyInstancesTakeTheRoomOfSome) {
  const std::vector<float3> position(30000);
  std::vector<std::uint32_t> index(300, 0);
  Draw draw;
  draw.position = position;
  draw.clip_from_object = perspective(1.0f, 1.0f, 0.1f, 50.0f);
  draw.index = index;
  const std::vector<Draw> draws(1000, draw);
  ProjectedDraws projected = number_draws(draws, {32, 32});
  std::size_t batches = 0, next = 0;
  project_batches(projected, [&](std::size_t first, std::size_t last) {
    EXPECT_EQ(first, next);
    next = last;
    ++batches;
    std::size_t vertices = 0;
    for (std::size_t d = 0; d < draws.size(); ++d) {
      EXPECT_TRUE(d < first || d >= last || projected.screen[d].size() == position.size());
      vertices += projected.screen[d].size();
    }
    EXPECT_LE(vertices, (std::size_t{1} << 22) + (std::size_t{1} << 20));
  });
  EXPECT_EQ(next, draws.size());
  EXPECT_GT(batches, 2u);
  // A mesh that is larger than that, drawn once, is kept whole.
  const std::vector<float3> large((std::size_t{1} << 22) + 5);
  draw.position = large;
  EXPECT_EQ(number_draws(std::span(&draw, 1), {32, 32}).kept, large.size());
}

}  // namespace
}  // namespace zoneplate
