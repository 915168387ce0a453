// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/texture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <mutex>
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
#include "zoneplate/signal/filter/resample.h"

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

/// The value of a texel, and the texel of a value, clamped to the texture's range.
template <class Code>
constexpr float unit_of = std::is_same_v<Code, std::uint8_t>    ? 1.0f / 255.0f
                          : std::is_same_v<Code, std::uint16_t> ? 1.0f / 32767.0f
                                                                : 1.0f;
template <class Code>
Code code_of(float value, float most) {
  const float inside = clamped(value, most);
  if constexpr (std::is_same_v<Code, std::uint8_t>)
    return static_cast<Code>(inside * 255.0f + 0.5f);
  else if constexpr (std::is_same_v<Code, std::uint16_t>)
    return static_cast<Code>(inside * 32767.0f + 0.5f);
  else if constexpr (std::is_same_v<Code, Half>)
    return {half_bits(std::min(inside, 65504.0f))};
  else
    return inside;
}

Border border_of(Wrap wrap) {
  return wrap == Wrap::Repeat ? Border::Wrap : wrap == Wrap::Mirror ? Border::Reflect : Border::Clamp;
}

/// Makes level l from the level before it, by a kernel with negative lobes.
template <class Code>
void filter_level(Code* codes, const TextureView& view, std::int32_t l, const LevelOptions& options) {
  static const Kernel kaiser = make_kernel("kaiser"), lanczos = make_kernel("lanczos3");
  const Kernel& kernel = options.filter == MipFilter::Kaiser ? kaiser : lanczos;
  const Size from{view.width[l - 1], view.height[l - 1]}, to{view.width[l], view.height[l]};
  LinearImage image(from.width, from.height);
  for (std::int32_t y = 0; y < from.height; ++y) {
    const Code* texel = row_of(codes, view, l - 1, y);
    for (Linear& p : image.row(y)) {
      const auto value = [&](int c) { return static_cast<float>(term(texel[c])) * unit_of<Code>; };
      p = {value(0), value(1), value(2), value(3)};
      texel += 4;
    }
  }
  // One direction after the other, since the borders may differ.
  const LinearImage wide = resample(image, to.width, from.height, kernel, {.border = border_of(options.wrap_u)});
  const LinearImage small = resample(wide, to.width, to.height, kernel, {.border = border_of(options.wrap_v)});
  for (std::int32_t y = 0; y < to.height; ++y) {
    Code* const row = row_of(codes, view, l, y);
    Code* texel = row;
    for (const Linear& p : small.row(y)) {
      texel[0] = code_of<Code>(p.r, view.most), texel[1] = code_of<Code>(p.g, view.most);
      texel[2] = code_of<Code>(p.b, view.most), texel[3] = code_of<Code>(p.a, 1);
      texel += 4;
    }
    close_row(row, to.width);
  }
}

/// The alphas of a level's texels, ascending.
template <class Code>
std::vector<float> sorted_alphas(const Code* codes, const TextureView& view, std::int32_t l) {
  std::vector<float> alphas;
  for (std::int32_t y = 0; y < view.height[l]; ++y) {
    const Code* const row = row_of(const_cast<Code*>(codes), view, l, y);
    for (std::int32_t x = 0; x < view.width[l]; ++x)
      alphas.push_back(static_cast<float>(term(row[std::ptrdiff_t{4} * x + 3])) * unit_of<Code>);
  }
  std::ranges::sort(alphas);
  return alphas;
}

