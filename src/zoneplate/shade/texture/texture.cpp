// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/texture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <type_traits>
#include <utility>
#include <vector>

#include "zoneplate/base/made_once.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/half.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/shade/texture/growing_memory.h"
#include "zoneplate/shade/texture/mip_levels.h"
#include "zoneplate/shade/texture/shrinking.h"
#include "zoneplate/shade/texture/tables.h"
#include "zoneplate/shade/texture/texel_values.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

static_assert(TextureView::max_size == TextureImage::max_side);

/// The image at a smaller size. `row(y, buffer)` returns row y of the image, for which `buffer` has the capacity.
template <class Code, class Row>
std::vector<Code> shrunk(LevelSize from, LevelSize to, const Row& row) {
  const std::size_t width = std::size_t{4} * static_cast<std::size_t>(from.width);
  const std::size_t out_width = std::size_t{4} * static_cast<std::size_t>(to.width);
  std::vector<Code> out(out_width * static_cast<std::size_t>(to.height));
  parallel_ranges(static_cast<std::size_t>(to.height), texel_rows_per_range, [&](std::size_t begin, std::size_t end) {
    std::vector<Code> buffer(3 * width);
    for (std::size_t y = begin; y < end; ++y) {
      const TexelCover rows = cover(from.height, to.height, static_cast<std::int32_t>(y));
      const auto source = covered_rows<Code>(rows, [&](std::int32_t at, std::int32_t number) {
        return row(at, buffer.data() + width * static_cast<std::size_t>(number));
      });
      shrink_row(source, rows, from, to, out.data() + out_width * y);
    }
  });
  return out;
}

/// Half of each side that is longer than a level may be.
LevelSize fitted(LevelSize size) {
  const auto part = [](std::int32_t n) { return n > TextureView::max_size ? n / 2 : n; };
  return {part(size.width), part(size.height)};
}

/// Sets the sizes and offsets of all levels.
void lay_out(LevelSize size, TextureView& view) {
  std::int64_t texels = 0;
  for (std::int32_t w = size.width, h = size.height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
    view.width[view.levels] = w;
    view.height[view.levels] = h;
    view.offset[view.levels++] = static_cast<std::int32_t>(texels);
    texels += std::int64_t{RowPitch::of(w)} * (h + 2);
    if (w == 1 && h == 1) break;
  }
  assert(texels + 2 < (std::int64_t{1} << 31));
}

/// Each 8-bit sRGB value as 15-bit linear light. Neighbouring values differ by 9 or more, so that none is lost.
std::array<std::uint16_t, 256> linear_codes() {
  std::array<std::uint16_t, 256> table;
  for (int code = 0; code < 256; ++code)
    table[static_cast<std::size_t>(code)] =
        static_cast<std::uint16_t>(32767.0f * decode_srgb8(static_cast<std::uint8_t>(code)) + 0.5f);
  return table;
}

float value_of(std::uint16_t code) { return static_cast<float>(code) / 65535.0f; }

/// The texel of scene-linear colours and alpha, each within the range of a texture.
float4 clamped_texel(const float4& p, float most) {
  return {clamped(p.x, most), clamped(p.y, most), clamped(p.z, most), clamped(p.w, 1)};
}

bool is_half(float value) { return half_value(half_bits(value)) == value; }

/// True if half floats represent every clamped texel exactly.
bool are_halves(const Plane<float4>& image, float most) {
  std::atomic<bool> all = true;
  parallel_ranges(static_cast<std::size_t>(image.height()), texel_rows_per_range,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t y = begin; y < end && all.load(std::memory_order_relaxed); ++y)
                      if (!std::ranges::all_of(image.row(static_cast<int>(y)), [&](const float4& p) {
                            const float4 v = clamped_texel(p, most);
                            return is_half(v.x) && is_half(v.y) && is_half(v.z) && is_half(v.w);
                          }))
                        all.store(false, std::memory_order_relaxed);
                  });
  return all;
}

}  // namespace

struct Texture::Levels {
  void make_first_level(const TexelImage& image, TexelMeaning meaning);
  void make_other_levels(const LevelOptions& options);
  template <class Code, class Pixel, class Decode>
  void fill(const Plane<Pixel>& image, const Code* TextureView::*texels, const Decode& decode);
  template <class Code>
  void make_levels(const Code* TextureView::*texels, const LevelOptions& options);

  GrowingMemory memory;
  TextureView view;

  MadeOnce<RipmapTable> ripmap;
  MadeOnce<SumsTable> sums;
  MadeOnce<NormalSpread> normal_spread;
};

