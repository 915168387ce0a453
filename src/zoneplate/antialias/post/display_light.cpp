// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/display_light.h"

namespace zoneplate::antialias {

Linear DisplayLight::operator()(Linear color) const {
  if (!(color.a > 0)) return {0, 0, 0, 0};
  const float a = color.a < 1 ? color.a : 1.0f;
  const auto straight = [&](float v) { return v / a * options_.exposure; };
  const float3 mapped = tone_map({straight(color.r), straight(color.g), straight(color.b)},
                                 options_.raw ? ToneMapping::None : options_.mapping);
  return {mapped.x * a, mapped.y * a, mapped.z * a, a};
}

DisplayImage encode_display_light(const LinearImage& image, DisplayOptions options) {
  options.mapping = ToneMapping::None;
  options.exposure = 1;
  return make_display(image, options);
}

}  // namespace zoneplate::antialias
