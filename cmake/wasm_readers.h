// SPDX-License-Identifier: Apache-2.0
// As wasm_library.h, for the readers of models and images, and the lessons.
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
template <class Range>
constexpr auto max(Range&& range) {
  return *std::max_element(std::begin(range), std::end(range));
}
template <class Range>
constexpr auto min(Range&& range) {
  return *std::min_element(std::begin(range), std::end(range));
}
template <class Range>
constexpr void reverse(Range&& range) {
  std::reverse(std::begin(range), std::end(range));
}
template <class Range, class Place>
constexpr void nth_element(Range&& range, Place place) {
  std::nth_element(std::begin(range), place, std::end(range));
}
template <class A, class B, class Same>
constexpr bool equal(A&& a, B&& b, Same same) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b), same);
}
template <class Range, class Condition, class Part>
constexpr bool any_of(Range&& range, Condition condition, Part part) {
  return std::any_of(std::begin(range), std::end(range), [&](auto&& x) { return condition(std::invoke(part, x)); });
}
template <class Range, class Out, class Condition>
constexpr void copy_if(Range&& range, Out out, Condition condition) {
  std::copy_if(std::begin(range), std::end(range), out, [&](auto&& x) { return std::invoke(condition, x); });
}
template <class Range, class Condition, class T>
constexpr void replace_if(Range&& range, Condition condition, const T& value) {
  std::replace_if(std::begin(range), std::end(range), condition, value);
}
template <class Range, class Order, class Part>
void stable_sort(Range&& range, Order, Part part) {
  std::stable_sort(std::begin(range), std::end(range),
                   [&](auto&& a, auto&& b) { return std::invoke(part, a) < std::invoke(part, b); });
}
}  // namespace ranges

}  // namespace std
#endif
