// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "zoneplate/sdf/outline.h"

struct FT_LibraryRec_;
struct FT_FaceRec_;

namespace zoneplate {

/// The path of a DejaVu font, such as "DejaVuSans.ttf", in the usual folders.
///
/// Errors    ErrorKind::Failed naming the file, the folders and the package.
std::string dejavu_path(const std::string& file);

/// The outlines of a scalable font.
///
/// Space     y points downwards, baselines are at y = 0.
/// Units     em.
class Font {
 public:
  struct Metrics {
    double line_height = 0, ascender = 0, descender = 0, underline = 0, underline_thickness = 0;
  };

  /// Errors    ErrorKind::Input naming the file: not a font, or one of bitmaps only.
  explicit Font(const std::string& path);

  Metrics metrics() const;
  bool has(char32_t code) const;
  /// The outline of a character, at the origin of its baseline; the replacement character's if the font lacks it.
  sdf::Outline outline(char32_t code) const;
  double advance(char32_t code) const;
  double kerning(char32_t left, char32_t right) const;

 private:
  struct Close {
    void operator()(FT_LibraryRec_* library) const;
    void operator()(FT_FaceRec_* face) const;
  };
  double em() const;
  bool load(char32_t code) const;

  std::unique_ptr<FT_LibraryRec_, Close> library_;
  std::unique_ptr<FT_FaceRec_, Close> face_;
};

/// The outline of a line of text of this size that starts at the origin of its baseline, as the boundary of all glyphs.
sdf::Outline text_outline(const Font& font, std::string_view text, double size);
/// The width of the line: the sum of advances and kerning.
double text_width(const Font& font, std::string_view text, double size);

}  // namespace zoneplate
