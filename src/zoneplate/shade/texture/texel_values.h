// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "zoneplate/image/half.h"

/// The values of texels of every type.
namespace zoneplate {

/// The value clamped to [0, most]; NaN gives 0.
inline float clamped(float value, float most) { return value > 0 ? std::min(value, most) : 0.0f; }

/// The value of a texel, and the texel of a value, clamped to the texture's range.
template <class Code>
constexpr float unit_of = std::is_same_v<Code, std::uint8_t>    ? 1.0f / 255.0f
                          : std::is_same_v<Code, std::uint16_t> ? 1.0f / 32767.0f
                                                                : 1.0f;
template <class Code>
Code code_of(float value, float most) {
  const float inside = clamped(value, most);
  if constexpr (std::is_same_v<Code, std::uint8_t>)
    return static_cast<Code>(inside * 255.0f + 0.5f);
  else if constexpr (std::is_same_v<Code, std::uint16_t>)
    return static_cast<Code>(inside * 32767.0f + 0.5f);
  else if constexpr (std::is_same_v<Code, Half>)
    return {half_bits(std::min(inside, 65504.0f))};
  else
    return inside;
}

}  // namespace zoneplate
