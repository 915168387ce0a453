// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
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
};

/// An unnamed temporary file, which exists as long as this object.
///
/// Errors    ErrorKind::Failed naming `owner` if it cannot be created or written.
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

/// Runs an installed program without a shell, with `input` as its stdin.
///
/// The program is searched in the absolute folders of PATH, then in /usr/local/bin, /usr/bin and /bin. Its environment
/// has only these folders and the C locale in UTF-8: without HOME, so that settings of the user have no effect.
/// Errors    ErrorKind::Failed naming the program if it cannot be started or exceeds a limit.
ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments, const std::string& input,
                        const ProgramLimits& limits = {});
/// Runs a program with a file as its stdin, read from the beginning.
ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments, const ScratchFile& input,
                        const ProgramLimits& limits = {});

}  // namespace zoneplate
