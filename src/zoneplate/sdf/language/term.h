// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace zoneplate::sdf {

/// A place in a scene's file; columns count characters.
struct Position {
  int line = 1, column = 1;
  bool operator==(const Position&) const = default;
};

/// A value of a scene's file, whichever its language: a number, a string, or a name with arguments, such as
/// circle(1, 2, 3).
struct Term {
  enum class Kind { Number, Text, Call };
  Kind kind = Kind::Number;
  Position at;
  double number = 0;
  std::string text{};          ///< the string, or the name of a call
  bool has_arguments = false;  ///< a call with parentheses
  std::vector<Term> arguments{};
};

/// Takes the statements of a file one by one: canvas(width, height), background(colour), let(name, shape),
/// fill(colour, shape), stroke(colour, width, shape). Colours are strings.
using StatementSink = std::function<void(const Term& statement)>;

/// Throws ErrorKind::Input with "file: line 3, column 14: cause".
[[noreturn]] void fail_at(std::string_view file, Position at, const std::string& cause);

/// Calls in calls are at most this deep.
inline constexpr int deepest_term = 48;

/// Parses the text language:
///
///     canvas 640 480  background #ffffff       // a comment
///     let eye = circle(320, 240, 60)
///     fill #d55e00 smooth-union(20, eye, rectangle(420, 240, 120, 40))
///     stroke #000000 2 eye
///
/// Errors    ErrorKind::Input with the file, line and column.
void parse_text_scene(std::string_view text, std::string_view file, const StatementSink& sink);

/// Parses the same scene as JSON:
///
///     {"canvas": [640, 480], "background": "#ffffff", "let": {"eye": {"circle": [320, 240, 60]}},
///      "layers": [{"fill": "#d55e00", "shape": {"smooth-union": [20, {"eye": []}, {"rectangle": [420, 240, 120,
///      40]}]}},
///                 {"stroke": "#000000", "width": 2, "shape": {"eye": []}}]}
///
/// Members are read in order, so that "let" precedes the layers that use its names.
/// Errors    as parse_text_scene.
void parse_json_scene(std::string_view text, std::string_view file, const StatementSink& sink);

/// The text with its position, as both parsers read it.
class Reader {
 public:
  Reader(std::string_view text, std::string_view file) : rest_(text), file_(file) {}

  bool at_end() const { return rest_.empty(); }
  /// The next byte; 0 at the end.
  char peek() const { return rest_.empty() ? '\0' : rest_.front(); }
  bool starts_with(std::string_view prefix) const { return rest_.starts_with(prefix); }
  Position position() const { return at_; }
  char take();
  std::string_view take(std::size_t bytes);
  /// Takes bytes while `belongs` holds.
  template <class Belongs>
  std::string_view take_while(const Belongs& belongs) {
    std::size_t count = 0;
    while (count < rest_.size() && belongs(rest_[count])) ++count;
    return take(count);
  }
  void skip_space();
  /// A finite decimal number: JSON's grammar, and a plus sign or a missing digit before or after the point.
  double take_number();
  [[noreturn]] void fail(const std::string& cause) const { fail_at(file_, at_, cause); }
  /// "'x'", or "the end of the file".
  std::string found() const;
  std::string_view file() const { return file_; }

 private:
  std::string_view rest_, file_;
  Position at_;
};

}  // namespace zoneplate::sdf
