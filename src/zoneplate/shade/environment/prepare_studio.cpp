// SPDX-License-Identifier: Apache-2.0
// Apart from studio.cpp, so that a module that has the bytes of the prepared studio defines the function itself.
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/environment/studio.h"

namespace zoneplate {

PreparedEnvironment prepare_studio() { return PreparedEnvironment(studio_cube(64)); }

}  // namespace zoneplate
