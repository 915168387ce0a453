// SPDX-License-Identifier: Apache-2.0
// The text language of scenes of shapes.
#include <fmt/format.h>

#include "zoneplate/sdf/language/term.h"

namespace zoneplate::sdf {
namespace {

bool is_name_start(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_name_part(char c) { return is_name_start(c) || (c >= '0' && c <= '9') || c == '-'; }

class TextParser {
 public:
  TextParser(std::string_view text, std::string_view file) : in_(text, file) {}

  void parse(const StatementSink& sink) {
    for (skip(); !in_.at_end(); skip()) sink(statement());
  }

 private:
  /// Spaces and comments.
  void skip() {
    for (in_.skip_space(); in_.starts_with("//"); in_.skip_space()) in_.take_while([](char c) { return c != '\n'; });
  }

  std::string name(const char* what) {
    skip();
    if (!is_name_start(in_.peek())) in_.fail(fmt::format("expected {}, found {}", what, in_.found()));
    return std::string(in_.take_while(is_name_part));
  }

  void sign(char c) {
    skip();
    if (in_.peek() != c) in_.fail(fmt::format("expected '{}', found {}", c, in_.found()));
    in_.take();
  }

  Term number() {
    skip();
    Term term{.at = in_.position()};
    term.number = in_.take_number();
    return term;
  }

  Term color() {
    skip();
    Term term{.kind = Term::Kind::Text, .at = in_.position()};
    if (in_.peek() != '#') in_.fail("expected a colour as #rrggbb, found " + in_.found());
    term.text += in_.take();
    term.text += in_.take_while(is_name_part);
    return term;
  }

  Term string() {
    Term term{.kind = Term::Kind::Text, .at = in_.position()};
    in_.take();
    while (in_.peek() != '"') {
      if (in_.at_end()) fail_at(in_.file(), term.at, "the string has no closing quotation mark");
      if (in_.peek() == '\\') {
        in_.take();
        if (in_.peek() != '"' && in_.peek() != '\\') in_.fail("expected \\\" or \\\\ after \\, found " + in_.found());
      }
      term.text += in_.take();
    }
    in_.take();
    return term;
  }

  /// A name, or a name with arguments.
  Term shape(int depth = 0) {
    skip();
    Term term{.kind = Term::Kind::Call, .at = in_.position()};
    term.text = name("a shape");
    if (depth == deepest_term) fail_at(in_.file(), term.at, fmt::format("shapes are nested more than {} deep", depth));
    skip();
    if (in_.peek() != '(') return term;
    in_.take();
    term.has_arguments = true;
    skip();
    while (in_.peek() != ')') {
      if (!term.arguments.empty()) sign(',');
      skip();
      term.arguments.push_back(in_.peek() == '"' ? string() : is_name_start(in_.peek()) ? shape(depth + 1) : number());
      skip();
      if (in_.peek() != ',' && in_.peek() != ')') in_.fail("expected ',' or ')', found " + in_.found());
    }
    in_.take();
    return term;
  }

  Term statement() {
    Term out{.kind = Term::Kind::Call, .at = in_.position(), .has_arguments = true};
    out.text = name("a statement");
    const auto add = [&out](Term term) { out.arguments.push_back(std::move(term)); };
    if (out.text == "canvas") {
      add(number()), add(number());
    } else if (out.text == "background") {
      add(color());
    } else if (out.text == "let") {
      skip();
      const Position at = in_.position();
      add({.kind = Term::Kind::Text, .at = at, .text = name("a name")});
      sign('=');
      add(shape());
    } else if (out.text == "fill") {
      add(color()), add(shape());
    } else if (out.text == "stroke") {
      add(color()), add(number()), add(shape());
    } else {
      fail_at(in_.file(), out.at,
              fmt::format("'{}' is not a statement; expected canvas, background, let, fill or stroke", out.text));
    }
    return out;
  }

  Reader in_;
};

}  // namespace

void parse_text_scene(std::string_view text, std::string_view file, const StatementSink& sink) {
  TextParser(text, file).parse(sink);
}

}  // namespace zoneplate::sdf
