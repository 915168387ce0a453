#include "zoneplate/image/tonemap.h"

#include <algorithm>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/tonemap_kernels.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/image/transfer_kernels.h"

namespace zoneplate {
namespace {

/// x clamped to [0, 1]; 0 where it is not a number.
float clamp_unit(float x) {
  x = x > 0 ? x : 0.0f;
  return x < 1 ? x : 1.0f;
}

float usable_light(float x) {
  x = x > 0 ? x : 0.0f;
  return x < tone::greatest ? x : tone::greatest;
}

float3 times(const float (&m)[3][3], float3 v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

float aces_curve(float v) {
  return (v * (v + tone::aces_a) - tone::aces_b) / (v * (tone::aces_c * v + tone::aces_d) + tone::aces_e);
}

float3 map_aces(float3 color) {
  const float3 v = times(tone::aces_in, color * tone::aces_exposure);
  return times(tone::aces_out, {aces_curve(v.x), aces_curve(v.y), aces_curve(v.z)});
}

/// Hue is kept: up to `neutral_start` only the light that a dielectric reflects is taken off, above it the peak is
/// compressed towards 1 and the colour towards white.
float3 map_neutral(float3 color) {
  const float least = std::min(std::min(color.x, color.y), color.z);
  const float offset = least < 2 * tone::neutral_f90 ? least - 6.25f * (least * least) : tone::neutral_f90;
  color = {color.x - offset, color.y - offset, color.z - offset};
  const float peak = std::max(std::max(color.x, color.y), color.z);
  if (peak < tone::neutral_start) return color;

  const float d = 1 - tone::neutral_start;
  const float new_peak = 1 - d * d / (peak + d - tone::neutral_start);
  const float ratio = new_peak / peak;
  const float white = 1 - 1 / (tone::neutral_desaturation * (peak - new_peak) + 1);
  const auto mixed = [&](float x) { return x * ratio * (1 - white) + new_peak * white; };
  return {mixed(color.x), mixed(color.y), mixed(color.z)};
}

}  // namespace

float3 tone_map(float3 color, ToneMapping mapping) {
  color = {usable_light(color.x), usable_light(color.y), usable_light(color.z)};
  if (mapping == ToneMapping::Aces) color = map_aces(color);
  if (mapping == ToneMapping::Neutral) color = map_neutral(color);
  return {clamp_unit(color.x), clamp_unit(color.y), clamp_unit(color.z)};
}

namespace scalar {
namespace {

void display_pixel(const DisplayStep& step, const float* linear, float* display) {
  const float a = clamp_unit(linear[3]);
  const auto straight = [&](float premultiplied) { return a > 0 ? premultiplied / a * step.exposure : 0.0f; };
  const float3 color = tone_map({straight(linear[0]), straight(linear[1]), straight(linear[2])}, step.mapping);
  const float mapped[3] = {color.x, color.y, color.z};

  const float rest = 1 - a;
  const float alpha = step.is_transparent ? a : step.light[3] == 1 ? 1.0f : a + step.light[3] * rest;
  for (int c = 0; c < 3; ++c) {
    const float light = step.is_transparent ? mapped[c] : (mapped[c] * a + step.light[c] * rest) / alpha;
    const float shown = step.is_encoded ? encode_srgb(light) : clamp_unit(light);
    display[c] = a > 0 ? shown : step.code[c];
  }
  display[3] = a > 0 ? clamp_unit(alpha) : step.code[3];
}

void display_row(const DisplayStep& step, const float* linear, float* display, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) display_pixel(step, linear + 4 * i, display + 4 * i);
}

void show_groups(const DisplayStep& step, const Linear8* linear, Rgba8* shown, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < Linear8::size; ++k) {
      const Linear color = linear[i].get(k);
      float display[4];
      display_pixel(step, &color.r, display);
      TransferKernels::scalar.quantize8(display, &shown[Linear8::size * i + k].r, 4);
    }
}

}  // namespace

}  // namespace scalar

template <>
const TonemapKernels PerIsa<TonemapKernels>::scalar = {.display_row = scalar::display_row,
                                                       .show_groups = scalar::show_groups};

namespace {

DisplayStep make_step(const DisplayOptions& options) {
  DisplayStep step;
  step.mapping = options.raw ? ToneMapping::None : options.mapping;
  step.exposure = options.exposure;
  step.is_encoded = !options.raw;
  step.is_transparent = options.is_transparent;
  const float alpha = options.is_transparent ? 0.0f : clamp_unit(options.background.w);
  const float codes[3] = {options.background.x, options.background.y, options.background.z};
  for (int c = 0; c < 3; ++c) {
    const float code = clamp_unit(codes[c]);
    step.code[c] = alpha > 0 ? code : 0.0f;
    step.light[c] = alpha * (options.raw ? code : decode_srgb(code));
  }
  step.code[3] = step.light[3] = alpha;
  return step;
}

}  // namespace

DisplayImage make_display(const LinearImage& image, const DisplayOptions& options) {
  static_assert(sizeof(Linear) == 4 * sizeof(float) && sizeof(Display) == 4 * sizeof(float));
  const TonemapKernels& kernels = TonemapKernels::of();
  const DisplayStep step = make_step(options);
  DisplayImage display(image.width(), image.height());
  // Blocks of pixels rather than rows, so that a thin image is shared out as well.
  parallel_ranges(image.values().size(), 8192, [&](std::size_t begin, std::size_t end) {
    kernels.display_row(step, &image.values()[begin].r, &display.values()[begin].r, end - begin);
  });
  return display;
}

void show_light(std::span<const Linear> pixels, const DisplayOptions& options, float* light) {
  DisplayStep step = make_step(options);
  step.is_encoded = false;
  for (int c = 0; c < 3; ++c) step.code[c] = options.raw ? step.code[c] : decode_srgb(step.code[c]);
  TonemapKernels::of().display_row(step, &pixels.data()->r, light, pixels.size());
}

DisplayTransform::DisplayTransform(const DisplayOptions& options) : step_(make_step(options)) {
  Rgba8 shown[Linear8::size];
  const Linear8 nothing{};
  present({&nothing, 1}, shown);
  background_ = shown[0];
}

void DisplayTransform::present(std::span<const Linear8> groups, Rgba8* out) const {
  TonemapKernels::of().show_groups(step_, groups.data(), out, groups.size());
}

LinearImage over_background(LinearImage image, const DisplayOptions& options) {
  const float4 b = options.background;
  const Linear behind{decode_srgb(b.x), decode_srgb(b.y), decode_srgb(b.z), 1};
  for (Linear& c : image.values()) {
    const float rest = options.is_transparent ? 0.0f : (1 - c.a) * b.w;
    c = c * options.exposure + behind * rest;
  }
  return image;
}

}  // namespace zoneplate
