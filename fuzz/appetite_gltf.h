// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "appetite.h"

namespace zoneplate::appetite {

/// A glTF file while it is put together: its JSON, to which members are added, and the bytes of buffer 0 of a GLB.
struct Gltf {
  using Json = nlohmann::json;

  Json root{{"asset", {{"version", "2.0"}}}, {"scene", 0}};
  Bytes binary;

  /// Appends an element to one of the root's lists and returns its number.
  std::size_t append(const char* list, Json element) {
    root[list].push_back(std::move(element));
    return root[list].size() - 1;
  }
  /// An accessor for whose elements there are no bytes: all are zero.
  std::size_t zeros(std::uint64_t count, const char* type, int component = 5126) {
    return append("accessors", {{"componentType", component}, {"count", count}, {"type", type}});
  }
  /// An accessor of floats that stand in the binary chunk.
  std::size_t floats(const char* type, std::size_t components, const std::vector<float>& values);
  std::size_t view(const Bytes& bytes);

  /// A mesh of one primitive. `more` are further members of the primitive.
  std::size_t mesh(Json attributes, const Json& more = Json::object());
  std::size_t zero_mesh(std::uint64_t vertices) { return mesh({{"POSITION", zeros(vertices, "VEC3")}}); }
  /// A square from -1 to 1 in the plane z = 0, with these further attributes.
  std::size_t square(Json attributes = Json::object(), const Json& more = Json::object());
  /// A node that is a root of the scene.
  std::size_t add_root(Json node);
  /// A root that has a mesh at so many places; `translation` is the accessor of the places.
  void place(std::size_t mesh, std::size_t translation);
  void place_at_zero(std::size_t mesh, std::uint64_t places) { place(mesh, zeros(places, "VEC3")); }

  std::string json() const { return root.dump(); }
  Bytes glb() const;
};

}  // namespace zoneplate::appetite
