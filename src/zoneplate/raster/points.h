#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/raster/draw.h"
#include "zoneplate/raster/rasterize.h"

namespace zoneplate {

/// A surface point to be shaded: where on the screen, of which triangle.
struct Point {
  std::int32_t x, y;      ///< 1/256 pixel from the picture's top-left corner
  std::int32_t id;        ///< triangle
  std::uint32_t pixel;    ///< within the tile
  std::uint64_t samples;  ///< the samples of the pixel that take its colour
};

/// What the data planes show of a point.
struct PointData {
  std::vector<float3> normal, albedo;
  std::vector<float2> uv;
};

/// Shades lists of points in batches of one material.
class PointBatcher {
 public:
  PointBatcher(const ProjectedDraws& projected, const PointShader& shader, Isa isa, const Target& target);

  /// The colours of the points, in their order; fills `data` with what the target has planes for, if it is not null.
  void shade(std::span<const Point> points, std::vector<Linear>& colors, PointData* data);

  /// Keeps the points whose alpha reaches the cutoff: is_there[i] is 1 or 0.
  void test_alpha(std::span<const Point> points, std::vector<std::uint8_t>& is_there);

  std::uint64_t shaded() const { return shaded_; }

 private:
  void order_by_material(std::span<const Point> points);
  template <class Use>
  void for_batches(std::span<const Point> points, Use use);
  void fill(std::span<const Point> points, std::span<const std::uint32_t> numbers);

  const ProjectedDraws& projected_;
  const PointShader& shader_;
  const InterpolateKernels& interpolate_;
  const Target& target_;
  std::uint64_t shaded_ = 0;

  std::vector<std::uint32_t> order_, material_;
  Batch batch_;
  BatchPlanes planes_;
  Shaded shaded_batch_;
};

}  // namespace zoneplate
