#include "zoneplate/shade/texture.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

constexpr std::size_t rows_per_range = 32;

/// The texels of one axis that a texel of the next level covers: `count` of them from `first`, by integer weights.
struct Cover {
  std::int32_t first, count;
  std::uint64_t weight[3];
};

/// Along an axis of n texels. The weights sum to `total_weight(n)`.
Cover cover(std::int32_t n, std::int32_t i) {
  if (n == 1) return {0, 1, {1, 0, 0}};
  if (n % 2 == 0) return {2 * i, 2, {1, 1, 0}};
  const std::int32_t half = n / 2;
  return {2 * i,
          3,
          {static_cast<std::uint64_t>(half - i), static_cast<std::uint64_t>(half), static_cast<std::uint64_t>(i + 1)}};
}

std::uint64_t total_weight(std::int32_t n) { return n == 1 ? 1 : n % 2 == 0 ? 2 : static_cast<std::uint64_t>(n); }

struct Size {
  std::int32_t width, height;
};

/// Around a row of the level: copies of its last and its first texel.
template <class Code>
void close_row(Code* row, std::int32_t width) {
  std::copy_n(row, 4, row + std::ptrdiff_t{4} * width);
  std::copy_n(row + std::ptrdiff_t{4} * (width - 1), 4, row - 4);
}

/// Above and below a level whose rows are closed: copies of its last and its first row.
template <class Code>
void close_level(Code* codes, const TextureView& view, int l) {
  const std::ptrdiff_t pitch = std::ptrdiff_t{4} * view.pitch(l);
  Code* const level = codes + std::ptrdiff_t{4} * view.offset[l];
  std::copy_n(level + pitch * view.height[l], pitch, level);
  std::copy_n(level + pitch, pitch, level + pitch * (view.height[l] + 1));
}

/// Texel (0, y) of a level.
template <class Code>
Code* row_of(Code* codes, const TextureView& view, int l, std::size_t y) {
  return codes + std::ptrdiff_t{4} * view.texel(l, 0, static_cast<std::int32_t>(y));
}

/// Both sizes even: the mean of four.
template <class Code>
void halve_row(const Code* upper, const Code* lower, std::int32_t out_width, Code* out) {
  for (std::int32_t x = 0; x < out_width; ++x)
    for (int c = 0; c < 4; ++c) {
      const std::ptrdiff_t at = std::ptrdiff_t{8} * x + c;
      const std::uint32_t sum = std::uint32_t{upper[at]} + upper[at + 4] + lower[at] + lower[at + 4];
      out[std::ptrdiff_t{4} * x + c] = static_cast<Code>((sum + 2) >> 2);
    }
}

/// Any size: weighted means.
template <class Code>
void shrink_row(const Code* source, Size size, std::int32_t y, std::int32_t out_width, Code* out) {
  const Cover rows = cover(size.height, y);
  const std::uint64_t total = total_weight(size.width) * total_weight(size.height);
  for (std::int32_t x = 0; x < out_width; ++x) {
    const Cover columns = cover(size.width, x);
    for (int c = 0; c < 4; ++c) {
      std::uint64_t sum = total / 2;
      for (std::int32_t j = 0; j < rows.count; ++j)
        for (std::int32_t i = 0; i < columns.count; ++i) {
          const std::ptrdiff_t texel = std::ptrdiff_t{rows.first + j} * (size.width + 2) + columns.first + i;
          sum += rows.weight[j] * columns.weight[i] * source[4 * texel + c];
        }
      out[std::ptrdiff_t{4} * x + c] = static_cast<Code>(sum / total);
    }
  }
}

/// Makes all levels from level 0, each from the one before.
template <class Code>
void make_levels(Code* codes, const TextureView& view) {
  for (std::int32_t l = 1; l < view.levels; ++l) {
    const Size size{view.width[l - 1], view.height[l - 1]}, out_size{view.width[l], view.height[l]};
    const Code* source = row_of(codes, view, l - 1, 0);
    const bool is_even = size.width % 2 == 0 && size.height % 2 == 0;
    parallel_ranges(static_cast<std::size_t>(out_size.height), rows_per_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) {
        Code* out = row_of(codes, view, l, y);
        if (is_even) {
          halve_row(row_of(codes, view, l - 1, 2 * y), row_of(codes, view, l - 1, 2 * y + 1), out_size.width, out);
        } else {
          shrink_row(source, size, static_cast<std::int32_t>(y), out_size.width, out);
        }
        close_row(out, out_size.width);
      }
    });
    close_level(codes, view, l);
  }
}

