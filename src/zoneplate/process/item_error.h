// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "zoneplate/base/error.h"

namespace zoneplate {

/// Why an item has no result, apart from the kind of its error.
enum class ItemCause : std::uint8_t {
  Other,   ///< that of the kind of its error
  Memory,  ///< it needs more than --max-memory
  Time,    ///< it takes longer than --max-seconds or --max-import-seconds
  Killed,  ///< its process crashed or was killed, as by a system that ran out of memory
};

/// The error of an item with its cause.
class ItemError : public Error {
 public:
  ItemError(ErrorKind kind, const std::string& message, ItemCause cause) : Error(kind, message), cause_(cause) {}
  ItemCause cause() const { return cause_; }

 private:
  ItemCause cause_;
};

/// The word for the cause of an error in reports: "memory", "time", "killed", "usage", "input", "output" or "failed".
std::string_view cause_name(const Error& error);

}  // namespace zoneplate
