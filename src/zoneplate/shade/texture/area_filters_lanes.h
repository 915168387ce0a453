// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "zoneplate/shade/texture/area_filters.h"
#include "zoneplate/shade/texture/filtering_lanes.h"
#include "zoneplate/shade/texture/texture_view.h"

/// The stages of shade/texture/area_filters.h over the lane types of math/lanes.h.
namespace zoneplate::area {

/// The 32-bit words at 4 × (stride × index + which) bytes, one for each lane.
template <class Int, int stride>
[[gnu::always_inline]] inline Int words_at(const void* bytes, const std::int32_t* index, int which) {
  alignas(64) std::int32_t word[Int::lanes];
  for (int lane = 0; lane < Int::lanes; ++lane)
    std::memcpy(
        word + lane,
        static_cast<const unsigned char*>(bytes) + std::ptrdiff_t{4} * (std::ptrdiff_t{stride} * index[lane] + which),
        4);
  return Int::load(word);
}

/// Texel formats. `load` gives the four channels of the texels at these indices; a value is a number × `unit`.
struct Unorm8Texels {
  const std::uint8_t* codes;
  static constexpr float unit = 1.0f / 255.0f;
  template <class F>
  [[gnu::always_inline]] void load(typename F::Int at, F (&out)[4]) const {
    using Int = typename F::Int;
    alignas(64) std::int32_t index[F::lanes];
    at.store(index);
    const Int word = words_at<Int, 1>(codes, index, 0), byte(255);
    out[0] = F::from(word & byte), out[1] = F::from(word.template shifted_right<8>() & byte);
    out[2] = F::from(word.template shifted_right<16>() & byte),
    out[3] = F::from(word.template shifted_right<24>() & byte);
  }
};

struct Unorm15Texels {
  const std::uint16_t* codes;
  static constexpr float unit = 1.0f / 32767.0f;
  template <class F>
  [[gnu::always_inline]] void load(typename F::Int at, F (&out)[4]) const {
    using Int = typename F::Int;
    alignas(64) std::int32_t index[F::lanes];
    at.store(index);
    const Int low = words_at<Int, 2>(codes, index, 0), high = words_at<Int, 2>(codes, index, 1), half(0xffff);
    out[0] = F::from(low & half), out[1] = F::from(low.template shifted_right<16>() & half);
    out[2] = F::from(high & half), out[3] = F::from(high.template shifted_right<16>() & half);
  }
};

/// Powers of two by the exponent of a half float that is not negative: its value is power[e] × (m + 1024), without the
/// 1024 for e = 0.
struct HalfPowers {
  alignas(64) float power[32];
};
constexpr HalfPowers make_half_powers() {
  HalfPowers p{};
  float power = 0x1p-24f;
  for (int e = 0; e < 32; ++e) {
    p.power[e] = power;
    if (e > 0) power *= 2;
  }
  return p;
}
inline constexpr HalfPowers half_powers = make_half_powers();

struct HalfTexels {
  const Half* halves;
  static constexpr float unit = 1.0f;
  template <class F>
  [[gnu::always_inline]] static F value(typename F::Int bits) {
    using Int = typename F::Int;
    const Int exponent = bits.template shifted_right<10>() & Int(31);
    const Int mantissa = (bits & Int(1023)) + select(exponent > Int(0), Int(1024), Int(0));
    return F::gather(half_powers.power, exponent) * F::from(mantissa);
  }
  template <class F>
  [[gnu::always_inline]] void load(typename F::Int at, F (&out)[4]) const {
    using Int = typename F::Int;
    alignas(64) std::int32_t index[F::lanes];
    at.store(index);
    const Int low = words_at<Int, 2>(halves, index, 0), high = words_at<Int, 2>(halves, index, 1), half(0xffff);
    out[0] = value<F>(low & half), out[1] = value<F>(low.template shifted_right<16>() & half);
    out[2] = value<F>(high & half), out[3] = value<F>(high.template shifted_right<16>() & half);
  }
};

struct FloatTexels {
  const float* values;
  static constexpr float unit = 1.0f;
  template <class F>
  [[gnu::always_inline]] void load(typename F::Int at, F (&out)[4]) const {
    alignas(64) std::int32_t index[F::lanes];
    at.store(index);
    F::load_quads([&](int lane) { return values + std::ptrdiff_t{4} * index[lane]; }, out);
  }
};

/// Calls use(texels) with the format of the view.
template <class Use>
[[gnu::always_inline]] inline void with_texels(const TextureView& t, Use use) {
  if (t.unorm8 != nullptr) return use(Unorm8Texels{t.unorm8});
  if (t.unorm15 != nullptr) return use(Unorm15Texels{t.unorm15});
  if (t.halves != nullptr) return use(HalfTexels{t.halves});
  use(FloatTexels{t.values});
}

/// The derivatives of fragments, with those that the footprint leaves out.
struct Derivatives {
  alignas(64) float value[4][Taps::padded_capacity];

