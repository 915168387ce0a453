#pragma once

#include <string>

#include "zoneplate/antialias/post/display_light.h"
#include "zoneplate/render/custom_draw.h"

namespace zoneplate::antialias {

struct ConvergedOptions {
  int samples = 1024;          ///< a power of two, 64 at least
  std::string filter = "box";  ///< of signal/filter/kernel.h, or "quadratic"
  FilterOrder order = FilterOrder::Scene;
};

/// Draws many stratified samples a pixel, each shaded, weighted by a reconstruction filter about the pixel's centre.
///
/// The samples are taken in four groups, each stratified by itself. The standard error of a pixel is estimated from the
/// spread of the groups' means; because all of them together are stratified finer, the true error is smaller as a rule.
///
/// Edges     a picture ends where its pixels do: weights are divided by their sum over the samples inside.
/// Exact     the same bits for any number of threads and any crop. Places are multiples of 1/256 pixel, as vertices
/// are:
///           the share of an upright or level edge is known to 1/512 at best, whatever the number of samples.
/// Cost      one shaded point a sample; memory does not grow with the samples.
void draw_converged(const CustomDraw& drawing, const ConvergedOptions& options);

}  // namespace zoneplate::antialias
