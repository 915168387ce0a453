// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace zoneplate::cli {

/// Writes text to stdout, all of it or an error; nothing else of the program writes there but images for "-".
///
/// Errors    ErrorKind::Output where stdout is closed or full.
void print(const std::string& text);

enum class Verbosity { Quiet, Normal, Verbose };

/// Prints one line to stderr: `zoneplate: warning: ...`. Control characters are replaced by '?'.
///
/// The kind of line is coloured on a terminal; NO_COLOR and TERM=dumb say no, CLICOLOR_FORCE says yes anywhere.
void say_error(const std::string& message);
void say_warning(const std::string& message);
void say_note(const std::string& message);

/// True where stderr is a terminal that moves its cursor.
bool stderr_is_terminal();

}  // namespace zoneplate::cli
