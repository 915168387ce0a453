// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/canvas.h"

#include "zoneplate/raster/tile/draw_image.h"

namespace zoneplate {

struct Canvas::Mesh {
  std::vector<float4> clip;
  std::vector<std::uint32_t> indices;
  std::unique_ptr<FragmentShader> shader;
  MeshOptions options;
};

namespace {

/// Calls the shader of a batch's mesh; the material of a draw is the index of its mesh.
class ShaderByMesh : public FragmentShader {
 public:
  explicit ShaderByMesh(std::vector<const FragmentShader*> shaders) : shaders_(std::move(shaders)) {}
  void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const override {
    of(batch).shade(batch, outputs, out);
  }
  float alpha(const FragmentBatch& batch, float* out) const override { return of(batch).alpha(batch, out); }

 private:
  const FragmentShader& of(const FragmentBatch& batch) const {
    return *shaders_[static_cast<std::size_t>(batch.material)];
  }
  std::vector<const FragmentShader*> shaders_;
};

}  // namespace

Canvas::Canvas(int width, int height, SamplePattern samples, bool is_per_sample)
    : width_(width), height_(height), samples_(std::move(samples)), is_per_sample_(is_per_sample) {}
Canvas::~Canvas() = default;

void Canvas::add(std::vector<float4> clip, std::span<const std::uint32_t> indices,
                 std::unique_ptr<FragmentShader> shader, const MeshOptions& options) {
  meshes_.push_back({std::move(clip), {indices.begin(), indices.end()}, std::move(shader), options});
}

LinearImage Canvas::resolve() const {
  std::vector<Draw> draws;
  std::vector<const FragmentShader*> shaders;
  for (const Mesh& mesh : meshes_) {
    Draw drawn;
    drawn.clip = mesh.clip;
    drawn.index = mesh.indices;
    drawn.alpha_mode = mesh.options.alpha_mode;
    drawn.culls_back_faces = mesh.options.culls_back_faces;
    drawn.material = static_cast<int>(draws.size());
    drawn.instance = static_cast<std::uint32_t>(draws.size());
    draws.push_back(drawn);
    shaders.push_back(mesh.shader.get());
  }
  return draw_image(draws, ShaderByMesh(std::move(shaders)), width_, height_, samples_, is_per_sample_);
}

}  // namespace zoneplate
