// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/image/rgb.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// The radiance of a texel of an environment image.
///
/// Edges     light that is negative or not a number counts as 0, above 1e9 as 1e9; alpha is ignored.
inline float3 radiance_of(float4 light) {
  const auto bounded = [](float x) { return x > 0 ? (x < 1e9f ? x : 1e9f) : 0.0f; };
  return {bounded(light.x), bounded(light.y), bounded(light.z)};
}
inline float3 radiance_of(Rgba16 code) {
  const auto light = [](int c) { return decode_srgb(static_cast<float>(c) / 65535); };
  return {light(code.r), light(code.g), light(code.b)};
}
inline float3 radiance_of(Rgba8 code) {
  const auto light = [](int c) { return decode_srgb(static_cast<float>(c) / 255); };
  return {light(code.r), light(code.g), light(code.b)};
}

}  // namespace zoneplate
