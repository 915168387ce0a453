// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/evaluate/compare/report.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"

namespace zoneplate {

/// The regions of greatest error of one method, enlarged 8 times: the reference, the method, and the FLIP error map,
/// one below the other.
Rgba8Image worst_picture(const SceneTrials& scene, const Trial& trial);

/// The whole scene with the region of the greatest mean error marked, and that region rendered by every method,
/// enlarged 8 times, the best first.
Rgba8Image crops_picture(const SceneTrials& scene);

/// Row `y` of every frame, one below the other: time runs downwards.
Rgba8Image slice_in_time(const std::vector<Rgba8Image>& film, int y);

/// Eight times the difference of two films, about grey.
std::vector<Rgba8Image> difference_film(const std::vector<Rgba8Image>& reference, const std::vector<Rgba8Image>& test);

/// The ranking metric against CPU time, with the Pareto front and the names of its methods.
Plot cost_plot(const SceneTrials& scene);

/// The plot of the means over several scenes.
Plot cost_plot(const std::vector<SceneTrials>& scenes);

}  // namespace zoneplate
