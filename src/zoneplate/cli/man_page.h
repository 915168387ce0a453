// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/cli/args.h"

namespace zoneplate::cli {

/// The section of a verb in the manual page, in the man macros of roff: its options in their groups, examples and
/// notes.
std::string man_section(const Syntax& syntax);

/// Text for roff: backslashes, hyphens, and dots and quotes at the beginning of a line are escaped.
std::string roff(const std::string& text);

}  // namespace zoneplate::cli
