// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "zoneplate/math/vec.h"

#pragma GCC visibility push(default)
namespace zoneplate {

/// What the indices of a mesh form.
enum class Topology {
  Triangles,  ///< three indices each
  Lines,      ///< separate segments, two indices each; RenderOptions::line_width
  Points,     ///< one index each; RenderOptions::point_size
};

/// Indexed primitives of one kind with one material: a glTF primitive, or an OBJ group of one material.
///
/// Shape     every attribute is empty or as long as `position`; `index` holds 3, 2 or 1 entries a primitive.
/// Space     object space, right-handed, +Y up; uv (0,0) is the top-left of the image; front faces are
///           counter-clockwise. `tangent.w` is the sign of the bitangent; `color` is linear, straight alpha.
/// Requires  after load: all values finite, every index < position.size(), normals (where present) of unit length.
///           `normal` is present for triangles. A mesh without normals is drawn unlit.
struct Mesh {
  std::string name{};                       ///< from the file, for listings; need not be unique
  Topology topology = Topology::Triangles;  ///< how `index` is grouped
  std::vector<float3> position{};           ///< one for each vertex
  std::vector<float3> normal{};             ///< unit length
  std::vector<float4> tangent{};            ///< xyz: unit length, along +u; w: 1 or -1
  std::vector<float2> uv0{}, uv1{};         ///< texture coordinates, sets 0 and 1 of TextureUse::uv_set
  std::vector<float4> color{};              ///< multiplies the base colour
  std::vector<std::uint32_t> index{};       ///< into the attributes, primitive by primitive
  int material = 0;                         ///< index into Scene::materials

  /// 3, 2 or 1, by the topology.
  int vertices_per_primitive() const {
    return topology == Topology::Triangles ? 3 : topology == Topology::Lines ? 2 : 1;
  }
  /// The number of triangles, lines or points.
  std::size_t primitives() const { return index.size() / static_cast<std::size_t>(vertices_per_primitive()); }
};

}  // namespace zoneplate
#pragma GCC visibility pop
