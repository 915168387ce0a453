// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "zoneplate/formats/import/load_options.h"

namespace zoneplate {

/// The message about an input that takes longer to read than its limit.
std::string late_reading(const std::string& name, const LoadLimits& limits);

/// Reads a model with the limit of import time.
///
/// Errors    ErrorKind::Input naming the model and the option if the time is exceeded; exceptions of `read`.
void within_import_time(const std::string& name, const LoadLimits& limits, const std::function<void()>& read);

}  // namespace zoneplate
