#pragma once

#include <cstdint>
#include <new>

namespace zoneplate {

// A job's memory has one limit, and the kernel keeps it: `limit_memory` bounds every page that the process can write
// to, whichever container, library or file mapping it belongs to. What passes the limit is an allocation that fails,
// and so std::bad_alloc; `growing` adds what it was for.

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

/// From now on this process may have `bytes` more of memory that it can write to than it has now, whoever allocates
/// it; past that, allocations fail. Files that FileBytes maps count. A later call replaces the limit.
///
/// For programs: the limit is the whole process's (RLIMIT_DATA), and passes to its children.
void limit_memory(std::uint64_t bytes);

}  // namespace zoneplate
