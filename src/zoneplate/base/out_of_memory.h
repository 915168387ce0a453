// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

namespace zoneplate {

/// An allocation that failed, with what it was for.
class OutOfMemory : public std::bad_alloc {
 public:
  /// Requires  `what` is a literal: a noun phrase in the plural, such as "screen vertices".
  explicit OutOfMemory(const char* what) : what_(what) {}
  const char* what() const noexcept override { return what_; }

 private:
  const char* what_;
};

/// Calls `body`. An allocation that fails in it, and has no name yet, is thrown again as OutOfMemory(what).
template <class Body>
decltype(auto) growing(const char* what, Body&& body) {
  try {
    return body();
  } catch (const OutOfMemory&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw OutOfMemory(what);
  }
}

}  // namespace zoneplate
