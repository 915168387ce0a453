// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <mutex>
#include <optional>

namespace zoneplate {

/// A value that its first use makes; several threads may use it.
///
/// It replaces std::call_once, whose function must not throw in a static program: there the exception would pass
/// through the C library's pthread_once, whose frame belongs to another unwinder, and the program would be aborted.
/// Errors    those of `make`; the value is then not made, and the next use tries again.
/// Cost      after the first use, one atomic read.
template <class T>
class MadeOnce {
 public:
  /// The value, which the first call makes by `make()`. Other threads wait until it is made.
  template <class Make>
  const T& value(const Make& make) {
    if (!is_made_.load(std::memory_order_acquire)) {
      const std::lock_guard lock(mutex_);
      if (!is_made_.load(std::memory_order_relaxed)) {
        value_.emplace(make());
        is_made_.store(true, std::memory_order_release);
      }
    }
    return *value_;
  }

 private:
  std::atomic<bool> is_made_ = false;
  std::mutex mutex_;
  std::optional<T> value_;
};

}  // namespace zoneplate
