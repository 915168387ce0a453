// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/texture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <type_traits>
#include <utility>
#include <vector>

#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/half.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/scene/material.h"
#include "zoneplate/shade/texture/growing_memory.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

static_assert(TextureView::max_size == TextureImage::most_side);

constexpr std::size_t rows_per_range = 32;

struct Size {
  std::int32_t width, height;
  bool operator==(const Size&) const = default;
};

/// A sum of weighted texels, and its mean: exact for unorm texels, rounded to the nearest.
template <class Code>
using Sum = std::conditional_t<std::is_integral_v<Code>, std::uint64_t, double>;

/// The texel as a term of a sum.
template <class Code>
Code term(Code code) {
  return code;
}
float term(Half half) { return half_value(half.bits); }

/// A mean as a texel of floats or half floats.
template <class Code>
Code rounded(double mean) {
  if constexpr (std::is_same_v<Code, Half>)
    return {half_bits(static_cast<float>(mean))};
  else
    return static_cast<Code>(mean);
}

template <class Code>
Code mean_of(Sum<Code> sum, std::uint64_t total) {
  if constexpr (std::is_integral_v<Code>)
    return static_cast<Code>((sum + total / 2) / total);
  else
    return rounded<Code>(sum / static_cast<double>(total));
}

/// The texels of one axis that a texel of a smaller image covers: `count` of them from `first`, by integer weights.
struct Cover {
  std::int32_t first, count;
  std::uint64_t weight[3];
};

/// The texels along an axis of n texels that is reduced to `to` texels: n, or n / 2 rounded down. The weights add up to
/// `total_weight(n, to)`.
Cover cover(std::int32_t n, std::int32_t to, std::int32_t i) {
  if (n == to) return {i, 1, {1, 0, 0}};
  if (n % 2 == 0) return {2 * i, 2, {1, 1, 0}};
  const std::int32_t half = n / 2;
  return {2 * i,
          3,
          {static_cast<std::uint64_t>(half - i), static_cast<std::uint64_t>(half), static_cast<std::uint64_t>(i + 1)}};
}

std::uint64_t total_weight(std::int32_t n, std::int32_t to) {
  return n == to ? 1 : n % 2 == 0 ? 2 : static_cast<std::uint64_t>(n);
}

/// Fills the border of a row with copies of its last and its first texel.
template <class Code>
void close_row(Code* row, std::int32_t width) {
  std::copy_n(row, 4, row + std::ptrdiff_t{4} * width);
  std::copy_n(row + std::ptrdiff_t{4} * (width - 1), 4, row - 4);
}

/// Fills the border above and below a level, whose rows have theirs, with copies of its last and its first row.
template <class Code>
void close_level(Code* codes, const TextureView& view, int l) {
  const std::ptrdiff_t pitch = std::ptrdiff_t{4} * view.pitch(l);
  Code* const level = codes + std::ptrdiff_t{4} * view.offset[l];
  std::copy_n(level + pitch * view.height[l], pitch, level);
  std::copy_n(level + pitch, pitch, level + pitch * (view.height[l] + 1));
}

/// Texel (0, y) of a level.
template <class Code>
Code* row_of(Code* codes, const TextureView& view, int l, std::int32_t y) {
  return codes + std::ptrdiff_t{4} * view.texel(l, 0, y);
}

/// Both sizes even: the mean of four.
template <class Code>
void halve_row(const Code* upper, const Code* lower, std::int32_t out_width, Code* out) {
  using Four = std::conditional_t<std::is_integral_v<Code>, std::uint32_t, double>;
  for (std::int32_t x = 0; x < out_width; ++x)
    for (int c = 0; c < 4; ++c) {
      const std::ptrdiff_t at = std::ptrdiff_t{8} * x + c;
      const Four sum = Four{term(upper[at])} + term(upper[at + 4]) + term(lower[at]) + term(lower[at + 4]);
      if constexpr (std::is_integral_v<Code>)
        out[std::ptrdiff_t{4} * x + c] = static_cast<Code>((sum + 2) >> 2);
      else
        out[std::ptrdiff_t{4} * x + c] = rounded<Code>(sum * 0.25);
    }
}

