// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "zoneplate/sdf/shape.h"

namespace zoneplate::sdf {

/// A monotone, gently curved part of an outline as a polynomial: p(t) = ((a t + b) t + c) t + start.
struct Piece {
  float start_x, start_y, end_x, end_y;
  float a_x, a_y, b_x, b_y, c_x, c_y;
  float low_x, high_x, low_y, high_y;  ///< the bounds of the ends, and by monotony of the part
  float inverse_square;                ///< 1 / |end - start|²
  float bulge;      ///< not less than its distance from the line between its ends, or rounding errors
  float direction;  ///< +1 where y rises along the part, -1 where it falls, 0 for a horizontal one
};

/// The coordinates of an instruction: local = rotationᵀ (p - move) / scale, then y is multiplied by `mirror`.
struct LocalFrame {
  float move_x = 0, move_y = 0, cosine = 1, sine = 0, mirror = 1, scale = 1, inverse_scale = 1;
};

/// One instruction of a stack machine whose values are distances with their gradients.
struct Instruction {
  enum class Code : std::uint8_t {
    Circle,
    Ellipse,
    Rectangle,
    Region,
    Union,
    Intersection,
    Difference,
    SmoothUnion,
    SmoothIntersection,
    SmoothDifference,
    Offset,
    Border,
    Complement,
    EnterCell,  ///< replaces the coordinates by those of a cell of a repetition
    LeaveCell,
    Store,  ///< keeps the last value in slot `first`
    Load,   ///< a value that was kept
  };
  Code code = Code::Circle;
  std::uint8_t cell = 0;            ///< EnterCell: bits 0 and 1 choose the second nearest column and row
  bool is_even_odd = false;         ///< Region
  std::int32_t first = 0, end = 0;  ///< Region: the range of its pieces, lines first; Store and Load: the slot
  std::int32_t curves = 0;          ///< Region: the first piece that is not a line
  float a = 0, b = 0;               ///< the numbers of the shape; EnterCell: the steps
  float count_x = 0, count_y = 0;   ///< EnterCell; 0: no limit
  LocalFrame frame;
};

/// The instructions of one shape among those of a program.
struct ShapeCode {
  std::size_t first = 0, end = 0;
  Bounds bounds;  ///< the distance is positive outside
};

/// Shapes compiled to instructions. Outlines that shapes share are stored once, a shape that is added again is not
/// compiled again, and an operand that several operations share is evaluated once where its coordinates are the same.
class Program {
 public:
  static constexpr std::size_t max_instructions = std::size_t{1} << 22;  ///< of all shapes
  static constexpr std::size_t max_pieces = std::size_t{1} << 22;
  static constexpr std::int32_t max_slots = 4096;  ///< kept values, 768 bytes each
  static constexpr double farthest = 1e6;          ///< the greatest coordinate or size
  static constexpr double smallest = 1e-4;         ///< the least size of a unit of a shape, as scaled

  /// Errors    ErrorKind::Input: too many instructions, or a number that is out of range.
  ShapeCode add(const ShapePtr& shape);

  const std::vector<Instruction>& instructions() const { return instructions_; }
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// The greatest number of values, and of coordinates, on the stacks of an evaluation.
  int value_depth() const { return value_depth_; }
  int frame_depth() const { return frame_depth_; }
  /// The number of values that an evaluation keeps.
  std::int32_t slots() const { return slots_; }

 private:
  struct Emitter;
  std::vector<Instruction> instructions_;
  std::vector<Piece> pieces_;
  struct StoredOutline {
    std::shared_ptr<const Outline> outline;  ///< held so that its address stays its own
    std::int32_t first, curves, end;
    Point centre;
  };
  std::map<const Outline*, StoredOutline> outlines_;
  std::map<const Shape*, std::pair<ShapePtr, ShapeCode>> shared_;  ///< held for the same reason
  int value_depth_ = 1, frame_depth_ = 1;
  std::int32_t slots_ = 0;
};

}  // namespace zoneplate::sdf
