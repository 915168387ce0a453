// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/antialias/temporal/jitter.h"
#include "zoneplate/antialias/temporal/parts.h"
#include "zoneplate/base/spec.h"

namespace zoneplate::antialias {

/// The kernel by which the current colour is made from 3 × 3 samples.
enum class CurrentFilter {
  Point,     ///< the pixel's own sample
  Unjitter,  ///< bilinear interpolation at the pixel's centre
  Gauss,     ///< exp(-2.29 d²) of the distance to the pixel's centre in pixels
};

/// What pixels without history are; those of two frames are so to a quarter.
enum class NewPixels {
  Sample,     ///< their sample
  Smaa,       ///< that of the image filtered by SMAA
  SmaaExact,  ///< that of the image filtered with SMAA's edges and the areas for the frame's sample
};

/// The options of temporal antialiasing.
struct TemporalOptions {
  TemporalParts parts;
  JitterSequence sequence = JitterSequence::Halton;
  int length = 16;  ///< of the jitter's period
  CurrentFilter current = CurrentFilter::Point;
  bool follows_camera = false;  ///< motion is that of a scene at rest, from depths and cameras
  float bias = 0;               ///< mip levels that textures are blurrier than for one sample per pixel
  float sharpening = 0;
  NewPixels new_pixels = NewPixels::Sample;
  int settling_frames = 64;
};

/// The parameters of `taa`.
std::span<const Param> temporal_params();

/// The options of a preset, changed by the parameters that are given.
TemporalOptions temporal_options(const Settings& settings);

/// The weights of a current filter for samples at a position of every pixel, by row; their sum is 1.
void set_kernel(CurrentFilter filter, SamplePosition jitter, TemporalParts& parts);

}  // namespace zoneplate::antialias