template <class Code, class Pixel, class Decode>
void Texture::Levels::fill(const Plane<Pixel>& image, const Code* TextureView::*texels, const Decode& decode) {
  const auto decode_row = [&](std::int32_t y, Code* out) {
    for (const Pixel& p : image.row(y)) decode(p, out), out += 4;
  };
  // An image that is too large for level 0 is reduced while it is copied.
  LevelSize size{image.width(), image.height()};
  std::vector<Code> smaller;
  if (fitted(size) != size) {
    smaller = shrunk<Code>(size, fitted(size), [&](std::int32_t y, Code* buffer) {
      decode_row(y, buffer);
      return buffer;
    });
    size = fitted(size);
  }
  const auto row_of_smaller = [&](std::int32_t y) { return smaller.data() + std::ptrdiff_t{4} * size.width * y; };
  while (fitted(size) != size) {
    std::vector<Code> half =
        shrunk<Code>(size, fitted(size), [&](std::int32_t y, const Code*) { return row_of_smaller(y); });
    smaller = std::move(half), size = fitted(size);
  }

  lay_out(size, view);
  const std::size_t count = texel_count(view);
  memory = GrowingMemory(count * 4 * sizeof(Code));
  memory.grow(view.levels > 1 ? static_cast<std::size_t>(view.offset[1]) * 4 * sizeof(Code) : count * 4 * sizeof(Code));
  auto* const target = reinterpret_cast<Code*>(memory.data());
  view.*texels = target;
  parallel_ranges(static_cast<std::size_t>(size.height), texel_rows_per_range, [&](std::size_t begin, std::size_t end) {
    for (auto y = static_cast<std::int32_t>(begin); y < static_cast<std::int32_t>(end); ++y) {
      Code* const row = row_of(target, view, 0, y);
      if (smaller.empty())
        decode_row(y, row);
      else
        std::copy_n(row_of_smaller(y), std::ptrdiff_t{4} * size.width, row);
      close_row(row, size.width);
    }
  });
  close_level(target, view, 0);
}

/// Makes all levels from level 0, each from the level before it.
template <class Code>
void Texture::Levels::make_levels(const Code* TextureView::*texels, const LevelOptions& options) {
  if (view.*texels == nullptr) return;
  memory.grow(texel_count(view) * 4 * sizeof(Code));
  make_mip_levels(reinterpret_cast<Code*>(memory.data()), view, options);
}

void Texture::Levels::make_first_level(const TexelImage& image, TexelMeaning meaning) {
  const bool is_color = meaning == TexelMeaning::Color;
  if (image.kind() == TexelKind::Codes16 && !image.empty()) {
    const std::vector<float> table = is_color ? decoded_srgb16() : std::vector<float>();
    const auto value = [&](std::uint16_t code) { return is_color ? table[code] : value_of(code); };
    return fill(image.as<Rgba16>(), &TextureView::values, [&](const Rgba16& p, float* out) {
      out[0] = value(p.r), out[1] = value(p.g), out[2] = value(p.b), out[3] = value_of(p.a);
    });
  }
  if (image.kind() == TexelKind::Light && !image.empty()) {
    const float most = view.most = is_color ? 1e9f : 1.0f;
    const Plane<float4>& light = image.as<float4>();
    if (are_halves(light, most))
      return fill(light, &TextureView::halves, [&](const float4& p, Half* out) {
        const float4 v = clamped_texel(p, most);
        out[0] = {half_bits(v.x)}, out[1] = {half_bits(v.y)}, out[2] = {half_bits(v.z)}, out[3] = {half_bits(v.w)};
      });
    return fill(light, &TextureView::values, [&](const float4& p, float* out) {
      const float4 v = clamped_texel(p, most);
      out[0] = v.x, out[1] = v.y, out[2] = v.z, out[3] = v.w;
    });
  }
  const Rgba8Image white(1, 1, Rgba8{255, 255, 255, 255});
  const Rgba8Image& codes = image.empty() ? white : image.as<Rgba8>();
  if (!is_color)
    return fill(codes, &TextureView::unorm8,
                [](const Rgba8& p, std::uint8_t* out) { out[0] = p.r, out[1] = p.g, out[2] = p.b, out[3] = p.a; });
  const auto table = linear_codes();
  fill(codes, &TextureView::unorm15, [&](const Rgba8& p, std::uint16_t* out) {
    out[0] = table[p.r], out[1] = table[p.g], out[2] = table[p.b];
    out[3] = static_cast<std::uint16_t>((p.a * 32767 + 127) / 255);
  });
}

/// Exactly one of the four is present.
void Texture::Levels::make_other_levels(const LevelOptions& options) {
  make_levels(&TextureView::unorm8, options);
  make_levels(&TextureView::unorm15, options);
  make_levels(&TextureView::halves, options);
  make_levels(&TextureView::values, options);
}

Texture::Texture(const TexelImage& image, TexelMeaning meaning, const LevelOptions& options)
    : levels_(std::make_unique<Levels>()) {
  growing("texture levels", [&] {
    levels_->make_first_level(image, meaning);
    levels_->make_other_levels(options);
  });
}

Texture::Texture(TexelImage&& image, TexelMeaning meaning, const LevelOptions& options)
    : levels_(std::make_unique<Levels>()) {
  growing("texture levels", [&] {
    levels_->make_first_level(image, meaning);
    image = TexelImage();
    levels_->make_other_levels(options);
  });
}

Texture::~Texture() = default;
Texture::Texture(Texture&& other) noexcept = default;
Texture& Texture::operator=(Texture&& other) noexcept = default;

const TextureView& Texture::view() const { return levels_->view; }

const RipmapView& Texture::ripmap() const {
  const auto make = [&] { return growing("ripmap levels", [&] { return make_ripmap(levels_->view); }); };
  return levels_->ripmap.value(make).view;
}

const SumsView& Texture::sums() const {
  const auto make = [&] { return growing("summed-area tables", [&] { return make_sums(levels_->view); }); };
  return levels_->sums.value(make).view;
}

const TextureView& Texture::normal_spread() const {
  const auto make = [&] { return growing("normal variances", [&] { return make_normal_spread(levels_->view); }); };
  return levels_->normal_spread.value(make).view;
}

}  // namespace zoneplate