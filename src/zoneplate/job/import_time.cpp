// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/import_time.h"

#include <fmt/format.h>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"

namespace zoneplate {

std::string late_reading(const std::string& name, const LoadLimits& limits) {
  return fmt::format("{}: takes longer to load than the limit of {:.6g} s (--max-import-seconds)", name,
                     limits.seconds);
}

void within_import_time(const std::string& name, const LoadLimits& limits, const std::function<void()>& read) {
  with_deadline(limits.seconds, ErrorKind::Input, late_reading(name, limits), read);
}

}  // namespace zoneplate
