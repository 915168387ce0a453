// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <utility>

namespace zoneplate {

/// The first exception of callbacks that a C library calls, kept until the library has returned.
///
/// An exception must not pass through the library's frames: they free nothing, and those of a shared library may belong
/// to another unwinder than that of a static program, which then aborts.
class CallbackError {
 public:
  /// The result of `body()`, or `failed` after an exception.
  template <class Result, class Body>
  Result guarded(Result failed, const Body& body) noexcept {
    try {
      return body();
    } catch (...) {
      if (!first_) first_ = std::current_exception();
      return failed;
    }
  }
  /// Throws the exception, if there is one, after the library has returned.
  void rethrow() {
    if (first_) std::rethrow_exception(std::exchange(first_, nullptr));
  }

 private:
  std::exception_ptr first_;
};

}  // namespace zoneplate
