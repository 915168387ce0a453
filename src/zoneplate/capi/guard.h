// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstring>
#include <new>

#include "zoneplate/base/error.h"
#include "zoneplate/zoneplate.h"

namespace zoneplate::capi {

/// Stores the text for zoneplate_error_text and returns `status`.
zoneplate_status fail(zoneplate_status status, const char* text) noexcept;

/// Calls `body` and converts its exceptions to a status and a text.
template <class Body>
zoneplate_status guarded(const Body& body) noexcept {
  try {
    body();
    return ZONEPLATE_OK;
  } catch (const Error& error) {
    constexpr zoneplate_status statuses[] = {ZONEPLATE_FAILED, ZONEPLATE_USAGE, ZONEPLATE_INPUT, ZONEPLATE_OUTPUT};
    return fail(statuses[static_cast<std::size_t>(error.kind())], error.what());
  } catch (const std::bad_alloc& error) {  // OutOfMemory has a description
    return fail(ZONEPLATE_OUT_OF_MEMORY, error.what());
  } catch (const std::exception& error) {
    return fail(ZONEPLATE_FAILED, error.what());
  } catch (...) {
    return fail(ZONEPLATE_FAILED, "an exception of unknown type");
  }
}

/// The object that a pointer points to.
///
/// Errors    ErrorKind::Usage naming the argument if the pointer is null.
template <class T>
T& required(T* pointer, const char* argument) {
  if (pointer == nullptr) throw Error(ErrorKind::Usage, fmt::format("{}: is null", argument));
  return *pointer;
}

/// The options of a caller whose header may be older: members after its `size` are 0. Null: all of them are.
///
/// Errors    ErrorKind::Usage for a size of a newer header, or none.
template <class Options>
Options completed(const Options* options, const char* type) {
  Options out{};
  if (options == nullptr) return out;
  if (options->size < sizeof(std::size_t) || options->size > sizeof(Options))
    throw Error(ErrorKind::Usage, fmt::format("{}: size is {}, expected sizeof({}), at most {}", type, options->size,
                                              type, sizeof(Options)));
  std::memcpy(&out, options, options->size);
  return out;
}

/// The C++ value at the index of a C enumeration's value.
///
/// Errors    ErrorKind::Usage for a value out of range.
template <class Value, std::size_t count>
Value at(const Value (&values)[count], int chosen, const char* member) {
  if (chosen < 0 || static_cast<std::size_t>(chosen) >= count)
    throw Error(ErrorKind::Usage, fmt::format("{}: is {}, expected 0 to {}", member, chosen, count - 1));
  return values[chosen];
}

}  // namespace zoneplate::capi
