// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate::cli {

/// The output of `--version`: version, instruction set, compiler, commit, licence, and the versions of the libraries
/// that the program is linked with.
std::string version_text();

/// The version and the commit of this program: "1.2.0 0123456789ab". Programs of one name make the same files.
std::string program_name();

}  // namespace zoneplate::cli
