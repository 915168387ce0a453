// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/antialias/reference/analytic/cells.h"
#include "zoneplate/antialias/reference/analytic/filter.h"

namespace zoneplate::antialias {

/// A layer of a fragment.
struct Layer {
  std::int32_t id;  ///< triangle
  AlphaMode alpha_mode;
  bool operator==(const Layer&) const = default;
};

/// A region of a pixel with one order of layers, shaded at one position: the centroid of its area.
struct AreaFragment {
  int x = 0, y = 0;                           ///< the pixel
  std::uint32_t part = 0;                     ///< index of the part of the pixel's grid, if it is divided by one
  std::uint32_t first_layer = 0, layers = 0;  ///< near to far; a layer that is not blended is the last one
  AreaMoments moments;
  bool is_fine = false;  ///< the grid is the finer one for alpha-tested surfaces
};

/// Fragments in the order of their pixels, each with a fixed number of weights. All areas of a part of a pixel that
/// have the same layers form one fragment.
class AreaFragmentTable {
 public:
  explicit AreaFragmentTable(std::size_t weights) : weights_each_(weights) {}

  void clear();
  /// Starts the pixel (x, y), to which the following fragments belong.
  void begin_pixel(int x, int y);
  /// Drops the fragments of this pixel.
  void abandon_pixel();

  /// The index of the pixel's fragment of this part with these layers; a new, empty one if there is none.
  std::size_t find(std::uint32_t part, bool is_fine, std::span<const Layer> layers);
  /// Adds a fragment that is not found by later calls of `find`.
  void append(const AreaFragment& fragment, Layer layer, std::span<const double> weights);

  std::span<const AreaFragment> fragments() const { return fragments_; }
  std::size_t layer_count() const { return layers_.size(); }
  AreaFragment& fragment(std::size_t i) { return fragments_[i]; }
  std::span<const Layer> layers_of(const AreaFragment& f) const {
    return std::span(layers_).subspan(f.first_layer, f.layers);
  }
  std::span<const double> weights_of(std::size_t i) const {
    return std::span(weights_).subspan(i * weights_each_, weights_each_);
  }
  std::span<double> weights_of(std::size_t i) { return std::span(weights_).subspan(i * weights_each_, weights_each_); }

 private:
  const std::size_t weights_each_;
  std::vector<AreaFragment> fragments_;
  std::vector<double> weights_;
  std::vector<Layer> layers_;
  int x_ = 0, y_ = 0;                                     ///< the current pixel
  std::size_t first_of_pixel_ = 0, layers_of_pixel_ = 0;  ///< numbers of fragments and layers of the previous pixels
  /// The pixel's fragments by hash: the index of the last one, or -1.
  std::vector<std::int32_t> head_;
  /// For each fragment: the previous one with the same hash, or -1.
  std::vector<std::int32_t> next_;
};

/// Converts the polygons of pixels to fragments, with their filter weights.
///
/// A pixel's polygons are cut by a grid of `shading` × `shading` parts.
class AreaFragmentList {
 public:
  AreaFragmentList(const PolynomialFilter& filter, int shading);

  void clear() { table_.clear(); }
  void begin_pixel(int x, int y) { table_.begin_pixel(x, y); }
  void abandon_pixel() { table_.abandon_pixel(); }
  void add(const ConvexPolygon& polygon, std::span<const Layer> layers);
  /// Adds a polygon that is within one part of the grid of alpha-tested surfaces.
  void add_fine(const ConvexPolygon& polygon, std::uint32_t part, std::span<const Layer> layers);
  /// Adds a pixel that one opaque triangle covers.
  void add_whole(std::int32_t id, int x, int y);

  const AreaFragmentTable& table() const { return table_; }
  std::span<const AreaFragment> fragments() const { return table_.fragments(); }
  /// The weights of fragment i, one for each neighbouring pixel, rows from the top.
  std::span<const double> weights_of(std::size_t i) const { return table_.weights_of(i); }

 private:
  void add_part(const ConvexPolygon& polygon, std::uint32_t part, bool is_fine, std::span<const Layer> layers);

  const PolynomialFilter& filter_;
  const int shading_;
  AreaFragmentTable table_;
  std::vector<AreaMoments> whole_;  ///< moments of the grid's parts for a whole pixel
  std::vector<double> whole_weights_;
};

}  // namespace zoneplate::antialias
