// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "zoneplate/formats/obj/lists.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// Assigns indices to the vertices of a mesh in the order of their first use: corners with the same indices, and the
/// same computed normal if any, are one vertex.
///
/// A hash table with chaining. At first, the hash maps nearby indices, which most files have in succession, to nearby
/// buckets, for locality in the cache. If a chain grows long, all vertices are rehashed with a hash that scatters. If a
/// chain grows even longer, which only happens to corners chosen to collide, an ordered map replaces the table. The
/// indices are the same in all cases.
class ObjVertexTable {
 public:
  /// Reserves capacity for `expected` vertices; more may be added.
  explicit ObjVertexTable(std::size_t expected) : heads_(std::bit_ceil(std::max<std::size_t>(expected, 64)), none) {
    corners_.reserve(expected);
    next_.reserve(expected);
  }

  std::uint32_t number(const ObjCorner& corner, float3 made = {}) {
    int steps = 0;
    const std::size_t at = place(corner, made);
    for (std::uint32_t i = heads_[at]; i != none; i = next_[i], ++steps)
      if (corners_[i] == corner && this->made(i) == made) return i;
    if (steps > 64 || is_ordered_) return number_in_order(corner, made);
    return add(corner, made, at, steps > 24 && !is_scattered_);
  }

  /// Whether collisions caused the switch to the ordered map.
  bool is_ordered() const { return is_ordered_; }

  const std::vector<ObjCorner>& corners() const { return corners_; }
  /// The computed normal of a vertex; zero if there is none.
  float3 made(std::size_t i) const { return made_.empty() ? float3{} : made_[i]; }
  std::size_t bytes() const {
    return corners_.capacity() * (sizeof(ObjCorner) + sizeof(next_[0])) + heads_.size() * sizeof(heads_[0]) +
           made_.capacity() * sizeof(float3) + ordered_.size() * sizeof(Node);
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;

  using Key = std::array<std::uint32_t, 6>;
  struct Node {
    std::pair<Key, std::uint32_t> value;
    void* links[5];  ///< links of the map's tree, and overhead of the heap
  };
  static Key key_of(const ObjCorner& corner, float3 made) {
    const auto word = [](float value) { return std::bit_cast<std::uint32_t>(value + 0.0f); };  // -0 becomes 0
    return {static_cast<std::uint32_t>(corner.position),
            static_cast<std::uint32_t>(corner.uv),
            static_cast<std::uint32_t>(corner.normal),
            word(made.x),
            word(made.y),
            word(made.z)};
  }
  /// Moves all vertices to the map. The chains become empty, so that every later search uses the map.
  void put_in_order() {
    is_ordered_ = true;
    heads_.assign(1, none);
    for (std::uint32_t i = 0; i < corners_.size(); ++i) ordered_.try_emplace(key_of(corners_[i], this->made(i)), i);
  }
  [[gnu::noinline]] std::uint32_t number_in_order(const ObjCorner& corner, float3 made) {
    if (!is_ordered_) put_in_order();
    const auto fresh = static_cast<std::uint32_t>(corners_.size());
    const auto [found, is_new] = ordered_.try_emplace(key_of(corner, made), fresh);
    if (!is_new) return found->second;
    append_made(made);
    corners_.push_back(corner);
    return fresh;
  }
  void append_made(float3 made) {
    if (made_.empty() && made != float3{}) made_.resize(corners_.size());
    if (!made_.empty() || made != float3{}) made_.push_back(made);
  }

  std::size_t place(const ObjCorner& corner, float3 made) const {
    const auto v = static_cast<std::uint32_t>(corner.position), t = static_cast<std::uint32_t>(corner.uv),
               n = static_cast<std::uint32_t>(corner.normal);
    const std::uint32_t h = is_scattered_
                                ? hash(v, t, n,
                                       std::bit_cast<std::uint32_t>(made.x) ^ std::bit_cast<std::uint32_t>(made.y) * 5 ^
                                           std::bit_cast<std::uint32_t>(made.z) * 9)
                                : v + 3 * t + 5 * n;
    return h & (heads_.size() - 1);
  }
  [[gnu::noinline]] std::uint32_t add(const ObjCorner& corner, float3 made, std::size_t at, bool is_crowded) {
    const auto fresh = static_cast<std::uint32_t>(corners_.size());
    append_made(made);
    corners_.push_back(corner);
    next_.push_back(std::exchange(heads_[at], fresh));
    if (!is_crowded && corners_.size() <= heads_.size()) return fresh;
    is_scattered_ = is_scattered_ || is_crowded;
    heads_.assign(std::max(heads_.size(), std::bit_ceil(2 * corners_.size())), none);
    for (std::uint32_t i = 0; i < corners_.size(); ++i)
      next_[i] = std::exchange(heads_[place(corners_[i], this->made(i))], i);
    return fresh;
  }

  std::vector<ObjCorner> corners_;
  std::vector<float3> made_;  ///< as many as corners, or empty if no normal was computed
  std::vector<std::uint32_t> next_, heads_;
  std::map<Key, std::uint32_t> ordered_;
  bool is_scattered_ = false, is_ordered_ = false;
};

}  // namespace zoneplate
