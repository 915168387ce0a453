// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"

namespace zoneplate {

/// Plots that another process draws, because a confined one starts no program.
struct PlotsToDraw {
  std::vector<Plot> plots;
  int columns = 1;
  PlotSize size;
  std::optional<Figure> figure = {};  ///< instead of `plots`, the panels that have a plot but no picture
};

/// Draws them in the format of the path's ending, .svg or PNG.
///
/// Errors    those of report/plot.h, also after `seconds`.
std::vector<std::uint8_t> drawn_plots(PlotsToDraw plots, const std::string& path, double seconds);

std::vector<std::uint8_t> pack_plots(const PlotsToDraw& plots);

/// Errors    ErrorKind::Failed for bytes that are not those of `pack_plots`, or of too many and too large plots.
PlotsToDraw unpack_plots(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
