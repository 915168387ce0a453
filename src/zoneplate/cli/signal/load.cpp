// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/signal/load.h"

#include <algorithm>
#include <array>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate::cli {
namespace {

/// Maps every pixel by value_of(code), a function of a straight code, and premultiplies it.
template <class Code, class ValueOf>
LinearImage premultiplied(const Plane<Code>& codes, float greatest, const ValueOf& value_of) {
  LinearImage out(codes.width(), codes.height());
  metrics::for_rows(codes.height(), [&](int y) {
    std::ranges::transform(codes.row(y), out.row(y).begin(), [&](const Code& c) {
      const float alpha = static_cast<float>(c.a) / greatest;
      return Linear{value_of(c.r) * alpha, value_of(c.g) * alpha, value_of(c.b) * alpha, alpha};
    });
  });
  return out;
}

LinearImage image_of(const Rgba8Image& codes, bool uses_codes) {
  std::array<float, 256> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto code = static_cast<std::uint8_t>(i);
    values[i] = uses_codes ? static_cast<float>(code) / 255 : decode_srgb8(code);
  }
  return premultiplied(codes, 255, [&](std::uint8_t code) { return values[code]; });
}

LinearImage image_of(const Rgba16Image& codes, bool uses_codes) {
  return premultiplied(codes, 65535, [&](std::uint16_t code) {
    const float value = static_cast<float>(code) / 65535;
    return uses_codes ? value : decode_srgb(value);
  });
}

LinearImage as_codes(LinearImage image) {
  for (Linear& c : image.values()) c = {encode_srgb(c.r), encode_srgb(c.g), encode_srgb(c.b), c.a};
  return image;
}

/// An image, and damage of its file that the decoder passed over.
struct Loaded {
  LinearImage image;
  std::string flaw = {};
};

Loaded load_file(const std::string& operand, bool uses_codes, std::uint64_t most_pixels) {
  const FileBytes file(operand);
  if (is_hdr(file.bytes()) || is_exr(file.bytes()) || is_pfm(file.bytes())) {
    LinearImage light = is_hdr(file.bytes())   ? decode_hdr(file.bytes(), operand, most_pixels)
                        : is_exr(file.bytes()) ? decode_exr(file.bytes(), operand, most_pixels)
                                               : decode_pfm(file.bytes(), operand, most_pixels);
    return {uses_codes ? as_codes(std::move(light)) : std::move(light)};
  }
  const bool is_png = !file.bytes().empty() && file.bytes()[0] == 0x89;
  if (!is_png) {
    DecodedImage decoded = decode_image(file.bytes(), operand, most_pixels);
    return {image_of(decoded.texels.as<Rgba8>(), uses_codes), std::move(decoded.flaw)};
  }
  const PngImage png = decode_png(file.bytes(), operand, most_pixels);
  return {png.pixels16.empty() ? image_of(png.pixels, uses_codes) : image_of(png.pixels16, uses_codes)};
}

Loaded load(const std::string& operand, bool uses_codes, std::uint64_t most_pixels) {
  if (is_pattern(operand)) return {uses_codes ? as_codes(make_pattern(operand)) : make_pattern(operand)};
  const MappedFileWatch watch;
  Loaded loaded = load_file(operand, uses_codes, most_pixels);
  watch.check(operand);
  return loaded;
}

}  // namespace

LinearImage load_signal(const std::string& operand, bool uses_codes, std::uint64_t most_pixels) {
  Loaded loaded = load(operand, uses_codes, most_pixels);
  if (!loaded.flaw.empty()) throw Error(ErrorKind::Input, loaded.flaw);
  return std::move(loaded.image);
}

LinearImage load_signal(const std::string& operand, bool uses_codes, Delivery& out) {
  Loaded loaded;
  out.read(operand, [&] { loaded = load(operand, uses_codes, out.limits().pixels); });
  out.warn_of_flaw(loaded.flaw);
  return std::move(loaded.image);
}

}  // namespace zoneplate::cli
