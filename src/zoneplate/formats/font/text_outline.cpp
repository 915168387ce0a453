// SPDX-License-Identifier: Apache-2.0
// What of a font needs no library: where DejaVu is, and lines of text.
#include <fmt/format.h>

#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/formats/font/font.h"
#include "zoneplate/sdf/boundary.h"

namespace zoneplate {
namespace {

constexpr const char* package = "fonts-dejavu-core";
/// Font folders of Debian, Arch, Fedora, Gentoo and Alpine, and of local installations.
constexpr const char* folders[] = {"/usr/share/fonts/truetype/dejavu/",       "/usr/share/fonts/TTF/",
                                   "/usr/share/fonts/dejavu-sans-fonts/",     "/usr/share/fonts/dejavu/",
                                   "/usr/local/share/fonts/truetype/dejavu/", "/usr/local/share/fonts/"};

/// Calls use(code, position) for every character of a line of text, positions in em.
template <class Use>
double set_line(const Font& font, std::string_view text, const Use& use) {
  double pen = 0;
  char32_t before = 0;
  while (!text.empty()) {
    const char32_t code = take_code_point(text);
    if (before != 0) pen += font.kerning(before, code);
    use(code, pen);
    pen += font.advance(code);
    before = code;
  }
  return pen;
}

}  // namespace

std::string dejavu_path(const std::string& file) {
  std::error_code ignored;
  for (const char* folder : folders)
    if (std::filesystem::exists(folder + file, ignored)) return folder + file;
  throw Error(ErrorKind::Failed, fmt::format("{}: the font of captions is in none of {}; it is in Debian's package {}",
                                             file, fmt::join(folders, ", "), package));
}

sdf::Outline text_outline(const Font& font, std::string_view text, double size) {
  sdf::Outline out;
  set_line(font, text, [&](char32_t code, double pen) {
    for (sdf::Contour& contour : font.outline(code).mapped({.scale = size, .move = {pen * size, 0}}).contours)
      out.contours.push_back(std::move(contour));
  });
  return sdf::boundary_of(out);
}

double text_width(const Font& font, std::string_view text, double size) {
  return size * set_line(font, text, [](char32_t, double) {});
}

}  // namespace zoneplate
