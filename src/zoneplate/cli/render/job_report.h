// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "zoneplate/cli/render/args.h"
#include "zoneplate/job/summary.h"
#include "zoneplate/report/json.h"

namespace zoneplate::cli {

/// The result as JSON.
Json::Object summary_json(const RenderArgs& args, const Summary& summary);

/// The line of --dry-run about an item, and its report as JSON with this status.
std::string plan_text(const RenderArgs& args);
Json::Object plan_json(const RenderArgs& args, std::string_view status);

}  // namespace zoneplate::cli
