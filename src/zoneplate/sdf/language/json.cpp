// SPDX-License-Identifier: Apache-2.0
// Scenes of shapes as JSON. A parser of its own, because every error names its line and column.
#include <fmt/format.h>

#include "zoneplate/base/utf8.h"
#include "zoneplate/sdf/language/term.h"

namespace zoneplate::sdf {
namespace {

class JsonParser {
 public:
  JsonParser(std::string_view text, std::string_view file) : in_(text, file) {}

  void parse(const StatementSink& sink) {
    object("the scene", [&](const Term& key) {
      if (key.text == "canvas" || key.text == "background") {
        Term out{.kind = Term::Kind::Call, .at = key.at, .text = key.text, .has_arguments = true};
        if (key.text == "canvas")
          out.arguments = list(0);
        else
          out.arguments.push_back(string());
        sink(out);
      } else if (key.text == "let") {
        object("let", [&](const Term& name) {
          Term out{.kind = Term::Kind::Call, .at = name.at, .text = "let", .has_arguments = true};
          out.arguments = {name, shape(0)};
          sink(out);
        });
      } else if (key.text == "layers") {
        elements([&] { sink(layer()); });
      } else {
        fail_at(in_.file(), key.at,
                fmt::format("'{}' is not a member of a scene; expected canvas, background, let or layers", key.text));
      }
    });
    in_.skip_space();
    if (!in_.at_end()) in_.fail("expected the end of the file, found " + in_.found());
  }

 private:
  void sign(char c, const std::string& what) {
    in_.skip_space();
    if (in_.peek() != c) in_.fail(fmt::format("expected '{}' of {}, found {}", c, what, in_.found()));
    in_.take();
  }

  /// True after a comma, false after the closing sign.
  bool has_next(char closing) {
    in_.skip_space();
    if (in_.peek() != ',' && in_.peek() != closing)
      in_.fail(fmt::format("expected ',' or '{}', found {}", closing, in_.found()));
    return in_.take() == ',';
  }

  template <class Member>
  void object(const std::string& what, const Member& member) {
    sign('{', what);
    in_.skip_space();
    if (in_.peek() == '}') {
      in_.take();
      return;
    }
    do {
      const Term key = string();
      sign(':', "member " + key.text);
      member(key);
    } while (has_next('}'));
  }

  template <class Element>
  void elements(const Element& element) {
    sign('[', "a list");
    in_.skip_space();
    if (in_.peek() == ']') {
      in_.take();
      return;
    }
    do {
      element();
    } while (has_next(']'));
  }

  unsigned hex4() {
    unsigned code = 0;
    for (int i = 0; i < 4; ++i) {
      const char c = in_.peek();
      const int digit = c >= '0' && c <= '9'   ? c - '0'
                        : c >= 'a' && c <= 'f' ? c - 'a' + 10
                        : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                               : -1;
      if (digit < 0) in_.fail("expected four hexadecimal digits after \\u, found " + in_.found());
      code = code * 16 + static_cast<unsigned>(digit);
      in_.take();
    }
    return code;
  }

  void escape(std::string& out) {
    constexpr std::string_view letters = "\"\\/bfnrt", values = "\"\\/\b\f\n\r\t";
    const Position at = in_.position();
    in_.take();
    if (in_.peek() == 'u') {
      in_.take();
      unsigned code = hex4();
      if (code >> 10 == 0x36 && in_.starts_with("\\u")) {
        in_.take(2);
        const unsigned low = hex4();
        if (low >> 10 != 0x37) fail_at(in_.file(), at, "a surrogate without its second half");
        code = 0x10000 + ((code & 0x3ff) << 10) + (low & 0x3ff);
      }
      if (code >> 11 == 0x1b) fail_at(in_.file(), at, "a surrogate without its other half");
      return append_utf8(out, code);
    }
    const std::size_t i = letters.find(in_.peek());
    if (in_.at_end() || i == std::string_view::npos) in_.fail("expected an escape such as \\n, found " + in_.found());
    out += values[i];
    in_.take();
  }

  Term string() {
    in_.skip_space();
    Term term{.kind = Term::Kind::Text, .at = in_.position()};
    if (in_.peek() != '"') in_.fail("expected a string, found " + in_.found());
    in_.take();
    while (in_.peek() != '"') {
      if (in_.at_end()) fail_at(in_.file(), term.at, "the string has no closing quotation mark");
      if (static_cast<unsigned char>(in_.peek()) < ' ') in_.fail("a control character in a string");
      if (in_.peek() == '\\')
        escape(term.text);
      else
        term.text += in_.take();
    }
    in_.take();
    return term;
  }

  Term number() {
    in_.skip_space();
    Term term{.at = in_.position()};
    term.number = in_.take_number();
    return term;
  }

  std::vector<Term> list(int depth) {
    std::vector<Term> out;
    elements([&] {
      in_.skip_space();
      out.push_back(in_.peek() == '"' ? string() : in_.peek() == '{' ? shape(depth + 1) : number());
    });
    return out;
  }

  /// {"circle": [1, 2, 3]}
  Term shape(int depth) {
    in_.skip_space();
    const Position at = in_.position();
    if (depth > deepest_term) in_.fail(fmt::format("shapes are nested more than {} deep", deepest_term));
    Term out;
    int members = 0;
    object("a shape", [&](const Term& key) {
      if (++members > 1) fail_at(in_.file(), key.at, "a shape has one member, its name with its arguments");
      out = {.kind = Term::Kind::Call, .at = key.at, .text = key.text, .has_arguments = true};
      out.arguments = list(depth);
      if (out.arguments.empty()) out.has_arguments = false;
    });
    if (members == 0) fail_at(in_.file(), at, "a shape has one member, its name with its arguments; found none");
    return out;
  }

  Term layer() {
    in_.skip_space();
    Term out{.kind = Term::Kind::Call, .at = in_.position(), .has_arguments = true};
    std::vector<Term> color, width, form;
    object("a layer", [&](const Term& key) {
      const auto set = [&](std::vector<Term>& member, Term value) {
        if (!member.empty()) fail_at(in_.file(), key.at, fmt::format("a second '{}' of a layer", key.text));
        member.push_back(std::move(value));
      };
      if (key.text == "fill" || key.text == "stroke")
        set(color, string()), out.text = key.text;
      else if (key.text == "width")
        set(width, number());
      else if (key.text == "shape")
        set(form, shape(0));
      else
        fail_at(in_.file(), key.at,
                fmt::format("'{}' is not a member of a layer; expected fill, stroke, width or shape", key.text));
    });
    if (color.empty()) fail_at(in_.file(), out.at, "the layer has neither fill nor stroke");
    if (form.empty()) fail_at(in_.file(), out.at, "the layer has no shape");
    if ((out.text == "stroke") != !width.empty())
      fail_at(in_.file(), out.at, width.empty() ? "the stroke has no width" : "a fill has no width");
    for (std::vector<Term>* member : {&color, &width, &form})
      for (Term& term : *member) out.arguments.push_back(std::move(term));
    return out;
  }

  Reader in_;
};

}  // namespace

void parse_json_scene(std::string_view text, std::string_view file, const StatementSink& sink) {
  JsonParser(text, file).parse(sink);
}

}  // namespace zoneplate::sdf
