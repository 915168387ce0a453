#pragma once

#include <string>

namespace zoneplate::cli {

/// True where the name says where a frame's number stands: "####", "%04d", "{frame}" or "{frame:04}".
bool has_frame_number(const std::string& name);

/// The name with the frame's number in its place, padded with zeros as the place says, and "{model}" replaced.
///
/// "a.####.png" and 7 give "a.0007.png". Numbers that are longer than their place are written in full.
std::string frame_name(const std::string& name, int frame, const std::string& model);

}  // namespace zoneplate::cli
