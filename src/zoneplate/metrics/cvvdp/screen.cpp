// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>

#include "zoneplate/metrics/cvvdp/cvvdp.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {

Viewing viewing_of(const Settings& settings) {
  return {.pixels_per_degree = settings.number("ppd"), .peak = settings.number("peak")};
}

std::vector<Figure> channel_figures(const std::vector<double>& channels) {
  constexpr const char* names[] = {"luminance", "red_green", "violet_yellow", "transient"};
  std::vector<Figure> figures;
  for (std::size_t c = 0; c < channels.size(); ++c) figures.push_back({names[c], channels[c], ""});
  return figures;
}

OpponentPlanes opponent_planes(const LinearImage& image, const Viewing& viewing) {
  const double black = viewing.peak / viewing.contrast;
  const double reflected = viewing.ambient / std::numbers::pi * 0.005;
  OpponentPlanes out(3, Plane<double>(image.width(), image.height()));
  for_rows(image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x) {
      const auto emitted = [&](float v) {
        return (viewing.peak - black) * static_cast<double>(std::clamp(v, 0.0f, 1.0f)) + black + reflected;
      };
      const Linear c = image(x, y);
      const double r = emitted(c.r), g = emitted(c.g), b = emitted(c.b);

      // Linear light to XYZ, to the cone responses of the 2006 fundamentals, to opponent differences relative to D65.
      const double px = 0.4124564 * r + 0.3575761 * g + 0.1804375 * b;
      const double py = 0.2126729 * r + 0.7151522 * g + 0.0721750 * b;
      const double pz = 0.0193339 * r + 0.1191920 * g + 0.9503041 * b;
      const double l = 0.187596268556126 * px + 0.585168649077728 * py - 0.026384263306304 * pz;
      const double m = -0.133397430663221 * px + 0.405505777260049 * py + 0.034502127690364 * pz;
      const double s = 0.000244379021663 * px - 0.000542995890619 * py + 0.019406849066323 * pz;
      out[0](x, y) = l + m;
      out[1](x, y) = l - 2.311130179947035 * m;
      out[2](x, y) = 50.977571328718781 * s - l - m;
    }
  });
  return out;
}

}  // namespace zoneplate::metrics
