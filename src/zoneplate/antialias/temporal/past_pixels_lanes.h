// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "zoneplate/antialias/temporal/color_lanes.h"

/// Pixels of the last frame around one for each lane, over a lane type of math/lanes.h.
namespace zoneplate::stages {

/// Planes of the last frame, moved by the position of a pixel for each lane; beyond the image, its outermost values.
///
/// Where neighbouring lanes have neighbouring pixels, as most have, values are loaded without gathering.
template <class F>
class PastPixels {
 public:
  /// The pixels (x, y), whole numbers, of the lanes at columns `column`, the first of which is `i`. Offsets are from
  /// -1 to `reach`.
  [[gnu::always_inline]] PastPixels(F x, F y, int width, int height, F column, std::ptrdiff_t i, int reach)
      : x_(x), y_(y), width_(width), height_(height) {
    using Int = typename F::Int;
    const Int shift = truncate(x - column), row = truncate(y);
    const std::ptrdiff_t first = i + shift.first();
    is_block_ = shift.is_uniform() && row.is_uniform() && first >= 1 && first + F::lanes + reach <= width &&
                row.first() >= 1 && row.first() + reach < height;
    row_ = row.first(), first_ = first;
  }

  [[gnu::always_inline]] F value(const float* plane, int dx, int dy) const {
    return is_block_ ? F::load(plane + begin(dx, dy)) : F::gather(plane, index(dx, dy, width_));
  }
  /// The result of use(color), where color(dx, dy) are colours of `colors`: ColorPlanes, or four floats per pixel.
  template <class Colors, class Use>
  [[gnu::always_inline]] auto with_colors(const Colors& colors, const Use& use) const {
    // Decided once for all colours: gathering is rare, and far longer.
    if (is_block_) return use([&](int dx, int dy) { return block(colors, dx, dy); });
    return use([&](int dx, int dy) { return gathered(colors, dx, dy); });
  }

 private:
  [[gnu::always_inline]] Rgba<F> block(const ColorPlanes<const float>& planes, int dx, int dy) const {
    return Rgba<F>::load(planes, (row_ + dy) * planes.stride() + first_ + dx);
  }
  [[gnu::always_inline]] Rgba<F> gathered(const ColorPlanes<const float>& planes, int dx, int dy) const {
    const auto at = index(dx, dy, static_cast<int>(planes.stride()));
    return {{F::gather(planes.channel(0), at), F::gather(planes.channel(1), at), F::gather(planes.channel(2), at),
             F::gather(planes.channel(3), at)}};
  }
  [[gnu::always_inline]] Rgba<F> block(const float* pixels, int dx, int dy) const {
    return Rgba<F>::load(pixels + 4 * begin(dx, dy));
  }
  [[gnu::always_inline]] Rgba<F> gathered(const float* pixels, int dx, int dy) const {
    alignas(32) std::int32_t at[F::lanes];
    index(dx, dy, width_).store(at);
    Rgba<F> out;
    const auto texel = [&](int lane) { return pixels + std::ptrdiff_t{4} * at[lane]; };
    if constexpr (F::lanes == 1)
      for (int c = 0; c < 4; ++c) out.c[c] = F(texel(0)[c]);
    else
      F::load_quads(texel, out.c);
    return out;
  }
  [[gnu::always_inline]] std::ptrdiff_t begin(int dx, int dy) const { return (row_ + dy) * width_ + first_ + dx; }
  [[gnu::always_inline]] typename F::Int index(int dx, int dy, int stride) const {
    const F last_x(static_cast<float>(width_ - 1)), last_y(static_cast<float>(height_ - 1)), zero(0.0f);
    const F x = x_ + F(static_cast<float>(dx)), y = y_ + F(static_cast<float>(dy));
    return truncate(min(max(y, zero), last_y)) * typename F::Int(stride) + truncate(min(max(x, zero), last_x));
  }

  F x_, y_;
  int width_, height_;
  std::ptrdiff_t row_, first_;
  bool is_block_;
};

}  // namespace zoneplate::stages
