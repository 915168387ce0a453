// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate {

/// Opens the library that encode_image needs for an ending such as ".avif", so that processes which this one forks
/// have it; nothing for the other endings. `output` is the prefix of the error message.
///
/// Errors    ErrorKind::Input naming the library and its package if it is not installed.
void open_encoder_library(const std::string& extension, const std::string& output);

}  // namespace zoneplate
