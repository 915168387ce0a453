// SPDX-License-Identifier: Apache-2.0
// Ghosts: what remains of an object in the first frame without it, and how long it remains.
//
// Weakness: at pixels that are never at rest for eight frames a ghost is not measured.
#include "zoneplate/metrics/event.h"

namespace zoneplate::metrics {

Metric ghost() {
  return {.name = "ghost",
          .summary = "share of the earlier image that remains in the first frame after a sudden change",
          .source = "projection of the error onto the change of the reference, in linear light",
          .unit = "",
          .is_default = false,
          .frames = event_window,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            auto event = event_response(reference, test);
            if (!event) return std::nullopt;
            const std::vector<double>& remains = event->remains;
            return Score{.value = remains[1],
                         .more = {{"half_life", frames_until(remains, 0.5), "frames"}, {"last", remains.back(), ""}},
                         .map = std::move(event->map)};
          }};
}

}  // namespace zoneplate::metrics
