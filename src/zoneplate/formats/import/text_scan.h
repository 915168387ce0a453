// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace zoneplate {

/// Iterates over the logical lines of a text: a line that ends in a backslash continues in the next.
class TextLines {
 public:
  /// `first` is the number of the text's first line; `separator` is '\n', or '\r' for a text without '\n'.
  TextLines(std::string_view text, std::uint64_t first, char separator = '\n')
      : rest_(text), next_number_(first), separator_(separator) {}

  /// Moves to the next line; false after the last.
  bool next();

  std::string_view line() const { return line_; }   ///< without the line end, with continuations
  std::uint64_t number() const { return number_; }  ///< the number of its first physical line
  std::uint64_t next_number() const { return next_number_; }
  const char* rest() const { return rest_.data(); }  ///< the beginning of the next line

 private:
  std::string_view rest_, line_;
  std::uint64_t number_ = 0, next_number_;
  char separator_;
};

/// Iterates over the words of a line, which are separated by spaces, control characters and continuations.
class LineWords {
 public:
  explicit LineWords(std::string_view line) : at_(line.data()), end_(line.data() + line.size()) {}

  /// The next word; empty at the end of the line and before a comment ('#').
  std::string_view next();
  /// The rest of the line without spaces around it; continuations and control characters within it become spaces.
  std::string rest();
  /// Whether rest() is empty.
  bool is_over();

 private:
  void skip_space();
  const char* at_;
  const char* end_;
};

/// Parses a word as a number; nothing if it is not a number.
///
/// "nan", "inf" and Visual C++'s "1.#IND" are numbers that are not finite. Overflow gives infinity, underflow zero.
/// Exact     the float nearest to the decimal number, ties to even.
std::optional<float> find_number(std::string_view word);

/// The same number as the nearest double. Numbers outside the range of floats are those of find_number.
std::optional<double> find_double(std::string_view word);

/// Parses a number at the front of a text on a fast path: sign, digits, point, exponent.
///
/// Returns the end of the number, which is a space or `end`; null if find_number has to parse it.
/// Exact     as find_number.
const char* scan_number(const char* at, const char* end, float& value);

}  // namespace zoneplate
