// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/language/scene_file.h"

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

#include "zoneplate/base/closest.h"
#include "zoneplate/base/error.h"
#include "zoneplate/image/hex_color.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/sdf/language/svg_path.h"
#include "zoneplate/sdf/language/term.h"

namespace zoneplate::sdf {
namespace {

using Kind = Shape::Kind;

/// The arguments of a call, checked against its parameters.
struct Arguments {
  std::vector<double> numbers;
  std::string text;
  std::vector<ShapePtr> shapes;
  const SceneFileOptions& options;

  Point at() const { return {numbers[0], numbers[1]}; }
  double operator[](std::size_t i) const { return numbers[i]; }
  const ShapePtr& shape() const { return shapes[0]; }
};

/// Parameters are separated by spaces. A number may be any, positive (+), at least 0 (*), or a whole number from 1 (#)
/// or from 3 (##); `shape` is a shape, `shapes` one or more, `points` the coordinates of three or more, `text` a
/// string.
struct Word : ShapeWord {
  ShapePtr (*make)(const Arguments&);
};

ShapePtr capsule(const Arguments& a) {
  const Point ends[] = {{a[0], a[1]}, {a[2], a[3]}};
  if (ends[0] == ends[1]) return moved(ends[0], circle(a[4] / 2));
  return modified(Kind::Offset, a[4] / 2, region(polygon(ends)));  // a contour there and back has no inside
}

ShapePtr points_polygon(const Arguments& a) {
  std::vector<Point> points;
  for (std::size_t i = 0; i + 1 < a.numbers.size(); i += 2) points.push_back({a[i], a[i + 1]});
  return region(polygon(points));
}

ShapePtr text_region(const Arguments& a) {
  if (!a.options.text_outline) throw Error(ErrorKind::Input, "text requires a font, which is not available here");
  return moved(a.at(), region(a.options.text_outline(a.text, a[2])));
}

template <Kind kind>
ShapePtr join(const Arguments& a) {
  return combined(kind, a.shapes, a.numbers.empty() ? 0 : a[0]);
}

constexpr Word words[] = {
    {{"circle", "x y radius+", "disc around (x, y)"}, [](const Arguments& a) { return moved(a.at(), circle(a[2])); }},
    {{"ellipse", "x y radius_x+ radius_y+", "ellipse with its axes along x and y"},
     [](const Arguments& a) { return moved(a.at(), ellipse(a[2], a[3])); }},
    {{"square", "x y side+", "square with its centre at (x, y)"},
     [](const Arguments& a) { return moved(a.at(), rectangle(a[2], a[2])); }},
    {{"rectangle", "x y width+ height+", "rectangle with its centre at (x, y)"},
     [](const Arguments& a) { return moved(a.at(), rectangle(a[2], a[3])); }},
    {{"diamond", "x y width+", "rhombus of equal diagonals"},
     [](const Arguments& a) { return moved(a.at(), rhombus(a[2], a[2])); }},
    {{"rhombus", "x y width+ height+", "rhombus with these diagonals"},
     [](const Arguments& a) { return moved(a.at(), rhombus(a[2], a[3])); }},
    {{"trapezoid", "x y top* bottom+ height+", "isosceles trapezoid with horizontal sides"},
     [](const Arguments& a) { return moved(a.at(), trapezoid(a[2], a[3], a[4])); }},
    {{"triangle", "x y base+ height+", "isosceles triangle that points upwards"},
     [](const Arguments& a) { return moved(a.at(), triangle(a[2], a[3])); }},
    {{"regular-polygon", "x y radius+ corners##", "regular polygon with a corner at the top"},
     [](const Arguments& a) { return moved(a.at(), regular_polygon(a[2], static_cast<int>(a[3]))); }},
    {{"polygon", "points", "polygon through x1, y1, x2, y2, ...; non-zero winding"}, points_polygon},
    {{"line", "x1 y1 x2 y2 width+", "line with round ends"}, capsule},
    {{"path", "text", "outline of SVG path data: M L H V C S Q T A Z, absolute or relative"},
     [](const Arguments& a) { return region(parse_svg_path(a.text)); }},
    {{"text", "x y size+ text", "line of text that starts at (x, y) on its baseline"}, text_region},
    {{"union", "shapes", "points in any of the shapes"}, join<Kind::Union>},
    {{"intersection", "shapes", "points in all of them"}, join<Kind::Intersection>},
    {{"difference", "shapes", "points in the first and in no other"}, join<Kind::Difference>},
    {{"smooth-union", "width* shapes", "union with joints rounded over this width"}, join<Kind::SmoothUnion>},
    {{"smooth-intersection", "width* shapes", "intersection with rounded edges"}, join<Kind::SmoothIntersection>},
    {{"smooth-difference", "width* shapes", "difference with rounded edges"}, join<Kind::SmoothDifference>},
    {{"round", "radius* shape", "grown by the radius, which rounds outer corners"},
     [](const Arguments& a) { return modified(Kind::Offset, a[0], a.shape()); }},
    {{"shrink", "amount* shape", "points deeper inside than the amount"},
     [](const Arguments& a) { return modified(Kind::Offset, -a[0], a.shape()); }},
    {{"outline", "width+ shape", "points within half of the width of the boundary"},
     [](const Arguments& a) { return modified(Kind::Border, a[0], a.shape()); }},
    {{"complement", "shape", "points outside"},
     [](const Arguments& a) { return modified(Kind::Complement, 0, a.shape()); }},
    {{"move", "x y shape", "moved"}, [](const Arguments& a) { return moved(a.at(), a.shape()); }},
    {{"turn", "degrees shape", "rotated about (0, 0), clockwise"},
     [](const Arguments& a) { return rotated(a[0], a.shape()); }},
    {{"scale", "factor+ shape", "scaled about (0, 0)"},
     [](const Arguments& a) { return mapped({.scale = a[0]}, a.shape()); }},
    {{"flip", "shape", "mirrored left to right about x = 0"},
     [](const Arguments& a) { return mapped({.cosine = -1, .is_mirrored = true}, a.shape()); }},
    {{"repeat", "step_x* step_y* shape", "copies without end; a step of 0: none along that axis"},
     [](const Arguments& a) { return repeated(a.at(), 0, 0, a.shape()); }},
    {{"grid", "columns# rows# step_x+ step_y+ shape", "copies in columns and rows around (0, 0)"},
     [](const Arguments& a) {
       return repeated({a[2], a[3]}, static_cast<int>(a[0]), static_cast<int>(a[1]), a.shape());
     }}};

/// The words of a table of parameters, one by one.
template <class Use>
void for_parameters(std::string_view parameters, const Use& use) {
  while (!parameters.empty()) {
    const std::size_t end = std::min(parameters.find(' '), parameters.size());
    use(parameters.substr(0, end));
    parameters.remove_prefix(std::min(end + 1, parameters.size()));
  }
}

/// "x, y, radius"
std::string readable(std::string_view parameters) {
  std::string out;
  for_parameters(parameters, [&](std::string_view name) {
    out += (out.empty() ? "" : ", ") + std::string(name.substr(0, name.find_first_of("+*#")));
  });
  return out;
}

class Builder {
  /// The result of `body()`, in whose errors the place of the term is named.
  template <class Body>
  decltype(auto) naming(const Term& term, const Body& body) {
    try {
      return body();
    } catch (const Error& error) {
      fail(term, error.what());
    }
  }

