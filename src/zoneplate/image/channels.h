// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// The floats of a pixel. A row is an array of channels × width floats, with the channels of a pixel contiguous.
template <class Pixel>
inline constexpr std::size_t channels = sizeof(Pixel) / sizeof(float);

inline float* floats(std::span<float> row) { return row.data(); }
inline float* floats(std::span<Linear> row) { return &row.data()->r; }
inline const float* floats(std::span<const float> row) { return row.data(); }
inline const float* floats(std::span<const Linear> row) { return &row.data()->r; }

}  // namespace zoneplate
