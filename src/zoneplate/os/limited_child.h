// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace zoneplate {

/// The stream to which a child process writes its answer.
class ChildAnswer {
 public:
  explicit ChildAnswer(int pipe) : pipe_(pipe) {}
  /// Does not return if the reader is gone.
  void write(const void* data, std::size_t size);
  bool is_begun() const { return is_begun_; }

 private:
  int pipe_;
  bool is_begun_ = false;
};

/// True in the process of a LimitedChild, in which work does not need another child.
bool is_limited_child();

/// Runs work on untrusted data in a child process, a fork of this one.
///
/// The child has limits of memory and time and the sandbox of sandbox.h; it ends with its parent, and is killed by the
/// destructor. `work` computes its result first and then writes it: an Error that it throws before the first write is
/// rethrown in the parent by the first `read`.
/// Errors    ErrorKind::Input with `place` in front if the child crashes, exceeds its memory or time, or makes a system
///           call that reading does not need; ErrorKind::Failed if no process can be started.
class LimitedChild {
 public:
  struct Limits {
    std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes beyond the memory that the process has at the start
    double seconds = 60;                            ///< processor time per thread
    /// The options that raise the limits, for error messages; may be empty.
    std::string options;
    std::function<void()> check_time;  ///< called while the parent waits; throws when its own limit is exceeded
    bool is_sandboxed = true;          ///< false: only the limits apply
    std::optional<std::vector<std::string>> readable = {};  ///< files and folders; nothing: all that the user may read
    /// The subject of error messages about the end of the child.
    std::string worker = "its reader";
  };

  /// `open` runs in the child before the sandbox is entered, to open libraries.
  LimitedChild(std::string place, Limits limits, const std::function<void(ChildAnswer&)>& work,
               const std::function<void()>& open = {});
  ~LimitedChild();
  LimitedChild(const LimitedChild&) = delete;
  LimitedChild& operator=(const LimitedChild&) = delete;

  void read(void* out, std::size_t size);

 private:
  std::size_t read_some(void* out, std::size_t size);
  void begin();
  [[noreturn]] void fail();

  std::string place_;
  Limits limits_;
  int id_ = -1, pipe_ = -1;
  bool is_begun_ = false;
};

}  // namespace zoneplate
