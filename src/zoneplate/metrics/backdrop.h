// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "zoneplate/metrics/picture.h"

namespace zoneplate::metrics {

/// A background over which an image with alpha is measured.
enum class Backdrop { Black, White };

/// True if a pixel is not opaque.
bool has_alpha(const Picture& picture);

/// The same image in values that a metric can measure: NaN is 0, and an infinity ±65504, the greatest half float.
Picture finite(Picture picture);

inline bool is_finite(const Linear& c) {
  return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b) && std::isfinite(c.a);
}

inline float finite(float v) {
  constexpr float max_half = 65504;
  return std::isfinite(v) ? v : std::isnan(v) ? 0.0f : std::copysign(max_half, v);
}
inline Linear finite(Linear c) { return {finite(c.r), finite(c.g), finite(c.b), finite(c.a)}; }

/// The image over a backdrop: display-referred images as codes are blended, scene-linear ones in light, to which also
/// light without alpha (of flames) adds.
///
/// Requires  finite values.
Picture laid_on(Picture picture, Backdrop backdrop);

}  // namespace zoneplate::metrics
