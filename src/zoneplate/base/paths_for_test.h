// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate {

// Paths of this build, defined in a source that CMake writes: objects of tests hold no path, so that a compiler cache
// shares them between folders.

extern const char* const source_root;       ///< the project's root folder
extern const char* const program_file;      ///< the command
extern const char* const appetite_program;  ///< the generator of inputs that ask for much memory or time (fuzz/)

}  // namespace zoneplate
