// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"

namespace zoneplate::sdf {
namespace {

using Code = Instruction::Code;

[[noreturn]] void refuse(const std::string& cause) { throw Error(ErrorKind::Input, cause); }

float single(double v) { return static_cast<float>(v); }

LocalFrame frame_of(const Similarity& s) {
  return {single(s.move.x), single(s.move.y),   single(s.cosine), single(s.sine), s.is_mirrored ? -1.0f : 1.0f,
          single(s.scale),  single(1 / s.scale)};
}

/// The greatest distance of a curve from the line between its ends: that of its control points is not less.
double bulge_of(const Segment& s) {
  const Point chord = s.last() - s.first();
  const double chord_length = length(chord);
  double most = 0;
  for (int i = 1; i < s.degree; ++i) {
    const Point p = s.p[i] - s.first();
    most = std::max(most, chord_length > 0 ? std::abs(cross(chord, p)) / chord_length : length(p));
  }
  return most;
}

/// The piece relative to the centre of its outline, whose sides are at most `extent`.
Piece piece_of(const Segment& segment, Point centre, double extent) {
  const Point p0 = segment.first() - centre, p1 = segment.last() - centre;
  Piece piece{};
  piece.start_x = single(p0.x), piece.start_y = single(p0.y);
  piece.end_x = single(p1.x), piece.end_y = single(p1.y);
  const Segment s = segment.elevated();
  const Point d1 = s.p[1] - s.p[0], d2 = s.p[2] - s.p[1], d3 = s.p[3] - s.p[2];
  const Point a = d3 - d2 * 2 + d1, b = (d2 - d1) * 3, c = d1 * 3;
  piece.a_x = single(a.x), piece.a_y = single(a.y), piece.b_x = single(b.x), piece.b_y = single(b.y);
  piece.c_x = single(c.x), piece.c_y = single(c.y);
  if (segment.degree == 1) {
    piece.a_x = piece.a_y = piece.b_x = piece.b_y = 0;
    piece.c_x = piece.end_x - piece.start_x, piece.c_y = piece.end_y - piece.start_y;
  }
  piece.low_x = std::min(piece.start_x, piece.end_x), piece.high_x = std::max(piece.start_x, piece.end_x);
  piece.low_y = std::min(piece.start_y, piece.end_y), piece.high_y = std::max(piece.start_y, piece.end_y);
  const float dx = piece.end_x - piece.start_x, dy = piece.end_y - piece.start_y, square = dx * dx + dy * dy;
  piece.inverse_square = square > 0 ? 1 / square : 0;
  constexpr double rounding = 1e-5;  // of single precision, as a part of the extent
  piece.bulge = single(bulge_of(segment) * 1.0001 + extent * rounding);
  piece.direction = piece.end_y > piece.start_y ? 1.0f : piece.end_y < piece.start_y ? -1.0f : 0.0f;
  return piece;
}

/// A shape with its coordinates: the cell of a repetition in which it is evaluated, and the map to the cell.
struct Use {
  const Shape* shape;
  int cell;
  Similarity map;

  auto key() const {
    return std::tuple(shape, cell, map.cosine, map.sine, map.is_mirrored, map.scale, map.move.x, map.move.y);
  }
  bool operator<(const Use& other) const { return key() < other.key(); }
};

/// Assigns slots to the kept values, from number `at` on: a Store that no Load follows is left out, and a slot is free
/// again after its last Load. Returns the number of slots.
std::int32_t assign_slots(std::vector<Instruction>& instructions, std::size_t at, std::int32_t kept) {
  if (kept == 0) return 0;
  std::vector<std::int32_t> loads(static_cast<std::size_t>(kept)), slot(loads.size()), unused;
  const auto is = [](const Instruction& i, Code code) { return i.code == code; };
  for (std::size_t i = at; i < instructions.size(); ++i)
    if (is(instructions[i], Code::Load)) ++loads[static_cast<std::size_t>(instructions[i].first)];
  std::int32_t slots = 0;
  std::size_t end = at;
  for (std::size_t i = at; i < instructions.size(); ++i) {
    Instruction now = instructions[i];
    const auto value = static_cast<std::size_t>(now.first);
    if (is(now, Code::Store)) {
      if (loads[value] == 0) continue;
      if (unused.empty()) unused.push_back(slots++);
      now.first = slot[value] = unused.back();
      unused.pop_back();
    } else if (is(now, Code::Load)) {
      now.first = slot[value];
      if (--loads[value] == 0) unused.push_back(now.first);
    }
    instructions[end++] = now;
  }
  instructions.resize(end);
  return slots;
}

}  // namespace

struct Program::Emitter {
  Program& program;
  std::size_t first = program.instructions_.size();
  int values = 0, frames = 1;
  std::map<Use, std::int32_t> kept{};  ///< the numbers of values, until slots are assigned
  int cells = 0, cell = 0;             ///< counted, so that each cell has its own number; 0: outside of repetitions

