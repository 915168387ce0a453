// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/antialias/post/display_light.h"
#include "zoneplate/render/custom_draw.h"

namespace zoneplate::antialias {

struct ConvergedOptions {
  int samples = 1024;          ///< a power of two, at least 64
  std::string filter = "box";  ///< a name of signal/filter/kernel.h, or "quadratic"
  FilterOrder order = FilterOrder::Scene;
};

/// Draws many stratified samples per pixel, each shaded, weighted by a reconstruction filter about the pixel's centre.
///
/// The samples are taken in four groups, each of which is stratified. The standard error of a pixel is estimated from
/// the variance of the groups' means; because all samples together are stratified more finely, the actual error is
/// mostly smaller.
///
/// Edges     the image ends at its outermost pixels: weights are divided by their sum over the samples inside.
/// Exact     the same bits for any number of threads and any crop. Positions are multiples of 1/256 pixel, as vertices
///           are: coverage by a vertical or horizontal edge is accurate to 1/512 at best, for any number of samples.
/// Cost      one shaded fragment per sample; memory is independent of the number of samples.
void draw_converged(const CustomDraw& drawing, const ConvergedOptions& options);

}  // namespace zoneplate::antialias
