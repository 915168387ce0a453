// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "zoneplate/formats/import/part_cache.h"
#include "zoneplate/formats/obj/parse.h"

namespace zoneplate {

/// The parts of a text that were read last. Several threads may use it.
class ObjPartCache {
 public:
  /// `before`: what read_obj_parts returns. Parts are kept up to `capacity` bytes.
  ObjPartCache(ObjText text, std::vector<ObjCounts> before, std::uint64_t capacity);

  std::size_t size() const { return parts_.size(); }
  std::string_view text(std::size_t part) const { return text_.parts[part]; }
  const std::vector<ObjCounts>& before() const { return before_; }
  const PartCache<ObjPart>& parts() const { return parts_; }

  /// Errors    ObjLineError, and another number of vertices as one, if the text has changed.
  std::shared_ptr<const ObjPart> part(std::size_t i) const { return parts_.part(i); }

 private:
  ObjPart read(std::size_t i) const;

  ObjText text_;
  std::vector<ObjCounts> before_;
  PartCache<ObjPart> parts_;
};

/// Reads single vertex data, for one thread.
///
/// Errors    those of ObjPartCache::part, and ObjLineError for data that the text lacks.
class ObjVertexReader {
 public:
  explicit ObjVertexReader(const ObjPartCache& parts) : parts_(parts), held_(parts.parts()) {}

  float3 position(std::int32_t i) { return find(i, &ObjCounts::positions, &ObjVertices::positions); }
  float3 normal(std::int32_t i) { return find(i, &ObjCounts::normals, &ObjVertices::normals); }
  float2 uv(std::int32_t i) { return find(i, &ObjCounts::uvs, &ObjVertices::uvs); }
  /// The colour of a position; white if it has none.
  float4 color(std::int32_t position);

 private:
  const ObjPart& holding(std::int32_t i, std::uint64_t ObjCounts::*kind, std::size_t& number);
  template <class V>
  V find(std::int32_t i, std::uint64_t ObjCounts::*kind, std::vector<V> ObjVertices::*list) {
    std::size_t number = 0;
    const ObjPart& part = holding(i, kind, number);
    return (part.vertices.*
            list)[static_cast<std::size_t>(static_cast<std::uint64_t>(i) - parts_.before()[number].*kind)];
  }

  const ObjPartCache& parts_;
  HeldParts<ObjPart> held_;
  std::size_t last_ = 0;
};

}  // namespace zoneplate
