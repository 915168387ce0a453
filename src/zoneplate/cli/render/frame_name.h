// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate::cli {

/// True if the name has a placeholder for the frame number: "####", "%04d", "{frame}" or "{frame:04}".
bool has_frame_number(const std::string& name);

/// The name with the frame number in place of the placeholder, padded with zeros as it specifies, and "{model}"
/// replaced.
///
/// "a.####.png" and 7 give "a.0007.png". Numbers that are longer than their place are written in full.
std::string frame_name(const std::string& name, int frame, const std::string& model);

}  // namespace zoneplate::cli
