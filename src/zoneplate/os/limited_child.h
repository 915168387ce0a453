// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace zoneplate {

/// Where a child process writes its answer.
class ChildAnswer {
 public:
  explicit ChildAnswer(int pipe) : pipe_(pipe) {}
  /// Never returns if the reader is gone.
  void write(const void* data, std::size_t size);
  bool is_begun() const { return is_begun_; }

 private:
  int pipe_;
  bool is_begun_ = false;
};

/// True in the process of a LimitedChild, where work needs no further child.
bool is_limited_child();

/// Work on untrusted data in a child process, a copy of this one.
///
/// The child has limits on memory and time and the sandbox of sandbox.h; it ends with its parent, and is killed with
/// this object. `work` makes its result first and writes it then: an Error that it throws before it writes is thrown
/// here again, by the first `read`.
/// Errors    ErrorKind::Input with `place` in front where the child crashes, runs out of memory or time, or makes a
///           system call that a reader does not need; ErrorKind::Failed where no process can be started.
class LimitedChild {
 public:
  struct Limits {
    std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes beyond what the process has now
    double seconds = 60;                            ///< of each thread's processor
    std::string options;                            ///< that raise the limits, as errors name them; may be empty
    std::function<void()> check_time;  ///< called while the parent waits; throws when it has waited too long
    bool is_sandboxed = true;          ///< false: the limits alone
    std::optional<std::vector<std::string>> readable = {};  ///< files and folders; nothing: all that its user may read
    std::string worker = "its reader";                      ///< the subject of errors about the child's end
  };

  /// `open` runs in the child before its rights are taken, to open libraries.
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
