// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

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

/// The piece relative to the centre of its outline.
Piece piece_of(const Segment& segment, Point centre) {
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
  piece.direction = piece.end_y > piece.start_y ? 1.0f : piece.end_y < piece.start_y ? -1.0f : 0.0f;
  return piece;
}

}  // namespace

struct Program::Emitter {
  Program& program;
  int values = 0, frames = 1;

  Instruction& emit(Instruction instruction) {
    if (program.instructions_.size() == most_instructions)
      refuse(fmt::format("the shapes have more than {} instructions", most_instructions));
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
      if (!bounds.empty()) stored.centre = (bounds.low + bounds.high) * 0.5;
      std::vector<Segment> lines, curves;
      for (const Contour& contour : shape.outline->contours)
        for (const Segment& segment : contour)
          for (const Segment& part : gentle_parts(segment)) (part.degree == 1 ? lines : curves).push_back(part);
      if (program.pieces_.size() + lines.size() + curves.size() > most_instructions)
        refuse(fmt::format("the outlines have more than {} parts", most_instructions));
      for (const Segment& s : lines) program.pieces_.push_back(piece_of(s, stored.centre));
      stored.curves = static_cast<std::int32_t>(program.pieces_.size());
      for (const Segment& s : curves) program.pieces_.push_back(piece_of(s, stored.centre));
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
  void join(const Shape& shape, const Similarity& map, Code code, int depth) {
    for (std::size_t i = 0; i < shape.operands.size(); ++i) {
      add(*shape.operands[i], map, depth + 1);
      if (i == 0) continue;
      emit({.code = code, .a = single(shape.a * map.scale)});
      --values;
    }
  }
  void modify(const Shape& shape, const Similarity& map, Code code, int depth) {
    add(*shape.operands[0], map, depth + 1);
    emit({.code = code, .a = single(shape.a * map.scale)});
  }

  /// The union of the copies in the two nearest columns and the two nearest rows.
  void repeat(const Shape& shape, const Similarity& map, int depth) {
    const std::uint8_t columns = shape.a > 0 ? 2 : 1, rows = shape.b > 0 ? 2 : 1;
    bool is_first = true;
    for (std::uint8_t y = 0; y < rows; ++y)
      for (std::uint8_t x = 0; x < columns; ++x) {
        const Instruction enter{.code = Code::EnterCell,
                                .cell = static_cast<std::uint8_t>(x | y << 1),
                                .a = single(shape.a),
                                .b = single(shape.b),
                                .count_x = static_cast<float>(shape.count_x),
                                .count_y = static_cast<float>(shape.count_y),
                                .frame = frame_of(map)};
        emit(enter);
        program.frame_depth_ = std::max(program.frame_depth_, ++frames);
        add(*shape.operands[0], {}, depth + 1);
        emit(enter).code = Code::LeaveCell;
        --frames;
        if (!std::exchange(is_first, false)) emit({.code = Code::Union}), --values;
      }
  }

  void leaf(const Shape& shape, const Similarity& map, Code code) {
    emit({.code = code, .a = single(shape.a), .b = single(shape.b), .frame = frame_of(map)});
    push();
  }

  void add(const Shape& shape, const Similarity& map, int depth) {
    if (depth > deepest) refuse(fmt::format("operations are nested more than {} deep", deepest));
    check_range(map, shape.bounds());
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
        return join(shape, map, Code::Union, depth);
      case Shape::Kind::Intersection:
        return join(shape, map, Code::Intersection, depth);
      case Shape::Kind::Difference:
        return join(shape, map, Code::Difference, depth);
      case Shape::Kind::SmoothUnion:
        return join(shape, map, Code::SmoothUnion, depth);
      case Shape::Kind::SmoothIntersection:
        return join(shape, map, Code::SmoothIntersection, depth);
      case Shape::Kind::SmoothDifference:
        return join(shape, map, Code::SmoothDifference, depth);
      case Shape::Kind::Offset:
        return modify(shape, map, Code::Offset, depth);
      case Shape::Kind::Border:
        return modify(shape, map, Code::Border, depth);
      case Shape::Kind::Complement:
        return modify(shape, map, Code::Complement, depth);
      case Shape::Kind::Mapped:
        return add(*shape.operands[0], map * shape.map, depth + 1);
      case Shape::Kind::Repeat:
        return repeat(shape, map, depth);
    }
  }
};

ShapeCode Program::add(const ShapePtr& shape) {
  const std::size_t first = instructions_.size();
  Emitter emitter{*this};
  emitter.add(*shape, {}, 0);
  return {first, instructions_.size(), shape->bounds()};
}

}  // namespace zoneplate::sdf
