// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/figure_vector.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>

#include "zoneplate/codec/png.h"
#include "zoneplate/formats/font/font.h"
#include "zoneplate/image/hex_color.h"
#include "zoneplate/report/figure_layout.h"
#include "zoneplate/report/markup.h"

namespace zoneplate {
namespace {

/// The layout of a page, moved to its middle, and the outlines of its letters.
class PageLayout {
 public:
  explicit PageLayout(const FigurePage& page) : layout_(lay_out(page.figure, page.style)), size_(page.size) {
    if (size_.x == 0) size_ = {layout_.width, layout_.height};
    const int x = (size_.x - layout_.width) / 2, y = (size_.y - layout_.height) / 2;
    for (FigureLayout::Image& image : layout_.images) image.left += x, image.top += y;
    for (FigureLayout::Line& line : layout_.lines) line.left += x, line.baseline += y;
  }

  int2 size() const { return size_; }
  std::span<const FigureLayout::Image> images() const { return layout_.images; }
  std::span<const FigureLayout::Line> lines() const { return layout_.lines; }

 private:
  FigureLayout layout_;
  int2 size_;
};

/// The fonts of the figure's texts.
class Fonts {
 public:
  sdf::Outline outline(const FigureLayout::Line& line) const {
    const Font& font = line.weight == Typeface::Weight::Bold ? bold_ : regular_;
    const sdf::Point origin{static_cast<double>(line.left), static_cast<double>(line.baseline)};
    return text_outline(font, line.text, line.px).mapped({.move = origin});
  }

 private:
  Font regular_{dejavu_path("DejaVuSans.ttf")}, bold_{dejavu_path("DejaVuSans-Bold.ttf")};
};

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return i + k < bytes.size() ? unsigned{bytes[i + k]} : 0u; };
    const unsigned three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (int k = 0; k < 4; ++k) out += digits[three >> (18 - 6 * k) & 63];
  }
  for (std::size_t k = bytes.size() % 3; k != 0 && k < 3; ++k) out[out.size() - (3 - k)] = '=';
  return out;
}

/// A coordinate with the digits that print needs.
std::string coordinate(double v) {
  std::string text = fmt::format("{:.2f}", v);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}
std::string coordinates(sdf::Point p) { return coordinate(p.x) + ' ' + coordinate(p.y); }

std::string svg_path(const sdf::Outline& outline) {
  std::string out;
  for (const sdf::Contour& contour : outline.contours) {
    if (contour.empty()) continue;
    out += 'M' + coordinates(contour.front().first());
    for (const sdf::Segment& s : contour) {
      constexpr char commands[] = {'L', 'Q', 'C'};
      out += commands[s.degree - 1];
      for (int i = 1; i <= s.degree; ++i) out += (i > 1 ? " " : "") + coordinates(s.p[i]);
    }
    out += 'Z';
  }
  return out;
}

/// PDF has no quadratic curves: they become cubics.
std::string pdf_path(const sdf::Outline& outline) {
  std::string out;
  for (const sdf::Contour& contour : outline.contours) {
    if (contour.empty()) continue;
    out += coordinates(contour.front().first()) + " m\n";
    for (const sdf::Segment& s : contour) {
      const sdf::Segment cubic = s.elevated();
      out += s.degree == 1 ? coordinates(s.last()) + " l\n"
                           : fmt::format("{} {} {} c\n", coordinates(cubic.p[1]), coordinates(cubic.p[2]),
                                         coordinates(cubic.p[3]));
    }
    out += "h\n";
  }
  return out;
}

std::string pdf_color(Rgba8 c) { return fmt::format("{:.4f} {:.4f} {:.4f}", c.r / 255.0, c.g / 255.0, c.b / 255.0); }

std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes) {
  std::vector<std::uint8_t> out(compressBound(bytes.size()));
  uLongf size = out.size();
  [[maybe_unused]] const int result = compress2(out.data(), &size, bytes.data(), bytes.size(), Z_BEST_COMPRESSION);
  assert(result == Z_OK);
  out.resize(size);
  return out;
}

/// A PDF file, to which objects are appended. An object's number may be reserved before the object is written.
class PdfFile {
 public:
  int reserve() {
    places_.push_back(0);
    return static_cast<int>(places_.size());
  }
  void put_object(int number, const std::string& text) {
    begin(number);
    put(text + "\nendobj\n");
  }
  int put_stream(const std::string& entries, std::span<const std::uint8_t> data) {
    const std::vector<std::uint8_t> packed = deflated(data);
    const int number = reserve();
    begin(number);
    put(fmt::format("<< {}/Filter /FlateDecode /Length {} >>\nstream\n", entries, packed.size()));
    bytes_.insert(bytes_.end(), packed.begin(), packed.end());
    put("\nendstream\nendobj\n");
    return number;
  }

  /// The whole file: the objects, their places, and the number of the catalog.
  std::vector<std::uint8_t> take(int catalog) {
    const std::size_t start = bytes_.size();
    put(fmt::format("xref\n0 {}\n0000000000 65535 f \n", places_.size() + 1));
    for (const std::size_t place : places_) put(fmt::format("{:010} 00000 n \n", place));
    put(fmt::format("trailer\n<< /Size {} /Root {} 0 R >>\nstartxref\n{}\n%%EOF\n", places_.size() + 1, catalog,
                    start));
    return std::move(bytes_);
  }

