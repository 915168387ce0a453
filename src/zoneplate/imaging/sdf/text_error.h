// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/formats/font/font.h"
#include "zoneplate/image/plane.h"
#include "zoneplate/sdf/draw.h"
#include "zoneplate/sdf/field/atlas.h"

namespace zoneplate {

/// A line of text at one size, and its coverage by several methods.
struct TextLine {
  TextLine(const Font& font, const std::string& words, double px);

  std::vector<char32_t> text;
  double em;  ///< pixels
  sdf::Raster raster;
  sdf::Point baseline;
  sdf::Outline outline;  ///< pixels

  Plane<float> exact() const;
  Plane<float> from_outline() const;  ///< from the distances of the outlines
  Plane<float> from_atlas(const sdf::Atlas& atlas) const;
};

/// Differences of coverage over the pixels that have an edge, or should have none and differ.
struct CoverageError {
  double rms = 0, greatest = 0;
  int pixels = 0;
};
CoverageError error_of(const Plane<float>& coverage, const Plane<float>& exact);

}  // namespace zoneplate
