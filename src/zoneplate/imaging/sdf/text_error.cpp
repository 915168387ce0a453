// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/sdf/text_error.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/imaging/sdf/atlas_file.h"
#include "zoneplate/sdf/exact_coverage.h"

namespace zoneplate {

TextLine::TextLine(const Font& font, const std::string& words, double px) : text(code_points(words)), em(px) {
  const double margin = std::ceil(px / 8) + 2;
  const Font::Metrics m = font.metrics();
  raster.width = static_cast<int>(std::ceil(text_width(font, words, px) + 2 * margin));
  raster.height = static_cast<int>(std::ceil((m.ascender - m.descender) * px + 2 * margin));
  baseline = {margin, std::ceil(margin + m.ascender * px)};
  outline = text_outline(font, words, px).mapped({.move = baseline});
}

Plane<float> TextLine::exact() const { return sdf::exact_coverage(outline, raster); }
Plane<float> TextLine::from_outline() const { return sdf::coverage_of(sdf::region(outline), raster); }
Plane<float> TextLine::from_atlas(const sdf::Atlas& atlas) const {
  Plane<float> out(raster.width, raster.height);
  sdf::draw_text(atlas, text, baseline, em, out);
  return out;
}

CoverageError error_of(const Plane<float>& coverage, const Plane<float>& exact) {
  CoverageError error;
  double squares = 0;
  for (std::size_t i = 0; i < exact.values().size(); ++i) {
    const double e = static_cast<double>(exact.values()[i]);
    const double d = std::abs(static_cast<double>(coverage.values()[i]) - e);
    constexpr double edge = 1.0 / 1024;  // of coverage: a pixel without an edge, drawn well
    if (e < edge && d < edge) continue;
    if (e > 1 - edge && d < edge) continue;
    error.greatest = std::max(error.greatest, d);
    squares += d * d;
    ++error.pixels;
  }
  error.rms = error.pixels > 0 ? std::sqrt(squares / error.pixels) : 0;
  return error;
}

}  // namespace zoneplate
