#pragma once

namespace zoneplate {

/// The exponent of a highlight. Whole ones up to 1024 are powers by squaring: cheaper, and nearer to the truth.
struct Exponent {
  float value = 1;
  int whole = 1;  ///< 0 where it is not whole
};

constexpr Exponent make_exponent(float value) {
  const bool is_small = value >= 1 && value <= 1024;
  const int whole = is_small ? static_cast<int>(value) : 0;
  return {value, static_cast<float>(whole) == value ? whole : 0};
}

}  // namespace zoneplate