/// Any size: row y of the smaller image, as weighted means of the rows that it covers.
template <class Code>
void shrink_row(const std::array<const Code*, 3>& source, const Cover& rows, Size from, Size to, Code* out) {
  const std::uint64_t total = total_weight(from.width, to.width) * total_weight(from.height, to.height);
  for (std::int32_t x = 0; x < to.width; ++x) {
    const Cover columns = cover(from.width, to.width, x);
    for (int c = 0; c < 4; ++c) {
      Sum<Code> sum = 0;
      for (std::size_t j = 0; j < static_cast<std::size_t>(rows.count); ++j)
        for (std::int32_t i = 0; i < columns.count; ++i)
          sum += static_cast<Sum<Code>>(rows.weight[j] * columns.weight[i]) *
                 term(source[j][std::ptrdiff_t{4} * (columns.first + i) + c]);
      out[std::ptrdiff_t{4} * x + c] = mean_of<Code>(sum, total);
    }
  }
}

/// The rows that row y of the smaller image covers, each as `row(y, its index among them)`.
template <class Code, class Row>
std::array<const Code*, 3> covered_rows(const Cover& rows, const Row& row) {
  std::array<const Code*, 3> source{};
  for (std::int32_t j = 0; j < rows.count; ++j) source[static_cast<std::size_t>(j)] = row(rows.first + j, j);
  return source;
}

/// The image at a smaller size. `row(y, buffer)` returns row y of the image, for which `buffer` has the capacity.
template <class Code, class Row>
std::vector<Code> shrunk(Size from, Size to, const Row& row) {
  const std::size_t width = std::size_t{4} * static_cast<std::size_t>(from.width);
  const std::size_t out_width = std::size_t{4} * static_cast<std::size_t>(to.width);
  std::vector<Code> out(out_width * static_cast<std::size_t>(to.height));
  parallel_ranges(static_cast<std::size_t>(to.height), rows_per_range, [&](std::size_t begin, std::size_t end) {
    std::vector<Code> buffer(3 * width);
    for (std::size_t y = begin; y < end; ++y) {
      const Cover rows = cover(from.height, to.height, static_cast<std::int32_t>(y));
      const auto source = covered_rows<Code>(rows, [&](std::int32_t at, std::int32_t number) {
        return row(at, buffer.data() + width * static_cast<std::size_t>(number));
      });
      shrink_row(source, rows, from, to, out.data() + out_width * y);
    }
  });
  return out;
}

/// Half of each side that is longer than a level may be.
Size fitted(Size size) {
  const auto part = [](std::int32_t n) { return n > TextureView::max_size ? n / 2 : n; };
  return {part(size.width), part(size.height)};
}

/// Sets the sizes and offsets of all levels; returns the number of texels, including borders and padding.
std::size_t lay_out(Size size, TextureView& view) {
  std::int64_t texels = 0;
  for (std::int32_t w = size.width, h = size.height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
    view.width[view.levels] = w;
    view.height[view.levels] = h;
    view.offset[view.levels++] = static_cast<std::int32_t>(texels);
    texels += (std::int64_t{w} + 2) * (h + 2);
    if (w == 1 && h == 1) break;
  }
  texels += 2;
  assert(texels < (std::int64_t{1} << 31));
  return static_cast<std::size_t>(texels);
}

/// Each 8-bit sRGB value as 15-bit linear light. Neighbouring values differ by 9 or more, so that none is lost.
std::array<std::uint16_t, 256> linear_codes() {
  std::array<std::uint16_t, 256> table;
  for (int code = 0; code < 256; ++code)
    table[static_cast<std::size_t>(code)] =
        static_cast<std::uint16_t>(32767.0f * decode_srgb8(static_cast<std::uint8_t>(code)) + 0.5f);
  return table;
}

/// The value clamped to [0, most]; NaN gives 0.
float clamped(float value, float most) { return value > 0 ? std::min(value, most) : 0.0f; }

float value_of(std::uint16_t code) { return static_cast<float>(code) / 65535.0f; }

/// The texel of scene-linear colours and alpha, each within the range of a texture.
float4 clamped(const float4& p, float most) {
  return {clamped(p.x, most), clamped(p.y, most), clamped(p.z, most), clamped(p.w, 1)};
}

bool is_half(float value) { return half_value(half_bits(value)) == value; }

/// True if half floats represent every clamped texel exactly.
bool are_halves(const Plane<float4>& image, float most) {
  std::atomic<bool> all = true;
  parallel_ranges(static_cast<std::size_t>(image.height()), rows_per_range, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end && all.load(std::memory_order_relaxed); ++y)
      if (!std::ranges::all_of(image.row(static_cast<int>(y)), [&](const float4& p) {
            const float4 v = clamped(p, most);
            return is_half(v.x) && is_half(v.y) && is_half(v.z) && is_half(v.w);
          }))
        all.store(false, std::memory_order_relaxed);
  });
  return all;
}

}  // namespace

