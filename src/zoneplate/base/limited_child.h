#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "zoneplate/base/clock.h"

namespace zoneplate {

/// Work in a child process that is a copy of this one with limits on memory and time: what a library does with a
/// hostile file ends the child alone. It is killed with this object.
class LimitedChild {
 public:
  struct Limits {
    std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes beyond what the process has now
    double seconds = 60;                            ///< of processor time, and of waiting for an answer
  };
  /// Hands bytes to the parent.
  using Send = std::function<void(std::span<const std::uint8_t>)>;

  /// A cause why the work cannot be done; for `work` to throw.
  struct Refusal {
    std::string cause;
  };

  /// Starts `work`, which sends its answer. It may throw Refusal; another exception counts as want of memory.
  ///
  /// Errors    Trouble::Failed where no process can be started.
  LimitedChild(const Limits& limits, const std::function<void(const Send&)>& work);
  ~LimitedChild();
  LimitedChild(const LimitedChild&) = delete;
  LimitedChild& operator=(const LimitedChild&) = delete;

  /// Waits for as many bytes of the answer; false where the child ended before, or was too slow.
  bool read(std::span<std::uint8_t> out);

  /// Why the answer is cut off, after `read` was false: "needs more memory than the limit", the refusal, ...
  std::string cause();

 private:
  bool wait_for_more(int pipe);
  int id_ = -1;
  int answer_ = -1, refusal_ = -1;
  double deadline_ms_;  ///< after which nothing is waited for
  Stopwatch clock_;
  bool is_late_ = false;
};

}  // namespace zoneplate
