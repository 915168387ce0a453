// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/mip_levels.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/shade/texture/shrinking.h"
#include "zoneplate/shade/texture/texel_values.h"
#include "zoneplate/shade/texture/wrap_border.h"
#include "zoneplate/signal/filter/resample.h"

namespace zoneplate {
namespace {

/// Makes level l from the level before it, by a kernel with negative lobes.
template <class Code>
void filter_level(Code* codes, const TextureView& view, std::int32_t l, const LevelOptions& options,
                  bool weights_by_alpha) {
  static const Kernel kaiser = make_kernel("kaiser"), lanczos = make_kernel("lanczos3");
  const Kernel& kernel = options.filter == MipFilter::Kaiser ? kaiser : lanczos;
  const LevelSize from{view.width[l - 1], view.height[l - 1]}, to{view.width[l], view.height[l]};
  LinearImage image(from.width, from.height);
  for (std::int32_t y = 0; y < from.height; ++y) {
    const Code* texel = row_of(codes, view, l - 1, y);
    for (Linear& p : image.row(y)) {
      const auto value = [&](int c) { return static_cast<float>(term(texel[c])) * unit_of<Code>; };
      p = {value(0), value(1), value(2), value(3)};
      if (weights_by_alpha) p = {p.r * p.a, p.g * p.a, p.b * p.a, p.a};
      texel += 4;
    }
  }
  // One direction after the other, since the borders may differ.
  const LinearImage wide = resample(image, to.width, from.height, kernel, {.border = border_of(options.wrap_u)});
  const LinearImage small = resample(wide, to.width, to.height, kernel, {.border = border_of(options.wrap_v)});
  for (std::int32_t y = 0; y < to.height; ++y) {
    Code* const row = row_of(codes, view, l, y);
    Code* texel = row;
    for (Linear p : small.row(y)) {
      if (weights_by_alpha && p.a > 0) p = {p.r / p.a, p.g / p.a, p.b / p.a, p.a};
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
  const auto passing = static_cast<double>(first.end() - std::lower_bound(first.begin(), first.end(), cutoff));
  const double coverage = passing / static_cast<double>(first.size());
  for (std::int32_t l = 1; l < view.levels; ++l) {
    const std::vector<float> alphas = sorted_alphas(codes, view, l);
    const auto wanted = static_cast<std::size_t>(coverage * static_cast<double>(alphas.size()) + 0.5);
    // The alpha that comes to lie on the cutoff: that of the last texel that is to pass, or, if it has many equals and
    // the coverage without them is nearer, the next greater one.
    const float last = wanted > 0 ? alphas[alphas.size() - wanted] : alphas.back();
    const auto [from, to] = std::equal_range(alphas.begin(), alphas.end(), last);
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

/// Makes level l from the level before it, by means.
template <class Code>
void halve_level(Code* codes, const TextureView& view, std::int32_t l) {
  const LevelSize from{view.width[l - 1], view.height[l - 1]}, to{view.width[l], view.height[l]};
  const bool is_even = from.width % 2 == 0 && from.height % 2 == 0;
  parallel_ranges(static_cast<std::size_t>(to.height), texel_rows_per_range, [&](std::size_t begin, std::size_t end) {
    for (auto y = static_cast<std::int32_t>(begin); y < static_cast<std::int32_t>(end); ++y) {
      Code* const out = row_of(codes, view, l, y);
      const TexelCover rows = cover(from.height, to.height, y);
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

/// A texel of a weighted sum: colours times alpha, and alpha.
template <class Code>
struct WeightedSum {
  TexelSum<Code> color[3] = {}, alpha = 0;

  /// Does not read the colour of a transparent texel, which another thread may write.
  void add(const Code* texel, std::uint64_t weight) {
    const auto by = static_cast<TexelSum<Code>>(weight) * static_cast<TexelSum<Code>>(term(texel[3]));
    if (by == 0) return;
    for (int c = 0; c < 3; ++c) color[c] += by * static_cast<TexelSum<Code>>(term(texel[c]));
    alpha += by;
  }
  bool is_transparent() const { return !(alpha > 0); }
  void write_color(Code* out) const {
    for (int c = 0; c < 3; ++c)
      if constexpr (std::is_integral_v<Code>)
        out[c] = static_cast<Code>((color[c] + alpha / 2) / alpha);
      else
        out[c] = rounded<Code>(color[c] / alpha);
  }
};

/// Replaces the colours of level l, the means of those of the level before it, by means that are weighted by alpha.
template <class Code>
void weight_level(Code* codes, const TextureView& view, std::int32_t l) {
  const LevelSize from{view.width[l - 1], view.height[l - 1]}, to{view.width[l], view.height[l]};
  parallel_ranges(static_cast<std::size_t>(to.height), texel_rows_per_range, [&](std::size_t begin, std::size_t end) {
    for (auto y = static_cast<std::int32_t>(begin); y < static_cast<std::int32_t>(end); ++y) {
      Code* const out = row_of(codes, view, l, y);
      const TexelCover rows = cover(from.height, to.height, y);
      for (std::int32_t x = 0; x < to.width; ++x) {
        const TexelCover columns = cover(from.width, to.width, x);
        WeightedSum<Code> sum;
        for (std::int32_t j = 0; j < rows.count; ++j)
          for (std::int32_t i = 0; i < columns.count; ++i)
            sum.add(row_of(codes, view, l - 1, rows.first + j) + std::ptrdiff_t{4} * (columns.first + i),
                    rows.weight[j] * columns.weight[i]);
        if (!sum.is_transparent()) sum.write_color(out + std::ptrdiff_t{4} * x);
      }
      close_row(out, to.width);
    }
  });
}

/// The texel at a coordinate that may lie one beyond the border; none with Wrap::Clamp and Wrap::Mirror.
std::int32_t wrapped(std::int32_t at, std::int32_t size, Wrap wrap) {
  if (at >= 0 && at < size) return at;
  return wrap == Wrap::Repeat ? (at + size) % size : -1;
}

/// Gives the transparent texels of a level the colour of the visible ones next to them or, where there are none, that
/// of the texel of the next level that covers them.
template <class Code>
void color_transparent_texels(Code* codes, const TextureView& view, std::int32_t l, const LevelOptions& options) {
  const std::int32_t width = view.width[l], height = view.height[l];
  const auto color_texel = [&](std::int32_t x, std::int32_t y, Code* texel) {
    WeightedSum<Code> sum;
    for (std::int32_t j = y - 1; j <= y + 1; ++j)
      for (std::int32_t i = x - 1; i <= x + 1; ++i) {
        const std::int32_t u = wrapped(i, width, options.wrap_u), v = wrapped(j, height, options.wrap_v);
        if (u >= 0 && v >= 0) sum.add(row_of(codes, view, l, v) + std::ptrdiff_t{4} * u, 1);
      }
    if (!sum.is_transparent())
      sum.write_color(texel);
    else if (l + 1 < view.levels)
      std::copy_n(row_of(codes, view, l + 1, std::min(y / 2, view.height[l + 1] - 1)) +
                      std::ptrdiff_t{4} * std::min(x / 2, view.width[l + 1] - 1),
                  3, texel);
  };
  // Transparent texels have no weight, so that the order in which they are coloured does not matter.
  parallel_ranges(static_cast<std::size_t>(height), texel_rows_per_range, [&](std::size_t begin, std::size_t end) {
    for (auto y = static_cast<std::int32_t>(begin); y < static_cast<std::int32_t>(end); ++y) {
      Code* const row = row_of(codes, view, l, y);
      for (std::int32_t x = 0; x < width; ++x)
        if (Code* const texel = row + std::ptrdiff_t{4} * x; !(term(texel[3]) > 0)) color_texel(x, y, texel);
      close_row(row, width);
    }
  });
  close_level(codes, view, l);
}

/// True if a texel of level 0 is not opaque.
template <class Code>
bool has_transparency(Code* codes, const TextureView& view) {
  const Code opaque = code_of<Code>(1, 1);
  for (std::int32_t y = 0; y < view.height[0]; ++y) {
    const Code* const row = row_of(codes, view, 0, y);
    for (std::int32_t x = 0; x < view.width[0]; ++x)
      if (term(row[std::ptrdiff_t{4} * x + 3]) != term(opaque)) return true;
  }
  return false;
}

}  // namespace

template <class Code>
void make_mip_levels(Code* codes, const TextureView& view, const LevelOptions& options) {
  const bool weights_by_alpha = options.weights_by_alpha && has_transparency(codes, view);
  for (std::int32_t l = 1; l < view.levels; ++l) {
    if (options.filter == MipFilter::Box)
      halve_level(codes, view, l);
    else
      filter_level(codes, view, l, options, weights_by_alpha);
    if (weights_by_alpha && options.filter == MipFilter::Box) weight_level(codes, view, l);
    close_level(codes, view, l);
  }
  if (weights_by_alpha)
    for (std::int32_t l = view.levels; l-- > 0;) color_transparent_texels(codes, view, l, options);
  if (options.kept_cutoff) keep_coverage(codes, view, *options.kept_cutoff);
}

template void make_mip_levels(std::uint8_t*, const TextureView&, const LevelOptions&);
template void make_mip_levels(std::uint16_t*, const TextureView&, const LevelOptions&);
template void make_mip_levels(Half*, const TextureView&, const LevelOptions&);
template void make_mip_levels(float*, const TextureView&, const LevelOptions&);

}  // namespace zoneplate
