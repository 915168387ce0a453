// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "zoneplate/antialias/post/display_light.h"
#include "zoneplate/render/custom_draw.h"

namespace zoneplate::antialias {

/// The filter and the shading of the exact image.
struct AnalyticOptions {
  std::string_view filter = "box";  ///< a name of PolynomialFilter
  int shading = 1;                  ///< each pixel's surfaces are shaded in shading × shading parts
  int mask = 8;  ///< alpha-tested surfaces are shaded, and their contours computed, in mask × mask parts
  FilterOrder order = FilterOrder::Scene;
};

/// Draws the exact integral of the filter over the visible surfaces, fragment by fragment, each with one colour.
///
/// A pixel is sampled instead (CrowdSampler) if more than 8 alpha-tested triangles may be visible in it, or if its
/// polygons exceed the limits of PixelRegions, PixelCells or MaskedPolygons. `drawing.error` is the estimated standard
/// error of the sampled contributions to a pixel's colour, in units of the colour; without samples it is 0.
///
/// Edges     the image ends at its outermost pixels: near its sides the filter's weights inside are scaled to sum 1.
/// Exact     coverage is within 1e-12 of that of the snapped vertices if no surface is alpha-tested and no pixel
///           sampled; contours of alpha as in AlphaEdges; the same bits for any number of threads, any crop, and any
///           order of the triangles (of triangles with equal depths the first drawn is visible).
/// Errors    those of the deadline (base/deadline.h), checked for each row of pixels and each region; OutOfMemory.
/// Memory    the screen vertices, the ids of the triangles in tiles (TileTriangles), and for each thread the triangles
///           of one tile, or of a row of its pixels if they are more than 32,768.
void draw_analytic(const CustomDraw& drawing, const AnalyticOptions& options);

}  // namespace zoneplate::antialias
