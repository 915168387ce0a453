// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/scene/camera.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Computes normals and distances of a scene's surfaces instead of colours (Content::Geometry).
///
/// The colour of a fragment is its geometry, as described at Frame::sample_geometry. Alpha is that of `surfaces`, the
/// scene's own shader. The scene and the shader must outlive this object.
class GeometryFragmentShader : public FragmentShader {
 public:
  GeometryFragmentShader(const Scene& scene, const Camera& camera, const FragmentShader& surfaces);

  void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const override;
  float alpha(const FragmentBatch& batch, float* out) const override { return surfaces_.alpha(batch, out); }
  bool needs_derivatives(int material) const override { return surfaces_.needs_derivatives(material); }

 private:
  /// The transform from an instance's vertices to normals and distances.
  struct InstanceGeometry {
    float4x4 world_from_normal;
    float4 distance;  ///< the distance along the view axis is its dot product with (position, 1)
  };
  /// The normals and distances of a triangle's vertices.
  struct TriangleGeometry {
    float3 normal[3];
    float distance[3];
  };
  TriangleGeometry geometry_of(const FragmentBatch& batch, std::size_t leader) const;

  const Scene& scene_;
  const FragmentShader& surfaces_;
  float3 to_viewer_;  ///< against the view axis
  std::vector<InstanceGeometry> instances_;
};

}  // namespace zoneplate
