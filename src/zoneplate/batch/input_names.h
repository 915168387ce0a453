// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace zoneplate {

/// The inputs, with each folder replaced by the models in it and in its folders, sorted by name. Folders in it that
/// cannot be read are left out, and `warn` gets a message about each.
///
/// Errors    ErrorKind::Input for a folder without models, or one that cannot be read.
std::vector<std::string> with_folders_listed(const std::vector<std::string>& inputs,
                                             const std::function<void(const std::string&)>& warn);

/// Checks that an input exists and has the extension of a format that is read.
///
/// Errors    ErrorKind::Input.
void check_input(const std::string& input, const std::string& format);

}  // namespace zoneplate
