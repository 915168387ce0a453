// SPDX-License-Identifier: Apache-2.0
// Lag: how late a sudden change, such as of a light that is switched, reaches the image.
//
// Weakness: the same as that of `ghost`, whose measurement it shares.
#include "zoneplate/metrics/event.h"

namespace zoneplate::metrics {

Metric lag() {
  return {.name = "lag",
          .summary = "frames until nine tenths of a sudden change have reached the image",
          .source = "step response; projection of the error onto the change of the reference, in linear light",
          .unit = "frames",
          .is_default = false,
          .frames = event_window,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            const auto event = event_response(reference, test);
            if (!event) return std::nullopt;
            return Score{.value = frames_until(event->remains, 0.1)};
          }};
}

}  // namespace zoneplate::metrics
