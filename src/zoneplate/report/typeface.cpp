// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/typeface.h"

#include <fmt/format.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/font/font.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

constexpr const char* files[] = {"DejaVuSans.ttf", "DejaVuSans-Bold.ttf"};
constexpr double leading_em = 1.4;  // DejaVu's letters are tall: the usual 1.2 would be too narrow

/// Calls use(glyph, pen) for every letter of a line, with the pen in 1/64 pixel; returns the final position of the pen.
template <class Use>
FT_Pos set_line(FT_Face face, std::string_view line, Use use) {
  FT_Pos pen = 0;
  FT_UInt before = 0;
  while (!line.empty()) {
    const FT_UInt glyph = FT_Get_Char_Index(face, take_code_point(line));
    FT_Vector kerning{};
    if (before != 0) FT_Get_Kerning(face, before, glyph, FT_KERNING_UNFITTED, &kerning);
    pen += kerning.x;
    before = glyph;
    if (FT_Load_Glyph(face, glyph, FT_LOAD_TARGET_LIGHT) != 0) continue;
    use(face->glyph, pen);
    pen += (face->glyph->linearHoriAdvance + 512) >> 10;  // 16.16 to 26.6
  }
  return pen;
}

/// The number of bytes of a word that fit into the width, at least its first letter.
std::size_t fitting(const Typeface& face, std::string_view word, int width) {
  std::string_view rest = word;
  take_code_point(rest);
  std::size_t size = word.size() - rest.size();
  while (!rest.empty()) {
    take_code_point(rest);
    const std::size_t longer = word.size() - rest.size();
    if (face.width(word.substr(0, longer)) > width) break;
    size = longer;
  }
  // In its second half, a word is preferably broken at a joint: "Spheres|.glb", "two-|squares", "Metal|Rough".
  const auto is_joint = [word](std::size_t i) {
    const char before = word[i - 1], after = word[i];
    return before == '-' || before == '_' || before == '/' || after == '.' ||
           (before >= 'a' && before <= 'z' && after >= 'A' && after <= 'Z');
  };
  for (std::size_t i = size; size < word.size() && i > size / 2; --i)
    if (is_joint(i)) return i;
  return size;
}

}  // namespace

Rgba8 laid_over(Rgba8 under, Rgba8 over, int coverage255) {
  const float share = static_cast<float>(coverage255 * over.a) / (255.0f * 255.0f);
  const auto mixed = [share](std::uint8_t a, std::uint8_t b) {
    const float from = decode_srgb8(a), to = decode_srgb8(b);
    return encode_srgb8(from + (to - from) * share);
  };
  return {mixed(under.r, over.r), mixed(under.g, over.g), mixed(under.b, over.b), 255};
}

void Typeface::Close::operator()(FT_LibraryRec_* library) const { FT_Done_FreeType(library); }
void Typeface::Close::operator()(FT_FaceRec_* face) const { FT_Done_Face(face); }

Typeface::Typeface(Weight weight, int px) : px_(px) {
  const char* const file = files[weight == Weight::Bold];
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  if (FT_Init_FreeType(&library) != 0) throw Error(ErrorKind::Failed, "FreeType cannot be started");
  library_.reset(library);
  const std::string path = dejavu_path(file);
  if (FT_New_Face(library, path.c_str(), 0, &face) != 0) throw Error(ErrorKind::Failed, path + ": not a font");
  face_.reset(face);
  if (FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(px)) != 0)
    throw Error(ErrorKind::Failed, fmt::format("{}: there are no letters of {} pixels", file, px));
}

int Typeface::leading() const { return static_cast<int>(leading_em * px_ + 0.5); }

// The height of the letters according to the font, centred in the leading.
int Typeface::ascent() const {
  const auto pixels = [this](FT_Short units) {
    return static_cast<double>(units) * px_ / static_cast<double>(face_->units_per_EM);
  };
  const double above = pixels(face_->ascender), below = -pixels(face_->descender);
  return static_cast<int>((leading() - above - below) / 2 + above + 0.5);
}

double Typeface::width(std::string_view line) const {
  return static_cast<double>(set_line(face_.get(), line, [](FT_GlyphSlot, FT_Pos) {})) / 64;
}

std::vector<std::string> Typeface::wrapped(std::string_view text, int width) const {
  std::vector<std::string> lines;
  for (bool more = !text.empty(); more;) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view rest = text.substr(0, end);
    more = end < text.size();
    text.remove_prefix(end + (more ? 1 : 0));

    std::string line;
    while (!rest.empty()) {
      // A word is taken with the preceding spaces, which are dropped at the beginning of a line.
      std::size_t size = std::min(rest.find(' ', std::min(rest.find_first_not_of(' '), rest.size())), rest.size());
      std::string_view word = rest.substr(0, size);
      if (this->width(line + std::string(word)) > width) {
        if (!line.empty()) {
          lines.push_back(std::exchange(line, {}));
          rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
          continue;
        }
        size = fitting(*this, word, width);
        word = rest.substr(0, size);
      }
      line += word;
      rest.remove_prefix(size);
    }
    lines.push_back(std::move(line));
  }
  return lines;
}

void Typeface::draw(Rgba8Image& picture, int left, int top, std::string_view line, Rgba8 ink) const {
  const int baseline = top + ascent();
  set_line(face_.get(), line, [&](FT_GlyphSlot glyph, FT_Pos pen) {
    FT_Outline_Translate(&glyph->outline, pen & 63, 0);
    if (FT_Render_Glyph(glyph, FT_RENDER_MODE_NORMAL) != 0) return;
    const FT_Bitmap& bitmap = glyph->bitmap;
    const int x0 = left + static_cast<int>(pen >> 6) + glyph->bitmap_left, y0 = baseline - glyph->bitmap_top;
    for (int y = 0; y < static_cast<int>(bitmap.rows); ++y)
      for (int x = 0; x < static_cast<int>(bitmap.width); ++x) {
        const int coverage = bitmap.buffer[y * bitmap.pitch + x], px = x0 + x, py = y0 + y;
        if (coverage == 0 || px < 0 || py < 0 || px >= picture.width() || py >= picture.height()) continue;
        picture(px, py) = laid_over(picture(px, py), ink, coverage);
      }
  });
}

}  // namespace zoneplate
