#pragma once

#include <span>

#include "zoneplate/image/display_step.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Maps one linear colour (not premultiplied) to linear display light in [0, 1].
///
/// Edges     what is negative or not a number counts as 0, what is above 2^24 as 2^24.
float3 tone_map(float3 color, ToneMapping mapping);

/// The background of pictures unless another one is given: dark grey, as F3D has it.
inline constexpr float4 default_background{0.2f, 0.2f, 0.2f, 1};

struct DisplayOptions {
  ToneMapping mapping = ToneMapping::None;
  float exposure = 1;             ///< multiplies linear colour first
  bool is_transparent = false;    ///< keep alpha; else the background shows through
  float4 background{0, 0, 0, 1};  ///< sRGB code, straight alpha; shown as it is, not tone mapped
  bool raw = false;               ///< no tone mapping and no sRGB encoding (--color-management raw)
};

/// The picture as it is shown: straight colour × exposure is tone mapped, laid over the background in linear
/// light, and encoded. Where alpha is 0 a transparent picture holds (0, 0, 0, 0).
///
/// Edges     every channel of the result is in [0, 1], whatever the picture holds; where alpha is 0 the
///           background's own code is shown, where the picture is opaque nothing of it.
DisplayImage make_display(const LinearImage& image, const DisplayOptions& options);

/// Linear light × exposure over the background, premultiplied: the picture before tone mapping. A transparent picture
/// stays without background.
LinearImage over_background(LinearImage image, const DisplayOptions& options);

/// make_display of some pixels without the encoding: straight linear light in [0, 1], four floats a pixel.
void show_light(std::span<const Linear> pixels, const DisplayOptions& options, float* light);

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
