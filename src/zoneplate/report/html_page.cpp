// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/html_page.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "zoneplate/codec/png.h"
#include "zoneplate/image/half.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/report/markup.h"

namespace zoneplate {
namespace {

std::vector<std::uint8_t> small_png(const Rgba8Image& image) {
  const bool is_opaque = std::ranges::all_of(image.values(), [](Rgba8 c) { return c.a == 255; });
  return encode_png(image, {.has_alpha = !is_opaque, .is_small = true, .may_be_indexed = true});
}

std::vector<std::uint8_t> small_png(const Rgba16Image& image, std::uint16_t opaque_code) {
  const bool is_opaque = std::ranges::all_of(image.values(), [&](Rgba16 c) { return c.a == opaque_code; });
  return encode_png(image, {.has_alpha = !is_opaque, .is_srgb = false, .is_small = true});
}

std::string_view name_of(PagePicture::Values values) {
  switch (values) {
    case PagePicture::Values::Codes:
      return "codes";
    case PagePicture::Values::Halves:
      return "halves";
    case PagePicture::Values::Errors:
      break;
  }
  return "errors";
}

/// The bytes as a zlib stream.
std::vector<std::uint8_t> deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> out(size);
  [[maybe_unused]] const int result = compress2(out.data(), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                                                static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION);
  assert(result == Z_OK);
  out.resize(size);
  return out;
}

/// The colours of error maps, as hexadecimal digits.
std::string error_colors() {
  std::string out;
  for (int i = 0; i < 256; ++i) {
    const Rgba8 c = metrics::magma(static_cast<float>(i) / 255);
    out += fmt::format("{:02x}{:02x}{:02x}", c.r, c.g, c.b);
  }
  return out;
}

/// The script of the viewer for data, with the modules that these need. Quotation marks inside the strings of JSON have
/// a backslash, so that only members have these texts.
std::string script_for(std::string_view content) {
  std::string out;
  if (content.find("\"tables\":[{") != std::string_view::npos) out += viewer_table;
  if (content.find("\"plot\":{") != std::string_view::npos) out += viewer_plot;
  return out.append(viewer_script);
}

}  // namespace

PagePicture page_picture(const Rgba8Image& image) { return {.png = small_png(image)}; }

PagePicture page_picture(const DisplayImage& image) {
  const Rgba8Image codes = quantize8(image);
  const auto is_exact = [](float value, std::uint8_t code) { return value == static_cast<float>(code) / 255; };
  const bool has_8_bits = std::ranges::equal(image.values(), codes.values(), [&](Display d, Rgba8 c) {
    return is_exact(d.r, c.r) && is_exact(d.g, c.g) && is_exact(d.b, c.b) && is_exact(d.a, c.a);
  });
  if (has_8_bits) return page_picture(codes);
  return {.png = small_png(quantize16(image), 65535)};
}

PagePicture page_picture(const LinearImage& image) {
  PagePicture out{.values = PagePicture::Values::Halves};
  const auto bits = [&](float value) {
    const std::uint16_t half = half_bits(value);
    out.is_rounded |= half_value(half) != value;
    return half;
  };
  Rgba16Image halves(image.width(), image.height());
  std::ranges::transform(image.values(), halves.values().begin(), [&](Linear c) {
    return Rgba16{bits(c.r), bits(c.g), bits(c.b), bits(c.a)};
  });
  out.png = small_png(halves, half_bits(1));
  return out;
}

PagePicture page_errors(const Plane<float>& errors) {
  Rgba8Image codes(errors.width(), errors.height());
  std::ranges::transform(errors.values(), codes.values().begin(), [](float error) {
    const auto code = static_cast<std::uint8_t>(std::lround(255 * std::clamp(error, 0.0f, 1.0f)));
    return Rgba8{code, code, code, 255};
  });
  return {.png = small_png(codes), .values = PagePicture::Values::Errors};
}

std::string text_of_bytes(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view left_out("\0\n\r<", 4);
  constexpr unsigned with_next = 512, alone = 1024;
  std::string out;
  out.reserve(bytes.size() / 7 * 8 + 16);
  const std::size_t count = (bytes.size() * 8 + 6) / 7;
  const auto seven = [&](std::size_t i) {
    const std::size_t bit = 7 * i, at = bit / 8;
    const unsigned two = unsigned{bytes[at]} << 8 | (at + 1 < bytes.size() ? bytes[at + 1] : 0u);
    return two >> (9 - bit % 8) & 127;
  };
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned value = seven(i);
    const std::size_t place = left_out.find(static_cast<char>(value));
    if (place == std::string_view::npos) {
      out += static_cast<char>(value);
      continue;
    }
    const bool has_next = ++i < count;
    const unsigned code = (has_next ? with_next + seven(i) : alone) + (static_cast<unsigned>(place) << 7);
    out += static_cast<char>(0xc0 | code >> 6), out += static_cast<char>(0x80 | (code & 63));
  }
  return out;
}

std::string html_page(std::string_view title, const Json& content, std::span<const PagePicture> pictures) {
  std::string out;
  std::string_view rest = viewer_page;
  const auto copy_to = [&](std::string_view mark) {
    const std::size_t end = rest.find(mark);
    out += rest.substr(0, end);
    rest.remove_prefix(end + mark.size());
  };
  copy_to("{{title}}");
  out += escape_markup(title);
  copy_to("{{content}}");
  const bool has_errors =
      std::ranges::any_of(pictures, [](const PagePicture& p) { return p.values == PagePicture::Values::Errors; });
  const std::string data = content.text();
  const std::string packed = fmt::format("{}{zero}{}{zero}{}{zero}{}", viewer_style, script_for(data),
                                         has_errors ? error_colors() : "", data, fmt::arg("zero", '\0'));
  out += fmt::format("<script type=\"text/plain\" id=\"viewer\">{}</script>\n", text_of_bytes(deflated(packed)));
  for (const PagePicture& picture : pictures)
    out += fmt::format("<script type=\"text/plain\" class=\"picture\" data-values=\"{}\"{}>{}</script>\n",
                       name_of(picture.values), picture.is_rounded ? " data-rounded" : "", text_of_bytes(picture.png));
  return out.append(rest);
}

}  // namespace zoneplate
