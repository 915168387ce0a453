// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/environment_cache.h"

#include <cstdlib>

namespace zoneplate::cli {
namespace {

std::string absolute_variable(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr && value[0] == '/' ? value : "";
}

}  // namespace

std::string environment_cache() {
  if (const std::string cache = absolute_variable("XDG_CACHE_HOME"); !cache.empty()) return cache + "/zoneplate";
  const std::string home = absolute_variable("HOME");
  return home.empty() ? "" : home + "/.cache/zoneplate";
}

}  // namespace zoneplate::cli
