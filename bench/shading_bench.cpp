// SPDX-License-Identifier: Apache-2.0
// Speed of the shading kernels, with all that they read in the first cache: nanoseconds a group of eight fragments.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"
#include "zoneplate/raster/fragment/interpolate.h"
#include "zoneplate/shade/surface/shading.h"
#include "zoneplate/shade/surface/vertices.h"
#include "zoneplate/shade/texture/area_filters.h"
#include "zoneplate/shade/texture/filtering.h"
#include "zoneplate/shade/texture/texture.h"

namespace zoneplate {
namespace {

constexpr int fragments = FragmentBatch::capacity;

template <class Work>
void time_groups(benchmark::State& state, Work work) {
  for (auto _ : state) {
    work();
    benchmark::ClobberMemory();
  }
  state.counters["groups"] =
      benchmark::Counter(static_cast<double>(FragmentBatch::groups),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// A block of 16 × 8 fragments that looks at a texture with 1.3 texels a pixel, so that two levels are mixed.
struct Looks {
  static constexpr int size = 256;
  alignas(64) float u[fragments], v[fragments], dudx[fragments], dvdx[fragments], dudy[fragments], dvdy[fragments];
  alignas(64) float values[4][fragments];
  float* const out[4] = {values[0], values[1], values[2], values[3]};
  Texture texture;
  Taps taps;
  const FilteringKernels& kernels = FilteringKernels::of();

  /// `stretch`: how much longer than wide a footprint is.
  explicit Looks(TexelMeaning meaning, float stretch = 1) : texture(noise(), meaning) {
    constexpr float step = 1.3f / size;
    for (int i = 0; i < fragments; ++i) {
      u[i] = 0.1f + static_cast<float>(i % 8) * step, v[i] = 0.2f + static_cast<float>(i / 8) * step;
      dudx[i] = step * stretch, dvdx[i] = 0.1f * step, dudy[i] = -0.1f * step, dvdy[i] = step;
    }
  }
  Footprint footprint() const { return {u, v, dudx, dvdx, dudy, dvdy}; }

 private:
  static Rgba8Image noise() {
    Rgba8Image image(size, size);
    for (std::size_t i = 0; i < image.values().size(); ++i) {
      const std::uint32_t word = hash(static_cast<std::uint32_t>(i));
      image.values()[i] = {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
                           static_cast<std::uint8_t>(word >> 16), 255};
    }
    return image;
  }
};

void compute_taps(benchmark::State& state) {
  Looks l(TexelMeaning::Values);
  time_groups(state, [&] { l.kernels.compute_taps(l.texture.view(), {}, l.footprint(), l.taps, fragments); });
}

void mix_taps(benchmark::State& state, TexelMeaning meaning) {
  Looks l(meaning);
  l.kernels.compute_taps(l.texture.view(), {}, l.footprint(), l.taps, fragments);
  time_groups(state, [&] { l.kernels.mix_taps(l.texture.view(), l.taps, l.out, fragments); });
}

void sample_anisotropic(benchmark::State& state) {
  Looks l(TexelMeaning::Values, static_cast<float>(state.range(0)));
  SamplerState filtering;
  filtering.anisotropy = static_cast<std::int32_t>(state.range(0));
  time_groups(state,
              [&] { l.kernels.sample_anisotropic(l.texture.view(), filtering, l.footprint(), l.out, fragments); });
}

/// A filter with its own kernel, on footprints of 1.3 by 5.2 texels; `isa`: that of the kernel.
void sample_area(benchmark::State& state, TextureFilter::Kind kind, Isa isa) {
  Looks l(TexelMeaning::Color, 4);
  alignas(64) static float random[3][fragments];
  for (std::uint32_t n = 0; n < 3; ++n)
    for (std::uint32_t i = 0; i < fragments; ++i) random[n][i] = unit_float(hash(i, n));
  Footprint footprint = l.footprint();
  for (int n = 0; n < 3; ++n) footprint.random[n] = random[n];
  const SamplerState filtering = make_filtering({}, 1, {kind, 16});
  with_isa(isa, [&] { time_groups(state, [&] { sample_area(l.texture, filtering, footprint, l.out, fragments); }); });
}

/// The same for filters of FilteringKernels.
void sample_taps(benchmark::State& state, TextureFilter::Kind kind, Isa isa) {
  Looks l(TexelMeaning::Color, 4);
  const SamplerState filtering = make_filtering({}, 1, {kind, 16});
  const FilteringKernels& kernels = FilteringKernels::of(isa);
  time_groups(state, [&] {
    if (filtering.anisotropy > 1)
      return kernels.sample_anisotropic(l.texture.view(), filtering, l.footprint(), l.out, fragments);
    kernels.compute_taps(l.texture.view(), filtering, l.footprint(), l.taps, fragments);
    kernels.mix_taps(l.texture.view(), l.taps, l.out, fragments);
  });
}

/// A batch of one triangle's rows, or of fragments that each have a triangle of their own.
struct Surface {
  ScreenVertex screen[3] = {{0, 0, 0.5f, 0.3f}, {200000, 1000, 0.4f, 0.31f}, {1000, 150000, 0.3f, 0.32f}};
  float record[3][8] = {};
  InstanceTransform placement{};
  FragmentBatch batch;
  BatchTriangles screen_corners{};
  TriangleVertices corners;
  ShadingState at;
  FragmentOutputs shaded;
  const SurfaceKernels& kernels = SurfaceKernels::of();
  const InterpolateKernels& weights = InterpolateKernels::of();

  explicit Surface(bool has_rows) {
    batch.count = at.count = fragments;
    placement.keeps_normals = 1;
    for (std::uint32_t k = 0; k < 3; ++k)
      for (std::uint32_t c = 0; c < 8; ++c) record[k][c] = unit_float(hash(k, c)) + 0.1f;
    for (int i = 0; i < fragments; ++i) {
      batch.x[i] = 160000 + i % 8 * 256, batch.y[i] = 160000 + i / 8 * 256;
      batch.is_front[i] = 1, batch.instance[i] = 0;
      for (int k = 0; k < 3; ++k) screen_corners.vertex[k][i] = &screen[k], corners.record[k][i] = record[k];
    }
    std::fill(std::begin(batch.is_flat_run), std::end(batch.is_flat_run), has_rows);
    batch.run_end[0] = fragments / FragmentBatch::group;
    std::fill(std::begin(corners.one_instance), std::end(corners.one_instance), true);
    compute_weights();
  }
  void compute_weights() { weights.interpolate(screen_corners, {1000, 1000}, 1.0f, batch); }
};

void compute_weights(benchmark::State& state, bool has_rows) {
  Surface s(has_rows);
  time_groups(state, [&] { s.compute_weights(); });
}

void interpolate(benchmark::State& state, bool has_rows) {
  Surface s(has_rows);
  Attributes attributes;
  attributes.uv[0] = attributes.normal = true;
  const Interpolation interpolated = interpolation({}, attributes);
  time_groups(state, [&] { s.kernels.interpolate(s.batch, s.corners, interpolated, s.at); });
}

void light_phong(benchmark::State& state) {
  Surface s(true);
  PreparedLight light;
  light.radiance[0] = light.radiance[1] = light.radiance[2] = 1, light.towards[2] = 1;
  ShadingUniforms interpolated;
  interpolated.light = &light, interpolated.lights = 1, interpolated.has_specular = true,
  interpolated.exponent = {40, 40};
  interpolated.viewpoint.has_rays = true, interpolated.viewpoint.ray[2] = 1;
  interpolated.viewpoint.ray_dx[0] = interpolated.viewpoint.ray_dy[1] = 1e-5f;
  for (auto& base : s.at.base) std::fill(std::begin(base), std::end(base), 0.5f);
  for (auto& normal : s.at.normal) std::fill(std::begin(normal), std::end(normal), 0.577f);
  time_groups(state, [&] { s.kernels.light_phong(interpolated, s.batch, s.at, s.shaded); });
}

BENCHMARK(compute_taps);
BENCHMARK_CAPTURE(mix_taps, codes_of_8_bits, TexelMeaning::Values);
BENCHMARK_CAPTURE(mix_taps, codes_of_15_bits, TexelMeaning::Color);
BENCHMARK(sample_anisotropic)->ArgName("probes")->Arg(2)->Arg(8);
BENCHMARK_CAPTURE(compute_weights, rows, true);
BENCHMARK_CAPTURE(compute_weights, fragments, false);
BENCHMARK_CAPTURE(interpolate, rows, true);
BENCHMARK_CAPTURE(interpolate, fragments, false);
BENCHMARK(light_phong);

/// Every texture filter, by vectors and by its scalar twin.
void register_filters() {
  using Kind = TextureFilter::Kind;
  for (const TextureFilterEntry& filter : texture_filters())
    for (const Isa isa : {best_isa(), Isa::Scalar}) {
      const bool has_taps = make_filtering({}, 1, {filter.kind, 16}).kind == Kind::BySampler;
      const std::string name = "texture_filter/" + std::string(filter.name) + "/" + std::string(name_of(isa));
      benchmark::RegisterBenchmark(name.c_str(), has_taps ? sample_taps : sample_area, filter.kind, isa);
    }
}
const bool are_filters_registered = (register_filters(), true);

}  // namespace
}  // namespace zoneplate

BENCHMARK_MAIN();
