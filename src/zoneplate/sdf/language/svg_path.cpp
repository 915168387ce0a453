// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/language/svg_path.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::sdf {
namespace {

class PathParser {
 public:
  explicit PathParser(std::string_view data) : data_(data), pen_(outline_) {}

  Outline parse() {
    skip_space();
    while (at_ < data_.size()) {
      const char c = data_[at_];
      constexpr std::string_view commands = "MmLlHhVvCcSsQqTtAaZz";
      if (commands.find(c) == std::string_view::npos) fail("expected a command such as M or L");
      if (is_first_ && c != 'M' && c != 'm') fail("expected M, with which every path starts");
      ++at_;
      command(c);
      is_first_ = false;
      skip_space();
    }
    pen_.close();
    return std::move(outline_);
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    const auto c = at_ < data_.size() ? static_cast<unsigned char>(data_[at_]) : 0u;
    const std::string found = at_ >= data_.size()  ? "the end"
                              : c < ' ' || c > '~' ? fmt::format("byte {:#04x}", c)
                                                   : fmt::format("'{}'", data_[at_]);
    throw Error(ErrorKind::Input, fmt::format("character {}: {}, found {}", at_ + 1, expected, found));
  }

  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\f' || c == '\r'; }
  void skip_space() {
    while (at_ < data_.size() && is_space(data_[at_])) ++at_;
  }
  /// Spaces with at most one comma.
  void skip_separator() {
    skip_space();
    if (at_ < data_.size() && data_[at_] == ',') ++at_, skip_space();
  }
  /// True if another number follows, as when a command's arguments are repeated.
  bool has_number() {
    const std::size_t before = at_;
    skip_separator();
    const char c = at_ < data_.size() ? data_[at_] : '\0';
    if ((c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.') return true;
    if (at_ > before && data_.substr(before, at_ - before).find(',') != std::string_view::npos)
      fail("expected a number");
    return false;
  }

  double number() {
    skip_space();
    std::size_t start = at_;
    if (start < data_.size() && data_[start] == '+') ++start;
    const char first = start < data_.size() ? data_[start] : '\0';
    double value = 0;
    const auto [end, error] = std::from_chars(data_.data() + start, data_.data() + data_.size(), value);
    if (error == std::errc::result_out_of_range) fail("a number out of range");
    if (error != std::errc{} || std::isalpha(static_cast<unsigned char>(first)) || !std::isfinite(value) ||
        (start > at_ && first == '-'))
      fail("expected a number");
    at_ = static_cast<std::size_t>(end - data_.data());
    return value;
  }
  double next_number() {
    skip_separator();
    return number();
  }
  bool flag() {
    skip_separator();
    if (at_ >= data_.size() || (data_[at_] != '0' && data_[at_] != '1')) fail("expected a flag, 0 or 1");
    return data_[at_++] == '1';
  }
  Point point(bool is_relative) {
    const double x = next_number(), y = next_number();
    return is_relative ? pen_.at() + Point{x, y} : Point{x, y};
  }

  void command(char c) {
    const bool is_relative = c >= 'a';
    const char kind = static_cast<char>(c & ~0x20);
    if (kind == 'Z') {
      pen_.close();
      pen_.move_to(start_);
      last_cubic_ = last_quadratic_ = std::nullopt;
      return;
    }
    bool is_repeated = false;
    do {
      arguments(kind == 'M' && is_repeated ? 'L' : kind, is_relative);
      is_repeated = true;
    } while (has_number());
  }

  void arguments(char kind, bool is_relative) {
    const Point here = pen_.at();
    std::optional<Point> cubic, quadratic;  // the last control point, for S and T
    switch (kind) {
      case 'M': {
        start_ = point(is_relative);
        pen_.move_to(start_);
        break;
      }
      case 'L':
        pen_.line_to(point(is_relative));
        break;
      case 'H':
        pen_.line_to({next_number() + (is_relative ? here.x : 0), here.y});
        break;
      case 'V':
        pen_.line_to({here.x, next_number() + (is_relative ? here.y : 0)});
        break;
      case 'C':
      case 'S': {
        const Point a = kind == 'C' ? point(is_relative) : last_cubic_ ? here + (here - *last_cubic_) : here;
        const Point b = point(is_relative), end = point(is_relative);
        pen_.cubic_to(a, b, end);
        cubic = b;
        break;
      }
      case 'Q':
      case 'T': {
        const Point a = kind == 'Q' ? point(is_relative) : last_quadratic_ ? here + (here - *last_quadratic_) : here;
        pen_.quadratic_to(a, point(is_relative));
        quadratic = a;
        break;
      }
      default: {  // A
        const double rx = std::abs(next_number()), ry = std::abs(next_number()), degrees = next_number();
        const bool is_large = flag(), is_clockwise = flag();
        arc(rx, ry, degrees, is_large, is_clockwise, point(is_relative));
      }
    }
    last_cubic_ = cubic, last_quadratic_ = quadratic;
  }

  // The centre of the arc in the frame where the ellipse is a unit circle, then cubics of at most 22.5° each.
  void arc(double rx, double ry, double degrees, bool is_large, bool is_clockwise, Point end) {
    const Point start = pen_.at();
    if (rx == 0 || ry == 0 || start == end) return pen_.line_to(end);
    const SineCosine turn = sin_cos_pi(degrees / 180);
    const auto to_circle = [&](Point p) {
      return Point{(turn.cosine * p.x + turn.sine * p.y) / rx, (turn.cosine * p.y - turn.sine * p.x) / ry};
    };
    const auto from_circle = [&](Point p) {
      return Point{turn.cosine * p.x * rx - turn.sine * p.y * ry, turn.sine * p.x * rx + turn.cosine * p.y * ry};
    };
    const Point a = to_circle(start), b = to_circle(end), half = (b - a) * 0.5, middle = (a + b) * 0.5;
    double square = dot(half, half), grown = 1;
    if (!(square > 0)) return pen_.line_to(end);
    if (square > 1) grown = std::sqrt(square), square = 1;  // the ellipse is enlarged until it reaches both ends
    const double along = std::sqrt(std::max(0.0, 1 - square)) / std::sqrt(square) * (is_large == is_clockwise ? -1 : 1);
    const Point centre = grown > 1 ? middle : middle + Point{-half.y, half.x} * along;
    const Point from = (a - centre) * (1 / grown), to = (b - centre) * (1 / grown);
    double sweep = angle_of(cross(from, to), dot(from, to));
    if (is_clockwise && sweep < 0) sweep += 2 * std::numbers::pi;
    if (!is_clockwise && sweep > 0) sweep -= 2 * std::numbers::pi;
    const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / (std::numbers::pi / 8) - 1e-9)));
    const double step = sweep / parts;
    const SineCosine one = sin_cos_pi(step / std::numbers::pi), quarter = sin_cos_pi(step / 4 / std::numbers::pi);
    const double handle = 4.0 / 3 * quarter.sine / quarter.cosine;
    Point p = from;
    for (int i = 0; i < parts; ++i) {
      const Point q{one.cosine * p.x - one.sine * p.y, one.sine * p.x + one.cosine * p.y};
      const auto place = [&](Point v) { return from_circle(centre + v * grown); };
      pen_.cubic_to(place(p + Point{-p.y, p.x} * handle), place(q - Point{-q.y, q.x} * handle),
                    i + 1 == parts ? end : place(q));
      p = q;
    }
  }

  std::string_view data_;
  std::size_t at_ = 0;
  bool is_first_ = true;
  Outline outline_;
  Pen pen_;
  Point start_;
  std::optional<Point> last_cubic_, last_quadratic_;
};

}  // namespace

Outline parse_svg_path(std::string_view data) { return PathParser(data).parse(); }

}  // namespace zoneplate::sdf
