// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace zoneplate {

/// A corner of an element: zero-based indices, -1 where there is none.
struct ObjCorner {
  std::int32_t position = -1, uv = -1, normal = -1;
  bool operator==(const ObjCorner&) const = default;
};

enum class ObjKind : std::uint8_t { Face, Line, Point };

/// A face, a polyline or a set of points: `count` corners of its chunk, starting at `first`.
struct ObjElement {
  std::uint32_t first = 0, count = 0;
  ObjKind kind = ObjKind::Face;
  bool operator==(const ObjElement&) const = default;
};

/// A list of indices parallel to the list of positions. No memory is used if all are -1 or all are equal to the
/// positions' indices.
class ObjIndices {
 public:
  std::int32_t at(std::size_t i, std::int32_t position) const {
    return kind_ == Kind::Own ? own_[i] : kind_ == Kind::None ? -1 : position;
  }
  /// True if no index is -1; may also be false in that case.
  bool has_all() const { return kind_ == Kind::Same || (kind_ == Kind::Own && !has_none_); }

  /// Whether all are equal to the indices of their positions.
  bool are_same() const { return kind_ == Kind::Same; }

  void push_back(std::int32_t index, const std::vector<std::int32_t>& positions, std::int32_t position) {
    const bool is_first = positions.empty();
    if (is_first) kind_ = index == position ? Kind::Same : index < 0 ? Kind::None : Kind::Own;
    if (kind_ != Kind::Own && index == at(0, position)) return;
    if (kind_ != Kind::Own) become_own(positions);
    has_none_ = has_none_ || index < 0;
    own_.push_back(index);
  }
  void shorten(std::size_t size) {
    if (kind_ == Kind::Own) own_.resize(size);
  }
  std::size_t bytes() const { return own_.size() * sizeof(own_[0]); }

 private:
  enum class Kind : std::uint8_t { None, Same, Own };
  void become_own(const std::vector<std::int32_t>& positions) {
    if (kind_ == Kind::None)
      own_.assign(positions.size(), -1), has_none_ = true;
    else
      own_ = positions;
    kind_ = Kind::Own;
  }

  std::vector<std::int32_t> own_;
  Kind kind_ = Kind::None;
  bool has_none_ = false;
};

/// The corners of a chunk's elements, concatenated. In most files the three indices of a corner are equal, or a kind is
/// absent; then the list takes a third of the memory.
class ObjCorners {
 public:
  std::size_t size() const { return positions_.size(); }
  bool empty() const { return positions_.empty(); }
  ObjCorner operator[](std::size_t i) const {
    const std::int32_t position = positions_[i];
    return {position, uvs_.at(i, position), normals_.at(i, position)};
  }
  std::size_t position(std::size_t i) const { return static_cast<std::size_t>(positions_[i]); }
  /// True if every corner has a normal; may also be false in that case.
  bool have_normals() const { return normals_.has_all(); }

  void push_back(const ObjCorner& corner) {
    const bool is_one = corner.uv == corner.position && corner.normal == corner.position;
    if (is_one && !empty() && uvs_.are_same() && normals_.are_same()) return positions_.push_back(corner.position);
    uvs_.push_back(corner.uv, positions_, corner.position);
    normals_.push_back(corner.normal, positions_, corner.position);
    positions_.push_back(corner.position);
  }
  /// Truncates the list to `size` corners.
  void shorten(std::size_t size) {
    uvs_.shorten(size), normals_.shorten(size);
    positions_.resize(size);
  }
  std::size_t bytes() const { return positions_.size() * sizeof(positions_[0]) + uvs_.bytes() + normals_.bytes(); }

 private:
  std::vector<std::int32_t> positions_;
  ObjIndices uvs_, normals_;
};

/// The elements of a chunk. As long as all are consecutive triangles, only their number is stored.
class ObjElements {
 public:
  ObjElements() = default;
  explicit ObjElements(std::size_t triangles) : triangles_(triangles) {}
  std::size_t size() const { return triangles_ + own_.size(); }
  bool empty() const { return size() == 0; }
  bool are_triangles() const { return own_.empty(); }
  ObjElement operator[](std::size_t i) const { return own_.empty() ? triangle(i) : own_[i]; }

  void push_back(const ObjElement& element) {
    if (own_.empty() && element == triangle(triangles_)) return void(++triangles_);
    for (std::size_t i = 0; i < triangles_; ++i) own_.push_back(triangle(i));
    triangles_ = 0;
    own_.push_back(element);
  }
  std::size_t bytes() const { return own_.size() * sizeof(own_[0]); }

 private:
  static ObjElement triangle(std::size_t i) { return {static_cast<std::uint32_t>(3 * i), 3, ObjKind::Face}; }
  std::vector<ObjElement> own_;
  std::size_t triangles_ = 0;  ///< used while `own_` is empty
};

}  // namespace zoneplate
