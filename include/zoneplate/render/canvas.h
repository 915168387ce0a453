// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "zoneplate/render/user_shader.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// Options for one mesh of a Canvas.
struct MeshOptions {
  AlphaMode alpha_mode = AlphaMode::Opaque;  ///< Mask: the mesh is present where alpha is at least 0.5
  bool culls_back_faces = false;             ///< skips triangles whose vertices run clockwise in the image
};

/// An image into which several meshes are drawn, each with a shader of its own, with one depth buffer.
///
/// `draw` stores a mesh; `resolve` rasterizes all of them together. Opaque surfaces hide each other by depth, and
/// blended ones are composited in the order of their depth, regardless of the order of the calls.
class Canvas {
 public:
  /// An empty image of `width` × `height` pixels with these sample positions. `is_per_sample`: every sample is shaded,
  /// not once per triangle and pixel.
  Canvas(int width, int height, SamplePattern samples = standard_pattern(4), bool is_per_sample = false);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// Adds indexed triangles with a copy of a user shader.
  ///
  /// Requires  three indices per triangle, each < vertices; the shader is pure, and the objects that it references
  ///           outlive the last `resolve`.
  template <Shader S>
  void draw(const S& shader, std::span<const std::uint32_t> indices, std::uint32_t vertices,
            const MeshOptions& options = {}) {
    add(clip_positions(shader, vertices), indices, std::make_unique<OwnShader<S>>(shader), options);
  }

  /// The image of all meshes so far: linear and premultiplied, without a background.
  LinearImage resolve() const;

 private:
  /// A shader with the batches that call it.
  template <Shader S>
  class OwnShader : public FragmentShader {
   public:
    explicit OwnShader(const S& shader) : shader_(shader), fragments_(shader_) {}
    void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const override {
      fragments_.shade(batch, outputs, out);
    }
    float alpha(const FragmentBatch& batch, float* out) const override { return fragments_.alpha(batch, out); }

   private:
    S shader_;
    UserFragmentShader<S> fragments_;
  };
  struct Mesh;

  void add(std::vector<float4> clip, std::span<const std::uint32_t> indices, std::unique_ptr<FragmentShader> shader,
           const MeshOptions& options);

  int width_, height_;
  SamplePattern samples_;
  bool is_per_sample_;
  std::vector<Mesh> meshes_;
};

}  // namespace zoneplate
#pragma GCC visibility pop
