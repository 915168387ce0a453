// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace zoneplate::cli {

/// Writes text to stdout, completely or with an error. All other writes of the program to stdout are images for "-".
/// Control characters but line breaks and tabs are replaced by '?' (base/utf8.h); names in it are `printable`.
///
/// For output that has no purpose without a reader, such as a list or a help text: nothing is written, without an
/// error, to a pipe whose reader has ended.
/// Errors    ErrorKind::Output if stdout is closed or full.
void print(const std::string& text);

/// Writes the report of a run that makes files, as `print`: to stdout, or to stderr where stdout is the image.
///
/// Errors    ErrorKind::Output if it cannot be written; also for a pipe without a reader.
void print_report(const std::string& text, bool is_stdout_taken = false);

/// Writes text to stderr; errors are ignored.
void write_to_stderr(std::string_view text);

enum class Verbosity { Quiet, Normal, Verbose };

/// Prints one line to stderr: `zoneplate: warning: ...`, of the printable message (base/utf8.h).
///
/// The kind of line is coloured on a terminal; NO_COLOR and TERM=dumb disable colours, CLICOLOR_FORCE enables them
/// everywhere.
void say_error(const std::string& message);
void say_warning(const std::string& message);
void say_note(const std::string& message);

/// True if stderr is a terminal that supports cursor movement.
bool stderr_is_terminal();

}  // namespace zoneplate::cli
