// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/antialias/temporal/color_planes.h"
#include "zoneplate/math/blend_lanes.h"

/// Colours of four channels over a lane type of math/lanes.h.
namespace zoneplate::stages {

using antialias::ColorPlanes;

template <class F>
struct Rgba {
  F c[4];

  [[gnu::always_inline]] static Rgba load(const float* p) {
    Rgba out;
    F::load_fours(p, out.c);
    return out;
  }
  [[gnu::always_inline]] void store(float* p) const { F::store_fours(c, p); }
  [[gnu::always_inline]] static Rgba load(const ColorPlanes<const float>& p, std::ptrdiff_t i) {
    return {
        {F::load(p.channel(0) + i), F::load(p.channel(1) + i), F::load(p.channel(2) + i), F::load(p.channel(3) + i)}};
  }
  [[gnu::always_inline]] void store(const ColorPlanes<float>& p, std::ptrdiff_t i) const {
    for (int k = 0; k < 4; ++k) c[k].store(p.channel(k) + i);
  }
  [[gnu::always_inline]] static Rgba all(F value) { return {{value, value, value, value}}; }

  [[gnu::always_inline]] friend Rgba operator+(const Rgba& a, const Rgba& b) {
    return {{a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2], a.c[3] + b.c[3]}};
  }
  [[gnu::always_inline]] friend Rgba operator-(const Rgba& a, const Rgba& b) {
    return {{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2], a.c[3] - b.c[3]}};
  }
  [[gnu::always_inline]] friend Rgba operator*(const Rgba& a, const Rgba& b) {
    return {{a.c[0] * b.c[0], a.c[1] * b.c[1], a.c[2] * b.c[2], a.c[3] * b.c[3]}};
  }
  [[gnu::always_inline]] friend Rgba operator*(const Rgba& a, F s) {
    return {{a.c[0] * s, a.c[1] * s, a.c[2] * s, a.c[3] * s}};
  }
  [[gnu::always_inline]] friend Rgba min(const Rgba& a, const Rgba& b) {
    return {{min(a.c[0], b.c[0]), min(a.c[1], b.c[1]), min(a.c[2], b.c[2]), min(a.c[3], b.c[3])}};
  }
  [[gnu::always_inline]] friend Rgba max(const Rgba& a, const Rgba& b) {
    return {{max(a.c[0], b.c[0]), max(a.c[1], b.c[1]), max(a.c[2], b.c[2]), max(a.c[3], b.c[3])}};
  }
  template <class B>
  [[gnu::always_inline]] friend Rgba select(B m, const Rgba& a, const Rgba& b) {
    return {
        {select(m, a.c[0], b.c[0]), select(m, a.c[1], b.c[1]), select(m, a.c[2], b.c[2]), select(m, a.c[3], b.c[3])}};
  }
  [[gnu::always_inline]] friend auto operator==(const Rgba& a, const Rgba& b) {
    return (a.c[0] == b.c[0]) & (a.c[1] == b.c[1]) & (a.c[2] == b.c[2]) & (a.c[3] == b.c[3]);
  }
};

template <class F>
[[gnu::always_inline]] inline F max3(const Rgba<F>& c) {
  return max(max(c.c[0], c.c[1]), c.c[2]);
}

/// Y, Co, Cg and alpha; and back.
template <class F>
[[gnu::always_inline]] inline Rgba<F> ycocg_of(const Rgba<F>& c) {
  const F half(0.5f), quarter(0.25f);
  const F middle = (c.c[0] + c.c[2]) * quarter, green = c.c[1] * half;
  return {{middle + green, (c.c[0] - c.c[2]) * half, green - middle, c.c[3]}};
}
template <class F>
[[gnu::always_inline]] inline Rgba<F> rgb_of(const Rgba<F>& c) {
  const F rest = c.c[0] - c.c[2];
  return {{rest + c.c[1], c.c[0] + c.c[2], rest - c.c[1], c.c[3]}};
}

/// 4 Y, 2 Co, 4 Cg and alpha, which powers of two separate from Y, Co and Cg: the same digits by fewer operations; and
/// back.
template <class F>
[[gnu::always_inline]] inline Rgba<F> scaled_ycocg_of(const Rgba<F>& c) {
  const F sum = c.c[0] + c.c[2], green = c.c[1] + c.c[1];
  return {{sum + green, c.c[0] - c.c[2], green - sum, c.c[3]}};
}
template <class F>
[[gnu::always_inline]] inline Rgba<F> rgb_of_scaled(const Rgba<F>& c) {
  const F quarter(0.25f);
  return rgb_of<F>({{c.c[0] * quarter, c.c[1] * F(0.5f), c.c[2] * quarter, c.c[3]}});
}

/// Relative luminance of Rec.709.
template <class F>
[[gnu::always_inline]] inline F luminance_of(const Rgba<F>& c) {
  return c.c[0] * F(0.2126f) + c.c[1] * F(0.7152f) + c.c[2] * F(0.0722f);
}

/// Y of Y, Co, Cg.
template <class F>
[[gnu::always_inline]] inline F luma_of(const Rgba<F>& c) {
  return (c.c[0] + c.c[2]) * F(0.25f) + c.c[1] * F(0.5f);
}

}  // namespace zoneplate::stages
