// SPDX-License-Identifier: Apache-2.0
// What the C++ library of Debian 12's Emscripten lacks of C++20, for the sources that use it. Included before every one
// of them, in builds for WebAssembly only.
#pragma once

#ifdef __cplusplus
#include <algorithm>
#include <atomic>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <type_traits>

#include <sys/mman.h>

#ifndef MADV_POPULATE_WRITE
#define MADV_POPULATE_WRITE 23
#endif

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From));
  return __builtin_bit_cast(To, from);
}

template <class T>
auto make_unique_for_overwrite(size_t n) {
  return unique_ptr<T>(new remove_extent_t<T>[n]);
}

/// Decimal numbers only; nothing is said of those out of range.
inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  const string text(first, last);
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != string::npos || text[0] == '+')
    return {first, errc::invalid_argument};
  char* end = nullptr;
  const double found = strtod(text.c_str(), &end);
  if (end == text.c_str()) return {first, errc::invalid_argument};
  value = found;
  return {first + (end - text.c_str()), errc()};
}

/// Every store has the strictest order.
template <class T>
class atomic_ref {
 public:
  explicit atomic_ref(T& value) : value_(value) {}
  void store(T value, memory_order) const { __atomic_store_n(&value_, value, __ATOMIC_SEQ_CST); }

 private:
  T& value_;
};

namespace ranges {
template <class Range, class Out>
constexpr void copy(Range&& range, Out out) {
  std::copy(std::begin(range), std::end(range), out);
}
template <class Range, class T, class Part = identity>
constexpr auto find(Range&& range, const T& value, Part part = {}) {
  return std::find_if(std::begin(range), std::end(range), [&](auto&& x) { return std::invoke(part, x) == value; });
}
template <class Range, class Out, class Change>
constexpr void transform(Range&& range, Out out, Change change) {
  for (auto&& x : range) *out++ = std::invoke(change, x);
}
template <class A, class B, class Out, class Change>
constexpr void transform(A&& a, B&& b, Out out, Change change) {
  std::transform(std::begin(a), std::end(a), std::begin(b), out, change);
}
template <class Range, class Condition>
constexpr bool any_of(Range&& range, Condition condition) {
  return std::any_of(std::begin(range), std::end(range), [&](auto&& x) { return std::invoke(condition, x); });
}
template <class Range, class Condition>
constexpr bool all_of(Range&& range, Condition condition) {
  return std::all_of(std::begin(range), std::end(range), [&](auto&& x) { return std::invoke(condition, x); });
}
template <class Range, class Condition>
constexpr bool none_of(Range&& range, Condition condition) {
  return !ranges::any_of(range, condition);
}
template <class Range, class Condition>
constexpr auto count_if(Range&& range, Condition condition) {
  return std::count_if(std::begin(range), std::end(range), [&](auto&& x) { return std::invoke(condition, x); });
}
template <class In, class Count, class Out>
constexpr void copy_n(In in, Count count, Out out) {
  std::copy_n(in, count, out);
}
template <class Range, class T>
constexpr void fill(Range&& range, const T& value) {
  std::fill(std::begin(range), std::end(range), value);
}
template <class Range, class Order = std::less<>, class Part = identity>
void sort(Range&& range, Order order = {}, Part part = {}) {
  std::sort(std::begin(range), std::end(range),
            [&](auto&& a, auto&& b) { return std::invoke(order, std::invoke(part, a), std::invoke(part, b)); });
}
template <class Range, class T>
constexpr auto count(Range&& range, const T& value) {
  return std::count(std::begin(range), std::end(range), value);
}
template <class A, class B>
constexpr bool equal(A&& a, B&& b) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b));
}
}  // namespace ranges
}  // namespace std
#endif
