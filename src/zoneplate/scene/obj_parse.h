#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/math/vec.h"
#include "zoneplate/scene/import_budget.h"

namespace zoneplate {

/// What a model's text says, before it becomes meshes. Indices are zero-based and checked; -1 is none.
struct ObjCorner {
  std::int32_t position = -1, uv = -1, normal = -1;
  bool operator==(const ObjCorner&) const = default;
};

enum class ObjKind : std::uint8_t { Face, Line, Point };

/// A face, a polyline or a set of points: `count` corners of its chunk from `first` on.
struct ObjElement {
  std::uint32_t first = 0, count = 0;
  ObjKind kind = ObjKind::Face;
};

/// What is said between the elements and holds for those that follow.
enum class ObjStateKind { Object, Group, Material, Smoothing, Library };
struct ObjState {
  ObjStateKind kind;
  std::uint32_t before;  ///< the element of its chunk before which it stands
  std::string text;
};

/// Things passed over; counted, with the first place of each.
enum class ObjNote { FewCorners, FreeForm, Unknown, UvNotFinite, NoSuchUv, NoSuchNormal };
struct ObjTally {
  std::uint64_t count = 0, line = 0;
  std::string word;
};

/// A part of the file. The parts are cut at fixed places, so that they are the same for any number of threads.
struct ObjChunk {
  std::vector<ObjCorner> corners;
  std::vector<ObjElement> elements;
  std::vector<ObjState> states;
  std::array<ObjTally, 6> notes;  ///< by ObjNote
};

struct ObjFile {
  std::vector<float3> positions;  ///< not finite where the file says so
  std::vector<float4> colors;     ///< as long as positions, or empty; codes as in the file, white where it has none
  std::vector<float2> uvs;        ///< finite; origin at the bottom left
  std::vector<float3> normals;    ///< of unit length, or zero where the file's is zero or not finite
  std::vector<ObjChunk> chunks;
};

/// Reads the statements of an OBJ file, in parallel.
///
/// Edges     a corner that names a texture coordinate or normal that is not there has none, with a note.
/// Errors    Trouble::Input naming file, line and cause: a number that is none, too few numbers, a vertex that is not
///           there.
ObjFile parse_obj(std::string_view text, ImportBudget& budget);

}  // namespace zoneplate
