// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace zoneplate {

/// A JSON value to be written. Members of an object keep the order of their insertion.
///
/// Requires  strings are UTF-8; invalid bytes are written as U+FFFD.
/// Edges     NaN and infinities are written as null.
class Json {
 public:
  using Array = std::vector<Json>;
  using Object = std::vector<std::pair<std::string, Json>>;

  Json() = default;
  Json(bool value) : value_(value) {}
  Json(int value) : value_(std::int64_t{value}) {}
  Json(std::int64_t value) : value_(value) {}
  Json(std::uint64_t value) : value_(value) {}
  Json(double value) : value_(value) {}
  /// Written with the fewest digits that convert back to the same float.
  Json(float value) : value_(value) {}
  Json(const char* value) : value_(std::string(value)) {}
  Json(std::string_view value) : value_(std::string(value)) {}
  Json(std::string value) : value_(std::move(value)) {}
  Json(Array value) : value_(std::move(value)) {}
  Json(Object value) : value_(std::move(value)) {}

  /// `text` is one line without a line end; `indented` has several lines.
  std::string text() const;
  std::string indented() const;

 private:
  friend struct JsonWriter;
  std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, float, std::string, Array, Object> value_;
};

}  // namespace zoneplate
