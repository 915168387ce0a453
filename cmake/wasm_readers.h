// SPDX-License-Identifier: Apache-2.0
// As wasm_library.h, for the readers of models and the lessons.
#pragma once

#ifdef __cplusplus
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

namespace std {

/// Decimal numbers, inf and nan.
inline from_chars_result from_chars(const char* first, const char* last, float& value) {
  const string_view given(first, static_cast<size_t>(last - first));
  const string text(given.substr(0, given.find_first_not_of("0123456789+-.eEinfatyINFATY")));
  if (text.empty() || text[0] == '+') return {first, errc::invalid_argument};
  char* end = nullptr;
  errno = 0;
  const float found = strtof(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  const char* const stop = first + (end - text.c_str());
  if (errno == ERANGE) return {stop, errc::result_out_of_range};
  value = found;
  return {stop, errc()};
}

namespace ranges {
template <class Range, class Condition>
constexpr auto find_if(Range&& range, Condition condition) {
  return std::find_if(std::begin(range), std::end(range), condition);
}
template <class Range, class Order = std::less<>, class Part = identity>
constexpr auto min_element(Range&& range, Order order = {}, Part part = {}) {
  return std::min_element(std::begin(range), std::end(range), [&](auto&& a, auto&& b) {
    return std::invoke(order, std::invoke(part, a), std::invoke(part, b));
  });
}
template <class T>
struct minmax_result {
  T min, max;
};
template <class Range, class Order = std::less<>, class Part = identity>
constexpr auto minmax(Range&& range, Order order = {}, Part part = {}) {
  const auto found = std::minmax_element(std::begin(range), std::end(range), [&](auto&& a, auto&& b) {
    return std::invoke(order, std::invoke(part, a), std::invoke(part, b));
  });
  return minmax_result<std::decay_t<decltype(*found.first)>>{*found.first, *found.second};
}
}  // namespace ranges

}  // namespace std
#endif
