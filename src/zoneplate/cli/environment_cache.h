// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate::cli {

/// The folder of prepared environments (os/cache_folder.h): zoneplate in $XDG_CACHE_HOME, or else in $HOME/.cache;
/// empty where neither is an absolute path.
std::string environment_cache();

}  // namespace zoneplate::cli
