#pragma once

#include <span>

#include "zoneplate/image/rgb.h"
#include "zoneplate/image/tone_mapping.h"
#include "zoneplate/image/tonemap_kernels.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Maps one linear colour (not premultiplied) to linear display light in [0, 1].
///
/// Edges     negative values and NaN count as 0, values above 2^24 as 2^24.
float3 tone_map(float3 color, ToneMapping mapping);

/// The default background: dark grey, as in F3D.
inline constexpr float4 default_background{0.2f, 0.2f, 0.2f, 1};

struct DisplayOptions {
  ToneMapping mapping = ToneMapping::None;
  float exposure = 1;             ///< multiplies linear colour first
  bool is_transparent = false;    ///< keep alpha instead of compositing over the background
  float4 background{0, 0, 0, 1};  ///< sRGB-encoded, straight alpha; not tone-mapped
  bool raw = false;               ///< no tone mapping and no sRGB encoding (--color-management raw)
};

/// The display-referred image: straight colour × exposure is tone-mapped, composited over the background in linear
/// light, and encoded. A transparent image is (0, 0, 0, 0) where alpha is 0.
///
/// Edges     every channel of the result is in [0, 1], for any input; where alpha is 0 the result is exactly the
///           background, where the image is opaque it does not depend on the background.
DisplayImage make_display(const LinearImage& image, const DisplayOptions& options);

/// Linear light × exposure over the background, premultiplied, without tone mapping. A transparent image has no
/// background.
LinearImage over_background(LinearImage image, const DisplayOptions& options);

/// make_display of some pixels without the encoding: straight linear light in [0, 1], four floats a pixel.
void show_light(std::span<const Linear> pixels, const DisplayOptions& options, float* light);

/// quantize8 of make_display, a few pixels at a time, while they are in the cache.
class DisplayTransform {
 public:
  explicit DisplayTransform(const DisplayOptions& options);

  /// `out` has eight pixels for each group.
  void present(std::span<const Linear8> groups, Rgba8* out) const;
  /// The display-referred colour of empty pixels.
  Rgba8 background() const { return background_; }

 private:
  DisplayStep step_;
  Rgba8 background_;
};

}  // namespace zoneplate
