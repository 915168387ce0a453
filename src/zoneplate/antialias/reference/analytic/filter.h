// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/antialias/reference/analytic/polygon.h"

namespace zoneplate::antialias {

/// A reconstruction filter that is a polynomial between multiples of half a pixel, and its exact integrals over
/// polygons.
///
/// In two dimensions it is the product f(x) f(y) about the centre of the filtered pixel. A region of a pixel
/// contributes to all pixels within `radius` of its own: `add_weights` computes the weights of all of these at once,
/// rows from the top.
///
/// Units     pixels; ∫ f = 1.
/// Exact     within 1e-14: moments of the polygon by Green's theorem, edge by edge; each is the integral of a
///           polynomial of degree at most 7, which four-point Gauss-Legendre quadrature computes exactly.
/// Source    Duff, Polygon Scan Conversion by Exact Convolution, Raster Imaging and Digital Typography 1989.
class PolynomialFilter {
 public:
  /// "box", "tent", "quadratic" (the B-spline of degree 2), "b-spline" (of degree 3), "mitchell", "catmull-rom".
  explicit PolynomialFilter(std::string_view name);

  int radius() const { return radius_; }        ///< radius, in pixels, of the pixels to which a region contributes
  int span() const { return 2 * radius_ + 1; }  ///< the same as a width
  std::size_t weight_count() const { return static_cast<std::size_t>(span() * span()); }

  double value(double x) const;  ///< f(x); at a discontinuity, the value of one side

  /// Adds ∫∫ f(x - x_k) f(y - y_k) over a region of the pixel to `weights`, for each neighbouring pixel k.
  void add_weights(const ConvexPolygon& polygon, std::span<double> weights) const;

  /// Σ of a pixel's weights along an axis over the pixels in [0, size) of an image: 1 unless the image's end is within
  /// the radius.
  double share_inside(int pixel, int size) const;

 private:
  /// A polynomial of |x| that is valid up to `end`.
  struct Piece {
    double end;
    std::array<double, 4> coefficient;
  };
  /// f(x0 + t) as a polynomial of t that is valid for t in [0, ½].
  std::array<double, 4> expanded(double x0) const;

  std::vector<Piece> pieces_;
  int degree_ = 0, radius_ = 0;
  /// For each half of the pixel and each neighbouring pixel: its filter over this half.
  std::vector<std::array<double, 4>> half_;
};

}  // namespace zoneplate::antialias
