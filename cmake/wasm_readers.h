// SPDX-License-Identifier: Apache-2.0
// As wasm_library.h, for the readers of models.
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

}  // namespace std
#endif
