#pragma once

#include <vector>

#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/scene/camera.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Evaluates the geometry of a scene's surfaces in place of their light (Content::Geometry).
///
/// The colour of a point is its geometry: see Frame::sample_geometry. Alpha is that of `surfaces`, the scene's own
/// shader, which outlives this as the scene does.
class GeometryPoints : public FragmentShader {
 public:
  GeometryPoints(const Scene& scene, const Camera& camera, const FragmentShader& surfaces);

  void shade(const FragmentBatch& batch, OutputMask wanted, FragmentOutputs& out) const override;
  float alpha(const FragmentBatch& batch, float* out) const override { return surfaces_.alpha(batch, out); }
  bool needs_derivatives(int material) const override { return surfaces_.needs_derivatives(material); }

 private:
  /// How an instance's vertices become geometry.
  struct Placed {
    float4x4 world_from_normal;
    float4 distance;  ///< the distance along the view axis is its dot product with (position, 1)
  };
  /// A triangle's corners.
  struct Corners {
    float3 normal[3];
    float distance[3];
  };
  Corners corners_of(const FragmentBatch& batch, std::size_t leader) const;

  const Scene& scene_;
  const FragmentShader& surfaces_;
  float3 to_viewer_;  ///< against the view axis
  std::vector<Placed> placed_;
};

}  // namespace zoneplate
