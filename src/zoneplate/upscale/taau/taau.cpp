// SPDX-License-Identifier: Apache-2.0
// Temporal antialiasing that upsamples (TAAU): jittered frames of fewer pixels than the image are accumulated at the
// image's resolution.
//
// `preset=best` makes every pixel the mean of all samples that it has had, in linear light, with Gaussian weights by
// their distance, and counts them by the sum of the weights (sample_mean.h), as Yang et al. count frames. History is
// moved by the nearest of 3 × 3 surfaces, filtered by Catmull-Rom, and clamped to the extremes of 3 × 3 samples, which
// are kept over some eight frames where the surfaces around move as one. Where eight tenths of 7 × 7 samples leave
// these extremes in one direction, the light has changed, and the mean begins anew; where the samples differ from the
// history by the same sign for some frames, it fades. Weaknesses: where edges between motions are as close as the
// frame's pixels, only the extremes of one frame remain, and thin things are clamped away; light that changes in less
// than 7 × 7 pixels is followed over some eight frames; the first frames after a cut are single samples, blurred.
//
// `preset=karis` has the parts of `taa:preset=karis` at the image's resolution, as Unreal Engine 4.19 to 4.27. A
// pixel's current colour is the mean of the frame's 3 × 3 samples around it, by a kernel of one pixel's radius; the sum
// of the weights is the factor of the frame's share, so that a pixel far from every sample keeps its history. History
// is clamped to the range of the samples within 1.3 to 1.51 frame pixels. Left out: responsive materials, the flag that
// removes ghosts of moving objects before a background at rest, the wider kernel after rejection, which is of its
// supersampling mode, and dithering. Weaknesses: details of which a frame has no sample are clamped away, thin lines
// flicker; at 2 × a pixel's history is a mean of some 90 frames, so that after a cut the frame's own resolution stays
// visible for a second.
//
// A crop renders the whole image, since motion may bring any pixel into it.
//
// Source: Karis, High-Quality Temporal Supersampling, SIGGRAPH 2014 course; Unreal Engine 4.2x, TemporalAA.usf, pass
// MainUpsampling at high quality. Counts of samples: Yang et al., Amortized Supersampling, SIGGRAPH Asia 2009; Yang,
// Liu and Salvi, A Survey of Temporal Antialiasing Techniques, Eurographics 2020.
#include "zoneplate/upscale/jittered_frame.h"
#include "zoneplate/upscale/taau/sample_mean.h"
#include "zoneplate/upscale/taau/taau_core.h"
#include "zoneplate/upscale/taau/taau_method.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

constexpr std::string_view presets[] = {"best", "karis"};
constexpr Param taau_params[] = {
    scale_param,
    bias_param(0),
    {.name = "preset", .meaning = "mean of counted samples, or the shares of Unreal Engine 4", .names = presets}};

}  // namespace

Upscaler taau() {
  return {.name = "taau",
          .summary = "temporal antialiasing that upsamples: the mean of jittered samples, weighed by distance",
          .source = "Karis 2014; Yang et al. 2009; preset karis: Unreal Engine 4, TemporalAA.usf",
          .params = taau_params,
          .make_temporal = [](const Settings& s) -> std::unique_ptr<Resolver> {
            const double scale = s.number("scale"), bias = s.number("bias");
            if (s.chosen("preset") == "karis") return std::make_unique<TaauMethod<Taau>>("taau", scale, bias);
            return std::make_unique<TaauMethod<SampleMean>>("taau", scale, bias);
          },
          .is_specification_only = true};
}

}  // namespace zoneplate::upscale
