// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/texture/levels.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "zoneplate/base/utf8.h"
#include "zoneplate/codec/inspect/several_images.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/image/half.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/imaging/signal/load.h"
#include "zoneplate/imaging/signal/show.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/process/exr_layer.h"
#include "zoneplate/shade/texture/texture_view.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate {
namespace {

/// Texels of an image, which may be the first of several (several_images).
struct LoadedTexels {
  DecodedImage image;
  std::string several = {};
};

LoadedTexels load_texels(const std::string& operand, const std::string& layer, Delivery& out) {
  if (is_pattern(operand)) return {{shown(make_pattern(operand), false)}};
  const MappedFileWatch watch;
  metrics::ImageFile file = metrics::open_image(operand);
  file.exr.layer = layer;
  DecodedImage image;
  if (is_pfm(file.bytes)) {
    const LinearImage light = decode_pfm(file.bytes, operand, out.limits().pixels);
    Plane<float4> texels(light.width(), light.height());
    std::ranges::transform(light.values(), texels.values().begin(), [](const Linear& c) {
      return float4{c.r, c.g, c.b, c.a};
    });
    image.texels = std::move(texels);
  } else {
    image = decode_image(file.bytes, operand, out.limits().pixels, layer);
  }
  tell_layer(file, out);
  std::string several = several_images(file.bytes);
  watch.check(operand);
  return {std::move(image), std::move(several)};
}

/// Texels of any format as display codes.
struct TexelCodes {
  const TextureView& texels;
  bool is_color;

