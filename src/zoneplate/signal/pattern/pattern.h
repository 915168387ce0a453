#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "zoneplate/base/spec.h"
#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// A test picture that is made in code: what is in it is known, and so what a filter or a sampler may do to it.
struct PatternEntry {
  std::string_view name;
  std::string_view summary;
  std::vector<Param> params;
  LinearImage (*make)(std::span<const double> params);
};

/// zone-plate, sweep, sine, checkerboard, bricks, star, edge, impulse, noise.
std::span<const PatternEntry> patterns();

/// True where the text before a colon is the name of a pattern.
bool is_pattern(std::string_view text);

/// The picture of a text: `zone-plate:size=512`, `sine:frequency=0.2,angle=30`.
///
/// Shape     size × size pixels, each the pattern's value at its centre: no filter, as a sampler takes it.
/// Units     linear light; frequencies in cycles per pixel, angles in degrees, from +x towards +y (down).
/// Exact     the same bits on every machine.
/// Errors    ErrorKind::Usage for an unknown name or parameter, or a value out of its range.
LinearImage make_pattern(std::string_view text);

}  // namespace zoneplate
