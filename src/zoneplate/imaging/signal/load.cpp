// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>
#include <variant>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_layer.h"
#include "zoneplate/codec/exr/exr_replace.h"
#include "zoneplate/codec/hdr.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/codec/inspect/several_images.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/codec/system/system_format.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/image/orientation.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/imaging/filter/still.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/process/exr_layer.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate {
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

bool is_light(std::span<const std::uint8_t> bytes) { return is_hdr(bytes) || is_exr(bytes) || is_pfm(bytes); }

/// Scene-linear light as it is stored.
LinearImage decode_light(const metrics::ImageFile& file, std::uint64_t max_pixels) {
  return is_hdr(file.bytes)   ? decode_hdr(file.bytes, file.name, max_pixels)
         : is_exr(file.bytes) ? decode_exr_as_stored(file.bytes, file.name, max_pixels, file.exr)
                              : decode_pfm(file.bytes, file.name, max_pixels);
}

/// What the values of an image are. Only colours have a space and an orientation.
enum class ImageContent { Colors, Data };

/// An image, and what of its file the decoder passed over.
struct Loaded {
  Signal signal;
  std::string flaw = {}, color_flaw = {};
  std::size_t filled = 0;    ///< pixels that were not finite
  std::string several = {};  ///< as several_images, of which it is the first
};

Loaded load_file(const std::string& operand, const SignalChoice& choice, ImageContent content,
                 std::uint64_t max_pixels) {
  metrics::ImageFile file = metrics::open_image(operand);
  file.exr = choice.exr;
  ImageColor color =
      content == ImageContent::Data ? ImageColor{.space = nullptr} : read_image_color(file.bytes, operand, file.exr);
  const bool is_png = !file.bytes.empty() && file.bytes[0] == 0x89;
  Loaded out{.signal = {}, .several = several_images(file.bytes)};
  if (is_light(file.bytes)) {
    LinearImage light = decode_light(file, max_pixels);
    out.filled = fill_not_finite(light, operand);
    out.signal = signal_of(std::move(light), color, choice.uses_codes);
  } else if (const SystemFormat* const format = find_system_format(file.bytes)) {
    StoredImage stored = format->decode(file.bytes, operand, max_pixels);
    if (content == ImageContent::Colors) color = color_of(stored, std::move(color), operand);
    const auto take = [&]<class Pixel>(Plane<Pixel>& pixels) {
      if constexpr (std::is_same_v<Pixel, Linear>) {
        pixels = oriented(std::move(pixels), color.orientation);
        out.filled = fill_not_finite(pixels, operand);
      }
      out.signal = signal_of(std::move(pixels), color, choice.uses_codes);
    };
    std::visit(take, stored.pixels);
  } else if (is_png) {
    PngImage png = decode_png_as_stored(file.bytes, operand, max_pixels);
    out.signal = png.pixels16.empty() ? signal_of(std::move(png.pixels), color, choice.uses_codes)
                                      : signal_of(std::move(png.pixels16), color, choice.uses_codes);
  } else {
    DecodedImage decoded = decode_image(file.bytes, operand, max_pixels);
    out.signal = signal_of(decoded.texels.as<Rgba8>(), color, choice.uses_codes);
    out.flaw = std::move(decoded.flaw);
  }
  out.color_flaw = color.flaw;
  out.signal.origin = {std::move(file), color.space};
  return out;
}

Loaded load(const std::string& operand, const SignalChoice& choice, ImageContent content, std::uint64_t max_pixels) {
  if (is_pattern(operand)) {
    if (!choice.exr.layer.empty())
      throw Error(ErrorKind::Usage, operand + ": is a pattern, expected an EXR image for --layer");
    return {signal_of(make_pattern(operand), {.space = nullptr}, choice.uses_codes)};
  }
  const MappedFileWatch watch;
  Loaded loaded = load_file(operand, choice, content, max_pixels);
  watch.check(operand);
  return loaded;
}

Signal load(const std::string& operand, const SignalChoice& choice, ImageContent content, Delivery& out) {
  Loaded loaded;
  out.read(operand, [&] { loaded = load(operand, choice, content, out.limits().pixels); });
  tell_layer(loaded.signal.origin.file, out);
  out.warn_of_flaw(loaded.flaw), out.warn_of_flaw(loaded.color_flaw);
  warn_of_filled(operand, loaded.filled, out);
  warn_of_others(operand, loaded.several, out);
  return std::move(loaded.signal);
}

/// The display window of an EXR with overscan, from the top left of its pixels; else all pixels.
ExrWindow display_window(const Signal& signal) {
  const metrics::ImageFile& file = signal.origin.file;
  if (file.exr.area == ExrArea::Display || !is_exr(file.bytes))
    return {0, 0, signal.image.width() - 1, signal.image.height() - 1};
  const std::vector<ExrPart> parts = read_exr_parts(file.bytes);
  const ExrPart& part = parts[static_cast<std::size_t>(choose_exr_layer(parts, file.exr.layer, file.name).part)];
  const ExrWindow whole = exr_whole_window(part), &display = part.display;
  return {display.left - whole.left, display.top - whole.top, display.right - whole.left, display.bottom - whole.top};
}

}  // namespace

void warn_of_others(const std::string& operand, const std::string& several, Delivery& out) {
  if (!several.empty()) out.warn(fmt::format("{}: {}, of which the first is taken", operand, several));
}

LinearImage load_signal(const std::string& operand, bool uses_codes, std::uint64_t max_pixels) {
  Loaded loaded = load(operand, {uses_codes}, ImageContent::Colors, max_pixels);
  if (!loaded.flaw.empty()) throw Error(ErrorKind::Input, loaded.flaw);
  return in_rec709(std::move(loaded.signal)).image;
}

LinearImage load_signal(const std::string& operand, const SignalChoice& choice, Delivery& out) {
  return in_rec709(load(operand, choice, ImageContent::Colors, out)).image;
}

Signal load_as_stored(const std::string& operand, const SignalChoice& choice, Delivery& out) {
  return load(operand, choice, ImageContent::Colors, out);
}

Signal in_rec709(Signal signal) {
  if (signal.meaning.are_codes) return signal;
  if (signal.meaning.space) convert_to_rec709(signal.image, *signal.meaning.space);
  signal.meaning.space = nullptr;
  return signal;
}

bool is_converted(const Signal& signal) {
  const bool are_codes_of_light = signal.meaning.are_codes && is_light(signal.origin.file.bytes);
  return are_codes_of_light || (signal.origin.space && !signal.meaning.space);
}

int2 displayed_size(const Signal& signal) {
  const ExrWindow window = display_window(signal);
  return {static_cast<int>(window.width()), static_cast<int>(window.height())};
}

void crop_to_display(Signal& signal) {
  signal.image = cropped_to(signal.image, display_window(signal));
  signal.origin.file.exr.area = ExrArea::Display;
}

LinearImage load_texture(const std::string& operand, const std::string& layer, Delivery& out) {
  return load(operand, {true, {layer}}, ImageContent::Data, out).image;
}

}  // namespace zoneplate
