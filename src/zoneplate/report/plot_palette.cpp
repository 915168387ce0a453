// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/plot.h"

namespace zoneplate {

std::span<const Rgba8> plot_palette() {
  static constexpr Rgba8 palette[] = {{0, 114, 178}, {213, 94, 0},   {0, 158, 115}, {204, 121, 167},
                                      {230, 159, 0}, {86, 180, 233}, {40, 40, 40}};
  return palette;
}

Rgba8 curve_color(const Curve& curve, std::size_t place) {
  if (curve.color == Curve::grey) return {130, 130, 130, 255};
  return plot_palette()[(curve.color < 0 ? place : static_cast<std::size_t>(curve.color)) % plot_palette().size()];
}

}  // namespace zoneplate
