#include "zoneplate/image/display_transform.h"
#include "zoneplate/image/tone_curves.h"
#include "zoneplate/image/transfer_simd.h"

HWY_BEFORE_NAMESPACE();
namespace zoneplate::HWY_NAMESPACE {
namespace {

using DF = hn::CappedTag<float, 8>;
using VF = hn::Vec<DF>;
constexpr DF d;

struct Color {
  VF r, g, b;
};

template <class Step>
HWY_INLINE Color each(const Color& c, Step step) {
  return {step(c.r), step(c.g), step(c.b)};
}

HWY_INLINE VF usable_light(VF x) {
  const VF greatest = hn::Set(d, tone::greatest);
  x = hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), x);
  return hn::IfThenElse(hn::Lt(x, greatest), x, greatest);
}

HWY_INLINE VF times(const float (&row)[3], const Color& c) {
  const VF two = add_product(d, hn::Mul(hn::Set(d, row[0]), c.r), hn::Set(d, row[1]), c.g);
  return add_product(d, two, hn::Set(d, row[2]), c.b);
}

HWY_INLINE Color times(const float (&m)[3][3], const Color& c) {
  return {times(m[0], c), times(m[1], c), times(m[2], c)};
}

HWY_INLINE VF aces_curve(VF v) {
  const VF above = hn::Sub(hn::Mul(v, hn::Add(v, hn::Set(d, tone::aces_a))), hn::Set(d, tone::aces_b));
  const VF line = hn::Add(hn::Mul(hn::Set(d, tone::aces_c), v), hn::Set(d, tone::aces_d));
  return hn::Div(above, hn::Add(hn::Mul(v, line), hn::Set(d, tone::aces_e)));
}

HWY_INLINE Color map_aces(const Color& color) {
  const VF exposure = hn::Set(d, tone::aces_exposure);
  const Color v = times(tone::aces_in, each(color, [&](VF x) { return hn::Mul(x, exposure); }));
  return times(tone::aces_out, each(v, aces_curve));
}

HWY_INLINE Color map_neutral(const Color& color) {
  const VF one = hn::Set(d, 1.0f), start = hn::Set(d, tone::neutral_start);
  const VF least = hn::Min(hn::Min(color.r, color.g), color.b);
  const VF curved = hn::Sub(least, hn::Mul(hn::Set(d, 6.25f), hn::Mul(least, least)));
  const VF offset =
      hn::IfThenElse(hn::Lt(least, hn::Set(d, 2 * tone::neutral_f90)), curved, hn::Set(d, tone::neutral_f90));
  const Color low = each(color, [&](VF x) { return hn::Sub(x, offset); });
  const VF peak = hn::Max(hn::Max(low.r, low.g), low.b);

  constexpr float width = 1 - tone::neutral_start;
  const VF reach = hn::Sub(hn::Add(peak, hn::Set(d, width)), start);
  const VF new_peak = hn::Sub(one, hn::Div(hn::Set(d, width * width), reach));
  const VF ratio = hn::Div(new_peak, peak);
  const VF excess = hn::Mul(hn::Set(d, tone::neutral_desaturation), hn::Sub(peak, new_peak));
  const VF white = hn::Sub(one, hn::Div(one, hn::Add(excess, one)));
  const VF tint = hn::Mul(new_peak, white), rest = hn::Sub(one, white);
  const auto is_low = hn::Lt(peak, start);
  return each(low, [&](VF x) { return hn::IfThenElse(is_low, x, hn::Add(hn::Mul(hn::Mul(x, ratio), rest), tint)); });
}

template <ToneMapping mapping>
HWY_INLINE Color tone_map(Color color) {
  if constexpr (mapping == ToneMapping::None) return each(color, [](VF x) { return clamp_unit(d, x); });
  color = each(color, usable_light);
  if (mapping == ToneMapping::Aces) color = map_aces(color);
  if (mapping == ToneMapping::Neutral) color = map_neutral(color);
  return each(color, [](VF x) { return clamp_unit(d, x); });
}

struct Pixels {
  Color color;
  VF alpha;
};

