// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/signal/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/image/orientation.h"
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

bool is_usual(const RgbSpacePtr& space) { return !space || space->is_standard; }

/// The light of codes of a space.
template <class Code>
LinearImage light_of_codes(const Plane<Code>& codes, const RgbSpace& space) {
  constexpr float greatest = Code{}.a;  // of an opaque pixel
  DisplayImage straight(codes.width(), codes.height());
  std::ranges::transform(codes.values(), straight.values().begin(), [&](const Code& c) {
    const auto unit = [&](auto v) { return static_cast<float>(v) / greatest; };
    return Display{unit(c.r), unit(c.g), unit(c.b), unit(c.a)};
  });
  return light_of(straight, space);
}

LinearImage as_codes(LinearImage image) {
  for (Linear& c : image.values()) c = {encode_srgb(c.r), encode_srgb(c.g), encode_srgb(c.b), c.a};
  return image;
}

/// The values of codes, turned. Where a PNG could not state the space of the results, they are converted.
template <class Code>
Signal signal_of(Plane<Code> codes, const ImageColor& color, bool uses_codes) {
  codes = oriented(std::move(codes), color.orientation);
  Signal out{.image = {}, .meaning = {uses_codes, color.space}};
  const bool is_kept =
      is_usual(color.space) || (can_hold(".png", color.space->profile) && (uses_codes || can_encode(*color.space)));
  if (is_usual(color.space) || (is_kept && uses_codes)) {
    out.image = image_of(codes, uses_codes);
    return out;
  }
  out.image = light_of_codes(codes, *color.space);
  if (is_kept) return out;
  convert_to_rec709(out.image, *color.space);
  out.meaning.space = nullptr;
  if (uses_codes) out.image = as_codes(std::move(out.image));
  return out;
}

Signal signal_of(LinearImage light, const ImageColor& color, bool uses_codes) {
  Signal out{.image = std::move(light), .meaning = {uses_codes, color.space}};
  if (!uses_codes) return out;
  if (color.space) convert_to_rec709(out.image, *color.space);
  return {as_codes(std::move(out.image)), {uses_codes, nullptr}};
}

/// An image, and what of its file the decoder passed over.
struct Loaded {
  Signal signal;
  std::string flaw = {}, color_flaw = {};
  RgbSpacePtr space = nullptr;  ///< of the file
};

Loaded load_file(const std::string& operand, bool uses_codes, bool is_texture, std::uint64_t most_pixels) {
  const FileBytes file(operand);
  const ImageColor color = is_texture ? ImageColor{.space = nullptr} : read_image_color(file.bytes(), operand);
  Loaded out{.signal = {}, .color_flaw = color.flaw, .space = color.space};
  if (is_hdr(file.bytes()) || is_exr(file.bytes()) || is_pfm(file.bytes())) {
    out.signal = signal_of(is_hdr(file.bytes())   ? decode_hdr(file.bytes(), operand, most_pixels)
                           : is_exr(file.bytes()) ? decode_exr(file.bytes(), operand, most_pixels)
                                                  : decode_pfm(file.bytes(), operand, most_pixels),
                           color, uses_codes);
    return out;
  }
  const bool is_png = !file.bytes().empty() && file.bytes()[0] == 0x89;
  if (is_png) {
    PngImage png = decode_png_as_stored(file.bytes(), operand, most_pixels);
    out.signal = png.pixels16.empty() ? signal_of(std::move(png.pixels), color, uses_codes)
                                      : signal_of(std::move(png.pixels16), color, uses_codes);
    return out;
  }
  DecodedImage decoded = decode_image(file.bytes(), operand, most_pixels);
  out.signal = signal_of(decoded.texels.as<Rgba8>(), color, uses_codes);
  out.flaw = std::move(decoded.flaw);
  return out;
}

Loaded load(const std::string& operand, bool uses_codes, bool is_texture, std::uint64_t most_pixels) {
  if (is_pattern(operand)) return {signal_of(make_pattern(operand), {.space = nullptr}, uses_codes)};
  const MappedFileWatch watch;
  Loaded loaded = load_file(operand, uses_codes, is_texture, most_pixels);
  watch.check(operand);
  return loaded;
}

Loaded load(const std::string& operand, bool uses_codes, bool is_texture, Delivery& out) {
  Loaded loaded;
  out.read(operand, [&] { loaded = load(operand, uses_codes, is_texture, out.limits().pixels); });
  out.warn_of_flaw(loaded.flaw), out.warn_of_flaw(loaded.color_flaw);
  return loaded;
}

}  // namespace

LinearImage load_signal(const std::string& operand, bool uses_codes, std::uint64_t most_pixels) {
  Loaded loaded = load(operand, uses_codes, false, most_pixels);
  if (!loaded.flaw.empty()) throw Error(ErrorKind::Input, loaded.flaw);
  return in_rec709(std::move(loaded.signal)).image;
}

LinearImage load_signal(const std::string& operand, bool uses_codes, Delivery& out) {
  return in_rec709(load(operand, uses_codes, false, out).signal).image;
}

Signal load_as_stored(const std::string& operand, bool uses_codes, Delivery& out) {
  Loaded loaded = load(operand, uses_codes, false, out);
  const bool is_converted = !is_usual(loaded.space) && !loaded.signal.meaning.space;
  if (is_converted && !can_encode(*loaded.space))
    out.warn(
        fmt::format("{}: has {}, which gives light but no codes: results have sRGB colours, and those outside it "
                    "are clamped",
                    operand, loaded.space->name));
  return std::move(loaded.signal);
}

Signal in_rec709(Signal signal) {
  if (signal.meaning.are_codes) return signal;
  if (signal.meaning.space) convert_to_rec709(signal.image, *signal.meaning.space);
  signal.meaning.space = nullptr;
  return signal;
}

LinearImage load_texture(const std::string& operand, Delivery& out) {
  return load(operand, true, true, out).signal.image;
}

}  // namespace zoneplate::cli