/// Scales the alpha of each level but the first so that the fraction of its texels that reach the cutoff is that of
/// level 0, to the nearest texel. Source: Castaño, Computing Alpha Mipmaps, 2010.
template <class Code>
void keep_coverage(Code* codes, const TextureView& view, float cutoff) {
  if (!(cutoff > 0 && cutoff <= 1)) return;
  const std::vector<float> first = sorted_alphas(codes, view, 0);
  const auto passing = static_cast<double>(first.end() - std::ranges::lower_bound(first, cutoff));
  const double coverage = passing / static_cast<double>(first.size());
  for (std::int32_t l = 1; l < view.levels; ++l) {
    const std::vector<float> alphas = sorted_alphas(codes, view, l);
    const auto wanted = static_cast<std::size_t>(coverage * static_cast<double>(alphas.size()) + 0.5);
    // The alpha that comes to lie on the cutoff: that of the last texel that is to pass, or, if it has many equals and
    // the coverage without them is nearer, the next greater one.
    const float last = wanted > 0 ? alphas[alphas.size() - wanted] : alphas.back();
    const auto from = std::ranges::lower_bound(alphas, last), to = std::ranges::upper_bound(alphas, last);
    const auto with = static_cast<std::size_t>(alphas.end() - from),
               without = static_cast<std::size_t>(alphas.end() - to);
    const bool includes = wanted > without && with - wanted <= wanted - without;
    const float pivot = includes ? last : to != alphas.end() ? *to : last * 1.01f;
    if (!(pivot > 0)) continue;
    const float scale = cutoff / pivot;
    for (std::int32_t y = 0; y < view.height[l]; ++y) {
      Code* const row = row_of(codes, view, l, y);
      for (std::int32_t x = 0; x < view.width[l]; ++x) {
        Code& alpha = row[std::ptrdiff_t{4} * x + 3];
        alpha = code_of<Code>(static_cast<float>(term(alpha)) * unit_of<Code> * scale, 1);
      }
      close_row(row, view.width[l]);
    }
    close_level(codes, view, l);
  }
}

}  // namespace

struct Texture::Levels {
  void make_first_level(const TexelImage& image, TexelMeaning meaning);
  void make_other_levels(const LevelOptions& options);
  template <class Code, class Pixel, class Decode>
  void fill(const Plane<Pixel>& image, const Code* TextureView::*texels, const Decode& decode);
  template <class Code>
  void make_levels(const Code* TextureView::*texels, const LevelOptions& options);
  template <class Code>
  void halve_level(Code* codes, std::int32_t l);
  void make_ripmap();
  void make_sums();
  void make_normal_spread();

  GrowingMemory memory;
  std::size_t count = 0;  ///< of the texels of all levels, with what may be read after them
  TextureView view;