 public:
  Builder(std::string_view file, const SceneFileOptions& options) : file_(file), options_(options) {}

  void add(const Term& statement) {
    const std::vector<Term>& a = statement.arguments;
    if (statement.text == "canvas") {
      if (a.size() != 2) fail(statement, fmt::format("canvas has 2 numbers, width and height; found {}", a.size()));
      scene_.width = side(a[0]), scene_.height = side(a[1]);
    } else if (statement.text == "background") {
      scene_.background = color(a[0]);
    } else if (statement.text == "let") {
      const Term& name = a[0];
      if (find_word(name.text) != nullptr)
        fail(name, fmt::format("'{}' is already a shape or an operation", name.text));
      if (!named_.emplace(name.text, shape(a[1])).second) fail(name, fmt::format("'{}' is defined twice", name.text));
    } else if (statement.text == "fill") {
      layer(statement, color(a[0]), shape(a[1]));
    } else {
      assert(statement.text == "stroke");
      const Linear paint = color(a[0]);
      const double width = number(a[1], "width+");
      ShapePtr filled = shape(a[2]);
      layer(statement, paint, naming(statement, [&] { return modified(Kind::Border, width, std::move(filled)); }));
    }
  }

  SceneFile take() { return std::move(scene_); }

 private:
  [[noreturn]] void fail(const Term& term, const std::string& cause) const { fail_at(file_, term.at, cause); }

  static const Word* find_word(std::string_view name) {
    for (const Word& word : words)
      if (word.name == name) return &word;
    return nullptr;
  }

  int side(const Term& term) const {
    constexpr double most = 32768;
    if (term.kind != Term::Kind::Number || !(term.number >= 1 && term.number <= most) ||
        term.number != std::floor(term.number))
      fail(term, fmt::format("expected a side of the canvas, a whole number of pixels from 1 to {}", most));
    return static_cast<int>(term.number);
  }

  Linear color(const Term& term) const {
    const std::optional<Rgba8> found = parse_hex_color(term.text);
    if (!found) fail(term, fmt::format("'{}' is not a colour; expected #rgb, #rgba, #rrggbb or #rrggbbaa", term.text));
    const float alpha = static_cast<float>(found->a) / 255;
    return {decode_srgb8(found->r) * alpha, decode_srgb8(found->g) * alpha, decode_srgb8(found->b) * alpha, alpha};
  }

