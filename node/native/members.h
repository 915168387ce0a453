// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"

namespace zoneplate::node {

/// The members of a JSON object, which a caller writes: each is read by its name, and none may remain. Null is absent.
///
/// Errors    ErrorKind::Usage naming the member: of another type, or unknown.
class Members {
 public:
  /// Null: no members.
  Members(nlohmann::json object, std::string place) : object_(std::move(object)), place_(std::move(place)) {
    if (!object_.is_null() && !object_.is_object()) throw Error(ErrorKind::Usage, place_ + ": is not an object");
  }

  const nlohmann::json* find(const char* name) {
    if (std::find(known_.begin(), known_.end(), name) == known_.end()) known_.push_back(name);
    const auto found = object_.find(name);
    return found == object_.end() || found->is_null() ? nullptr : &*found;
  }

  std::optional<std::string> text(const char* name) {
    return value<std::string>(name, "text", &nlohmann::json::is_string);
  }
  std::optional<double> number(const char* name) { return value<double>(name, "a number", &nlohmann::json::is_number); }

  /// A list of `count` numbers.
  template <class Number>
  std::optional<std::vector<Number>> numbers(const char* name, std::size_t count) {
    const nlohmann::json* const found = find(name);
    if (found == nullptr) return std::nullopt;
    const auto is_number = [](const nlohmann::json& item) {
      return std::is_integral_v<Number> ? item.is_number_integer() : item.is_number();
    };
    if (!found->is_array() || found->size() != count || !std::all_of(found->begin(), found->end(), is_number))
      refuse(name, fmt::format("{} {}numbers", count, std::is_integral_v<Number> ? "whole " : ""));
    return found->get<std::vector<Number>>();
  }

  /// The position of a text among `names`.
  template <std::size_t count>
  int chosen(const char* name, const char* const (&names)[count]) {
    const std::string found = text(name).value_or(names[0]);
    for (std::size_t i = 0; i < count; ++i)
      if (found == names[i]) return static_cast<int>(i);
    refuse(name, fmt::format("one of {}", fmt::join(names, ", ")));
  }

  [[noreturn]] void refuse(const char* name, const std::string& expected) const {
    throw Error(ErrorKind::Usage,
                fmt::format("{}: {}: is {}, expected {}", place_, name, object_.at(name).dump(), expected));
  }

  /// Throws if a member was not read.
  void finish() const {
    if (object_.is_null()) return;
    for (const auto& [name, value] : object_.items())
      if (std::find(known_.begin(), known_.end(), name) == known_.end())
        throw Error(ErrorKind::Usage,
                    fmt::format("{}: no option '{}'; there are {}", place_, name, fmt::join(known_, ", ")));
  }

 private:
  template <class Value>
  std::optional<Value> value(const char* name, const char* expected,
                             bool (nlohmann::json::*is_valid)() const noexcept) {
    const nlohmann::json* const found = find(name);
    if (found == nullptr) return std::nullopt;
    if (!(found->*is_valid)()) refuse(name, expected);
    return found->get<Value>();
  }

  nlohmann::json object_;
  std::string place_;
  std::vector<std::string> known_;
};

}  // namespace zoneplate::node
