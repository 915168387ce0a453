// SPDX-License-Identifier: Apache-2.0
// The outlines of a TrueType font, in a page, where FreeType is not: what formats/font/font.cpp does by it. Outlines
// are those that FreeType gives without scaling and hinting, so that drawings have the same bytes.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/font/font.h"
#include "zoneplate/os/file.h"

struct FT_LibraryRec_ {};

/// A file of tables. What lies beyond its end is zero.
struct FT_FaceRec_ {
  std::vector<std::uint8_t> bytes;
  std::size_t cmap = 0, glyf = 0, head = 0, hhea = 0, hmtx = 0, kern = 0, loca = 0, post = 0;  ///< 0: there is none

  unsigned u8(std::size_t at) const { return at < bytes.size() ? bytes[at] : 0u; }
  unsigned u16(std::size_t at) const { return u8(at) << 8 | u8(at + 1); }
  int i16(std::size_t at) const { return static_cast<std::int16_t>(u16(at)); }
  std::uint32_t u32(std::size_t at) const { return std::uint32_t{u16(at)} << 16 | u16(at + 2); }

  std::size_t table(const char* tag) const {
    for (std::size_t i = 0; i < u16(4); ++i)
      if (std::equal(tag, tag + 4,
                     bytes.begin() + static_cast<std::ptrdiff_t>(std::min(12 + 16 * i, bytes.size() - 4))))
        return u32(12 + 16 * i + 8);
    return 0;
  }

  /// The glyph of a character by the table for all of Unicode, of format 12; 0 for none.
  unsigned glyph_of(char32_t code) const {
    for (std::size_t i = 0; i < u16(cmap + 2); ++i) {
      const std::size_t record = cmap + 4 + 8 * i, groups = cmap + u32(record + 4);
      if (u16(record) != 3 || u16(record + 2) != 10 || u16(groups) != 12) continue;
      for (std::size_t group = groups + 16, k = u32(groups + 12); k > 0; --k, group += 12)
        if (code >= u32(group) && code <= u32(group + 4)) return u32(group + 8) + (code - u32(group));
    }
    return 0;
  }

  unsigned advance(unsigned glyph) const { return u16(hmtx + 4 * std::min(glyph, u16(hhea + 34) - 1)); }
  int left_bearing(unsigned glyph) const {
    const unsigned whole = u16(hhea + 34);
    return i16(hmtx + (glyph < whole ? 4 * glyph + 2 : 4 * whole + 2 * (glyph - whole)));
  }

  /// The place of a glyph's outline; 0 if it has none.
  std::size_t outline_of(unsigned glyph) const {
    const bool is_long = u16(head + 50) != 0;
    const auto place = [&](unsigned i) { return is_long ? u32(loca + 4 * i) : 2 * u16(loca + 2 * i); };
    return place(glyph) == place(glyph + 1) ? 0 : glyf + place(glyph);
  }

  int kerning(unsigned left, unsigned right) const {
    if (kern == 0 || u16(kern + 4 + 4) >> 8 != 0) return 0;
    const std::uint32_t wanted = left << 16 | right;
    std::size_t low = 0, high = u16(kern + 4 + 6);
    while (low < high) {
      const std::size_t middle = (low + high) / 2, pair = kern + 4 + 14 + 6 * middle;
      if (u32(pair) == wanted) return i16(pair + 4);
      (u32(pair) < wanted ? low : high) = u32(pair) < wanted ? middle + 1 : middle;
    }
    return 0;
  }
};

