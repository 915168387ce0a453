// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace zoneplate {

/// The results of a program that has ended.
struct ProgramResult {
  int code = 0;                   ///< exit code; 128 + n if signal n ended the program
  std::vector<std::uint8_t> out;  ///< all of stdout
  std::string complaint;          ///< the first line of stderr
};

struct ProgramLimits {
  int milliseconds = 20000;                  ///< the program is killed after this time
  std::size_t bytes = std::size_t{1} << 28;  ///< maximum size of stdout; the program is killed when it exceeds it
  /// Called while this process waits; may throw when a limit of its own is exceeded, for which the program is killed.
  std::function<void()> check_time = {};
};

/// Runs an installed program without a shell, with `input` as its stdin.
///
/// The program is searched in the absolute folders of PATH, then in /usr/local/bin, /usr/bin and /bin. Its environment
/// has only these folders and the C locale in UTF-8: without HOME, so that settings of the user have no effect.
/// It and the programs that it starts are killed when a limit is exceeded, or a signal handler calls `end_programs`.
/// Errors    ErrorKind::Failed naming the program if it cannot be started or exceeds a limit.
ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments, const std::string& input,
                        const ProgramLimits& limits = {});
/// An installed program that works while its input is written, in parts of any size. The rest is as for run_child.
class RunningProgram {
 public:
  /// `limits.milliseconds`: how long the program may keep this process waiting in one call.
  RunningProgram(const std::string& program, const std::vector<std::string>& arguments,
                 const ProgramLimits& limits = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  /// Returns when the program has taken all bytes or has closed its stdin.
  ///
  /// Errors    ErrorKind::Failed naming the program if it exceeds a limit.
  void write(std::span<const std::uint8_t> bytes);
  /// Ends its input and waits for its end. Called once, last.
  ///
  /// Errors    those of `write`.
  ProgramResult finish();

 private:
  class Process;
  std::unique_ptr<Process> process_;
};

/// Kills the programs that are running; async-signal-safe.
void end_programs();

}  // namespace zoneplate