  [[gnu::always_inline]] Derivatives(const Footprint& from, int count) {
    const float* const source[4] = {from.dudx, from.dvdx, from.dudy, from.dvdy};
    for (int d = 0; d < 4; ++d)
      for (int i = 0; i < count; i += 8) {
        if (from.repeats != nullptr && i > 0 && from.repeats[i / 8])
          std::fill_n(value[d] + i, 8, value[d][i - 1]);
        else
          std::copy_n(source[d] + i, 8, value[d] + i);
      }
  }
  Footprint footprint(const Footprint& of) const { return {of.u, of.v, value[0], value[1], value[2], value[3]}; }
};

/// An axis of a level: how texel numbers beyond its ends are wrapped.
template <class F>
struct Axis {
  F size, period, inverse;
  bool mirrors, clamps;

  [[gnu::always_inline]] Axis(typename F::Int texels, bool mirrors_in, bool clamps_in)
      : size(F::from(texels)), mirrors(mirrors_in), clamps(clamps_in) {
    period = mirrors ? size + size : size;
    inverse = F(1.0f) / period;
  }
  /// The texel in [0, size) of a number, which is whole.
  [[gnu::always_inline]] typename F::Int wrapped(F number) const {
    const F last = size - F(1.0f);
    if (!clamps) number = number - floor((number + F(0.5f)) * inverse) * period;
    if (mirrors) number = select(number > last, period - F(1.0f) - number, number);
    return truncate(min(max(number, F(0.0f)), last));
  }
};

/// The coordinate within one period; NaN gives 0.
template <class F>
[[gnu::always_inline]] inline F reduced(F u, bool mirrors, bool clamps) {
  const F zero(0.0f);
  if (clamps) return min(max(u, zero), F(1.0f));
  if (!mirrors) return max(u - floor(u), zero);
  const F half = u * F(0.5f);
  return max(F(2.0f) * (half - floor(half)), zero);
}

/// A level of each fragment, with the places of its texels.
template <class F>
struct Grid {
  using Int = typename F::Int;
  Axis<F> x, y;
  Int pitch, origin;  ///< texel (0, 0) has the index `origin`

  [[gnu::always_inline]] Grid(Int width, Int height, Int offset, const SamplerState& f)
      : x(width, f.mirror_u, f.clamp_u), y(height, f.mirror_v, f.clamp_v), pitch(row_pitches(width)) {
    origin = offset + pitch + Int(1);
  }
  [[gnu::always_inline]] Int row(F number) const { return origin + y.wrapped(number) * pitch; }
};

template <class F>
[[gnu::always_inline]] inline Grid<F> grid_of(const TextureView& t, typename F::Int level, const SamplerState& f) {
  using Int = typename F::Int;
  return {Int::look_up(t.width, level), Int::look_up(t.height, level), Int::look_up(t.offset, level), f};
}

/// A sum of weighted differences from the first texel.
template <class F>
struct Mean {
  F first[4];
  F sum[4] = {F(0.0f), F(0.0f), F(0.0f), F(0.0f)};