  float value(std::int32_t index, int c) const {
    const std::ptrdiff_t at = std::ptrdiff_t{4} * index + c;
    if (texels.unorm8 != nullptr) return static_cast<float>(texels.unorm8[at]) / 255.0f;
    if (texels.unorm15 != nullptr) return static_cast<float>(texels.unorm15[at]) / 32767.0f;
    return texels.halves != nullptr ? half_value(texels.halves[at].bits) : texels.values[at];
  }
  Rgba8 operator()(std::int32_t index) const {
    const auto linear = [](float v) { return static_cast<std::uint8_t>(std::clamp(v, 0.0f, 1.0f) * 255 + 0.5f); };
    const auto code = [&](int c) { return is_color ? encode_srgb8(value(index, c)) : linear(value(index, c)); };
    return {code(0), code(1), code(2), linear(value(index, 3))};
  }
  std::int64_t bytes() const { return texels.unorm8 != nullptr ? 4 : texels.values != nullptr ? 16 : 8; }
  const char* kind() const {
    return texels.unorm8 != nullptr    ? "8-bit"
           : texels.unorm15 != nullptr ? "15-bit"
           : texels.halves != nullptr  ? "half"
                                       : "float";
  }
};

/// Copies a level to the image at (left, top); its texel (0, 0) has the index `first`.
void paint(const TexelCodes& codes, std::int32_t first, std::int32_t width, std::int32_t height, int left, int top,
           Rgba8Image& image) {
  for (std::int32_t y = 0; y < height; ++y)
    for (std::int32_t x = 0; x < width; ++x) image(left + x, top + y) = codes(first + y * (width + 2) + x);
}

/// Level 0 on the left, the others one below the other on its right.
Rgba8Image pyramid_of(const TextureView& view, bool is_color) {
  int right = view.levels > 1 ? view.width[1] : 0, below = 0;
  for (int l = 1; l < view.levels; ++l) below += view.height[l];
  Rgba8Image image(view.width[0] + right, std::max(view.height[0], below), Rgba8{0, 0, 0, 0});
  const TexelCodes codes{view, is_color};
  paint(codes, view.texel(0, 0, 0), view.width[0], view.height[0], 0, 0, image);
  int top = 0;
  for (int l = 1; l < view.levels; top += view.height[l++])
    paint(codes, view.texel(l, 0, 0), view.width[l], view.height[l], view.width[0], top, image);
  return image;
}

/// All pairs of reductions: along u to the right, along v downwards.
Rgba8Image ripmap_of(const RipmapView& r, bool is_color) {
  int width = 0, height = 0;
  for (int k = 0; k < r.columns; ++k) width += r.width[k];
  for (int l = 0; l < r.rows; ++l) height += r.height[l];
  Rgba8Image image(width, height);
  const TexelCodes codes{r.texels, is_color};
  int top = 0;
  for (int l = 0; l < r.rows; top += r.height[l++]) {
    int left = 0;
    for (int k = 0; k < r.columns; left += r.width[k++])
      paint(codes, r.offset[TextureView::max_levels * l + k] + r.width[k] + 3, r.width[k], r.height[l], left, top,
            image);
  }
  return image;
}

std::string bytes_text(std::int64_t bytes) {
  return bytes < 10'000 ? fmt::format("{} B", bytes) : fmt::format("{:.1f} KiB", static_cast<double>(bytes) / 1024);
}

/// Bytes of the texels, without their borders.
struct TexelMemory {
  std::int64_t first = 0, mips = 0, ripmap = 0, sums = 0;
};
TexelMemory memory_of(const TextureView& view, std::int64_t texel_bytes) {
  const auto all = [](std::int32_t size) {
    std::int64_t sum = 0;
    for (;; size /= 2) {
      sum += size;
      if (size == 1) return sum;
    }
  };
  TexelMemory m;
  for (int l = 0; l < view.levels; ++l) m.mips += std::int64_t{view.width[l]} * view.height[l] * texel_bytes;
  m.first = std::int64_t{view.width[0]} * view.height[0] * texel_bytes;
  m.ripmap = all(view.width[0]) * all(view.height[0]) * texel_bytes;
  m.sums = (std::int64_t{view.width[0]} + 1) * (view.height[0] + 1) * 32;
  return m;
}

/// The fraction of a level's texels whose alpha reaches the cutoff.
double coverage_of(const TextureView& view, int l, float cutoff) {
  const TexelCodes codes{view, false};
  std::int64_t passing = 0;
  for (std::int32_t y = 0; y < view.height[l]; ++y)
    for (std::int32_t x = 0; x < view.width[l]; ++x)
      if (codes.value(view.texel(l, x, y), 3) >= cutoff) ++passing;
  return static_cast<double>(passing) / (static_cast<double>(view.width[l]) * view.height[l]);
}

void print_levels(const TextureLevels& args, const std::string& input, const TextureView& view, Delivery& out) {
  const TexelCodes codes{view, false};
  const TexelMemory m = memory_of(view, codes.bytes());
  const auto ratio = [&](std::int64_t bytes) { return static_cast<double>(bytes) / static_cast<double>(m.first); };
  std::string text = fmt::format("{}, {} texels of four channels\n", printable(input), codes.kind());
  Json::Array levels;
  for (int l = 0; l < view.levels; ++l) {
    const std::int64_t bytes = std::int64_t{view.width[l]} * view.height[l] * codes.bytes();
    Json::Object row{{"width", view.width[l]}, {"height", view.height[l]}, {"bytes", static_cast<double>(bytes)}};
    text += fmt::format("  level {:<3}{:>12}{:>14}", l, fmt::format("{} × {}", view.width[l], view.height[l]),
                        bytes_text(bytes));
    if (args.options.kept_cutoff) {
      const double coverage = coverage_of(view, l, *args.options.kept_cutoff);
      text += fmt::format("   coverage {:.4f}", coverage);
      row.emplace_back("coverage", coverage);
    }
    text += '\n';
    levels.emplace_back(std::move(row));
  }
  text += fmt::format("mip levels {} ({:.3f} × level 0), ripmap {} ({:.3f} ×), summed-area table {} ({:.3f} ×)\n",
                      bytes_text(m.mips), ratio(m.mips), bytes_text(m.ripmap), ratio(m.ripmap), bytes_text(m.sums),
                      ratio(m.sums));
  print_result(args, text,
               {{"input", input},
                {"output", args.output},
                {"texels", codes.kind()},
                {"levels", std::move(levels)},
                {"mip_bytes", static_cast<double>(m.mips)},
                {"ripmap_bytes", static_cast<double>(m.ripmap)},
                {"summed_area_bytes", static_cast<double>(m.sums)}},
               out);
}

}  // namespace

void show_levels(const std::string& input, TextureLevels args, Delivery& out) {
  TexelImage texels;
  out.read(input, [&] {
    LoadedTexels loaded = load_texels(input, args.layer, out);
    out.warn_of_flaw(loaded.image.flaw);
    warn_of_others(input, loaded.several, out);
    texels = std::move(loaded.image.texels);
  });
  const bool is_color = args.meaning == TexelMeaning::Color;
  args.options.weights_by_alpha = args.weights_by_alpha && is_color;
  const Texture texture(std::move(texels), args.meaning, args.options);
  if (!args.output.empty())
    save_picture(args.output,
                 args.shows_ripmap ? ripmap_of(texture.ripmap(), is_color) : pyramid_of(texture.view(), is_color), out);
  print_levels(args, input, texture.view(), out);
}

}  // namespace zoneplate
