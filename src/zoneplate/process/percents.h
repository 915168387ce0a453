// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace zoneplate {

/// A function for RenderOptions::progress: it calls `report` with every new per cent of all work, while its argument
/// goes from 0 to 1 and the work from `begin` to `end`. Any thread may call it.
std::function<void(double)> percents(double begin, double end, std::function<void(double)> report);

}  // namespace zoneplate
