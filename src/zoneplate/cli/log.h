// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate::cli {

/// Writes text to stdout, completely or with an error. All other writes of the program to stdout are images for "-".
///
/// Errors    ErrorKind::Output if stdout is closed or full.
void print(const std::string& text);

enum class Verbosity { Quiet, Normal, Verbose };

/// Prints one line to stderr: `zoneplate: warning: ...`. Control characters are replaced by '?'.
///
/// The kind of line is coloured on a terminal; NO_COLOR and TERM=dumb disable colours, CLICOLOR_FORCE enables them
/// everywhere.
void say_error(const std::string& message);
void say_warning(const std::string& message);
void say_note(const std::string& message);

/// True if stderr is a terminal that supports cursor movement.
bool stderr_is_terminal();

}  // namespace zoneplate::cli
