#pragma once

#include <cstddef>
#include <span>

#include "zoneplate/base/isa.h"
#include "zoneplate/image/pixel.h"
#include "zoneplate/image/tonemap.h"

namespace zoneplate {

/// What make_display does to each pixel, with the background made ready.
struct DisplayStep {
  ToneMapping mapping = ToneMapping::None;  ///< None where raw
  float exposure = 1;
  bool is_encoded = true;
  bool is_transparent = false;
  float code[4] = {0, 0, 0, 1};   ///< the background as shown, straight; all 0 where its alpha is 0
  float light[4] = {0, 0, 0, 1};  ///< the background in linear light, premultiplied
};

struct TonemapKernels : PerIsa<TonemapKernels> {
  /// n pixels of four floats: Linear in, Display out.
  void (*display_row)(const DisplayStep& step, const float* linear, float* display, std::size_t n);
  /// The same of n groups of eight pixels, and quantize8 of that.
  void (*show_groups)(const DisplayStep& step, const Linear8* linear, Rgba8* shown, std::size_t n);
};

/// make_display of some pixels without the encoding: straight linear light in [0, 1], four floats a pixel.
void show_light(std::span<const Linear> pixels, const DisplayOptions& options, float* light);

/// make_display of some pixels: straight and encoded, four floats a pixel.
void show_encoded(std::span<const Linear> pixels, const DisplayOptions& options, float* encoded);

/// quantize8 of make_display, a few pixels at a time: for those that are shown while they are in cache.
class DisplayTransform {
 public:
  explicit DisplayTransform(const DisplayOptions& options);

  /// `out` has room for eight pixels a group.
  void present(std::span<const Linear8> groups, Rgba8* out) const;
  /// What is shown where the picture is empty.
  Rgba8 background() const { return background_; }

 private:
  DisplayStep step_;
  Rgba8 background_;
};

}  // namespace zoneplate