  double number(const Term& term, std::string_view parameter) const {
    const std::string name(parameter.substr(0, parameter.find_first_of("+*#")));
    if (term.kind != Term::Kind::Number)
      fail(term, fmt::format("expected {}, a number, found {}", name,
                             term.kind == Term::Kind::Text ? "a string" : "'" + term.text + "'"));
    const double v = term.number;
    if (!(std::abs(v) <= Program::farthest))
      fail(term, fmt::format("{} is {:g}; the greatest number is {:g}", name, v, Program::farthest));
    const bool is_whole = v == std::floor(v) && v <= 10'000;
    const std::string_view rule = parameter.substr(name.size());
    if (rule == "+" && !(v >= Program::smallest))
      fail(term, fmt::format("{} is {:g}; expected at least {:g}", name, v, Program::smallest));
    if (rule == "*" && !(v >= 0)) fail(term, fmt::format("{} is {:g}; expected at least 0", name, v));
    if (rule == "#" && !(is_whole && v >= 1))
      fail(term, fmt::format("{} is {:g}; expected a whole number from 1 to 10000", name, v));
    if (rule == "##" && !(is_whole && v >= 3))
      fail(term, fmt::format("{} is {:g}; expected a whole number from 3 to 10000", name, v));
    return v;
  }

  /// Adds the value of one parameter; `at` is the next argument.
  void take(const Term& call, std::string_view parameter, std::size_t& at, Arguments& out) {
    const std::vector<Term>& a = call.arguments;
    if (parameter == "points") {
      for (; at < a.size(); ++at) out.numbers.push_back(number(a[at], at % 2 == 0 ? "x" : "y"));
      if (out.numbers.size() < 6 || out.numbers.size() % 2 != 0)
        fail(call, fmt::format("{} has x and y of 3 or more points; found {} numbers", call.text, out.numbers.size()));
    } else if (parameter == "shapes") {
      if (at == a.size()) fail(call, fmt::format("{} has no shape", call.text));
      for (; at < a.size(); ++at) out.shapes.push_back(shape(a[at]));
    } else if (parameter == "shape") {
      out.shapes.push_back(shape(a[at++]));
    } else if (parameter == "text") {
      if (a[at].kind != Term::Kind::Text) fail(a[at], "expected a string in quotation marks");
      out.text = a[at++].text;
    } else {
      out.numbers.push_back(number(a[at++], parameter));
    }
  }

  ShapePtr shape(const Term& term) {
    if (term.kind != Term::Kind::Call)
      fail(term, fmt::format("expected a shape, found a {}", term.kind == Term::Kind::Text ? "string" : "number"));
    if (!term.has_arguments) {
      const auto found = named_.find(term.text);
      if (found != named_.end()) return found->second;
    }
    const Word* const word = find_word(term.text);
    if (word == nullptr) {
      std::vector<std::string_view> names;
      for (const Word& w : words) names.push_back(w.name);
      for (const auto& [name, shape] : named_) names.push_back(name);
      const std::string_view near = closest(term.text, names);
      fail(term, fmt::format("'{}' is not a shape{}", term.text,
                             near.empty() ? "" : fmt::format("; did you mean {}?", near)));
    }

    Arguments out{.numbers = {}, .text = {}, .shapes = {}, .options = options_};
    std::size_t at = 0;
    bool is_open = false;  // the last parameter takes all arguments
    for_parameters(word->parameters, [&](std::string_view parameter) {
      is_open = parameter == "points" || parameter == "shapes";
      if (at == term.arguments.size() && !is_open) missing(term, *word);
      take(term, parameter, at, out);
    });
    if (at < term.arguments.size()) missing(term, *word);
    try {
      return word->make(out);
    } catch (const Error& error) {
      fail(term.arguments.empty() ? term : term.arguments.back(), fmt::format("{}: {}", term.text, error.what()));
    }
  }

  [[noreturn]] void missing(const Term& term, const Word& word) const {
    fail(term, fmt::format("{}({}) has {} arguments", word.name, readable(word.parameters), term.arguments.size()));
  }

  void layer(const Term& statement, const Linear& paint, const ShapePtr& shape) {
    naming(statement, [&] { scene_.drawing.fill(shape, paint); });
    const Bounds& bounds = scene_.drawing.layers.back().shape.bounds;
    if (bounds.is_finite()) scene_.bounds.add(bounds);
    if (options_.keeps_shapes) scene_.shapes.push_back(shape);
  }

  std::string_view file_;
  const SceneFileOptions& options_;
  SceneFile scene_;
  std::map<std::string, ShapePtr, std::less<>> named_;
};

constexpr auto listed_words = [] {
  std::array<ShapeWord, std::size(words)> out;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = words[i];
  return out;
}();

}  // namespace

SceneFile read_scene_file(std::string_view text, std::string_view file, const SceneFileOptions& options) {
  Builder builder(file, options);
  const StatementSink sink = [&](const Term& statement) { builder.add(statement); };
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const bool is_json = first != std::string_view::npos && text[first] == '{';
  (is_json ? parse_json_scene : parse_text_scene)(text, file, sink);
  return builder.take();
}

std::span<const ShapeWord> shape_words() { return listed_words; }

}  // namespace zoneplate::sdf