struct Texture::Levels {
  void make_first_level(const TexelImage& image, TexelMeaning meaning);
  void make_other_levels();
  template <class Code, class Pixel, class Decode>
  void fill(const Plane<Pixel>& image, const Code* TextureView::*texels, const Decode& decode);
  template <class Code>
  void make_levels(const Code* TextureView::*texels);

  GrowingMemory memory;
  std::size_t count = 0;  ///< of the texels of all levels, with what may be read after them
  TextureView view;
};

template <class Code, class Pixel, class Decode>
void Texture::Levels::fill(const Plane<Pixel>& image, const Code* TextureView::*texels, const Decode& decode) {
  const auto decode_row = [&](std::int32_t y, Code* out) {
    for (const Pixel& p : image.row(y)) decode(p, out), out += 4;
  };
  // An image that is too large for level 0 is reduced while it is copied.
  Size size{image.width(), image.height()};
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

  count = lay_out(size, view);
  memory = GrowingMemory(count * 4 * sizeof(Code));
  memory.grow(view.levels > 1 ? static_cast<std::size_t>(view.offset[1]) * 4 * sizeof(Code) : count * 4 * sizeof(Code));
  auto* const target = reinterpret_cast<Code*>(memory.data());
  view.*texels = target;
  parallel_ranges(static_cast<std::size_t>(size.height), rows_per_range, [&](std::size_t begin, std::size_t end) {
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
void Texture::Levels::make_levels(const Code* TextureView::*texels) {
  if (view.*texels == nullptr) return;
  memory.grow(count * 4 * sizeof(Code));
  auto* const codes = reinterpret_cast<Code*>(memory.data());
  for (std::int32_t l = 1; l < view.levels; ++l) {
    const Size from{view.width[l - 1], view.height[l - 1]}, to{view.width[l], view.height[l]};
    const bool is_even = from.width % 2 == 0 && from.height % 2 == 0;
    parallel_ranges(static_cast<std::size_t>(to.height), rows_per_range, [&](std::size_t begin, std::size_t end) {
      for (auto y = static_cast<std::int32_t>(begin); y < static_cast<std::int32_t>(end); ++y) {
        Code* const out = row_of(codes, view, l, y);
        const Cover rows = cover(from.height, to.height, y);
        const auto source =
            covered_rows<Code>(rows, [&](std::int32_t at, std::int32_t) { return row_of(codes, view, l - 1, at); });
        if (is_even)
          halve_row(source[0], source[1], to.width, out);
        else
          shrink_row(source, rows, from, to, out);
        close_row(out, to.width);
      }
    });
    close_level(codes, view, l);
  }
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
    const float most = is_color ? 1e9f : 1.0f;
    const Plane<float4>& light = image.as<float4>();
    if (are_halves(light, most))
      return fill(light, &TextureView::halves, [&](const float4& p, Half* out) {
        const float4 v = clamped(p, most);
        out[0] = {half_bits(v.x)}, out[1] = {half_bits(v.y)}, out[2] = {half_bits(v.z)}, out[3] = {half_bits(v.w)};
      });
    return fill(light, &TextureView::values, [&](const float4& p, float* out) {
      const float4 v = clamped(p, most);
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
void Texture::Levels::make_other_levels() {
  make_levels(&TextureView::unorm8);
  make_levels(&TextureView::unorm15);
  make_levels(&TextureView::halves);
  make_levels(&TextureView::values);
}

Texture::Texture(const TexelImage& image, TexelMeaning meaning) : levels_(std::make_unique<Levels>()) {
  growing("texture levels", [&] {
    levels_->make_first_level(image, meaning);
    levels_->make_other_levels();
  });
}

Texture::Texture(TexelImage&& image, TexelMeaning meaning) : levels_(std::make_unique<Levels>()) {
  growing("texture levels", [&] {
    levels_->make_first_level(image, meaning);
    image = TexelImage();
    levels_->make_other_levels();
  });
}

Texture::~Texture() = default;
Texture::Texture(Texture&& other) noexcept = default;
Texture& Texture::operator=(Texture&& other) noexcept = default;

const TextureView& Texture::view() const { return levels_->view; }

}  // namespace zoneplate