 private:
  void begin(int number) {
    places_[static_cast<std::size_t>(number) - 1] = bytes_.size();
    put(fmt::format("{} 0 obj\n", number));
  }
  void put(const std::string& text) { bytes_.insert(bytes_.end(), text.begin(), text.end()); }

  static constexpr char header[] = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";  // the second line marks a binary file
  std::vector<std::uint8_t> bytes_{std::begin(header), std::end(header) - 1};
  std::vector<std::size_t> places_;
};

std::vector<std::uint8_t> rgb_bytes(const Rgba8Image& picture, Rgba8 paper) {
  std::vector<std::uint8_t> out;
  for (const Rgba8 c : picture.values()) {
    const Rgba8 over = c.a == 255 ? c : laid_over(paper, c, 255);
    out.insert(out.end(), {over.r, over.g, over.b});
  }
  return out;
}

/// Writes the page's images and content, and returns the number of the page's object.
int put_page(const FigurePage& page, const Fonts& fonts, int parent, PdfFile& pdf) {
  const PageLayout layout(page);
  const int2 size = layout.size();
  const FigureStyle& style = page.style;
  constexpr double point = 0.75;  // 1/96 inch in units of 1/72 inch
  // The content's coordinates are pixels, y pointing downwards.
  std::string content = fmt::format("{} 0 0 -{} 0 {} cm\n{} rg 0 0 {} {} re f\n", point, point, size.y * point,
                                    pdf_color(style.paper), size.x, size.y);
  std::string resources;
  int count = 0;
  for (const FigureLayout::Image& image : layout.images()) {
    const int w = image.picture->width(), h = image.picture->height();
    if (w == 0 || h == 0) continue;
    const int number = pdf.put_stream(
        fmt::format("/Type /XObject /Subtype /Image /Width {} /Height {} /ColorSpace /DeviceRGB /BitsPerComponent 8 ",
                    w, h),
        rgb_bytes(*image.picture, style.paper));
    resources += fmt::format("/I{} {} 0 R ", count, number);
    if (image.has_outline)
      content += fmt::format("{} rg {} {} {} {} re f\n", pdf_color(outline_color(style)), image.left - 1, image.top - 1,
                             w + 2, h + 2);
    content += fmt::format("q {} 0 0 -{} {} {} cm /I{} Do Q\n", w, h, image.left, image.top + h, count++);
  }
  content += pdf_color(style.ink) + " rg\n";
  for (const FigureLayout::Line& line : layout.lines())
    if (const std::string path = pdf_path(fonts.outline(line)); !path.empty()) content += path + "f\n";
  const int stream = pdf.put_stream("", {reinterpret_cast<const std::uint8_t*>(content.data()), content.size()});
  const int number = pdf.reserve();
  pdf.put_object(number, fmt::format("<< /Type /Page /Parent {} 0 R /MediaBox [0 0 {} {}] /Contents {} 0 R "
                                     "/Resources << /XObject << {}>> >> >>",
                                     parent, size.x * point, size.y * point, stream, resources));
  return number;
}

}  // namespace

std::string figure_svg(const FigurePage& page) {
  const PageLayout layout(page);
  const Fonts fonts;
  const int2 size = layout.size();
  const FigureStyle& style = page.style;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n"
      "<title>{2}</title>\n<rect width=\"{0}\" height=\"{1}\" fill=\"{3}\"/>\n",
      size.x, size.y, escape_markup(page.figure.title), hex_color(style.paper));
  for (const FigureLayout::Image& image : layout.images()) {
    const int w = image.picture->width(), h = image.picture->height();
    if (w == 0 || h == 0) continue;
    if (image.has_outline)
      out += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n", image.left - 1,
                         image.top - 1, w + 2, h + 2, hex_color(outline_color(style)));
    const std::vector<std::uint8_t> png =
        encode_png(*image.picture, {.has_alpha = true, .is_small = true, .may_be_indexed = true});
    out += fmt::format(
        "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" style=\"image-rendering:pixelated\" "
        "href=\"data:image/png;base64,{}\"/>\n",
        image.left, image.top, w, h, base64(png));
  }
  out += fmt::format("<g fill=\"{}\">\n", hex_color(style.ink));
  for (const FigureLayout::Line& line : layout.lines())
    if (const std::string path = svg_path(fonts.outline(line)); !path.empty())
      out += fmt::format("<path aria-label=\"{}\" d=\"{}\"/>\n", escape_markup(line.text), path);
  return out + "</g>\n</svg>\n";
}

std::vector<std::uint8_t> figures_pdf(std::span<const FigurePage> pages) {
  assert(!pages.empty());
  const Fonts fonts;
  PdfFile pdf;
  const int catalog = pdf.reserve(), tree = pdf.reserve();
  std::string kids;
  for (const FigurePage& page : pages) kids += fmt::format("{} 0 R ", put_page(page, fonts, tree, pdf));
  pdf.put_object(catalog, fmt::format("<< /Type /Catalog /Pages {} 0 R >>", tree));
  pdf.put_object(tree, fmt::format("<< /Type /Pages /Kids [{}] /Count {} >>", kids, pages.size()));
  return pdf.take(catalog);
}

}  // namespace zoneplate
