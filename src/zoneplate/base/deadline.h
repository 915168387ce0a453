// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "zoneplate/base/error.h"

namespace zoneplate {

/// The error of a limit of time that is exceeded.
class DeadlinePassed : public Error {
 public:
  using Error::Error;
};

/// Runs `body` with a limit of elapsed time, which starts now.
///
/// The limit applies to the calling thread and to every thread that takes part in its loops: `parallel_for` checks it
/// before each item. A long serial loop, such as that over the rows of a decoder, calls `check_deadline`. Nested limits
/// all apply.
/// Requires  `message` is one complete line, which names the file and the option that raises the limit.
/// Errors    those of `body`; DeadlinePassed(kind, message) from the first check after the limit.
void with_deadline(double seconds, ErrorKind kind, const std::string& message, const std::function<void()>& body);

/// Errors    that of the innermost enclosing `with_deadline` whose limit is exceeded.
/// Cost      reads the clock once per limit, about 25 ns: call it once per row, chunk or thousand cheap iterations.
void check_deadline();

/// The limits of the calling thread, for threads that work on its behalf.
class Deadline;
const Deadline* current_deadline();
/// Sets the result of `current_deadline` on this thread and returns the previous one.
const Deadline* exchange_deadline(const Deadline* deadline);

}  // namespace zoneplate
