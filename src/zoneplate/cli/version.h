// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate::cli {

/// What `--version` prints: version, instruction set, compiler, commit, licence, and the versions of the libraries that
/// the program is linked with.
std::string version_text();

}  // namespace zoneplate::cli
