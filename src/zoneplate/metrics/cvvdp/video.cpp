// SPDX-License-Identifier: Apache-2.0
// ColorVideoVDP of a sequence: the channels are filtered in time, and a fourth channel detects flicker.
//
// A frame is evaluated with the preceding quarter of a second. Weakness: fast pans, because eye movements are not
// modelled.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "zoneplate/metrics/cvvdp/cvvdp.h"
#include "zoneplate/metrics/power.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

constexpr double max_rate = 120;  // frames per second
constexpr int max_taps = 31;      // taps of the filters at that rate

OpponentPlanes seen_in_time(Frames frames, const Viewing& viewing, double rate) {
  const auto filters = temporal_filters(rate);
  std::vector<OpponentPlanes> planes;
  for (const Picture& frame : frames.last(std::min(frames.size(), filters[0].size()))) {
    planes.push_back(opponent_planes(frame.linear, viewing));
  }
  return filtered_in_time(planes, filters);
}

/// The quality of a sequence, computed from the root mean square of its frames' differences.
double pool(std::span<const double> frames) {
  std::vector<double> differences;
  for (const double quality : frames) differences.push_back(difference_of(quality));
  return quality_of(soft_root_mean_square(differences));
}

}  // namespace

std::vector<std::vector<double>> temporal_filters(double frames_per_second) {
  // Frequency responses: three low-passes, and a band-pass about 5 Hz.
  constexpr std::array<double, 4> width = {5.79336, 14.1255, 6.63661, 0.12314};
  constexpr std::array<double, 4> steepness = {1.3314, 1.1196, 0.947901, 0.1898};
  const int half = static_cast<int>(std::ceil(0.25 * frames_per_second / 2)), taps = 2 * half + 1;
  std::vector<std::vector<double>> filters;
  for (std::size_t c = 0; c < width.size(); ++c) {
    const double shift = c == 3 ? power(5, steepness[c]) : 0;
    std::vector<double> response;
    for (int k = 0; k <= half; ++k) {
      const double d = power(k * (frames_per_second / 2) / half, steepness[c]) - shift;
      response.push_back(natural_exp(-(c == 3 ? d * d : d) / width[c]));
    }
    std::vector<double> filter;
    for (int j = -half; j <= half; ++j) {
      double sum = response[0];
      for (int k = 1; k <= half; ++k) {
        sum += 2 * response[static_cast<std::size_t>(k)] * cos_pi(2.0 * ((j + taps) * k % taps) / taps);
      }
      filter.push_back(sum / taps);
    }
    filters.push_back(std::move(filter));
  }
  return filters;
}

OpponentPlanes filtered_in_time(std::span<const OpponentPlanes> frames,
                                const std::vector<std::vector<double>>& filters) {
  assert(!frames.empty());
  OpponentPlanes out;
  for (std::size_t c = 0; c < filters.size(); ++c) {
    const std::size_t source = c == 3 ? 0 : c, taps = filters[c].size();
    Plane<double> sum(frames[0][0].width(), frames[0][0].height());
    for (std::size_t back = 0; back < taps; ++back) {
      const OpponentPlanes& frame = frames[back < frames.size() ? frames.size() - 1 - back : 0];
      const double tap = filters[c][back];
      for_rows(sum.height(), [&](int y) {
        const auto from = frame[source].row(y);
        const auto to = sum.row(y);
        for (std::size_t x = 0; x < to.size(); ++x) to[x] += tap * from[x];
      });
    }
    out.push_back(std::move(sum));
  }
  return out;
}

Metric cvvdp_video() {
  static constexpr Param params[] = {viewing_params[0], viewing_params[1],
                                     real_param("fps", "frames shown in a second", 60, 4, max_rate)};
  return {.name = "cvvdp_video",
          .summary = "ColorVideoVDP of a sequence: quality in JOD, flicker included (10 is the same)",
          .source = "Mantiuk et al. 2024, version 0.5.6",
          .unit = "JOD",
          .better = Better::Higher,
          .perfect = 10.0,
          .is_default = false,
          .frames = max_taps,
          .starts_short = true,
          .smallest = min_visible_size,
          .params = params,
          .measure = [](Frames reference, Frames test, const Settings& settings) -> std::optional<Score> {
            const Viewing viewing = viewing_of(settings);
            const double rate = settings.number("fps");
            const std::vector<double> channels =
                visible_difference(seen_in_time(reference, viewing, rate), seen_in_time(test, viewing, rate), viewing,
                                   reference.back().is_ignored);
            return Score{.value = quality_of(pool_channels(channels)), .more = channel_figures(channels)};
          },
          .pool = pool};
}

}  // namespace zoneplate::metrics
