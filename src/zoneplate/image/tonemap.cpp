// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/image/tonemap.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/display_step_lanes.h"
#include "zoneplate/image/display_transform.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/image/transfer_rows.h"
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
    case ToneMapping::Agx:
      return mapped<ToneMapping::Agx>(color);
    case ToneMapping::Filmic:
      return mapped<ToneMapping::Filmic>(color);
  }
  return {};
}

float3 invert_neutral(float3 mapped) {
  constexpr double start = tone::neutral_start, width = 1 - start, most = 1 - 0x1p-20;
  double c[3] = {mapped.x, mapped.y, mapped.z};
  for (double& x : c) x = std::min(std::max(x, 0.0), most);
  const double new_peak = std::max({c[0], c[1], c[2]});
  if (new_peak >= start) {
    const double peak = width * width / (1 - new_peak) - width + start;
    const double rest = 1 / (tone::neutral_desaturation * (peak - new_peak) + 1);
    for (double& x : c) x = (x - new_peak * (1 - rest)) / rest * (peak / new_peak);
  }
  // The least channel is 6.25 x² below 2 f90, and x - f90 above.
  const double least = std::min({c[0], c[1], c[2]});
  constexpr double f90 = tone::neutral_f90;
  const double offset = least < f90 ? std::sqrt(std::max(least, 0.0) * (4 * f90)) - least : f90;
  return {static_cast<float>(c[0] + offset), static_cast<float>(c[1] + offset), static_cast<float>(c[2] + offset)};
}

DisplayImage make_display(const LinearImage& image, const DisplayOptions& options) {
  static_assert(sizeof(Linear) == 4 * sizeof(float) && sizeof(Display) == 4 * sizeof(float));
  const TonemapKernels& kernels = TonemapKernels::of();
  const DisplayStep step = make_step(options);
  DisplayImage display = DisplayImage::unset(image.width(), image.height());
  // Blocks of pixels and not rows, so that a narrow image is parallelized too.
  parallel_ranges(image.values().size(), 8192, [&](std::size_t begin, std::size_t end) {
    kernels.display_row(step, &image.values()[begin].r, &display.values()[begin].r, end - begin);
  });
  return display;
}

Rgba8Image make_display8(const LinearImage& image, const DisplayOptions& options) {
  const DisplayStep step = make_step(options);
  Rgba8Image codes = Rgba8Image::unset(image.width(), image.height());
  parallel_ranges(image.values().size(), 8192, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t most = 512;
    float shown[4 * most];
    for (std::size_t at = begin; at < end; at += most) {
      const std::size_t count = std::min(most, end - at);
      TonemapKernels::of().display_row(step, &image.values()[at].r, shown, count);
      TransferKernels::of().quantize8(shown, &codes.values()[at].r, 4 * count);
    }
  });
  return codes;
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
  constexpr std::size_t most = 64;
  Rgba8* spans[most];
  for (std::size_t first = 0; first < groups.size(); first += most) {
    const std::size_t count = std::min(most, groups.size() - first);
    for (std::size_t i = 0; i < count; ++i) spans[i] = out + (first + i) * Linear8::size;
    const Linear8& from = groups[first];
    present({{from.r, from.g, from.b, from.a}, sizeof(Linear8) / sizeof(float)}, {spans, count});
  }
}

void DisplayTransform::present(const SpanColors& colors, std::span<Rgba8* const> out) const {
  TonemapKernels::of().show_spans(step_, colors, out.data(), out.size());
}

bool DisplayTransform::is_decided(const Linear8& front, float brightest, float rounding) const {
  const bool ascends = step_.mapping == ToneMapping::None && !step_.is_transparent && step_.light[3] == 1;
  return ascends && TonemapKernels::of().is_decided(step_, front, brightest, rounding);
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
