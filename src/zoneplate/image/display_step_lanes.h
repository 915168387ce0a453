// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "zoneplate/image/display_step.h"
#include "zoneplate/image/transfer_lanes.h"
#include "zoneplate/math/for_row.h"

/// Tone mapping and the display transform over a lane type of math/lanes.h.
namespace zoneplate {

/// The constants of the tone curves.
namespace tone {

/// Light is clamped to this value, which keeps every intermediate value finite.
inline constexpr float greatest = 0x1p24f;

/// Hill's fit: by rows, sRGB to the space of the curve and back, and the curve (v (v + a) - b) / (v (c v + d) + e).
/// Source: Stephen Hill, BakingLab, ACES.hlsl; the exposure of 1 / 0.6 is that of three.js.
inline constexpr float aces_exposure = 1 / 0.6f;
inline constexpr float aces_in[3][3] = {
    {0.59719f, 0.35458f, 0.04823f}, {0.07600f, 0.90834f, 0.01566f}, {0.02840f, 0.13383f, 0.83777f}};
inline constexpr float aces_out[3][3] = {
    {1.60475f, -0.53108f, -0.07367f}, {-0.10208f, 1.10813f, -0.00605f}, {-0.00327f, -0.07276f, 1.07602f}};
inline constexpr float aces_a = 0.0245786f, aces_b = 0.000090537f;
inline constexpr float aces_c = 0.983729f, aces_d = 0.4329510f, aces_e = 0.238081f;

/// Source: Khronos Group, PBR Neutral Tone Mapper specification.
inline constexpr float neutral_f90 = 0.04f;
inline constexpr float neutral_start = 0.8f - neutral_f90;
inline constexpr float neutral_desaturation = 0.15f;

/// AgX: linear sRGB to linear Rec.2020, the inset of the primaries, a logarithm over this range of stops, a polynomial
/// fit of the contrast curve with coefficients of x, x² ... x⁶, and the way back; the curve's result is a code of gamma
/// 2.2. Source: Troy Sobotka, AgX; Benjamin Wrensch, Minimal AgX Implementation (the polynomial); three.js r185,
/// tonemapping_pars_fragment (the matrices).
inline constexpr float agx_in[3][3] = {
    {0.6274f, 0.3293f, 0.0433f}, {0.0691f, 0.9195f, 0.0113f}, {0.0164f, 0.0880f, 0.8956f}};
inline constexpr float agx_inset[3][3] = {{0.856627153315983f, 0.0951212405381588f, 0.0482516061458583f},
                                          {0.137318972929847f, 0.761241990602591f, 0.101439036467562f},
                                          {0.11189821299995f, 0.0767994186031903f, 0.811302368396859f}};
inline constexpr float agx_outset[3][3] = {{1.1271005818144368f, -0.11060664309660323f, -0.016493938717834573f},
                                           {-0.1413297634984383f, 1.157823702216272f, -0.016493938717834257f},
                                           {-0.14132976349843826f, -0.11060664309660294f, 1.2519364065950405f}};
inline constexpr float agx_out[3][3] = {
    {1.6605f, -0.5876f, -0.0728f}, {-0.1246f, 1.1329f, -0.0083f}, {-0.0182f, -0.1006f, 1.1187f}};
inline constexpr float agx_low = -12.47393f, agx_high = 4.026069f, agx_least = 1e-10f, agx_gamma = 2.2f;
inline constexpr float agx_offset = -0.00232f;
inline constexpr float agx_curve[6] = {0.1191f, 0.4298f, -6.868f, 31.96f, -40.14f, 15.5f};

/// (x (a x + c b) + d e) / (x (a x + b) + d f) - e / f.
/// Source: John Hable, Filmic Tonemapping Operators, 2010 (Uncharted 2).
inline constexpr float filmic_a = 0.15f, filmic_b = 0.50f, filmic_c = 0.10f, filmic_d = 0.20f;
inline constexpr float filmic_e = 0.02f, filmic_f = 0.30f;
inline constexpr float filmic_exposure = 2, filmic_white = 11.2f;

}  // namespace tone

/// One colour per lane.
template <class F>
struct ColorLanes {
  F r, g, b;
};

template <class F, class Step>
[[gnu::always_inline]] inline ColorLanes<F> each(const ColorLanes<F>& c, Step step) {
  return {step(c.r), step(c.g), step(c.b)};
}

template <class F>
[[gnu::always_inline]] inline ColorLanes<F> times(const float (&m)[3][3], const ColorLanes<F>& c) {
  const auto row = [&](int k) { return F(m[k][0]) * c.r + F(m[k][1]) * c.g + F(m[k][2]) * c.b; };
  return {row(0), row(1), row(2)};
}

template <class F>
[[gnu::always_inline]] inline ColorLanes<F> map_aces(const ColorLanes<F>& color) {
  const auto curve = [](F v) {
    return (v * (v + F(tone::aces_a)) - F(tone::aces_b)) /
           (v * (F(tone::aces_c) * v + F(tone::aces_d)) + F(tone::aces_e));
  };
  const ColorLanes<F> exposed = each(color, [](F x) { return x * F(tone::aces_exposure); });
  return times(tone::aces_out, each(times(tone::aces_in, exposed), curve));
}

/// Keeps the hue: up to `neutral_start` only the reflectance of a dielectric is subtracted; above it the peak is
/// compressed towards 1 and the colour is blended towards white.
template <class F>
[[gnu::always_inline]] inline ColorLanes<F> map_neutral(const ColorLanes<F>& color) {
  const F start(tone::neutral_start), one(1.0f), f90(tone::neutral_f90);
  const F least = min(min(color.r, color.g), color.b);
  const F offset = select(least < F(2 * tone::neutral_f90), least - F(6.25f) * (least * least), f90);
  const ColorLanes<F> low = each(color, [&](F x) { return x - offset; });
  const F peak = max(max(low.r, low.g), low.b);
  if (all(peak < start)) return low;

  constexpr float width = 1 - tone::neutral_start;
  const F new_peak = one - F(width * width) / (peak + F(width) - start);
  const F ratio = new_peak / peak;
  const F white = one - one / (F(tone::neutral_desaturation) * (peak - new_peak) + one);
  const F tint = new_peak * white, rest = one - white;
  return each(low, [&](F x) { return select(peak < start, x, x * ratio * rest + tint); });
}

template <class F>
[[gnu::always_inline]] inline ColorLanes<F> map_agx(const ColorLanes<F>& color) {
  const auto curve = [](F v) {
    const F stops = log2(max(v, F(tone::agx_least)));
    const F x = clamp_unit((stops - F(tone::agx_low)) / F(tone::agx_high - tone::agx_low));
    F sum(tone::agx_curve[5]);
    for (int k = 4; k >= 0; --k) sum = sum * x + F(tone::agx_curve[k]);
    return sum * x + F(tone::agx_offset);
  };
  const ColorLanes<F> codes = times(tone::agx_outset, each(times(tone::agx_inset, times(tone::agx_in, color)), curve));
  return times(tone::agx_out, each(codes, [](F x) { return pow(max(x, F(0.0f)), F(tone::agx_gamma)); }));
}

template <class F>
[[gnu::always_inline]] inline F filmic_curve(F x) {
  const F rising =
      x * (F(tone::filmic_a) * x + F(tone::filmic_c * tone::filmic_b)) + F(tone::filmic_d * tone::filmic_e);
  const F falling = x * (F(tone::filmic_a) * x + F(tone::filmic_b)) + F(tone::filmic_d * tone::filmic_f);
  return rising / falling - F(tone::filmic_e / tone::filmic_f);
}

template <class F>
[[gnu::always_inline]] inline ColorLanes<F> map_filmic(const ColorLanes<F>& color) {
  const F white = filmic_curve(F(tone::filmic_white));
  return each(color, [&](F x) { return filmic_curve(x * F(tone::filmic_exposure)) / white; });
}

/// See tone_map in image/tonemap.h.
template <ToneMapping mapping, class F>
[[gnu::always_inline]] inline ColorLanes<F> tone_map(ColorLanes<F> color) {
  const auto unit = [](F x) { return clamp_unit(x); };
  if constexpr (mapping == ToneMapping::None) return each(color, unit);
  color = each(color, [](F x) { return min(max(x, F(0.0f)), F(tone::greatest)); });
  if constexpr (mapping == ToneMapping::Aces) color = map_aces(color);
  if constexpr (mapping == ToneMapping::Neutral) color = map_neutral(color);
  if constexpr (mapping == ToneMapping::Agx) color = map_agx(color);
  if constexpr (mapping == ToneMapping::Filmic) color = map_filmic(color);
  return each(color, unit);
}

namespace stages {

template <class F>
struct PixelLanes {
  ColorLanes<F> color;
  F alpha;
};

/// The code of opaque pixels: what with_displayed gives, since x / 1, x 1 + 0 and a > 0 change no bit.
template <ToneMapping mapping, class F>
[[gnu::always_inline]] inline ColorLanes<F> displayed_opaque(const DisplayStep& step, const ColorLanes<F>& linear) {
  const F exposure(step.exposure);
  const ColorLanes<F> mapped = tone_map<mapping>(each(linear, [&](F x) { return x * exposure; }));
  return step.is_encoded ? each(mapped, [](F x) { return encode_srgb(x); }) : mapped;
}

/// Calls use(displayed). Each way ends in a call of its own: a common return value would be joined in memory.
template <ToneMapping mapping, class F, class Use>
[[gnu::always_inline]] inline void with_displayed(const DisplayStep& step, const PixelLanes<F>& linear, Use use) {
  const F zero(0.0f), one(1.0f), exposure(step.exposure);
  const F a = clamp_unit(linear.alpha);
  const auto encoded = [&](F x) { return step.is_encoded ? encode_srgb(x) : clamp_unit(x); };

  // If all pixels are opaque, the division and the background are skipped.
  if (all(a == one)) return use(PixelLanes<F>{displayed_opaque<mapping>(step, linear.color), one});

  // Empty pixels have the background only.
  if (all(a == zero)) return use(PixelLanes<F>{{F(step.code[0]), F(step.code[1]), F(step.code[2])}, F(step.code[3])});
  const auto is_seen = a > zero;
  const ColorLanes<F> mapped =
      tone_map<mapping>(each(linear.color, [&](F x) { return where(is_seen, x / a * exposure); }));
  const F rest = one - a;
  const F sum = step.light[3] == 1 ? one : a + F(step.light[3]) * rest;
  const F total = step.is_transparent ? a : sum;
  const auto shown = [&](F light, int c) {
    const F over = (light * a + F(step.light[c]) * rest) / total;
    return select(is_seen, encoded(step.is_transparent ? light : over), F(step.code[c]));
  };
  use(PixelLanes<F>{{shown(mapped.r, 0), shown(mapped.g, 1), shown(mapped.b, 2)},
                    select(is_seen, clamp_unit(total), F(step.code[3]))});
}

template <ToneMapping mapping, class Full, class One>
[[gnu::always_inline]] inline void display_pixels(const DisplayStep& step, const float* linear, float* display,
                                                  std::size_t n) {
  for_row<Full, One>(n, [=]<class F>(std::size_t i) {
    F v[4];
    F::load_fours(linear + 4 * i, v);
    with_displayed<mapping>(step, PixelLanes<F>{{v[0], v[1], v[2]}, v[3]}, [&](const PixelLanes<F>& p) {
      const F out[4] = {p.color.r, p.color.g, p.color.b, p.alpha};
      F::store_fours(out, display + 4 * i);
    });
  });
}

/// The code from 0 to 255 of x in [0, 1].
template <class F>
[[gnu::always_inline]] inline typename F::Int code8(F x) {
  return truncate(x * F(255.0f) + F(0.5f));
}

/// For vectors of at most eight lanes.
struct NoPairs {
  static constexpr bool exist = false;
};

/// Two spans of opaque pixels together, in vectors of twice as many lanes: false if some pixels are not opaque.
template <ToneMapping mapping, class Pairs>
[[gnu::always_inline]] inline bool show_pair(const DisplayStep& step, const SpanColors& linear, std::size_t first,
                                             Rgba8* const* shown) {
  using F = typename Pairs::Float;
  const auto load = [&](int c) {
    const float* const channel = linear.channel[c] + first * linear.stride;
    return Pairs::load(channel, channel + linear.stride);
  };
  if (!all(load(3) >= F(1.0f))) return false;
  const ColorLanes<F> p = displayed_opaque<mapping>(step, ColorLanes<F>{load(0), load(1), load(2)});
  Pairs::store_pixels(code8(p.r), code8(p.g), code8(p.b), typename F::Int(255), shown[first], shown[first + 1]);
  return true;
}

template <ToneMapping mapping, class F, class Pairs>
[[gnu::always_inline]] inline void show_pixels(const DisplayStep& step, const SpanColors linear, Rgba8* const* shown,
                                               std::size_t n) {
  static_assert(sizeof(Rgba8) == 4 && Linear8::size % F::lanes == 0);
  const auto codes = [](F x) { return code8(x); };
  for (std::size_t span = 0; span < n; ++span) {
    if constexpr (Pairs::exist) {
      if (span + 1 < n && show_pair<mapping, Pairs>(step, linear, span, shown)) {
        ++span;
        continue;
      }
    }
    for (std::size_t k = 0; k < Linear8::size; k += F::lanes) {
      const auto load = [&](int c) { return F::load(linear.channel[c] + span * linear.stride + k); };
      with_displayed<mapping>(step, PixelLanes<F>{{load(0), load(1), load(2)}, load(3)}, [&](const PixelLanes<F>& p) {
        F::Int::store_pixels(codes(p.color.r), codes(p.color.g), codes(p.color.b), codes(p.alpha), &shown[span][k].r);
      });
    }
  }
}

template <class Full, class One>
[[gnu::flatten]] void display_row(const DisplayStep& step, const float* linear, float* display, std::size_t n) {
  switch (step.mapping) {
    case ToneMapping::None:
      return display_pixels<ToneMapping::None, Full, One>(step, linear, display, n);
    case ToneMapping::Aces:
      return display_pixels<ToneMapping::Aces, Full, One>(step, linear, display, n);
    case ToneMapping::Neutral:
      return display_pixels<ToneMapping::Neutral, Full, One>(step, linear, display, n);
    case ToneMapping::Agx:
      return display_pixels<ToneMapping::Agx, Full, One>(step, linear, display, n);
    case ToneMapping::Filmic:
      return display_pixels<ToneMapping::Filmic, Full, One>(step, linear, display, n);
  }
}

template <class F, class Pairs>
[[gnu::flatten]] void show_spans(const DisplayStep& step, const SpanColors& linear, Rgba8* const* shown,
                                 std::size_t n) {
  switch (step.mapping) {
    case ToneMapping::None:
      return show_pixels<ToneMapping::None, F, Pairs>(step, linear, shown, n);
    case ToneMapping::Aces:
      return show_pixels<ToneMapping::Aces, F, Pairs>(step, linear, shown, n);
    case ToneMapping::Neutral:
      return show_pixels<ToneMapping::Neutral, F, Pairs>(step, linear, shown, n);
    case ToneMapping::Agx:
      return show_pixels<ToneMapping::Agx, F, Pairs>(step, linear, shown, n);
    case ToneMapping::Filmic:
      return show_pixels<ToneMapping::Filmic, F, Pairs>(step, linear, shown, n);
  }
}

/// With exposure e, the transmittance t of the front layers, their colour f and the background b, a pixel's colour c
/// lies in [f, f + t brightest], its alpha a in [1 - t, 1], and what is encoded, min(c e, a) + b (1 - a), between
/// min(f e, 1 - t) and (f + t brightest) e + b t. Both bounds are moved outwards by more than the rounding errors of
/// the display transform, and of the sRGB curve, which ascends only but for these.
template <class F>
[[gnu::flatten]] bool is_decided(const DisplayStep& step, const Linear8& front, float brightest, float rounding) {
  const float* const color[3] = {front.r, front.g, front.b};
  const float error = (step.is_encoded ? 0x1p-19f : 0x1p-21f) + rounding;
  const F exposure(step.exposure), one(1.0f), margin(error), less(1 - error), more(1 + error);
  const auto code = [&](F x) { return code8(step.is_encoded ? encode_srgb(x) : clamp_unit(x)); };
  for (std::size_t k = 0; k < Linear8::size; k += F::lanes) {
    const F t = F::load(front.a + k);
    for (int c = 0; c < 3; ++c) {
      const F light = F::load(color[c] + k) * exposure;
      const F low = min(light, one - t) * less - margin;
      const F high = (light + t * F(brightest * step.exposure + step.light[c])) * more + margin;
      if (!code(low).equals(code(high))) return false;
    }
  }
  return true;
}

template <class Full, class One, class Pairs>
constexpr TonemapKernels display_step() {
  return {
      .display_row = &display_row<Full, One>, .show_spans = &show_spans<Full, Pairs>, .is_decided = &is_decided<Full>};
}

}  // namespace stages
}  // namespace zoneplate