  // Made at first use.
  std::once_flag has_ripmap, has_sums, has_normal_spread;
  GrowingMemory ripmap_memory, sums_memory, spread_memory;
  RipmapView ripmap;
  SumsView sums;
  TextureView normal_spread;
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

/// Makes level l from the level before it, by means.
template <class Code>
void Texture::Levels::halve_level(Code* codes, std::int32_t l) {
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
}

/// Makes all levels from level 0, each from the level before it.
template <class Code>
void Texture::Levels::make_levels(const Code* TextureView::*texels, const LevelOptions& options) {
  if (view.*texels == nullptr) return;
  memory.grow(count * 4 * sizeof(Code));
  auto* const codes = reinterpret_cast<Code*>(memory.data());
  for (std::int32_t l = 1; l < view.levels; ++l) {
    if (options.filter == MipFilter::Box)
      halve_level(codes, l);
    else
      filter_level(codes, view, l, options);
    close_level(codes, view, l);
  }
  if (options.kept_cutoff) keep_coverage(codes, view, *options.kept_cutoff);
}

void Texture::Levels::make_ripmap() {
  ripmap.texels = view;
  const auto halves = [](std::int32_t size, std::int32_t(&sizes)[TextureView::max_levels]) {
    std::int32_t levels = 0;
    for (; levels == 0 || sizes[levels - 1] > 1; ++levels) sizes[levels] = levels == 0 ? size : sizes[levels - 1] / 2;
    return levels;
  };
  ripmap.columns = halves(view.width[0], ripmap.width), ripmap.rows = halves(view.height[0], ripmap.height);
  std::int64_t texels = 0;
  for (std::int32_t l = 0; l < ripmap.rows; ++l)
    for (std::int32_t k = 0; k < ripmap.columns; ++k) {
      ripmap.offset[TextureView::max_levels * l + k] = static_cast<std::int32_t>(texels);
      texels += (std::int64_t{ripmap.width[k]} + 2) * (ripmap.height[l] + 2);
    }
  texels += 2;
  if (texels >= std::int64_t{1} << 31) throw std::bad_alloc();
  const auto make = [&](auto TextureView::*texel_pointer) {
    using Code = std::remove_cvref_t<decltype(*(view.*texel_pointer))>;
    const Code* const source = view.*texel_pointer;
    if (source == nullptr) return;
    const std::size_t bytes = static_cast<std::size_t>(texels) * 4 * sizeof(Code);
    ripmap_memory = GrowingMemory(bytes);
    ripmap_memory.grow(bytes);
    auto* const codes = reinterpret_cast<Code*>(ripmap_memory.data());
    ripmap.texels.*texel_pointer = codes;
    const auto row = [&](std::int32_t k, std::int32_t l, std::int32_t y) {
      return codes +
             std::ptrdiff_t{4} * (ripmap.offset[TextureView::max_levels * l + k] + (y + 1) * (ripmap.width[k] + 2) + 1);
    };
    for (std::int32_t l = 0; l < ripmap.rows; ++l)
      for (std::int32_t k = 0; k < ripmap.columns; ++k) {
        const Size to{ripmap.width[k], ripmap.height[l]};
        // From the level before it along u; those of column 0, from the level before it along v.
        const std::int32_t from_k = std::max(k - 1, 0), from_l = k > 0 ? l : std::max(l - 1, 0);
        const Size from{ripmap.width[from_k], ripmap.height[from_l]};
        const bool is_first = k == 0 && l == 0;
        parallel_ranges(static_cast<std::size_t>(to.height), rows_per_range, [&](std::size_t begin, std::size_t end) {
          for (auto y = static_cast<std::int32_t>(begin); y < static_cast<std::int32_t>(end); ++y) {
            Code* const out = row(k, l, y);
            if (is_first) {
              std::copy_n(source + std::ptrdiff_t{4} * view.texel(0, 0, y), std::ptrdiff_t{4} * to.width, out);
            } else {
              const Cover rows = cover(from.height, to.height, y);
              shrink_row(
                  covered_rows<Code>(rows, [&](std::int32_t at, std::int32_t) { return row(from_k, from_l, at); }),
                  rows, from, to, out);
            }
            close_row(out, to.width);
          }
        });
        const std::ptrdiff_t pitch = std::ptrdiff_t{4} * (to.width + 2);
        std::copy_n(row(k, l, to.height - 1) - 4, pitch, row(k, l, -1) - 4);
        std::copy_n(row(k, l, 0) - 4, pitch, row(k, l, to.height) - 4);
      }
  };
  make(&TextureView::unorm8), make(&TextureView::unorm15), make(&TextureView::halves), make(&TextureView::values);
}

void Texture::Levels::make_sums() {
  const std::int32_t w = sums.width = view.width[0], h = sums.height = view.height[0];
  const std::size_t bytes = (static_cast<std::size_t>(w) + 1) * (static_cast<std::size_t>(h) + 1) * 4 * 8;
  sums_memory = GrowingMemory(bytes);
  sums_memory.grow(bytes);
  const auto make = [&](const auto* source, auto* table) {
    const std::ptrdiff_t pitch = std::ptrdiff_t{4} * (w + 1);
    for (std::int32_t y = 0; y < h; ++y) {
      const auto* from = source + std::ptrdiff_t{4} * view.texel(0, 0, y);
      auto* const out = table + pitch * (y + 1);
      std::remove_cvref_t<decltype(*table)> sum[4] = {};
      for (std::int32_t x = 0; x < w; ++x)
        for (int c = 0; c < 4; ++c) {
          sum[c] += term(from[std::ptrdiff_t{4} * x + c]);
          const std::ptrdiff_t at = std::ptrdiff_t{4} * (x + 1) + c;
          out[at] = out[at - pitch] + sum[c];
        }
    }
  };
  auto* const codes = reinterpret_cast<std::uint64_t*>(sums_memory.data());
  auto* const values = reinterpret_cast<double*>(sums_memory.data());
  if (view.unorm8 != nullptr) make(view.unorm8, codes);
  if (view.unorm15 != nullptr) make(view.unorm15, codes);
  if (view.halves != nullptr) make(view.halves, values);
  if (view.values != nullptr) make(view.values, values);
  if (view.unorm8 != nullptr || view.unorm15 != nullptr)
    sums.codes = codes;
  else
    sums.values = values;
  sums.unit = view.unorm8 != nullptr ? 1.0f / 255.0f : view.unorm15 != nullptr ? 1.0f / 32767.0f : 1.0f;
}

/// The moments of the unit normals and of their slopes are averaged exactly from level 0, level by level.
void Texture::Levels::make_normal_spread() {
  struct Moments {
    double x = 0, y = 0, z = 0;           ///< of unit normals
    double p = 0, q = 0, pp = 0, qq = 0;  ///< of slopes x / z and y / z, and of their squares
  };
  constexpr double least_z = 1.0 / 64;  // steeper slopes count as 64
  const auto value = [&](std::int32_t x, std::int32_t y, int c) {
    const std::ptrdiff_t at = std::ptrdiff_t{4} * view.texel(0, x, y) + c;
    if (view.unorm8 != nullptr) return static_cast<double>(view.unorm8[at]) / 255;
    if (view.unorm15 != nullptr) return static_cast<double>(view.unorm15[at]) / 32767;
    return static_cast<double>(view.halves != nullptr ? term(view.halves[at]) : view.values[at]);
  };
  normal_spread = view;
  normal_spread.unorm8 = nullptr, normal_spread.unorm15 = nullptr, normal_spread.halves = nullptr;
  spread_memory = GrowingMemory(count * 4 * sizeof(float));
  spread_memory.grow(count * 4 * sizeof(float));
  auto* const out = reinterpret_cast<float*>(spread_memory.data());
  normal_spread.values = out;

  Size size{view.width[0], view.height[0]};
  std::vector<Moments> moments(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  for (std::int32_t y = 0; y < size.height; ++y)
    for (std::int32_t x = 0; x < size.width; ++x) {
      double n[3] = {2 * value(x, y, 0) - 1, 2 * value(x, y, 1) - 1, 2 * value(x, y, 2) - 1};
      const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], unit = square > 1e-12 ? 1 / std::sqrt(square) : 0;
      for (double& v : n) v *= unit;
      const double z = std::max(n[2], least_z), p = n[0] / z, q = n[1] / z;
      moments[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)] = {
          n[0], n[1], unit > 0 ? n[2] : 1, p, q, p * p, q * q};
    }
  for (std::int32_t l = 0;; ++l) {
    for (std::int32_t y = 0; y < size.height; ++y) {
      float* const row = row_of(out, view, l, y);
      for (std::int32_t x = 0; x < size.width; ++x) {
        const Moments& m =
            moments[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)];
        const double length = l == 0 ? 1 : std::min(std::sqrt(m.x * m.x + m.y * m.y + m.z * m.z), 1.0);
        const double variance = l == 0 ? 0 : std::max(m.pp - m.p * m.p, 0.0) + std::max(m.qq - m.q * m.q, 0.0);
        row[4 * x] = static_cast<float>(length), row[4 * x + 1] = static_cast<float>(variance);
      }
      close_row(row, size.width);
    }
    close_level(out, view, l);
    if (l + 1 == view.levels) break;
    const Size to{view.width[l + 1], view.height[l + 1]};
    const double total = static_cast<double>(total_weight(size.width, to.width)) *
                         static_cast<double>(total_weight(size.height, to.height));
    std::vector<Moments> next;
    next.reserve(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
    for (std::int32_t y = 0; y < to.height; ++y)
      for (std::int32_t x = 0; x < to.width; ++x) {
        const Cover rows = cover(size.height, to.height, y), columns = cover(size.width, to.width, x);
        Moments sum;
        for (std::int32_t j = 0; j < rows.count; ++j)
          for (std::int32_t i = 0; i < columns.count; ++i) {
            const double weight = static_cast<double>(rows.weight[j] * columns.weight[i]) / total;
            const Moments& m = moments[static_cast<std::size_t>(rows.first + j) * static_cast<std::size_t>(size.width) +
                                       static_cast<std::size_t>(columns.first + i)];
            sum.x += weight * m.x, sum.y += weight * m.y, sum.z += weight * m.z;
            sum.p += weight * m.p, sum.q += weight * m.q, sum.pp += weight * m.pp, sum.qq += weight * m.qq;
          }
        next.push_back(sum);
      }
    moments = std::move(next), size = to;
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
    const float most = view.most = is_color ? 1e9f : 1.0f;
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
  std::call_once(levels_->has_ripmap, [&] { growing("ripmap levels", [&] { levels_->make_ripmap(); }); });
  return levels_->ripmap;
}

const SumsView& Texture::sums() const {
  std::call_once(levels_->has_sums, [&] { growing("summed-area tables", [&] { levels_->make_sums(); }); });
  return levels_->sums;
}

const TextureView& Texture::normal_spread() const {
  std::call_once(levels_->has_normal_spread,
                 [&] { growing("normal variances", [&] { levels_->make_normal_spread(); }); });
  return levels_->normal_spread;
}

}  // namespace zoneplate
