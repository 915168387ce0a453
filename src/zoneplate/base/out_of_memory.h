// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

namespace zoneplate {

/// A failed allocation, with a description of its purpose.
class OutOfMemory : public std::bad_alloc {
 public:
  /// Requires  `what` is a literal: a noun phrase in the plural, such as "screen vertices".
  explicit OutOfMemory(const char* what) : what_(what) {}
  const char* what() const noexcept override { return what_; }

 private:
  const char* what_;
};

/// Calls `body`. A failed allocation without a description is rethrown as OutOfMemory(what).
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
