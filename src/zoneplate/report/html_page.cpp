// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/html_page.h"

#include <fmt/format.h>

#include <algorithm>
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

/// JSON without <, which could end the element that contains it.
std::string escaped_json(const Json& json) {
  std::string out;
  for (const char c : json.text()) c == '<' ? out += "\\u003c" : out += c;
  return out;
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
  constexpr std::string_view alphabet =
      "!#$%'()*+,-./0123456789:;=>?@ABCDEFGHIJKLMNOPQRSTUVWXYZ[\\]^_`abcdefghijklmnopqrstuvwxyz{|}~";
  static_assert(alphabet.size() == 91 && 91 * 91 >= 1 << 13);
  std::string out;
  out.reserve(bytes.size() / 13 * 16 + 18);
  std::uint32_t bits = 0;
  int count = 0;
  const auto add_pair = [&](std::uint32_t value) { out += alphabet[value % 91], out += alphabet[value / 91]; };
  for (const std::uint8_t byte : bytes) {
    bits |= std::uint32_t{byte} << count, count += 8;
    if (count < 13) continue;
    add_pair(bits & 0x1fff);
    bits >>= 13, count -= 13;
  }
  if (count > 0) add_pair(bits);
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
  out += "<script type=\"application/json\" id=\"content\" data-colors=\"";
  for (int i = 0; i < 256; ++i) {
    const Rgba8 c = metrics::magma(static_cast<float>(i) / 255);
    out += fmt::format("{:02x}{:02x}{:02x}", c.r, c.g, c.b);
  }
  out += "\">" + escaped_json(content) + "</script>\n";
  for (const PagePicture& picture : pictures)
    out += fmt::format("<script type=\"text/plain\" class=\"picture\" data-values=\"{}\"{}>{}</script>\n",
                       name_of(picture.values), picture.is_rounded ? " data-rounded" : "", text_of_bytes(picture.png));
  return out.append(rest);
}

}  // namespace zoneplate
