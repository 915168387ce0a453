// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/font/font.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <fmt/format.h>

#include <filesystem>

#include "zoneplate/base/callback_error.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

/// The pen of a glyph's outline, and the size of the font's unit.
struct GlyphPen {
  sdf::Pen pen;
  double unit;
  CallbackError error{};

  sdf::Point point(const FT_Vector* v) const {
    return {static_cast<double>(v->x) * unit, -static_cast<double>(v->y) * unit};
  }
  /// Calls draw(pen) in a callback of FreeType, which ends at the first result that is not 0.
  template <class Draw>
  static int draw(void* user, const Draw& draw) noexcept {
    auto& pen = *static_cast<GlyphPen*>(user);
    return pen.error.guarded(1, [&] {
      draw(pen);
      return 0;
    });
  }
};

}  // namespace

void Font::Close::operator()(FT_LibraryRec_* library) const { FT_Done_FreeType(library); }
void Font::Close::operator()(FT_FaceRec_* face) const { FT_Done_Face(face); }

Font::Font(const std::string& path) {
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) throw Error(ErrorKind::Failed, "FreeType cannot be started");
  library_.reset(library);
  FT_Face face = nullptr;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw Error(ErrorKind::Input, path + ": no such file");
  check_is_file(path);
  if (FT_New_Face(library, path.c_str(), 0, &face) != 0) throw Error(ErrorKind::Input, path + ": not a font");
  face_.reset(face);
  if (FT_IS_SCALABLE(face) == 0 || face->units_per_EM == 0)
    throw Error(ErrorKind::Input, path + ": a font without outlines");
}

double Font::em() const { return face_->units_per_EM; }

Font::Metrics Font::metrics() const {
  return {face_->height / em(), face_->ascender / em(), face_->descender / em(), face_->underline_position / em(),
          face_->underline_thickness / em()};
}

bool Font::has(char32_t code) const { return FT_Get_Char_Index(face_.get(), code) != 0; }

bool Font::load(char32_t code) const {
  FT_UInt glyph = FT_Get_Char_Index(face_.get(), code);
  if (glyph == 0) glyph = FT_Get_Char_Index(face_.get(), replacement_character);
  return FT_Load_Glyph(face_.get(), glyph, FT_LOAD_NO_SCALE) == 0;
}

sdf::Outline Font::outline(char32_t code) const {
  sdf::Outline out;
  if (!load(code))
    throw Error(ErrorKind::Input,
                fmt::format("the font's glyph of U+{:04X} cannot be read", static_cast<std::uint32_t>(code)));
  if (face_->glyph->format != FT_GLYPH_FORMAT_OUTLINE) return out;
  GlyphPen pen{sdf::Pen(out), 1 / em()};
  FT_Outline_Funcs functions{};
  functions.move_to = [](const FT_Vector* to, void* user) {
    return GlyphPen::draw(user, [&](GlyphPen& p) { p.pen.move_to(p.point(to)); });
  };
  functions.line_to = [](const FT_Vector* to, void* user) {
    return GlyphPen::draw(user, [&](GlyphPen& p) { p.pen.line_to(p.point(to)); });
  };
  functions.conic_to = [](const FT_Vector* control, const FT_Vector* to, void* user) {
    return GlyphPen::draw(user, [&](GlyphPen& p) { p.pen.quadratic_to(p.point(control), p.point(to)); });
  };
  functions.cubic_to = [](const FT_Vector* a, const FT_Vector* b, const FT_Vector* to, void* user) {
    return GlyphPen::draw(user, [&](GlyphPen& p) { p.pen.cubic_to(p.point(a), p.point(b), p.point(to)); });
  };
  FT_Outline_Decompose(&face_->glyph->outline, &functions, &pen);
  pen.error.rethrow();
  pen.pen.close();
  return out;
}

double Font::advance(char32_t code) const {
  return load(code) ? static_cast<double>(face_->glyph->metrics.horiAdvance) / em() : 0;
}

double Font::kerning(char32_t left, char32_t right) const {
  FT_Vector kerning{};
  if (FT_HAS_KERNING(face_.get()) == 0) return 0;
  FT_Get_Kerning(face_.get(), FT_Get_Char_Index(face_.get(), left), FT_Get_Char_Index(face_.get(), right),
                 FT_KERNING_UNSCALED, &kerning);
  return static_cast<double>(kerning.x) / em();
}

}  // namespace zoneplate
