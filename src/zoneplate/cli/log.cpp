// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/log.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/base/utf8.h"
#include "zoneplate/os/file.h"

namespace zoneplate::cli {
namespace {

// 0, or the errno of the failure.
int write_text(int file, std::string_view text) {
  return write_fully(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void check_written(const char* stream, int error) {
  if (error != 0) throw Error(ErrorKind::Output, std::string(stream) + ": " + std::strerror(error));
}

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view{} : std::string_view(value);
}

bool uses_color() {
  const std::string_view forced = environment("CLICOLOR_FORCE");
  if (!forced.empty() && forced != "0") return true;
  return stderr_is_terminal() && environment("NO_COLOR").empty();
}

// Each line is written by one call, so that lines of several processes do not mix.
void say(std::string_view kind, std::string_view color, std::string_view message) {
  std::string line = "zoneplate: ";
  if (!kind.empty()) {
    if (uses_color())
      line.append(color).append(kind).append("\x1b[0m: ");
    else
      line.append(kind).append(": ");
  }
  write_to_stderr(line + printable(message) + '\n');
}

}  // namespace

void print(const std::string& text) {
  const int error = write_text(STDOUT_FILENO, printable_lines(text));
  check_written("stdout", error == EPIPE ? 0 : error);
}

void print_report(const std::string& text, bool is_stdout_taken) {
  if (is_stdout_taken)
    check_written("stderr", write_text(STDERR_FILENO, printable_lines(text)));
  else
    check_written("stdout", write_text(STDOUT_FILENO, printable_lines(text)));
}

void write_to_stderr(std::string_view text) { static_cast<void>(write_text(STDERR_FILENO, text)); }

void say_error(const std::string& message) { say("error", "\x1b[1;31m", message); }
void say_warning(const std::string& message) { say("warning", "\x1b[1;33m", message); }
void say_note(const std::string& message) { say("", "", message); }

bool stderr_is_terminal() { return ::isatty(STDERR_FILENO) == 1 && environment("TERM") != "dumb"; }

}  // namespace zoneplate::cli
