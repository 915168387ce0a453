// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace zoneplate {

/// The results of a program that has ended.
struct ProgramResult {
  int code = 0;                   ///< its exit code; 128 + n where signal n ended it
  std::vector<std::uint8_t> out;  ///< all of stdout
  std::string complaint;          ///< the first line of stderr
};

struct ProgramLimits {
  int milliseconds = 20000;                  ///< then it is killed
  std::size_t bytes = std::size_t{1} << 28;  ///< of stdout; then it is killed
};

/// A file without a name among the temporary ones, which ends with this object.
///
/// Errors    ErrorKind::Failed naming `owner`, where there is no room for it.
class ScratchFile {
 public:
  explicit ScratchFile(std::string owner);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  void append(std::span<const std::uint8_t> bytes);
  std::uint64_t size() const { return size_; }
  int number() const { return number_; }

 private:
  std::string owner_;
  int number_;
  std::uint64_t size_ = 0;
};

/// Runs a program of the system's folders on `input` as its stdin, without a shell.
///
/// It is looked for in the absolute folders of PATH, then in /usr/local/bin, /usr/bin and /bin. Its environment is
/// these folders and the C locale in UTF-8: no HOME, so that no settings of a user count. Errors    ErrorKind::Failed
/// naming the program where it cannot be started or goes past a limit.
ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments, const std::string& input,
                        const ProgramLimits& limits = {});
/// The same with a file as its stdin, read from its beginning.
ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments, const ScratchFile& input,
                        const ProgramLimits& limits = {});

}  // namespace zoneplate