  Instruction& emit(Instruction instruction) {
    constexpr std::size_t instructions_per_check = 4096;
    const std::size_t size = program.instructions_.size();
    if (size % instructions_per_check == 0) check_deadline();
    if (size - first == Shape::max_instructions)
      refuse(fmt::format("the shape has more than {} instructions", Shape::max_instructions));
    if (size == max_instructions) refuse(fmt::format("the shapes have more than {} instructions", max_instructions));
    return program.instructions_.emplace_back(instruction);
  }
  void push() { program.value_depth_ = std::max(program.value_depth_, ++values); }

  static void check_range(const Similarity& map, const Bounds& bounds) {
    if (!(map.scale >= smallest && map.scale <= farthest))
      refuse(fmt::format("a scale of {:g}: expected {:g} to {:g}", map.scale, smallest, farthest));
    const Bounds image = map(bounds);
    if (bounds.is_finite() && image.is_finite() &&
        !(std::max({-image.low.x, -image.low.y, image.high.x, image.high.y}) <= farthest))
      refuse(fmt::format("a shape extends beyond a coordinate of {:g}", farthest));
  }

  void region(const Shape& shape, const Similarity& map) {
    auto found = program.outlines_.find(shape.outline.get());
    if (found == program.outlines_.end()) {
      const Bounds bounds = shape.outline->bounds();
      StoredOutline stored{shape.outline, static_cast<std::int32_t>(program.pieces_.size()), 0, 0, {}};
      double extent = 0;
      if (!bounds.empty()) {
        stored.centre = (bounds.low + bounds.high) * 0.5;
        extent = std::max(bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y);
      }
      std::vector<Segment> lines, curves;
      for (const Contour& contour : shape.outline->contours)
        for (const Segment& segment : contour)
          for (const Segment& part : gentle_parts(segment)) (part.degree == 1 ? lines : curves).push_back(part);
      if (program.pieces_.size() + lines.size() + curves.size() > max_pieces)
        refuse(fmt::format("the outlines have more than {} parts", max_pieces));
      for (const Segment& s : lines) program.pieces_.push_back(piece_of(s, stored.centre, extent));
      stored.curves = static_cast<std::int32_t>(program.pieces_.size());
      for (const Segment& s : curves) program.pieces_.push_back(piece_of(s, stored.centre, extent));
      stored.end = static_cast<std::int32_t>(program.pieces_.size());
      found = program.outlines_.emplace(shape.outline.get(), std::move(stored)).first;
    }
    const StoredOutline& stored = found->second;
    Similarity centred = map;
    centred.move = map(stored.centre);
    emit({.code = Code::Region,
          .is_even_odd = shape.outline->fill == Outline::Fill::EvenOdd,
          .first = stored.first,
          .end = stored.end,
          .curves = stored.curves,
          .frame = frame_of(centred)});
    push();
  }

  /// Operands from the first to the last, each joined to the result so far.
  void join(const Shape& shape, const Similarity& map, Code code) {
    for (std::size_t i = 0; i < shape.operands.size(); ++i) {
      add(shape.operands[i], map);
      if (i == 0) continue;
      emit({.code = code, .a = single(shape.a * map.scale)});
      --values;
    }
  }
  void modify(const Shape& shape, const Similarity& map, Code code) {
    add(shape.operands[0], map);
    emit({.code = code, .a = single(shape.a * map.scale)});
  }

