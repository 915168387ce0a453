// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace zoneplate {

/// Steps through the logical lines of a text: a line that ends in a backslash goes on in the next.
class TextLines {
 public:
  /// `first` is the number of the text's first line; `separator` is '\n', or '\r' for a text that has no other.
  TextLines(std::string_view text, std::uint64_t first, char separator = '\n')
      : rest_(text), next_number_(first), separator_(separator) {}

  /// Moves to the next line; false after the last.
  bool next();

  std::string_view line() const { return line_; }   ///< without its end, continuations included
  std::uint64_t number() const { return number_; }  ///< of its first physical line
  std::uint64_t next_number() const { return next_number_; }
  const char* rest() const { return rest_.data(); }  ///< where the next line begins

 private:
  std::string_view rest_, line_;
  std::uint64_t number_ = 0, next_number_;
  char separator_;
};

/// Takes the words of a line one after the other. Spaces, control characters and continuations are between words.
class LineWords {
 public:
  explicit LineWords(std::string_view line) : at_(line.data()), end_(line.data() + line.size()) {}

  /// The next word; empty at the end of the line, or where a word begins with '#'.
  std::string_view next();
  /// All that is left, without the spaces around it; continuations and control characters in it become spaces.
  std::string rest();
  /// Whether rest() is empty.
  bool is_over();

 private:
  void skip_space();
  const char* at_;
  const char* end_;
};

/// The number that a word represents; nothing for other words.
///
/// "nan", "inf" and Visual C++'s "1.#IND" are numbers that are not finite. Too large is infinite, too small is zero.
/// Exact     the float nearest to the decimal number, ties to even.
std::optional<float> find_number(std::string_view word);

/// Reads a number at the front of a text where that is simply done: sign, digits, point, exponent.
///
/// Answers where it ends, which is at a space or at `end`; null where find_number has to decide.
/// Exact     as find_number.
const char* scan_number(const char* at, const char* end, float& value);

}  // namespace zoneplate
