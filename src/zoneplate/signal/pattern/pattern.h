// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/base/spec.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// A procedural test image: its contents, and therefore the correct result of a filter or sampler, are known.
struct PatternEntry {
  std::string_view name;
  std::string_view summary;
  std::vector<Param> params;
  LinearImage (*make)(std::span<const double> params);
};

/// zone-plate, sweep, sine, checkerboard, bricks, star, edge, impulse, perlin, noise.
std::span<const PatternEntry> patterns();

/// True if the text before a colon is the name of a pattern.
bool is_pattern(std::string_view text);

/// Parses and makes a pattern: `zone-plate:size=512`, `sine:frequency=0.2,angle=30`.
///
/// Shape     size × size pixels, each the pattern's value at its centre: point-sampled, not filtered.
/// Units     linear light; frequencies in cycles per pixel, angles in degrees, from +x towards +y (down).
/// Exact     the same bits on every machine.
/// Errors    ErrorKind::Usage for an unknown name or parameter, or a value out of its range.
LinearImage make_pattern(std::string_view text);

}  // namespace zoneplate