  /// The union of the copies in the two nearest columns and the two nearest rows.
  void repeat(const Shape& shape, const Similarity& map) {
    bool is_first = true;
    const int outer = cell;
    for (int y = 0; y < shape.rows(); ++y)
      for (int x = 0; x < shape.columns(); ++x) {
        const Instruction enter{.code = Code::EnterCell,
                                .cell = static_cast<std::uint8_t>(x | y << 1),
                                .a = single(shape.a),
                                .b = single(shape.b),
                                .count_x = static_cast<float>(shape.count_x),
                                .count_y = static_cast<float>(shape.count_y),
                                .frame = frame_of(map)};
        emit(enter);
        program.frame_depth_ = std::max(program.frame_depth_, ++frames);
        cell = ++cells;
        add(shape.operands[0], {});
        cell = outer;
        emit(enter).code = Code::LeaveCell;
        --frames;
        if (!std::exchange(is_first, false)) emit({.code = Code::Union}), --values;
      }
  }

  void leaf(const Shape& shape, const Similarity& map, Code code) {
    emit({.code = code, .a = single(shape.a), .b = single(shape.b), .frame = frame_of(map)});
    push();
  }

  /// Emits the shape, or loads its value if it is an operand that was evaluated before at the same coordinates.
  void add(const ShapePtr& shape, const Similarity& map) {
    const bool is_shared = shape.use_count() > 1 && (!shape->operands.empty() || shape->kind == Shape::Kind::Region);
    if (!is_shared) return evaluate(*shape, map);
    const auto [use, is_new] = kept.try_emplace(Use{shape.get(), cell, map}, static_cast<std::int32_t>(kept.size()));
    const std::int32_t value = use->second;
    if (is_new) {
      evaluate(*shape, map);
      emit({.code = Code::Store, .first = value});
    } else {
      emit({.code = Code::Load, .first = value});
      push();
    }
  }

  void evaluate(const Shape& shape, const Similarity& map) {
    check_range(map, shape.bounds);
    switch (shape.kind) {
      case Shape::Kind::Circle:
        return leaf(shape, map, Code::Circle);
      case Shape::Kind::Ellipse:
        return leaf(shape, map, shape.a == shape.b ? Code::Circle : Code::Ellipse);
      case Shape::Kind::Rectangle:
        return leaf(shape, map, Code::Rectangle);
      case Shape::Kind::Region:
        return region(shape, map);
      case Shape::Kind::Union:
        return join(shape, map, Code::Union);
      case Shape::Kind::Intersection:
        return join(shape, map, Code::Intersection);
      case Shape::Kind::Difference:
        return join(shape, map, Code::Difference);
      case Shape::Kind::SmoothUnion:
        return join(shape, map, Code::SmoothUnion);
      case Shape::Kind::SmoothIntersection:
        return join(shape, map, Code::SmoothIntersection);
      case Shape::Kind::SmoothDifference:
        return join(shape, map, Code::SmoothDifference);
      case Shape::Kind::Offset:
        return modify(shape, map, Code::Offset);
      case Shape::Kind::Border:
        return modify(shape, map, Code::Border);
      case Shape::Kind::Complement:
        return modify(shape, map, Code::Complement);
      case Shape::Kind::Mapped:
        return add(shape.operands[0], map * shape.map);
      case Shape::Kind::Repeat:
        return repeat(shape, map);
    }
  }
};

ShapeCode Program::add(const ShapePtr& shape) {
  if (const auto found = shared_.find(shape.get()); found != shared_.end()) return found->second.second;
  Emitter emitter{*this};
  emitter.evaluate(*shape, {});
  slots_ = std::max(slots_, assign_slots(instructions_, emitter.first, static_cast<std::int32_t>(emitter.kept.size())));
  if (slots_ > max_slots) refuse(fmt::format("more than {} operands are shared at once", max_slots));
  const ShapeCode code{emitter.first, instructions_.size(), shape->bounds};
  if (shape.use_count() > 1) shared_.emplace(shape.get(), std::pair(shape, code));
  return code;
}

}  // namespace zoneplate::sdf
