#pragma once

#include <string>
#include <vector>

#include "zoneplate/cli/compare/report.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"

namespace zoneplate::cli {

/// The worst places of one method, 8 times enlarged: the reference, the method, and FLIP between them, below one
/// another.
Rgba8Image worst_picture(const SceneTrials& scene, const Trial& trial);

/// The whole scene with the place where the methods are worst on average, and that place under every method, 8 times
/// enlarged, the nearest to the reference first.
Rgba8Image crops_picture(const SceneTrials& scene);

/// Error over time, the Pareto front marked and named.
Plot cost_plot(const SceneTrials& scene);

/// The same of the means over several scenes.
Plot cost_plot(const std::vector<MethodMeans>& means);

}  // namespace zoneplate::cli
