#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// A portable float map: RGB floats, little-endian, rows from the bottom up; alpha is left out.
std::vector<std::uint8_t> encode_pfm(const LinearImage& image);
/// The same with one float a pixel.
std::vector<std::uint8_t> encode_pfm(const Plane<float>& image);

}  // namespace zoneplate
