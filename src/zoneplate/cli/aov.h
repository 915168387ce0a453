#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/render/frame.h"

namespace zoneplate::cli {

/// A data pass that is written as a picture beside the colour.
struct Aov {
  std::string_view name, meaning;
  bool Planes::*plane;                                ///< the plane of the frame that it needs
  std::vector<std::uint8_t> (*encode)(const Frame&);  ///< as PNG
};

/// All of them.
///
/// depth        16-bit grey: code 0 is the nearest and 65534 the farthest distance seen, linear between; 65535 is
///              nothing. The distances are in the tEXt chunks "near" and "far".
/// normal       8-bit: 0.5 + 0.5 n of the world-space normal; transparent where nothing is, as all below.
/// albedo       8-bit sRGB base colour.
/// uv           8-bit: red and green are the fractional parts of u and v.
/// *-id         a false colour for each number, the same in every picture.
/// coverage     16-bit grey: share of the pixel's samples that a surface owns.
/// error        16-bit grey: estimated standard error of the colour, white being the greatest of the picture; that and
///              the root mean square, in light, are in the tEXt chunks "greatest" and "rms".
std::span<const Aov> aovs();

}  // namespace zoneplate::cli
