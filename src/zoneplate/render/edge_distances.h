// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/render/frame.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Computes the distances to the edges of the visible triangles instead of colours (Content::EdgeDistances).
///
/// The colour of a fragment is (x, y, 0, 1) with the two values of Frame::edge_distance. On an alpha-tested surface the
/// line where alpha reaches the cutoff, extrapolated by alpha's derivative at the pixel, counts as an edge too.
///
/// Exact     edges join the vertices snapped to 1/256 pixel, as for coverage; edges of clipped triangles join the
///           unsnapped vertices. An edge of length zero is ignored.
/// Source    Persson, Geometry Buffer Anti-Aliasing, demo of July 2011 (humus.name): FillBuffers.shd, whose geometry
///           shader computes the distances, RG16F.
class EdgeDistances : public FragmentShader {
 public:
  /// `surfaces` is the scene's own shader. All arguments must outlive this object.
  EdgeDistances(const Scene& scene, std::span<const Draw> draws, Viewport viewport, const FragmentShader& surfaces);

  void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const override;
  float alpha(const FragmentBatch& batch, float* out) const override { return surfaces_.alpha(batch, out); }
  bool needs_derivatives(int material) const override {
    return is_masked(material) || surfaces_.needs_derivatives(material);
  }

 private:
  /// a x + b y + c = 0, in 1/256 pixel from the image's centre.
  struct Line {
    double a = 0, b = 0, c = 0;
  };
  struct Edges {
    Line line[3];
  };
  /// The distance of the nearest line, along the row or the column.
  struct Distance {
    float value;
    bool is_along_row;
  };

  bool is_masked(int material) const {
    return scene_.materials[static_cast<std::size_t>(material)].alpha_mode == AlphaMode::Mask;
  }
  Edges edges_of(std::uint32_t triangle) const;
  static Distance nearest(const Edges& edges, double x, double y);
  void take_alpha_edges(const FragmentBatch& batch, FragmentOutputs& out) const;

  const Scene& scene_;
  std::span<const Draw> draws_;
  Viewport viewport_;
  const FragmentShader& surfaces_;
  std::vector<std::uint32_t> first_triangle_;  ///< by draw
};

/// Frame::edge_distance from the colours of EdgeDistances.
Plane<float2> edge_distances_of(const LinearImage& picture);

}  // namespace zoneplate
