// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/formats/obj/lists.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// A statement between elements that applies to those that follow.
enum class ObjStateKind { Object, Group, Material, Smoothing, Library };
struct ObjState {
  ObjStateKind kind;
  std::uint32_t before;  ///< the element of its chunk before which it stands
  std::string text;
};

/// Ignored content: its count, and the position of the first.
enum class ObjNote { FewCorners, FreeForm, Unknown, UvNotFinite, NoSuchUv, NoSuchNormal };
struct ObjTally {
  std::uint64_t count = 0, line = 0;
  std::string word;
};

/// A part of the file. The parts are cut at fixed places, so that they are the same for any number of threads.
struct ObjChunk {
  ObjCorners corners;
  ObjElements elements;
  std::vector<ObjState> states;
  std::array<ObjTally, 6> notes;  ///< by ObjNote

  std::uint64_t bytes() const {
    std::uint64_t texts = 0;
    for (const ObjState& s : states) texts += s.text.size();
    return corners.bytes() + elements.bytes() + states.size() * sizeof(ObjState) + texts;
  }
};

/// The vertices of a part.
struct ObjVertices {
  std::vector<float3> positions;
  std::vector<std::pair<std::uint64_t, float4>> colors;  ///< of which of these positions
  std::vector<float2> uvs;
  std::vector<float3> normals;
  bool has_odd_position = false;  ///< one that is not finite
  bool has_odd_normal = false;    ///< one without a direction

  std::uint64_t bytes() const {
    return positions.size() * sizeof(float3) + colors.size() * sizeof(colors[0]) + uvs.size() * sizeof(float2) +
           normals.size() * sizeof(float3);
  }
};

/// Numbers of elements of each kind: in a part, before it, or in the file.
struct ObjCounts {
  std::uint64_t lines = 0, positions = 0, uvs = 0, normals = 0;
};

/// One part, read by itself.
struct ObjPart {
  ObjChunk chunk;
  ObjVertices vertices;
  ObjCounts counts;
  ObjCounts named;  ///< the greatest absolute indices
};

/// A cause of refusal with its line.
struct ObjLineError {
  std::uint64_t line;
  std::string cause;
};

inline constexpr std::uint64_t most_obj_items = 1u << 30;  ///< of one kind, and corners of one chunk

/// Reads a part without knowing the others: lines are numbered from 1, and absolute indices may name what is not there.
///
/// Answers false where more has to be known, as for an index that counts backwards or before anything is refused; then
/// `counts` alone are right.
bool read_obj_part(std::string_view text, char separator, ObjPart& part);

/// Reads a part again whose contents depend on the parts before it and on the totals.
///
/// Errors    ObjLineError: a number that is none, too few numbers, a vertex that is not there.
void read_obj_part(std::string_view text, char separator, const ObjCounts& before, const ObjCounts& all, ObjPart& part);

}  // namespace zoneplate
