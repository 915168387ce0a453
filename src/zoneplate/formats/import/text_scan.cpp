// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/text_scan.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace zoneplate {
namespace {

bool is_space(char c) { return static_cast<unsigned char>(c) <= ' '; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether a backslash at `at` is followed by the end of a physical line.
bool is_continuation(const char* at, const char* end) {
  ++at;
  while (at != end && *at == '\r') ++at;
  return at == end || *at == '\n';
}

/// Infinity or zero, for a decimal number outside the range of double.
float out_of_range(std::string_view word, float sign) {
  const bool has_negative_power = word.find("e-") != word.npos || word.find("E-") != word.npos;
  const std::size_t digit = word.find_first_of("123456789"), point = word.find('.');
  const bool is_small = has_negative_power || (word.find_first_of("eE") == word.npos && digit > point);
  return sign * (is_small ? 0.0f : std::numeric_limits<float>::infinity());
}

/// Converts any number that the fast path does not handle, with the standard library's exact conversion.
std::optional<float> find_any_number(std::string_view word) {
  float sign = 1;
  if (!word.empty() && (word[0] == '-' || word[0] == '+')) {
    sign = word[0] == '-' ? -1.0f : 1.0f;
    word.remove_prefix(1);
  }
  if (word.empty() || word[0] == '-') return std::nullopt;
  if (is_digit(word[0]) && word.find(".#") != word.npos) return std::numeric_limits<float>::quiet_NaN();
  const char* const end = word.data() + word.size();
  float value = 0;
  const auto [stop, trouble] = std::from_chars(word.data(), end, value);
  if (trouble == std::errc::invalid_argument || stop != end) return std::nullopt;
  if (trouble == std::errc{}) return sign * value;
  double wide = 0;
  if (std::from_chars(word.data(), end, wide).ec == std::errc{}) return sign * static_cast<float>(wide);
  return out_of_range(word, sign);
}

constexpr std::array<double, 23> powers_of_ten = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/// Reads consecutive decimal digits: value becomes value × 10^n + the number of the n digits, without an overflow
/// check; `at` moves behind them. Eight digits are read at a time, because the length of a loop over digits is
/// unpredictable.
inline void scan_digits(const char*& at, const char* end, std::uint64_t& value) {
  static_assert(std::endian::native == std::endian::little, "the first character is the lowest byte");
  constexpr std::array<std::uint64_t, 9> scales = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
  while (end - at >= 8) {
    std::uint64_t eight;
    std::memcpy(&eight, at, sizeof eight);
    // A byte is a digit if the xor makes it 0 to 9. The mask finds the first other byte; carries affect only bytes
    // above it.
    eight ^= 0x3030303030303030;
    const std::uint64_t others = ((eight + 0x7676767676767676) | eight) & 0x8080808080808080;
    const int n = std::countr_zero(others) / 8;
    if (n == 0) return;
    // Combines pairs of digits, then fours, then eight; missing digits are replaced by leading zeros.
    eight <<= 64 - 8 * n;
    eight = eight * 10 + (eight >> 8);
    eight =
        ((eight & 0x000000ff000000ff) * 0x000f424000000064 + (eight >> 16 & 0x000000ff000000ff) * 0x0000271000000001) >>
        32;
    value = value * scales[static_cast<std::size_t>(n)] + eight;
    at += n;
    if (n < 8) return;
  }
  for (; at != end && is_digit(*at); ++at) value = value * 10 + static_cast<std::uint64_t>(*at - '0');
}

/// digits × 10^power as a float, if one rounding in double suffices.
///
/// Both factors are exact in double, so that the product is the double nearest to the number. Rounding it to float
/// gives the nearest float too, unless the double is halfway between two floats (its last 29 bits are a one and zeros).
std::optional<float> find_product(std::uint64_t digits, int power) {
  if (digits == 0) return 0.0f;
  if (digits >> 53 != 0 || power < -22 || power > 22) return std::nullopt;
  const double scale = powers_of_ten[static_cast<std::size_t>(std::abs(power))];
  const double value = power < 0 ? static_cast<double>(digits) / scale : static_cast<double>(digits) * scale;
  const std::uint64_t tail = std::bit_cast<std::uint64_t>(value) & 0x1fffffff;
  if (tail == 0x10000000 || value < 0x1p-126 || value > 0x1p127) return std::nullopt;
  return static_cast<float>(value);
}

}  // namespace

bool TextLines::next() {
  if (rest_.empty()) return false;
  number_ = next_number_;
  const char* const begin = rest_.data();
  const char* const end = begin + rest_.size();
  const char* stop = begin;
  for (bool more = true; more;) {
    const void* found = std::memchr(stop, separator_, static_cast<std::size_t>(end - stop));
    stop = found != nullptr ? static_cast<const char*>(found) : end;
    ++next_number_;
    const char* last = stop;
    while (last != begin && separator_ == '\n' && last[-1] == '\r') --last;
    more = stop != end && last != begin && last[-1] == '\\';
    if (more) ++stop;
  }
  line_ = {begin, static_cast<std::size_t>(stop - begin)};
  rest_.remove_prefix(line_.size() + (stop != end ? 1 : 0));
  return true;
}

void LineWords::skip_space() {
  while (at_ != end_ && (is_space(*at_) || (*at_ == '\\' && is_continuation(at_, end_)))) ++at_;
}

std::string_view LineWords::next() {
  skip_space();
  if (at_ == end_ || *at_ == '#') return {};
  const char* const begin = at_;
  while (at_ != end_ && !is_space(*at_) && !(*at_ == '\\' && is_continuation(at_, end_))) ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

bool LineWords::is_over() {
  skip_space();
  return at_ == end_;
}

std::string LineWords::rest() {
  skip_space();
  const char* last = end_;
  while (last != at_ && is_space(last[-1])) --last;
  std::string out;
  for (const char* c = at_; c != last; ++c)
    out += static_cast<unsigned char>(*c) < ' ' || (*c == '\\' && is_continuation(c, end_)) ? ' ' : *c;
  return out;
}

const char* scan_number(const char* at, const char* end, float& value) {
  bool is_negative = false;
  if (at != end && (*at == '-' || *at == '+')) is_negative = *at++ == '-';
  std::uint64_t digits = 0;
  int power = 0;
  const char* const first = at;
  for (; at != end && is_digit(*at); ++at) digits = digits * 10 + static_cast<std::uint64_t>(*at - '0');
  std::ptrdiff_t count = at - first;
  if (at != end && *at == '.') {
    const char* const point = ++at;
    scan_digits(at, end, digits);
    power = static_cast<int>(std::max<std::ptrdiff_t>(point - at, -1000));
    count += at - point;
  }
  if (count == 0 || count > 18) return nullptr;
  if (at != end && (*at == 'e' || *at == 'E')) {
    int exponent = 0;
    ++at;
    if (at != end && *at == '+' && at + 1 != end) ++at;
    const auto [stop, trouble] = std::from_chars(at, end, exponent);
    if (trouble != std::errc{} || std::abs(exponent) > 1000) return nullptr;
    at = stop;
    power += exponent;
  }
  if (at != end && !is_space(*at)) return nullptr;
  const std::optional<float> found = find_product(digits, power);
  if (!found) return nullptr;
  value = is_negative ? -*found : *found;
  return at;
}

std::optional<float> find_number(std::string_view word) {
  float value = 0;
  const char* const end = word.data() + word.size();
  if (scan_number(word.data(), end, value) == end) return value;
  return find_any_number(word);
}

std::optional<double> find_double(std::string_view word) {
  const std::optional<float> rounded = find_number(word);
  if (!rounded || !std::isfinite(*rounded)) return rounded;
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const bool is_in_range = std::from_chars(word.data(), word.data() + word.size(), value).ec == std::errc{};
  return is_in_range ? value : static_cast<double>(*rounded);
}

}  // namespace zoneplate