  template <class Texels>
  [[gnu::always_inline]] Mean(const Texels& texels, typename F::Int at) {
    texels.load(at, first);
  }
  template <class Texels>
  [[gnu::always_inline]] void add(const Texels& texels, typename F::Int at, F weight) {
    F texel[4];
    texels.load(at, texel);
    for (int c = 0; c < 4; ++c) sum[c] = sum[c] + (texel[c] - first[c]) * weight;
  }
  /// The mean for weights of this sum.
  [[gnu::always_inline]] F value(int c, F total) const { return first[c] + sum[c] / total; }
  /// The mean for weights with the sum 1.
  [[gnu::always_inline]] F value(int c) const { return first[c] + sum[c]; }
};

template <class F>
struct Color {
  F c[4];
};

/// Stores values × unit, clamped to the range of the texture.
template <class F>
[[gnu::always_inline]] inline void store(const Color<F>& color, float unit, float most, float* const out[4], int i) {
  for (int c = 0; c < 4; ++c) min(max(color.c[c] * F(unit), F(0.0f)), F(c < 3 ? most : 1.0f)).store(out[c] + i);
}

/// The mixture of two levels. make(level number) gives the values of a level.
template <class F, class Make>
[[gnu::always_inline]] inline Color<F> mix_levels(const TextureView& t, F lod, Make make) {
  using Int = typename F::Int;
  const F last(static_cast<float>(t.levels - 1)), level = min(max(lod, F(0.0f)), last), fine = floor(level);
  const F weight = level - fine;
  Color<F> color = make(truncate(fine));
  if (!(greatest(weight) > 0)) return color;
  const Color<F> second = make(min(truncate(fine) + Int(1), Int(t.levels - 1)));
  for (int c = 0; c < 4; ++c) color.c[c] = color.c[c] + (second.c[c] - color.c[c]) * weight;
  return color;
}

/// B and C of a cubic. Source: Mitchell and Netravali 1988, equation 8.
struct Cubic {
  float b, c;
};
inline Cubic cubic_of(TextureFilter::Kind kind) {
  if (kind == TextureFilter::Kind::CatmullRom) return {0, 0.5f};
  if (kind == TextureFilter::Kind::BSpline) return {1, 0};
  return {1.0f / 3, 1.0f / 3};
}

/// The weights of the four texels about a point that lies `t` behind the second of them.
template <class F>
[[gnu::always_inline]] inline void cubic_weights(const Cubic& k, F t, F (&out)[4]) {
  const float b = k.b, c = k.c;
  const auto inner = [&](F x) { return (F(2 - 1.5f * b - c) * x + F(-3 + 2 * b + c)) * x * x + F(1 - b / 3); };
  const auto outer = [&](F x) {
    return ((F(-b / 6 - c) * x + F(b + 5 * c)) * x + F(-2 * b - 8 * c)) * x + F(4 * b / 3 + 4 * c);
  };
  const F one(1.0f);
  out[0] = outer(one + t), out[1] = inner(t), out[2] = inner(one - t), out[3] = outer(F(2.0f) - t);
}

template <class F, class Texels>
[[gnu::always_inline]] inline Color<F> cubic_level(const Texels& texels, const Grid<F>& grid, const Cubic& cubic, F u,
                                                   F v) {
  const F half(0.5f), x = u * grid.x.size - half, y = v * grid.y.size - half, x0 = floor(x), y0 = floor(y);
  F wx[4], wy[4];
  cubic_weights(cubic, x - x0, wx), cubic_weights(cubic, y - y0, wy);
  typename F::Int column[4];
  for (int i = 0; i < 4; ++i) column[i] = grid.x.wrapped(x0 + F(static_cast<float>(i - 1)));
  Mean<F> mean(texels, grid.row(y0) + column[1]);
  for (int j = 0; j < 4; ++j) {
    const auto row = grid.row(y0 + F(static_cast<float>(j - 1)));
    for (int i = 0; i < 4; ++i) mean.add(texels, row + column[i], wx[i] * wy[j]);
  }
  return {{mean.value(0), mean.value(1), mean.value(2), mean.value(3)}};
}

template <class F>
void sample_cubic(const TextureView& t, const SamplerState& f, const Footprint& from, float* const out[4], int count) {
  const Derivatives derivatives(from, count);
  const Footprint at = derivatives.footprint(from);
  const F w(static_cast<float>(t.width[0])), h(static_cast<float>(t.height[0]));
  const Cubic cubic = cubic_of(f.kind);
  with_texels(t, [&](const auto& texels) {
    for (int i = 0; i < count; i += F::lanes) {
      const F u = reduced(F::load(at.u + i), f.mirror_u, f.clamp_u),
              v = reduced(F::load(at.v + i), f.mirror_v, f.clamp_v);
      const Color<F> color = mix_levels<F>(t, footprint_level(w, h, at, i), [&](typename F::Int level) {
        return cubic_level<F>(texels, grid_of<F>(t, level, f), cubic, u, v);
      });
      store(color, texels.unit, t.most, out, i);
    }
  });
}

/// log2 of a length in texels, clamped to the levels of an axis.
template <class F>
[[gnu::always_inline]] inline F axis_level(F a, F b, F size, std::int32_t levels) {
  const F length = max(abs(a), abs(b)) * size;
  const F lod = coarse_log2(min(max(length, F(0x1p-50f)), F(0x1p50f)));
  return min(max(lod, F(0.0f)), F(static_cast<float>(levels - 1)));
}

template <class F, class Texels>
[[gnu::always_inline]] inline void add_bilinear(const Texels& texels, const Grid<F>& grid, F u, F v, F weight,
                                                Mean<F>& mean) {
  const F half(0.5f), one(1.0f);
  const F x = u * grid.x.size - half, y = v * grid.y.size - half, x0 = floor(x), y0 = floor(y);
  const F right = x - x0, down = y - y0;
  const auto left = grid.x.wrapped(x0), next = grid.x.wrapped(x0 + one), top = grid.row(y0), low = grid.row(y0 + one);
  mean.add(texels, top + left, weight * (one - right) * (one - down));
  mean.add(texels, top + next, weight * right * (one - down));
  mean.add(texels, low + left, weight * (one - right) * down);
  mean.add(texels, low + next, weight * right * down);
}

template <class F>
void sample_ripmap(const RipmapView& r, const SamplerState& f, const Footprint& from, float* const out[4], int count) {
  using Int = typename F::Int;
  const Derivatives derivatives(from, count);
  const Footprint at = derivatives.footprint(from);
  const F w(static_cast<float>(r.width[0])), h(static_cast<float>(r.height[0])), one(1.0f);
  with_texels(r.texels, [&](const auto& texels) {
    for (int i = 0; i < count; i += F::lanes) {
      const F u = reduced(F::load(at.u + i), f.mirror_u, f.clamp_u),
              v = reduced(F::load(at.v + i), f.mirror_v, f.clamp_v);
      const F along_u = axis_level(F::load(at.dudx + i), F::load(at.dudy + i), w, r.columns);
      const F along_v = axis_level(F::load(at.dvdx + i), F::load(at.dvdy + i), h, r.rows);
      const F k0 = floor(along_u), l0 = floor(along_v), part_u = along_u - k0, part_v = along_v - l0;
      const auto grid = [&](int right, int down) {
        const Int k = min(truncate(k0) + Int(right), Int(r.columns - 1));
        const Int l = min(truncate(l0) + Int(down), Int(r.rows - 1));
        return Grid<F>(Int::look_up(r.width, k), Int::look_up(r.height, l),
                       Int::gather(r.offset, l * Int(TextureView::max_levels) + k), f);
      };
      const Grid<F> first = grid(0, 0);
      Mean<F> mean(texels,
                   first.row(floor(v * first.y.size - F(0.5f))) + first.x.wrapped(floor(u * first.x.size - F(0.5f))));
      for (int down = 0; down < 2; ++down)
        for (int right = 0; right < 2; ++right) {
          const F weight = (right > 0 ? part_u : one - part_u) * (down > 0 ? part_v : one - part_v);
          if (greatest(weight) > 0) add_bilinear(texels, grid(right, down), u, v, weight, mean);
        }
      store(Color<F>{{mean.value(0), mean.value(1), mean.value(2), mean.value(3)}}, texels.unit, r.texels.most, out, i);
    }
  });
}

/// The linear map from pixels to texels of a level.
template <class F>
struct Jacobian {
  F ux, vx, uy, vy;
};

/// The squares of the semi-axes of the ellipse to which a Jacobian maps the unit circle, and its matrix J Jᵀ.
template <class F>
struct Ellipse {
  F uu, uv, vv, longer, shorter;

