// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/image/rgb_space.h"
#include "zoneplate/metrics/picture.h"
#include "zoneplate/process/delivery.h"

namespace zoneplate {

/// What a filter computes on: the codes as they are, or their light, which becomes codes again.
enum class FilteredValues { Codes, Light };

/// The image in a colour space that the output file can state: its own one, or else sRGB (or light of Rec.709
/// primaries), with a warning.
metrics::Picture in_space_of(metrics::Picture picture, FilteredValues values, const std::string& input,
                             const std::string& output, Delivery& out);

/// Warns that the colours of an input are converted to others, because its space `why`: "gives light but no codes".
void warn_of_conversion(const std::string& input, const RgbSpace& space, const std::string& why,
                        const std::string& target, Delivery& out);
/// The targets.
inline constexpr const char* rec709_light = "light of Rec.709 primaries";
inline constexpr const char* clamped_srgb = "sRGB, and those outside it are clamped";

/// What the file of an image in this space states.
ColorProfile profile_of(const RgbSpacePtr& space);

/// Display-referred values of light in the primaries of a space.
DisplayImage display_of(LinearImage light, const RgbSpacePtr& space);

}  // namespace zoneplate
