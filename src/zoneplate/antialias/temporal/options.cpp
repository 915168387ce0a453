// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/options.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate::antialias {
namespace {

using Parts = TemporalParts;

/// Karis, High-Quality Temporal Supersampling, SIGGRAPH 2014 course, with the constants of Unreal Engine 4.
TemporalOptions karis() {
  return {.parts = {.dilation = Parts::Dilation::Cross,
                    .filter = Parts::Filter::CatmullRom5,
                    .rectification = Parts::Rectification::Clamp,
                    .box = Parts::Box::Rounded,
                    .rejection = Parts::Rejection::None,
                    .blend = Parts::Blend::Motion,
                    .min_weight = 0.04f,
                    .weighting = Parts::Weighting::Luma},
          .sequence = JitterSequence::UncentredHalton,
          .length = 8,
          .current = CurrentFilter::Gauss};
}

/// Pedersen, Temporal Reprojection Anti-Aliasing in INSIDE, GDC 2016, with the defaults of its published source but
/// without its motion blur and its dither, which that source makes optional.
TemporalOptions inside() {
  return {.parts = {.dilation = Parts::Dilation::Square,
                    .filter = Parts::Filter::Bilinear,
                    .box = Parts::Box::Rounded,
                    .is_ycocg = false,
                    .rejection = Parts::Rejection::None,
                    .blend = Parts::Blend::Contrast,
                    .min_weight = 0.03f},
          .sequence = JitterSequence::UncentredHalton,
          .current = CurrentFilter::Unjitter};
}

/// Salvi, An Excursion in Temporal Supersampling, GDC 2016: a tenth of the current frame, history clipped to the mean
/// ± one standard deviation. The talk leaves the other parts open.
TemporalOptions salvi() {
  return {.parts = {.rejection = Parts::Rejection::None, .blend = Parts::Blend::Fixed, .min_weight = 0.1f}};
}

/// three.js r187, examples/jsm/tsl/display/TRAANode.js.
TemporalOptions three() {
  return {.parts = {.dilation = Parts::Dilation::Square,
                    .filter = Parts::Filter::Bilinear,
                    .is_ycocg = false,
                    .moving_gamma = 0.5f,
                    .rejection = Parts::Rejection::Edge,
                    .blend = Parts::Blend::Velocity,
                    .min_weight = 0.05f,
                    .weighting = Parts::Weighting::Compressed},
          .sequence = JitterSequence::UncentredHalton,
          .length = 32};
}

/// PlayCanvas 2.23.3, taaResolve with QUALITY_HIGH.
TemporalOptions playcanvas() {
  return {.parts = {.dilation = Parts::Dilation::None,
                    .rectification = Parts::Rectification::Clamp,
                    .box = Parts::Box::Extremes,
                    .is_ycocg = false,
                    .rejection = Parts::Rejection::None,
                    .blend = Parts::Blend::Fixed,
                    .min_weight = 0.05f,
                    .keeps_current_alpha = true},
          .sequence = JitterSequence::UncentredHalton,
          .follows_camera = true};
}

/// Bevy, crates/bevy_anti_alias/src/taa/taa.wesl.
TemporalOptions bevy() {
  return {.parts = {.dilation = Parts::Dilation::Cross,
                    .filter = Parts::Filter::CatmullRom5,
                    .is_normalized = false,
                    .rejection = Parts::Rejection::None,
                    .blend = Parts::Blend::Confidence,
                    .min_weight = 0.015f,
                    .is_compressed = true},
          .sequence = JitterSequence::UncentredHalton,
          .length = 8};
}

/// The project's own choice of parts. Textures are as sharp as for the 16 samples of the jitter's period. The box of
/// the variance reaches beyond the neighbours' colours, and so does Catmull-Rom's history at the edges of what moves:
/// without the limit by extremes, dark objects have black edges.
TemporalOptions best() {
  return {.parts = {.box = Parts::Box::Both, .trusts_rest = true}, .bias = -2, .settling_frames = 32};
}

constexpr std::string_view presets[] = {"best", "karis", "inside", "salvi", "three", "playcanvas", "bevy"};
constexpr TemporalOptions (*makers[])() = {best, karis, inside, salvi, three, playcanvas, bevy};
constexpr std::string_view sequences[] = {"halton", "r2", "none", "halton-uncentred"};
constexpr std::string_view dilations[] = {"none", "square", "cross"};
constexpr std::string_view motions[] = {"surface", "camera"};
constexpr std::string_view filters[] = {"bilinear", "catmull5", "catmull9"};
constexpr std::string_view rectifications[] = {"none", "clamp", "clip"};
constexpr std::string_view boxes[] = {"extremes", "rounded", "variance", "both"};
constexpr std::string_view spaces[] = {"rgb", "ycocg"};
constexpr std::string_view rejections[] = {"none", "depth", "id", "both", "edge"};
constexpr std::string_view rests[] = {"test", "trust"};
constexpr std::string_view blends[] = {"fixed", "count", "contrast", "velocity", "confidence", "motion"};
constexpr std::string_view weightings[] = {"none", "luma", "compressed"};
constexpr std::string_view ranges[] = {"linear", "compressed"};
constexpr std::string_view news[] = {"sample", "smaa", "smaa-exact"};
constexpr std::string_view currents[] = {"point", "unjitter", "gauss"};

constexpr Param params[] = {
    {.name = "preset", .meaning = "the parts of this source; other parameters change single parts", .names = presets},
    {.name = "jitter",
     .meaning =
         "sequence of sample positions over frames; halton and r2 are moved so that the mean is the pixel's centre",
     .names = sequences},
    {.name = "length",
     .meaning = "number of positions before the sequence repeats",
     .value = 16,
     .low = 1,
     .high = 1024},
    {.name = "current", .meaning = "filter of the current frame's samples", .names = currents},
    {.name = "dilate",
     .meaning = "pixels of which the nearest surface gives the motion: itself, 3 × 3, or a cross of 5",
     .value = 1,
     .names = dilations},
    {.name = "motion",
     .meaning = "motion of the surfaces, or of the camera alone, as engines without a velocity buffer have it",
     .names = motions},
    {.name = "history", .meaning = "filter of the history between pixels", .value = 2, .names = filters},
    {.name = "rectify",
     .meaning = "history outside the neighbours' colours is kept, clamped, or moved towards their centre",
     .value = 2,
     .names = rectifications},
    {.name = "box", .meaning = "the colours that the neighbours allow", .value = 2, .names = boxes},
    {.name = "gamma",
     .meaning = "half the side of a variance box, in standard deviations",
     .value = 1,
     .low = 0,
     .high = 100,
     .decimals = 2},
    {.name = "space", .meaning = "axes of the box", .value = 1, .names = spaces},
    {.name = "reject",
     .meaning = "history is dropped where depth, object id or both differ, or as three.js does it (edge)",
     .value = 3,
     .names = rejections},
    {.name = "rest",
     .meaning = "trust: where all around rests, history is kept unless the light changes, at once or slowly",
     .value = 1,
     .names = rests},
    {.name = "tolerance",
     .meaning = "relative difference of depths that is accepted",
     .value = 0.01,
     .low = 0,
     .high = 1,
     .decimals = 6},
    {.name = "blend",
     .meaning =
         "weight of the current frame: fixed, 1 / frames, or the rule of INSIDE (contrast), three.js (velocity), "
         "Bevy (confidence), Unreal Engine 4 (motion)",
     .value = 1,
     .names = blends},
    {.name = "alpha",
     .meaning = "least weight of the current frame",
     .value = 0.05,
     .low = 0.001,
     .high = 1,
     .decimals = 4},
    {.name = "weigh",
     .meaning = "colours are weighted by 1 / (1 + luma), of the colour or of the compressed colour",
     .names = weightings},
    {.name = "range",
     .meaning = "colours are averaged in linear light, or compressed by 1 / (1 + max)",
     .names = ranges},
    {.name = "sharpen", .meaning = "strength of an unsharp mask after the blend", .low = 0, .high = 4, .decimals = 2},
    {.name = "bias",
     .meaning = "mip levels by which textures are blurrier (negative: sharper); -2: as for 16 samples",
     .value = -2,
     .low = -4,
     .high = 0,
     .decimals = 2},
    {.name = "new",
     .meaning = "pixels without history: their sample, or that filtered by SMAA or smaa-exact",
     .names = news},
    {.name = "frames", .meaning = "frames that are rendered for a still image", .value = 32, .low = 2, .high = 4096},
};

}  // namespace

