// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/tonemap.h"

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/display_step_lanes.h"
#include "zoneplate/image/display_transform.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/lanes.h"

namespace zoneplate {
namespace {

template <ToneMapping mapping>
float3 mapped(float3 color) {
  using F = scalar::Float;
  const ColorLanes<F> out = tone_map<mapping>(ColorLanes<F>{color.x, color.y, color.z});
  return {out.r.v, out.g.v, out.b.v};
}

float unit_of(float x) { return clamp_unit(scalar::Float(x)).v; }

DisplayStep make_step(const DisplayOptions& options) {
  DisplayStep step;
  step.mapping = options.raw ? ToneMapping::None : options.mapping;
  step.exposure = options.exposure;
  step.is_encoded = !options.raw;
  step.is_transparent = options.is_transparent;
  const float alpha = options.is_transparent ? 0.0f : unit_of(options.background.w);
  const float codes[3] = {options.background.x, options.background.y, options.background.z};
  for (int c = 0; c < 3; ++c) {
    const float code = unit_of(codes[c]);
    step.code[c] = alpha > 0 ? code : 0.0f;
    step.light[c] = alpha * (options.raw ? code : decode_srgb(code));
  }
  step.code[3] = step.light[3] = alpha;
  return step;
}

}  // namespace

float3 tone_map(float3 color, ToneMapping mapping) {
  switch (mapping) {
    case ToneMapping::None:
      return mapped<ToneMapping::None>(color);
    case ToneMapping::Aces:
      return mapped<ToneMapping::Aces>(color);
    case ToneMapping::Neutral:
      return mapped<ToneMapping::Neutral>(color);
  }
  return {};
}

DisplayImage make_display(const LinearImage& image, const DisplayOptions& options) {
  static_assert(sizeof(Linear) == 4 * sizeof(float) && sizeof(Display) == 4 * sizeof(float));
  const TonemapKernels& kernels = TonemapKernels::of();
  const DisplayStep step = make_step(options);
  DisplayImage display(image.width(), image.height());
  // Blocks of pixels and not rows, so that a narrow image is parallelized too.
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

void show_encoded(std::span<const Linear> pixels, const DisplayOptions& options, float* encoded) {
  TonemapKernels::of().display_row(make_step(options), &pixels.data()->r, encoded, pixels.size());
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
