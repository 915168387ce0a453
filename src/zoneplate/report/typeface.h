// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/image/rgb.h"

struct FT_LibraryRec_;
struct FT_FaceRec_;

namespace zoneplate {

/// DejaVu Sans at one size, for lines of text in images.
///
/// Letters are positioned to 1/64 pixel along the line, with kerning, and to whole pixels across it.
/// Shape     text is UTF-8; invalid bytes and characters that the font lacks are drawn as the replacement character.
/// Units     pixels.
/// Exact     the same bits on every machine with the same versions of the font and of FreeType.
class Typeface {
 public:
  enum class Weight { Regular, Bold };

  /// Errors    ErrorKind::Failed naming the font's file and package if it cannot be read.
  Typeface(Weight weight, int px);

  int ascent() const;   ///< from the top of a line to its baseline
  int leading() const;  ///< from one baseline to the next
  double width(std::string_view line) const;

  /// Breaks the text into lines of at most this width, at spaces and line ends. A longer word is broken at a joint
  /// (after a hyphen, before an extension or a capital), or anywhere.
  std::vector<std::string> wrapped(std::string_view text, int width) const;

  /// Draws one line at the given left end and top, blending ink and background in linear light; clipped to the image.
  void draw(Rgba8Image& picture, int left, int top, std::string_view line, Rgba8 ink) const;

 private:
  struct Close {
    void operator()(FT_LibraryRec_* library) const;
    void operator()(FT_FaceRec_* face) const;
  };
  std::unique_ptr<FT_LibraryRec_, Close> library_;
  std::unique_ptr<FT_FaceRec_, Close> face_;
  int px_;
};

/// Blends `over` onto `under` with this coverage of a pixel, in linear light; `under` is opaque.
Rgba8 laid_over(Rgba8 under, Rgba8 over, int coverage255);

}  // namespace zoneplate
