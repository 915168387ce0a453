// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/shade/texture/height_normals.h"

namespace zoneplate {

struct NormalMapOptions : SignalOptions {
  HeightNormals heights;
};

/// Makes a normal map of a height map.
void make_normal_map(const std::string& input, const NormalMapOptions& args, Delivery& out);

}  // namespace zoneplate
