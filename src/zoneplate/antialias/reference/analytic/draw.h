#pragma once

#include <string_view>

#include "zoneplate/antialias/post/display_light.h"
#include "zoneplate/render/custom_draw.h"

namespace zoneplate::antialias {

/// How the exact picture is filtered and shaded.
struct AnalyticOptions {
  std::string_view filter = "box";  ///< of PolynomialFilter
  int shading = 1;                  ///< each pixel's surfaces are shaded in shading × shading parts
  int mask = 8;                     ///< masked surfaces are shaded, and their edges followed, in mask × mask parts
  FilterOrder order = FilterOrder::Scene;
};

/// Draws the exact integral of the filter over what is visible, fragment by fragment, each with one colour.
///
/// A pixel is sampled in place of that (CrowdSampler) where more than 8 masked triangles may be seen in it, or where
/// its polygons pass the limits of PixelRegions, PixelCells or MaskedPolygons. `drawing.error` then holds the estimated
/// standard error of what the pixel and those around it take from samples, in units of the light; elsewhere it is 0.
///
/// Edges     a picture ends where its pixels do: near its sides the filter's weights are those inside, scaled to sum 1.
/// Exact     coverage within 1e-12 of the snapped vertices' own where nothing is masked or sampled; the edges of masks
///           as AlphaEdges says; the same bits for any number of threads, any crop, and
///           any order of the triangles (but where depths are equal, where the first drawn is seen).
/// Errors    the deadline's (base/deadline.h), checked once a row of pixels and a region; OutOfMemory.
/// Memory    the screen vertices, the numbers of the triangles in tiles (TileTriangles), and for each thread the
///           triangles of one tile, or of a row of its pixels where they are more than 32,768.
void draw_analytic(const CustomDraw& drawing, const AnalyticOptions& options);

}  // namespace zoneplate::antialias
