// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate::cli {

/// True if the name has a placeholder for the frame number: "####" or "@@@@", "%04d", "$F" or "$F4", "{frame}"
/// or "{frame:04}".
bool has_frame_number(const std::string& name);

/// Replaces the placeholder by the frame number, padded with zeros as it specifies.
///
/// "a.####.png" and 7 give "a.0007.png". Numbers longer than the placeholder are written in full.
std::string frame_name(const std::string& name, int frame);

}  // namespace zoneplate::cli