namespace zoneplate {
namespace {

/// A point of a contour, in units of the font, y upwards.
struct GlyphPoint {
  double x, y;
  bool is_on, ends;
};

constexpr int deepest = 8;  // glyphs in glyphs

void add_simple(const FT_FaceRec_& font, std::size_t at, int contours, std::vector<GlyphPoint>& out) {
  std::vector<unsigned> ends;
  for (int i = 0; i < contours; ++i) ends.push_back(font.u16(at + 10 + 2 * static_cast<std::size_t>(i)));
  const std::size_t count = ends.empty() ? 0 : ends.back() + 1u;
  std::size_t from = at + 10 + 2 * ends.size();
  from += 2 + font.u16(from);
  std::vector<unsigned> flags;
  while (flags.size() < count && from < font.bytes.size()) {
    const unsigned flag = font.u8(from++);
    flags.push_back(flag);
    if ((flag & 8) != 0) flags.insert(flags.end(), font.u8(from++), flag);
  }
  flags.resize(count);
  const auto coordinates = [&](unsigned is_short, unsigned is_same) {
    std::vector<int> values;
    int value = 0;
    for (const unsigned flag : flags) {
      if ((flag & is_short) != 0) {
        const int step = static_cast<int>(font.u8(from++));
        value += (flag & is_same) != 0 ? step : -step;
      } else if ((flag & is_same) == 0) {
        value += font.i16(from);
        from += 2;
      }
      values.push_back(value);
    }
    return values;
  };
  const std::vector<int> x = coordinates(2, 16), y = coordinates(4, 32);
  for (std::size_t i = 0; i < count; ++i)
    out.push_back({static_cast<double>(x[i]), static_cast<double>(y[i]), (flags[i] & 1) != 0,
                   std::ranges::find(ends, static_cast<unsigned>(i)) != ends.end()});
}

void add_glyph(const FT_FaceRec_& font, unsigned glyph, int depth, std::vector<GlyphPoint>& out) {
  const std::size_t at = font.outline_of(glyph);
  if (at == 0 || depth > deepest) return;
  if (const int contours = font.i16(at); contours >= 0) return add_simple(font, at, contours, out);
  std::size_t part = at + 10;
  for (bool more = true; more;) {
    const unsigned flags = font.u16(part), inner = font.u16(part + 2);
    const bool has_words = (flags & 1) != 0;
    const auto argument = [&](std::size_t i) {
      return has_words ? font.i16(part + 4 + 2 * i) : static_cast<std::int8_t>(font.u8(part + 4 + i));
    };
    const double dx = argument(0), dy = argument(1);
    part += has_words ? 8 : 6;
    const auto scale = [&] {
      part += 2;
      return font.i16(part - 2) / 16384.0;
    };
    double xx = 1, xy = 0, yx = 0, yy = 1;
    if ((flags & 0x08) != 0) xx = yy = scale();
    if ((flags & 0x40) != 0) xx = scale(), yy = scale();
    if ((flags & 0x80) != 0) xx = scale(), xy = scale(), yx = scale(), yy = scale();
    const std::size_t first = out.size();
    add_glyph(font, inner, depth + 1, out);
    for (std::size_t i = first; i < out.size(); ++i) {
      const GlyphPoint p = out[i];
      out[i].x = std::floor(p.x * xx + p.y * yx + 0.5) + dx;
      out[i].y = std::floor(p.x * xy + p.y * yy + 0.5) + dy;
    }
    more = (flags & 0x20) != 0;
  }
}

/// Draws a closed contour: between two points that are not on it lies one that is.
template <class At>
void draw(std::span<const GlyphPoint> points, const At& at, sdf::Pen& pen) {
  const auto middle = [](const GlyphPoint& a, const GlyphPoint& b) {
    return GlyphPoint{static_cast<double>((static_cast<int>(a.x) + static_cast<int>(b.x)) / 2),
                      static_cast<double>((static_cast<int>(a.y) + static_cast<int>(b.y)) / 2), true, false};
  };
  GlyphPoint start = points.front();
  std::span<const GlyphPoint> rest = points.subspan(1);
  if (!start.is_on && points.back().is_on) {
    start = points.back();
    rest = points.first(points.size() - 1);
  } else if (!start.is_on) {
    start = middle(start, points.back());
    rest = points;
  }
  pen.move_to(at(start));
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i].is_on) {
      pen.line_to(at(rest[i]));
      continue;
    }
    const bool is_last = i + 1 == rest.size();
    const GlyphPoint next = is_last ? start : rest[i + 1].is_on ? rest[i + 1] : middle(rest[i], rest[i + 1]);
    pen.quadratic_to(at(rest[i]), at(next));
    if (is_last) return;
    if (rest[i + 1].is_on) ++i;
  }
  pen.line_to(at(start));
}

}  // namespace

void Font::Close::operator()(FT_LibraryRec_* library) const { delete library; }
void Font::Close::operator()(FT_FaceRec_* face) const { delete face; }

Font::Font(const std::string& path) {
  const FileBytes file(path);
  face_.reset(new FT_FaceRec_{.bytes = {file.bytes().begin(), file.bytes().end()}});
  FT_FaceRec_& face = *face_;
  if (face.bytes.size() < 12) throw Error(ErrorKind::Input, path + ": not a font");
  face.cmap = face.table("cmap"), face.glyf = face.table("glyf"), face.head = face.table("head");
  face.hhea = face.table("hhea"), face.hmtx = face.table("hmtx"), face.kern = face.table("kern");
  face.loca = face.table("loca"), face.post = face.table("post");
  if (face.glyf == 0 || em() == 0) throw Error(ErrorKind::Input, path + ": not a TrueType font");
}

double Font::em() const { return face_->u16(face_->head + 18); }

Font::Metrics Font::metrics() const {
  const double above = face_->i16(face_->hhea + 4), below = face_->i16(face_->hhea + 6);
  const double gap = face_->i16(face_->hhea + 8), line = face_->i16(face_->post + 10);
  return {(above - below + gap) / em(), above / em(), below / em(),
          (face_->i16(face_->post + 8) - std::trunc(line / 2)) / em(), line / em()};
}

bool Font::has(char32_t code) const { return face_->glyph_of(code) != 0; }

namespace {

unsigned glyph_or_replacement(const FT_FaceRec_& face, char32_t code) {
  const unsigned glyph = face.glyph_of(code);
  return glyph == 0 ? face.glyph_of(replacement_character) : glyph;
}

}  // namespace

sdf::Outline Font::outline(char32_t code) const {
  const unsigned glyph = glyph_or_replacement(*face_, code);
  sdf::Outline out;
  std::vector<GlyphPoint> points;
  add_glyph(*face_, glyph, 0, points);
  if (points.empty()) return out;
  // The origin lies left of the outline by its bearing.
  const double move = face_->left_bearing(glyph) - face_->i16(face_->outline_of(glyph) + 2), unit = 1 / em();
  for (GlyphPoint& p : points) p.x += move;
  const auto at = [unit](const GlyphPoint& p) { return sdf::Point{p.x * unit, -p.y * unit}; };
  sdf::Pen pen(out);
  for (std::size_t first = 0, i = 0; i < points.size(); ++i) {
    if (!points[i].ends) continue;
    draw(std::span<const GlyphPoint>(points).subspan(first, i + 1 - first), at, pen);
    first = i + 1;
  }
  pen.close();
  return out;
}

double Font::advance(char32_t code) const { return face_->advance(glyph_or_replacement(*face_, code)) / em(); }
double Font::kerning(char32_t left, char32_t right) const {
  return face_->kerning(face_->glyph_of(left), face_->glyph_of(right)) / em();
}

}  // namespace zoneplate
