// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/formats/obj/lists.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// A statement between elements that applies to the following elements.
enum class ObjStateKind { Object, Group, Material, Smoothing, Library };
struct ObjState {
  ObjStateKind kind;
  std::uint32_t before;  ///< the index within its chunk of the element that follows the statement
  std::string text;
};

/// A kind of ignored content; ObjTally holds its count and its first occurrence.
enum class ObjNote { FewCorners, BadCorner, FreeForm, Unknown, UvNotFinite, NoSuchUv, NoSuchNormal };
struct ObjTally {
  std::uint64_t count = 0, line = 0;
  std::string word;
};

/// The elements of a part of the file. The file is cut independently of the number of threads.
struct ObjChunk {
  ObjCorners corners;
  ObjElements elements;
  std::vector<ObjState> states;
  std::array<ObjTally, 7> notes;  ///< by ObjNote

  std::uint64_t bytes() const {
    std::uint64_t texts = 0;
    for (const ObjState& s : states) texts += s.text.size();
    return corners.bytes() + elements.bytes() + states.size() * sizeof(ObjState) + texts;
  }
};

/// The vertices of a part.
struct ObjVertices {
  std::vector<float3> positions;
  std::vector<std::pair<std::uint64_t, float4>> colors;  ///< the index of a position of this part and its colour
  std::vector<float2> uvs;
  std::vector<float3> normals;
  bool has_odd_position = false;  ///< a position is not finite
  bool has_odd_normal = false;    ///< a normal has no direction

  std::uint64_t bytes() const {
    return positions.size() * sizeof(float3) + colors.size() * sizeof(colors[0]) + uvs.size() * sizeof(float2) +
           normals.size() * sizeof(float3);
  }
};

/// Numbers of lines and vertex data: in a part, before it, or in the file.
struct ObjCounts {
  std::uint64_t lines = 0, positions = 0, uvs = 0, normals = 0;
};

/// The result of reading one part.
struct ObjPart {
  ObjChunk chunk;
  ObjVertices vertices;
  ObjCounts counts;
  ObjCounts named;  ///< for each kind, the greatest one-based index that is used

  std::uint64_t bytes() const { return vertices.bytes() + chunk.bytes(); }
};

/// An error and its line.
struct ObjLineError {
  std::uint64_t line;
  std::string cause;
};

/// Maximum number of vertex data of one kind, and of corners of one chunk.
inline constexpr std::uint64_t max_obj_items = 1u << 30;

/// Reads a part without data of the others: lines are numbered from 1, and absolute indices are not checked against the
/// size of the file.
///
/// Returns false if the part depends on others, for example by an index that counts backwards, or contains an error;
/// then only `counts` is valid.
bool read_obj_part(std::string_view text, char separator, ObjPart& part);

/// Reads a part again whose contents depend on the parts before it and on the totals.
///
/// Errors    ObjLineError: a word that is not a number, too few numbers. An element with a corner that is no index, or
///           that of a missing vertex, is dropped with ObjNote::BadCorner.
void read_obj_part(std::string_view text, char separator, const ObjCounts& before, const ObjCounts& all, ObjPart& part);

/// Reads the positions of a part once more, relative to `origin`, which is subtracted in double before they are rounded
/// to floats.
///
/// Requires  the part was read without an error; `out` has an element for each of its positions.
void read_obj_positions(std::string_view text, char separator, double3 origin, std::span<float3> out);

}  // namespace zoneplate
