#pragma once

#include <string_view>

#include "zoneplate/antialias/shown_light.h"
#include "zoneplate/render/drawing.h"

namespace zoneplate::antialias {

/// How the exact picture is filtered and shaded.
struct AnalyticOptions {
  std::string_view filter = "box";  ///< of PolynomialFilter
  int shading = 1;                  ///< each pixel's surfaces are shaded in shading × shading parts
  int mask = 8;                     ///< alpha is tested in mask × mask parts of a pixel
  FilterOrder order = FilterOrder::Scene;
};

/// Draws the exact integral of the filter over what is visible, fragment by fragment, each with one colour.
///
/// Edges     a picture ends where its pixels do: near its sides the filter's weights are those inside, scaled to sum 1.
/// Exact     coverage within 1e-12 of the snapped vertices' own; the same bits for any number of threads, any crop, and
///           any order of the triangles (but where depths are equal, where the first drawn is seen).
void draw_analytic(const Drawing& drawing, const AnalyticOptions& options);

}  // namespace zoneplate::antialias
