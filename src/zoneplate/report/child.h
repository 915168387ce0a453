#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace zoneplate {

/// What a program that ran to its end left behind.
struct ChildAnswer {
  int code = 0;                   ///< its exit code; 128 + n where signal n ended it
  std::vector<std::uint8_t> out;  ///< all of stdout
  std::string complaint;          ///< the first line of stderr
};

struct ChildLimits {
  int milliseconds = 20000;                  ///< then it is killed
  std::size_t bytes = std::size_t{1} << 28;  ///< of stdout; then it is killed
};

/// Runs a program of the system's folders on `input` as its stdin, without a shell.
///
/// Its environment is the same everywhere: no HOME, so that no settings of a user count, and the C locale in UTF-8.
/// Errors    Trouble::Failed naming the program where it cannot be started or goes past a limit.
ChildAnswer run_child(const std::string& program, const std::vector<std::string>& arguments, const std::string& input,
                      const ChildLimits& limits = {});

}  // namespace zoneplate
