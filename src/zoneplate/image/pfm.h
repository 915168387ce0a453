#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// A portable float map: RGB floats, little-endian, rows from the bottom up; alpha is left out.
std::vector<std::uint8_t> encode_pfm(const LinearImage& image);

}  // namespace zoneplate
