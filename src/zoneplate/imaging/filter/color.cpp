// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/filter/color.h"

#include <fmt/format.h>

#include "zoneplate/codec/save.h"
#include "zoneplate/imaging/filter/items.h"
#include "zoneplate/metrics/file/picture_file.h"

namespace zoneplate {

metrics::Picture in_space_of(metrics::Picture picture, FilteredValues values, const std::string& input,
                             const std::string& output, Delivery& out) {
  if (!picture.space) return picture;
  const RgbSpace& space = *picture.space;
  const bool is_stated = can_hold(extension_of(output), space.profile);
  const bool is_made =
      picture.is_scene_linear || space.is_standard || values == FilteredValues::Codes || can_encode(space);
  if (is_stated && is_made) return picture;
  if (!space.is_standard)
    warn_of_conversion(input, space, is_stated ? "gives light but no codes" : output + " cannot state",
                       is_linear_file(output) ? rec709_light : clamped_srgb, out);
  return metrics::in_srgb(std::move(picture));
}

void warn_of_conversion(const std::string& input, const RgbSpace& space, const std::string& why,
                        const std::string& target, Delivery& out) {
  out.warn(fmt::format("{}: has {}, which {}: its colours are converted to {}", input, space.name, why, target));
}

ColorProfile profile_of(const RgbSpacePtr& space) { return space ? space->profile : ColorProfile{}; }

DisplayImage display_of(LinearImage light, const RgbSpacePtr& space) {
  if (space && !space->is_standard) return codes_of(light, *space);
  return metrics::make_picture(std::move(light)).display;
}

}  // namespace zoneplate