  [[gnu::always_inline]] explicit Ellipse(const Jacobian<F>& j)
      : uu(j.ux * j.ux + j.uy * j.uy), uv(j.ux * j.vx + j.uy * j.vy), vv(j.vx * j.vx + j.vy * j.vy) {
    const F difference = uu - vv, det = j.ux * j.vy - j.uy * j.vx;
    longer = F(0.5f) * (uu + vv + sqrt(difference * difference + F(4.0f) * (uv * uv)));
    shorter = min(det * det / max(longer, F(0x1p-100f)), longer);
  }
};

/// The quadratic form that is 1 on an ellipse, and half the ellipse's height.
template <class F>
struct Conic {
  F a, b, c, reach;

  /// The axes are clamped to what a level allows.
  [[gnu::always_inline]] Conic(const Ellipse<F>& e, F ratio) {
    const F one(1.0f);
    const F longer = min(max(e.longer, one), F(16.0f) * (ratio * ratio));
    const F shorter = min(max(max(e.shorter, longer / (ratio * ratio)), one), F(16.0f));
    const F s = one / shorter;
    // The projection on the longer axis is (J Jᵀ - shorter) / (longer - shorter).
    const F along = (one / longer - s) / max(e.longer - e.shorter, max(e.longer * F(1e-6f), F(1e-30f)));
    a = s + along * (e.uu - e.shorter), b = along * e.uv, c = s + along * (e.vv - e.shorter);
    reach = sqrt(max(a * (longer * shorter), one));
  }
};

template <class F>
[[gnu::always_inline]] inline F ceil(F x) {
  return -floor(-x);
}

template <class F, class Texels>
[[gnu::always_inline]] inline Color<F> ellipse_level(const Texels& texels, const Grid<F>& grid, const Conic<F>& q, F u,
                                                     F v) {
  const F zero(0.0f), one(1.0f), half(0.5f);
  const F x0 = u * grid.x.size - half, y0 = v * grid.y.size - half;
  const F first_row = ceil(y0 - q.reach), last_row = floor(y0 + q.reach);
  Mean<F> mean(texels, grid.row(floor(y0 + half)) + grid.x.wrapped(floor(x0 + half)));
  F total(0.0f);
  const float rows = greatest(last_row - first_row);
  const F inverse = one / q.a;
  for (float r = 0; r <= rows; r += 1) {
    const F y = first_row + F(r), dy = y - y0;
    // The row meets the ellipse where a dx² + 2 b dx dy + c dy² <= 1.
    const F slant = q.b * dy, square = slant * slant - q.a * (q.c * dy * dy - one);
    const F width = sqrt(max(square, zero)) * inverse, middle = x0 - slant * inverse;
    const F first = ceil(middle - width);
    const F end = select(y > last_row, first - one, floor(middle + width));
    const float columns = greatest(end - first);
    const auto row = grid.row(min(y, last_row));
    for (float k = 0; k <= columns; k += 1) {
      const F x = first + F(k), dx = x - x0;
      const F r2 = (q.a * dx + F(2.0f) * slant) * dx + q.c * dy * dy;
      // exp(-2 r²) - exp(-2)
      const F bell = exp2(max(r2, zero) * F(-2.88539008f)) - F(0.135335283f);
      const F weight = where(end >= x, max(bell, zero));
      total = total + weight;
      mean.add(texels, row + grid.x.wrapped(min(x, end)), weight);
    }
  }
  const F all = max(total, F(1e-6f));
  return {{mean.value(0, all), mean.value(1, all), mean.value(2, all), mean.value(3, all)}};
}

template <class F>
void sample_ellipse(const TextureView& t, const SamplerState& f, const Footprint& from, float* const out[4],
                    int count) {
  using Int = typename F::Int;
  const Derivatives derivatives(from, count);
  const Footprint at = derivatives.footprint(from);
  const F w(static_cast<float>(t.width[0])), h(static_cast<float>(t.height[0]));
  const F ratio(static_cast<float>(std::max(f.anisotropy, std::int32_t{1})));
  const auto clean = [](F x) { return min(max(x, F(-0x1p20f)), F(0x1p20f)); };
  with_texels(t, [&](const auto& texels) {
    for (int i = 0; i < count; i += F::lanes) {
      const F u = reduced(F::load(at.u + i), f.mirror_u, f.clamp_u),
              v = reduced(F::load(at.v + i), f.mirror_v, f.clamp_v);
      const Jacobian<F> j{clean(F::load(at.dudx + i) * w), clean(F::load(at.dvdx + i) * h),
                          clean(F::load(at.dudy + i) * w), clean(F::load(at.dvdy + i) * h)};
      const Ellipse<F> whole(j);
      const F shorter = max(whole.shorter, whole.longer / (ratio * ratio));
      const F lod = F(0.5f) * coarse_log2(max(shorter, F(0x1p-100f))) - F(1.0f);
      const Color<F> color = mix_levels<F>(t, lod, [&](Int level) {
        const Grid<F> grid = grid_of<F>(t, level, f);
        const F su = grid.x.size / w, sv = grid.y.size / h;
        const Ellipse<F> e({j.ux * su, j.vx * sv, j.uy * su, j.vy * sv});
        return ellipse_level<F>(texels, grid, Conic<F>(e, ratio), u, v);
      });
      store(color, texels.unit, t.most, out, i);
    }
  });
}

template <class F>
void sample_one(const TextureView& t, const SamplerState& f, const Footprint& from, float* const out[4], int count) {
  const Derivatives derivatives(from, count);
  const Footprint at = derivatives.footprint(from);
  const F w(static_cast<float>(t.width[0])), h(static_cast<float>(t.height[0])), half(0.5f);
  const F last(static_cast<float>(t.levels - 1));
  with_texels(t, [&](const auto& texels) {
    for (int i = 0; i < count; i += F::lanes) {
      const F u = reduced(F::load(at.u + i), f.mirror_u, f.clamp_u),
              v = reduced(F::load(at.v + i), f.mirror_v, f.clamp_v);
      const F lod = min(max(footprint_level(w, h, at, i), F(0.0f)), last);
      const Grid<F> grid = grid_of<F>(t, truncate(lod + min(F::load(from.random[0] + i), F(0x1.fffffep-1f))), f);
      const F x = floor(u * grid.x.size + F::load(from.random[1] + i) - half);
      const F y = floor(v * grid.y.size + F::load(from.random[2] + i) - half);
      Color<F> color;
      texels.load(grid.row(y) + grid.x.wrapped(x), color.c);
      store(color, texels.unit, t.most, out, i);
    }
  });
}

/// The kernels for one lane type.
template <class F>
constexpr AreaFilterKernels all() {
  return {.sample_cubic = &sample_cubic<F>,
          .sample_ripmap = &sample_ripmap<F>,
          .sample_ellipse = &sample_ellipse<F>,
          .sample_one = &sample_one<F>};
}

}  // namespace zoneplate::area
