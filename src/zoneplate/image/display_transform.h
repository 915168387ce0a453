// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "zoneplate/image/display_step.h"
#include "zoneplate/image/pixel.h"
#include "zoneplate/image/tonemap.h"

namespace zoneplate {

/// make_display of some pixels without the encoding: straight linear light in [0, 1], four floats per pixel.
void show_light(std::span<const Linear> pixels, const DisplayOptions& options, float* light);

/// make_display of some pixels: straight and encoded, four floats per pixel.
void show_encoded(std::span<const Linear> pixels, const DisplayOptions& options, float* encoded);

/// make_display followed by quantize8, a few pixels at a time, while they are in the cache.
class DisplayTransform {
 public:
  explicit DisplayTransform(const DisplayOptions& options);

  /// `out` has capacity for eight pixels per group.
  void present(std::span<const Linear8> groups, Rgba8* out) const;
  /// The same for spans, of which span i is stored from out[i] on.
  void present(const SpanColors& colors, std::span<Rgba8* const> out) const;
  /// Whether `present` gives the same codes to eight opaque or blended pixels whatever lies behind their front layers.
  /// `front` has the colour of these layers and, as alpha, the transmittance to what lies behind, of which no
  /// premultiplied channel exceeds `brightest` times its alpha. `rounding` bounds the error of the pixels that will be
  /// presented, relative to colour and alpha. False without a proof: with tone mapping, or if the background is not
  /// opaque.
  bool is_decided(const Linear8& front, float brightest, float rounding) const;
  /// The display-referred colour of empty pixels.
  Rgba8 background() const { return background_; }

 private:
  DisplayStep step_;
  Rgba8 background_;
};

}  // namespace zoneplate
