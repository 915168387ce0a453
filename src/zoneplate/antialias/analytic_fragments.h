#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/antialias/analytic_cells.h"
#include "zoneplate/antialias/analytic_filter.h"

namespace zoneplate::antialias {

/// A layer of a fragment.
struct Layer {
  std::int32_t id;  ///< triangle
  Surface surface;
  bool operator==(const Layer&) const = default;
};

/// A part of a pixel with one order of layers, shaded at one place: the centroid of its area.
struct Fragment {
  int x = 0, y = 0;                           ///< the pixel
  std::uint32_t part = 0;                     ///< of the pixel's grid, if it is cut by one
  std::uint32_t first_layer = 0, layers = 0;  ///< near to far
  AreaMoments moments;
};

/// Makes fragments of the cells of pixels and keeps them, in the order of the pixels, with their filter weights.
///
/// A pixel's polygons are cut by a grid of `shading` × `shading` cells, or of the finer `mask` × `mask` where a layer
/// is masked, so that its alpha can be asked at every part. What of a part has the same layers is one fragment.
class FragmentList {
 public:
  FragmentList(const PolynomialFilter& filter, int shading, int mask);

  void clear();
  /// What is added from now on is of the pixel (x, y).
  void begin_pixel(int x, int y);
  void add(const PixelCells& cells);
  /// A pixel that one opaque triangle covers.
  void add_whole(std::int32_t id, int x, int y);

  std::span<const Fragment> fragments() const { return fragments_; }
  std::span<const Layer> layers_of(const Fragment& f) const {
    return std::span(layers_).subspan(f.first_layer, f.layers);
  }
  /// Of fragment number i: for each pixel around, rows from the top.
  std::span<const double> weights_of(std::size_t i) const {
    return std::span(weights_).subspan(i * filter_.weight_count(), filter_.weight_count());
  }

 private:
  void add_parts(const ConvexPolygon& polygon, int grid);
  void add_part(const ConvexPolygon& polygon, std::uint32_t part);
  std::size_t fragment_of(std::uint32_t part);

  const PolynomialFilter& filter_;
  const int shading_, mask_;
  std::vector<Fragment> fragments_;
  std::vector<double> weights_;
  std::vector<Layer> layers_;
  int x_ = 0, y_ = 0;               ///< the pixel at work
  std::vector<std::int32_t> head_;  ///< its fragments by a hash: the last one, or -1
  std::vector<std::int32_t> next_;  ///< by fragment: an earlier one of the same hash, or -1
  std::vector<Layer> now_;          ///< of the cell at work
  std::vector<AreaMoments> whole_;  ///< of the grid's parts of a whole pixel
  std::vector<double> whole_weights_;
};

}  // namespace zoneplate::antialias