std::span<const Param> temporal_params() { return params; }

TemporalOptions temporal_options(const Settings& s) {
  TemporalOptions o = makers[s.integer("preset")]();
  const auto choose = [&](std::string_view name, auto& part) {
    if (s.is_given(name)) part = static_cast<std::remove_reference_t<decltype(part)>>(s.integer(name));
  };
  const auto set = [&](std::string_view name, float& part) {
    if (s.is_given(name)) part = static_cast<float>(s.number(name));
  };
  Parts& p = o.parts;
  choose("jitter", o.sequence), choose("length", o.length), choose("current", o.current);
  choose("dilate", p.dilation), choose("motion", o.follows_camera), choose("history", p.filter);
  choose("rectify", p.rectification), choose("box", p.box), choose("space", p.is_ycocg), choose("reject", p.rejection);
  choose("rest", p.trusts_rest);
  choose("blend", p.blend), choose("weigh", p.weighting), choose("range", p.is_compressed);
  choose("frames", o.settling_frames), choose("new", o.new_pixels);
  set("tolerance", p.tolerance), set("alpha", p.min_weight), set("sharpen", o.sharpening), set("bias", o.bias);
  if (s.is_given("gamma")) p.gamma = p.moving_gamma = static_cast<float>(s.number("gamma"));
  if (o.new_pixels != NewPixels::Sample && p.blend != Parts::Blend::Count)
    throw Error(ErrorKind::Usage,
                "taa: new=smaa and new=smaa-exact are for blend=count, which counts the frames of a pixel");
  return o;
}

void set_kernel(CurrentFilter filter, SamplePosition jitter, TemporalParts& parts) {
  parts.has_kernel = filter != CurrentFilter::Point;
  const float x = (static_cast<float>(jitter.x) - 128) / 256, y = (static_cast<float>(jitter.y) - 128) / 256;
  float sum = 0;
  for (int k = 0; k < 9; ++k) {
    const float dx = static_cast<float>(k % 3 - 1) + x, dy = static_cast<float>(k / 3 - 1) + y;
    parts.kernel[k] = filter == CurrentFilter::Gauss
                          ? exp(-2.29f * (dx * dx + dy * dy))
                          : std::max(0.0f, 1 - std::abs(dx)) * std::max(0.0f, 1 - std::abs(dy));
    sum += parts.kernel[k];
  }
  for (float& weight : parts.kernel) weight /= sum;
}

}  // namespace zoneplate::antialias
