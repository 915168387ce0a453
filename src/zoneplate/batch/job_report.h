// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "zoneplate/job/job.h"
#include "zoneplate/job/summary.h"
#include "zoneplate/report/json.h"

namespace zoneplate {

/// The result as JSON.
Json::Object summary_json(const Job& args, const Summary& summary);

/// The line of --dry-run about an item, and its report as JSON with this status.
std::string plan_text(const Job& args);
Json::Object plan_json(const Job& args, std::string_view status);

}  // namespace zoneplate
