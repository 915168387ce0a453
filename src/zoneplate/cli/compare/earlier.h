// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <string>

#include "zoneplate/cli/confined.h"

namespace zoneplate::cli {

/// The files and subfolders that an earlier comparison has written into a folder, by its report compare.json, which a
/// confined process reads. Nothing if there is no such folder.
///
/// Errors    ErrorKind::Output naming the folder, if it has no report of a comparison.
std::optional<std::set<std::string>> earlier_files(const std::string& folder, const ReadingLimits& limits);

}  // namespace zoneplate::cli
