// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/deadline.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace zoneplate {

using Clock = std::chrono::steady_clock;

class Deadline {
 public:
  Deadline(double seconds, ErrorKind kind, const std::string& message, const Deadline* outer)
      : end_(Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds))),
        kind_(kind),
        message_(message),
        outer_(outer) {}

  void check() const {
    const Clock::time_point now = Clock::now();
    for (const Deadline* limit = this; limit; limit = limit->outer_)
      if (now > limit->end_) throw DeadlinePassed(limit->kind_, limit->message_);
  }

 private:
  Clock::time_point end_;
  ErrorKind kind_;
  const std::string& message_;
  const Deadline* outer_;
};

namespace {
thread_local const Deadline* deadline_of_thread = nullptr;
}

const Deadline* current_deadline() { return deadline_of_thread; }

const Deadline* exchange_deadline(const Deadline* deadline) { return std::exchange(deadline_of_thread, deadline); }

void with_deadline(double seconds, ErrorKind kind, const std::string& message, const std::function<void()>& body) {
  constexpr double longest = 1e9;  // seconds; the range of the clock's type is about 300 years
  const Deadline deadline(std::min(seconds, longest), kind, message, deadline_of_thread);
  struct Restore {
    const Deadline* outer;
    ~Restore() { deadline_of_thread = outer; }
  } const restore{exchange_deadline(&deadline)};
  body();
}

void check_deadline() {
  if (deadline_of_thread) deadline_of_thread->check();
}

}  // namespace zoneplate
