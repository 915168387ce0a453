// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "zoneplate/base/error.h"

namespace zoneplate {

/// Runs `body` with a limit on its time, on the wall clock, which starts now.
///
/// The limit holds on the calling thread and on every thread that takes part in its loops: `parallel_for` checks it
/// before each item. A long serial loop, such as the rows of a decoder, calls `check_deadline`. Limits nest: all of
/// them hold.
/// Requires  `message` is one complete line, which names the file and the option that raises the limit.
/// Errors    whatever `body` throws; Error(kind, message) from the first check after the time is up.
void with_deadline(double seconds, ErrorKind kind, const std::string& message, const std::function<void()>& body);

/// Errors    that of the first limit of the enclosing `with_deadline`s whose time is up.
/// Cost      reads the clock once for each limit, some 25 ns: once a row, a chunk or a thousand cheap iterations.
void check_deadline();

/// The limits that hold on the calling thread, for threads that work on its behalf.
class Deadline;
const Deadline* current_deadline();
/// Sets what `current_deadline` returns on this thread and returns what it returned before.
const Deadline* exchange_deadline(const Deadline* deadline);

}  // namespace zoneplate