/// One vector of pixels.
template <ToneMapping mapping>
HWY_INLINE Pixels shown_pixels(const DisplayStep& step, const Color& color, VF alpha) {
  const VF zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const VF a = clamp_unit(d, alpha);
  const VF exposure = hn::Set(d, step.exposure);
  const auto encoded = [&](VF x) { return step.is_encoded ? encode_srgb(d, x) : clamp_unit(d, x); };

  // Where all is opaque, nothing is divided and nothing shines through: x / 1, x 1 + 0 and a > 0 change no bit.
  if (hn::AllTrue(d, hn::Eq(a, one))) {
    const Color mapped = tone_map<mapping>(each(color, [&](VF x) { return hn::Mul(x, exposure); }));
    return {step.is_encoded ? each(mapped, encoded) : mapped, one};
  }

  // Where nothing is, there is the background alone.
  if (hn::AllTrue(d, hn::Eq(a, zero)))
    return {{hn::Set(d, step.code[0]), hn::Set(d, step.code[1]), hn::Set(d, step.code[2])}, hn::Set(d, step.code[3])};
  const auto is_seen = hn::Gt(a, zero);
  const Color mapped = tone_map<mapping>(
      each(color, [&](VF x) { return hn::IfThenElseZero(is_seen, hn::Mul(hn::Div(x, a), exposure)); }));
  const VF rest = hn::Sub(one, a);
  const VF sum = step.light[3] == 1 ? one : hn::Add(a, hn::Mul(hn::Set(d, step.light[3]), rest));
  const VF total = step.is_transparent ? a : sum;
  const auto shown = [&](VF light, int c) {
    const VF over = hn::Div(hn::Add(hn::Mul(light, a), hn::Mul(hn::Set(d, step.light[c]), rest)), total);
    return hn::IfThenElse(is_seen, encoded(step.is_transparent ? light : over), hn::Set(d, step.code[c]));
  };
  return {{shown(mapped.r, 0), shown(mapped.g, 1), shown(mapped.b, 2)},
          hn::IfThenElse(is_seen, clamp_unit(d, total), hn::Set(d, step.code[3]))};
}

template <ToneMapping mapping>
HWY_INLINE void display_vector(const DisplayStep& step, const float* linear, float* display) {
  Color color;
  VF alpha;
  hn::LoadInterleaved4(d, linear, color.r, color.g, color.b, alpha);
  const Pixels p = shown_pixels<mapping>(step, color, alpha);
  hn::StoreInterleaved4(p.color.r, p.color.g, p.color.b, p.alpha, d, display);
}

template <ToneMapping mapping>
void display_all(const DisplayStep& step, const float* linear, float* display, std::size_t n) {
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) display_vector<mapping>(step, linear + 4 * i, display + 4 * i);

  // The pixels that are left are done in a vector filled up with black.
  if (i < n) {
    HWY_ALIGN float in[4 * hn::MaxLanes(DF())] = {};
    HWY_ALIGN float out[4 * hn::MaxLanes(DF())];
    for (std::size_t k = 0; k < 4 * (n - i); ++k) in[k] = linear[4 * i + k];
    display_vector<mapping>(step, in, out);
    for (std::size_t k = 0; k < 4 * (n - i); ++k) display[4 * i + k] = out[k];
  }
}

void display_row(const DisplayStep& step, const float* linear, float* display, std::size_t n) {
  switch (step.mapping) {
    case ToneMapping::None:
      return display_all<ToneMapping::None>(step, linear, display, n);
    case ToneMapping::Aces:
      return display_all<ToneMapping::Aces>(step, linear, display, n);
    case ToneMapping::Neutral:
      return display_all<ToneMapping::Neutral>(step, linear, display, n);
  }
}

/// 0 to 255, in the lowest byte; x in [0, 1].
HWY_INLINE auto codes(VF x) { return truncated(d, hn::Add(hn::Mul(x, hn::Set(d, 255.0f)), hn::Set(d, 0.5f))); }

template <ToneMapping mapping>
void show_all(const DisplayStep& step, const Linear8* linear, Rgba8* shown, std::size_t n) {
  const hn::RebindToSigned<DF> di;
  static_assert(sizeof(Rgba8) == 4);
  for (const Linear8* group = linear; group != linear + n; ++group)
    for (std::size_t k = 0; k < Linear8::size; k += hn::Lanes(d), shown += hn::Lanes(d)) {
      const Color color{hn::Load(d, group->r + k), hn::Load(d, group->g + k), hn::Load(d, group->b + k)};
      const Pixels p = shown_pixels<mapping>(step, color, hn::Load(d, group->a + k));
      const auto rg = hn::Or(codes(p.color.r), hn::ShiftLeft<8>(codes(p.color.g)));
      const auto ba = hn::Or(hn::ShiftLeft<16>(codes(p.color.b)), hn::ShiftLeft<24>(codes(p.alpha)));
      hn::StoreU(hn::Or(rg, ba), di, reinterpret_cast<std::int32_t*>(shown));
    }
}

void show_groups(const DisplayStep& step, const Linear8* linear, Rgba8* shown, std::size_t n) {
  switch (step.mapping) {
    case ToneMapping::None:
      return show_all<ToneMapping::None>(step, linear, shown, n);
    case ToneMapping::Aces:
      return show_all<ToneMapping::Aces>(step, linear, shown, n);
    case ToneMapping::Neutral:
      return show_all<ToneMapping::Neutral>(step, linear, shown, n);
  }
}

}  // namespace

}  // namespace zoneplate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

namespace zoneplate {
template <>
const TonemapKernels PerIsa<TonemapKernels>::HWY_NAMESPACE = {.display_row = HWY_NAMESPACE::display_row,
                                                              .show_groups = HWY_NAMESPACE::show_groups};
}  // namespace zoneplate
