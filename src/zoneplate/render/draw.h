#pragma once

#include <array>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/shade/surface/shader.h"

namespace zoneplate {

/// How `draw` rasterizes.
struct DrawOptions {
  SamplePattern samples = standard_pattern(4);
  bool is_per_sample = false;  ///< shade every sample, not once per triangle and pixel
  bool culls_back_faces = false;
  AlphaMode alpha_mode = AlphaMode::Opaque;
  RasterRules rules;
};

/// Adapts a user shader to FragmentShader: evaluates the varyings of the triangle's vertices and interpolates them.
template <Shader S>
class UserFragmentShader : public FragmentShader {
 public:
  using Varyings = typename S::Varyings;
  static constexpr std::size_t floats = sizeof(Varyings) / sizeof(float);
  static_assert(std::is_trivially_copyable_v<Varyings> && sizeof(Varyings) % sizeof(float) == 0 &&
                    alignof(Varyings) == alignof(float),
                "varyings are a struct of floats");

  explicit UserFragmentShader(const S& shader) : shader_(shader) {}

  void shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const override {
    for_fragments(batch, [&](int i, float4 c) { out.r[i] = c.x, out.g[i] = c.y, out.b[i] = c.z, out.a[i] = c.w; });
  }
  float alpha(const FragmentBatch& batch, float* out) const override {
    for_fragments(batch, [&](int i, float4 c) { out[i] = c.w; });
    return 0.5f;
  }

 private:
  using Floats = std::array<float, floats>;

  Floats varyings_of(std::uint32_t vertex) const {
    Floats out;
    const Varyings v = shader_.vertex(Vertex{vertex}).second;
    std::memcpy(out.data(), &v, sizeof v);
    return out;
  }

  /// first + ((v1 - v0) b[0] + (v2 - v0) b[1]).
  static Varyings weighted(const Floats& first, const Floats (&v)[3],
                           const float (&b)[2][FragmentBatch::padded_capacity], int i) {
    Floats sum;
    for (std::size_t f = 0; f < floats; ++f)
      sum[f] = first[f] + ((v[1][f] - v[0][f]) * b[0][i] + (v[2][f] - v[0][f]) * b[1][i]);
    Varyings out;
    std::memcpy(static_cast<void*>(&out), sum.data(), sizeof out);
    return out;
  }

  template <class Use>
  void for_fragments(const FragmentBatch& batch, Use use) const {
    Floats corner[3] = {}, none = {};
    std::uint32_t known = 0;
    for (int i = 0; i < batch.count; ++i) {
      const std::size_t leader = batch.leader(static_cast<std::size_t>(i));
      if (i == 0 || batch.triangle[leader] != known)
        for (int k = 0; k < 3; ++k) corner[k] = varyings_of(batch.vertex[k][leader]);
      known = batch.triangle[leader];
      const Varyings u = weighted(corner[0], corner, batch.b, i);
      use(i, shader_.fragment(u, weighted(none, corner, batch.dbdx, i), weighted(none, corner, batch.dbdy, i)));
    }
  }

  const S& shader_;
};

/// Draws indexed triangles with a user shader; returns the image, linear and premultiplied, without a background.
///
/// Requires  three indices a triangle, each < vertices; the shader is pure.
template <Shader S>
LinearImage draw(const S& shader, std::span<const std::uint32_t> indices, std::uint32_t vertices, int width, int height,
                 const DrawOptions& options = {}) {
  std::vector<float4> clip(vertices);
  parallel_ranges(vertices, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) clip[v] = shader.vertex(Vertex{static_cast<std::uint32_t>(v)}).first;
  });
  Draw d;
  d.clip = clip;
  d.index = indices;
  d.alpha_mode = options.alpha_mode;
  d.culls_back_faces = options.culls_back_faces;

  LinearImage image(width, height, Linear{0, 0, 0, 0});
  Target target;
  target.viewport = {width, height};
  target.width = width, target.height = height;
  target.samples = options.samples;
  target.is_per_sample = options.is_per_sample;
  target.color = &image;
  rasterize(std::span(&d, 1), UserFragmentShader<S>(shader), options.rules, target);
  return image;
}

}  // namespace zoneplate
