// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/edges/edge_options.h"

namespace zoneplate {

/// The value of --edges, such as `features:angle=40`; the colour stays as it is in `options`.
/// Errors    ErrorKind::Usage for an unknown kind or parameter.
void set_edges(const std::string& text, EdgeOptions& options);

}  // namespace zoneplate
