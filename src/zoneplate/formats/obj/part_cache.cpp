// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/part_cache.h"

#include <algorithm>
#include <utility>

namespace zoneplate {

ObjPartCache::ObjPartCache(ObjText text, std::vector<ObjCounts> before, std::uint64_t capacity)
    : text_(std::move(text)),
      before_(std::move(before)),
      parts_(text_.parts.size(), capacity, [this](std::size_t i) { return read(i); }) {}

ObjPart ObjPartCache::read(std::size_t i) const {
  ObjPart found;
  read_obj_part(text_.parts[i], text_.separator, before_[i], before_.back(), found);
  const ObjCounts &from = before_[i], &to = before_[i + 1];
  if (found.counts.positions != to.positions - from.positions || found.counts.uvs != to.uvs - from.uvs ||
      found.counts.normals != to.normals - from.normals)
    throw ObjLineError{from.lines, "has another number of vertices"};
  return found;
}

const ObjPart& ObjVertexReader::holding(std::int32_t i, std::uint64_t ObjCounts::*kind, std::size_t& number) {
  const std::vector<ObjCounts>& before = parts_.before();
  const auto v = static_cast<std::uint64_t>(i);
  if (i < 0 || v >= before.back().*kind) throw ObjLineError{0, "a vertex is missing"};
  if (before[last_].*kind <= v && v < before[last_ + 1].*kind) {
    number = last_;
  } else {
    const auto begins_after = [&](std::uint64_t value, const ObjCounts& counts) { return value < counts.*kind; };
    const auto next = std::upper_bound(before.begin(), before.end(), v, begins_after);
    number = last_ = static_cast<std::size_t>(next - before.begin()) - 1;
  }
  return held_[number];
}

float4 ObjVertexReader::color(std::int32_t position) {
  std::size_t number = 0;
  const ObjPart& part = holding(position, &ObjCounts::positions, number);
  const std::uint64_t own = static_cast<std::uint64_t>(position) - parts_.before()[number].positions;
  const auto& colors = part.vertices.colors;
  const auto is_before = [](const auto& color, std::uint64_t index) { return color.first < index; };
  const auto found = std::lower_bound(colors.begin(), colors.end(), own, is_before);
  return found != colors.end() && found->first == own ? found->second : float4{1, 1, 1, 1};
}

}  // namespace zoneplate
