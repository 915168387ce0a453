// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate::cli {

/// The output of `--version`: version, instruction set, compiler, commit, licence, and the versions of the libraries
/// that the program is linked with.
std::string version_text();

}  // namespace zoneplate::cli