/// Fills the sizes and offsets of all levels; gives the number of texels, with those that are only read.
std::size_t lay_out(int width, int height, TextureView& view) {
  std::int64_t texels = 0;
  for (std::int32_t w = width, h = height;; w = std::max(1, w / 2), h = std::max(1, h / 2)) {
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

/// Each 8-bit sRGB code as 15-bit linear light. Neighbouring codes differ by 9 or more, so none is lost.
std::array<std::uint16_t, 256> linear_codes() {
  std::array<std::uint16_t, 256> table;
  for (int code = 0; code < 256; ++code)
    table[static_cast<std::size_t>(code)] =
        static_cast<std::uint16_t>(32767.0f * decode_srgb8(static_cast<std::uint8_t>(code)) + 0.5f);
  return table;
}

/// Half as wide, or as high: the rounded mean of two.
Rgba8Image halved(const Rgba8Image& image, bool in_x) {
  Rgba8Image half(in_x ? image.width() / 2 : image.width(), in_x ? image.height() : image.height() / 2);
  for (int y = 0; y < half.height(); ++y)
    for (int x = 0; x < half.width(); ++x) {
      const Rgba8 p = in_x ? image(2 * x, y) : image(x, 2 * y), q = in_x ? image(2 * x + 1, y) : image(x, 2 * y + 1);
      const auto mean = [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>((a + b + 1) / 2); };
      half(x, y) = {mean(p.r, q.r), mean(p.g, q.g), mean(p.b, q.b), mean(p.a, q.a)};
    }
  return half;
}

/// The image, halved along an axis until that fits.
Rgba8Image fitted(Rgba8Image image) {
  while (image.width() > TextureView::max_size) image = halved(image, true);
  while (image.height() > TextureView::max_size) image = halved(image, false);
  return image;
}

}  // namespace

Texture::Texture(const Rgba8Image& image, TexelMeaning meaning) {
  const Rgba8Image white(1, 1, Rgba8{255, 255, 255, 255});
  const bool fits = std::max(image.width(), image.height()) <= TextureView::max_size;
  const Rgba8Image smaller = fits ? Rgba8Image() : fitted(image);
  const Rgba8Image& source = image.empty() ? white : fits ? image : smaller;
  const std::size_t codes = 4 * lay_out(source.width(), source.height(), view_);
  const std::size_t width = static_cast<std::size_t>(source.width());
  const std::size_t height = static_cast<std::size_t>(source.height());

  // Level 0 is the image itself, decoded where it holds colours.
  const auto fill = [&](auto* target, const auto& decode, const auto& widen) {
    parallel_ranges(height, rows_per_range, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) {
        const auto row = source.row(static_cast<int>(y));
        for (std::size_t x = 0; x < width; ++x) {
          auto* out = row_of(target, view_, 0, y) + 4 * x;
          out[0] = decode(row[x].r), out[1] = decode(row[x].g), out[2] = decode(row[x].b), out[3] = widen(row[x].a);
        }
        close_row(row_of(target, view_, 0, y), source.width());
      }
    });
    close_level(target, view_, 0);
  };
  // Between the last level and the end lie two texels that may be read.
  const auto room = [&](auto* type) {
    auto* const first = reinterpret_cast<decltype(type)>(codes_.room(codes * sizeof(*type)));
    std::fill_n(first + codes - 8, 8, 0);
    return first;
  };
  if (meaning == TexelMeaning::Color) {
    std::uint16_t* const target = room(static_cast<std::uint16_t*>(nullptr));
    view_.codes15 = target;
    const auto table = linear_codes();
    const auto widen = [](std::uint8_t code) { return static_cast<std::uint16_t>((code * 32767 + 127) / 255); };
    fill(
        target, [&](std::uint8_t code) { return table[code]; }, widen);
    make_levels(target, view_);
  } else {
    std::uint8_t* const target = room(static_cast<std::uint8_t*>(nullptr));
    view_.codes8 = target;
    const auto same = [](std::uint8_t code) { return code; };
    fill(target, same, same);
    make_levels(target, view_);
  }
}

}  // namespace zoneplate
