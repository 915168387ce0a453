#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "zoneplate/base/api.h"
#include "zoneplate/math/vec.h"

namespace ZONEPLATE_API zoneplate {

enum class Topology { Triangles, Lines, Points };

/// Indexed primitives of one kind with one material: a glTF primitive, or an OBJ group of one material.
///
/// Shape     every attribute is empty or as long as `position`; `index` holds 3, 2 or 1 entries a primitive.
/// Space     object space, right-handed, +Y up; uv (0,0) is the top-left of the image; front faces are
///           counter-clockwise. `tangent.w` is the sign of the bitangent; `color` is linear, straight alpha.
/// Requires  after load: all values finite, every index < position.size(), normals (where present) of unit length.
///           `normal` is present for triangles; lines and points without normals are drawn unlit.
struct Mesh {
  std::string name;
  Topology topology = Topology::Triangles;
  std::vector<float3> position;
  std::vector<float3> normal;
  std::vector<float4> tangent;
  std::vector<float2> uv0, uv1;
  std::vector<float4> color;
  std::vector<std::uint32_t> index;
  int material = 0;  ///< index into Scene::materials

  int vertices_per_primitive() const {
    return topology == Topology::Triangles ? 3 : topology == Topology::Lines ? 2 : 1;
  }
  std::size_t primitives() const { return index.size() / static_cast<std::size_t>(vertices_per_primitive()); }
};

}  // namespace zoneplate
