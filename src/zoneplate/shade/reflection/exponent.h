// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate {

/// The exponent of a highlight. Integers up to 1024 are raised by repeated squaring, which is faster and more accurate.
struct Exponent {
  float value = 1;
  int whole = 1;  ///< 0 where the value is not an integer
};

constexpr Exponent make_exponent(float value) {
  const bool is_small = value >= 1 && value <= 1024;
  const int whole = is_small ? static_cast<int>(value) : 0;
  return {value, static_cast<float>(whole) == value ? whole : 0};
}

}  // namespace zoneplate
