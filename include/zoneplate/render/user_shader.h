// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/raster/types/fragment_shader.h"
#include "zoneplate/scene/alpha_mode.h"
#include "zoneplate/signal/samples.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// The argument of a user shader's vertex stage: the vertex's index in the arrays that the shader itself holds.
struct Vertex {
  std::uint32_t index = 0;  ///< in [0, vertices) of `draw`
};

/// A user shader: pure functions, compiled into the batched loops that call them.
///
/// `Varyings` is a struct of floats only. `vertex` returns the clip position (reversed depth, see math/transform.h)
/// and the varyings; it may be called more than once for a vertex. The arguments of `fragment` are the
/// perspective-correct varyings, their derivatives per pixel to the right and their derivatives per pixel down; it
/// returns a linear, premultiplied colour.
template <class S>
concept Shader = requires(const S& s, const Vertex& v, const typename S::Varyings& u) {
  { s.vertex(v) } -> std::same_as<std::pair<float4, typename S::Varyings>>;
  { s.fragment(u, u, u) } -> std::same_as<float4>;
};

/// Converts to float, and implicitly to no other type.
struct AnyFloat {
  /// Declared only, for `holds_only_floats`.
  template <std::same_as<float> T>
  operator T() const;
};

/// Whether a struct can be initialized by as many floats as have its size: no member of it, nested ones and arrays
/// included, is of another type.
template <class Struct>
constexpr bool holds_only_floats() {
  constexpr auto takes = []<std::size_t... i>(std::index_sequence<i...>) {
    return requires { Struct{(static_cast<void>(i), AnyFloat{})...}; };
  };
  if constexpr (!std::is_aggregate_v<Struct> || sizeof(Struct) % sizeof(float) != 0) return false;
  return takes(std::make_index_sequence<sizeof(Struct) / sizeof(float)>{});
}

/// How `draw` rasterizes.
struct DrawOptions {
  SamplePattern samples = standard_pattern(4);  ///< positions in every pixel, whose mean is its colour
  bool is_per_sample = false;                   ///< shade every sample, not once per triangle and pixel
  bool culls_back_faces = false;                ///< skips triangles whose vertices run clockwise in the image
  AlphaMode alpha_mode = AlphaMode::Opaque;     ///< Mask: a surface is present where alpha is at least 0.5
};

/// Draws indexed triangles, given by their clip positions, with a shader of batches; returns the linear, premultiplied
/// image without a background. The threads are those of the innermost `with_threads`.
///
/// Requires  three indices per triangle, each < clip.size().
LinearImage draw_triangles(std::span<const float4> clip, std::span<const std::uint32_t> indices,
                           const FragmentShader& shader, int width, int height, const DrawOptions& options = {});

/// Adapts a user shader to FragmentShader: evaluates the varyings of the triangle's vertices and interpolates them.
template <Shader S>
class UserFragmentShader : public FragmentShader {
 public:
  using Varyings = typename S::Varyings;                                   ///< what the shader interpolates
  static constexpr std::size_t floats = sizeof(Varyings) / sizeof(float);  ///< the number of floats in Varyings
  static_assert(std::is_trivially_copyable_v<Varyings>, "varyings are a struct of floats: it has a copy constructor");
  static_assert(alignof(Varyings) == alignof(float), "varyings are a struct of floats: a member has another alignment");
  static_assert(holds_only_floats<Varyings>(), "varyings are a struct of floats: a member is of another type");

  /// Keeps a reference to the shader, which outlives this object.
  explicit UserFragmentShader(const S& shader) : shader_(shader) {}

  /// Runs `fragment` for every fragment; only the colour is written.
  void shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const override {
    for_fragments(batch, [&](int i, float4 c) { out.r[i] = c.x, out.g[i] = c.y, out.b[i] = c.z, out.a[i] = c.w; });
  }
  /// Runs `fragment` for its alpha; the cutoff is 0.5.
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

/// The clip positions of a shader's vertices, computed on the threads of the innermost `with_threads`.
template <Shader S>
std::vector<float4> clip_positions(const S& shader, std::uint32_t vertices) {
  std::vector<float4> clip(vertices);
  parallel_ranges(vertices, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) clip[v] = shader.vertex(Vertex{static_cast<std::uint32_t>(v)}).first;
  });
  return clip;
}

/// Draws indexed triangles with a user shader; returns the linear, premultiplied image without a background.
///
/// Requires  three indices per triangle, each < vertices; the shader is pure.
template <Shader S>
LinearImage draw(const S& shader, std::span<const std::uint32_t> indices, std::uint32_t vertices, int width, int height,
                 const DrawOptions& options = {}) {
  return draw_triangles(clip_positions(shader, vertices), indices, UserFragmentShader<S>(shader), width, height,
                        options);
}

}  // namespace zoneplate
#pragma GCC visibility pop
