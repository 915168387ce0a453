// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "zoneplate/sdf/field/field_image.h"

namespace zoneplate::sdf {

/// A character of a font, in em; y points downwards from the baseline.
struct GlyphOutline {
  char32_t code = 0;
  double advance = 0;
  Outline outline;
};

/// Distance fields of glyphs in one image, as text is drawn from in games.
struct Atlas {
  struct Glyph {
    char32_t code = 0;
    double advance = 0;  ///< em
    Bounds plane;        ///< of the quad around the baseline's start, in em, y downwards; empty for a space
    Bounds cell;         ///< the same quad in the image, in texels: its sides are at centres of texels
  };
  FieldImage field;
  double size = 32;  ///< texels per em
  double range = 4;  ///< texels between the lowest and the highest value that 8 bits hold
  std::vector<Glyph> glyphs;
  std::map<std::pair<char32_t, char32_t>, double> kerning;  ///< em

  const Glyph* find(char32_t code) const;
};

struct AtlasOptions {
  FieldKind kind = FieldKind::Multi;
  double size = 32, range = 4;
  std::uint64_t max_texels = std::uint64_t{1} << 28;  ///< of the image (--max-pixels)
};

/// Lays the glyphs out in rows, tallest first, in an image about as wide as high.
///
/// Errors    ErrorKind::Usage if it has more texels than the limit.
Atlas make_atlas(std::span<const GlyphOutline> glyphs, const AtlasOptions& options);

/// The atlas with distances rounded to 8 bits, as its PNG image holds them: ½ + distance / range.
Plane<float4> encoded(const Atlas& atlas);
/// The distances of such values.
Plane<float4> decoded(Plane<float4> values, double range);

/// Draws a line of text: coverage in an image, with the baseline's start at `origin` and `em` pixels per em. Characters
/// that the atlas lacks are left out.
void draw_text(const Atlas& atlas, std::span<const char32_t> text, Point origin, double em, Plane<float>& image);

}  // namespace zoneplate::sdf
