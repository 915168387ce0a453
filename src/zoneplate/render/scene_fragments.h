// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "zoneplate/raster/types/fragment_shader.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/shade/cast/ground.h"
#include "zoneplate/shade/surface/surface.h"

namespace zoneplate {

/// Adapts the scene's materials to FragmentShader. The material after them is that of the ground.
class SceneFragmentShader : public FragmentShader {
 public:
  /// The scene and the ground must outlive the shader, and so must what the view refers to.
  SceneFragmentShader(const PreparedScene& scene, const ViewUniforms& view, const Ground* ground)
      : scene_(scene.scene()), surfaces_(scene_, view, scene.textures(), scene.vertices()), ground_(ground) {}

  void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const override {
    if (is_ground(batch.material)) return ground_->shade(batch, out);
    surfaces_.shade(batch, outputs, out);
  }
  float alpha(const FragmentBatch& batch, float* out) const override {
    surfaces_.alpha(batch, out);
    return scene_.materials[static_cast<std::size_t>(batch.material)].alpha_cutoff;
  }
  float brightest() const override { return surfaces_.brightest(); }
  bool needs_derivatives(int material) const override {
    return is_ground(material) ? ground_->needs_derivatives() : surfaces_.needs_derivatives(material);
  }
  bool needs_coverage() const override { return surfaces_.needs_coverage(); }
  VertexMemory vertex_memory(std::uint32_t instance, int material) const override {
    if (is_ground(material)) return {};
    const std::span<const float> record = surfaces_.vertex_record(instance, material);
    return {reinterpret_cast<const std::byte*>(record.data()), record.size_bytes()};
  }

 private:
  bool is_ground(int material) const { return static_cast<std::size_t>(material) == scene_.materials.size(); }

  const Scene& scene_;
  SurfaceShader surfaces_;
  const Ground* ground_;
};

}  // namespace zoneplate
