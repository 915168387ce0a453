// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/report/json.h"

namespace zoneplate {

/// The lessons of `zoneplate demo` with their parameters.
Json::Array figure_rows();

}  // namespace zoneplate
