// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/base/isa.h"
#include "zoneplate/shade/environment/environment_view.h"

namespace zoneplate {

struct LookupKernels : PerIsa<LookupKernels> {
  /// specular_light (shade/environment/lookup_lanes.h) in directions of any length, each the three numbers at one
  /// index of the arrays.
  ///
  /// Requires  `count` is a multiple of 16.
  void (*specular)(const EnvironmentView& environment, const float* const direction[3], float roughness,
                   float* const light[3], int count);
  /// Control points of a level, the second of three, mixed with those of the levels before and after it.
  ///
  /// Requires  `count` is a multiple of 16.
  void (*mix_levels)(const float* const level[3], const float weights[3], float* mixed, int count);
};

}  // namespace zoneplate
