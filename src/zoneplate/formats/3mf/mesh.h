// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "zoneplate/formats/3mf/flaws.h"
#include "zoneplate/formats/3mf/model.h"
#include "zoneplate/formats/import/model_folder.h"

namespace zoneplate {

/// The contents of a part of a package, charged to the budget, which gets them back from the caller; nothing if there
/// is no such part.
///
/// Errors    ErrorKind::Input: its packed bytes are damaged, limits of the budget exceeded.
using PartContents = std::function<std::optional<std::vector<std::uint8_t>>(const std::string& part)>;

/// Converts the meshes of a package's objects to meshes, materials and images of the scene.
///
/// An object becomes one mesh for each material that its triangles have: one for each base material and texture; all
/// colours that are interpolated share a material and are colours of the vertices.
class MeshMaker3mf {
 public:
  /// Requires  the arguments outlive the object.
  MeshMaker3mf(PartContents contents, ModelFolder& files, FlawList& flaws)
      : contents_(std::move(contents)), files_(files), flaws_(flaws), budget_(files.budget()), scene_(files.scene()) {}

  /// The indices of the meshes of an object, which are made once, from its arrays, which it loses; none if it has no
  /// triangles.
  const std::vector<int>& meshes_of(const model_3mf::Model& model, model_3mf::Object& object);

 private:
  using Model = model_3mf::Model;
  using Object = model_3mf::Object;
  using PropertyGroup = model_3mf::PropertyGroup;
  using TriangleProperty = model_3mf::TriangleProperty;

  /// The property of a triangle, found: its material, and the group whose colours and coordinates its corners have.
  struct Found {
    int material = 0;
    const PropertyGroup* group = nullptr;  ///< null: corners have no properties of their own
    std::array<std::uint32_t, 3> index{};
  };

  Found find(const Model& model, const Object& object, TriangleProperty property);
  int material_of(const Model& model, std::uint32_t group_id, const PropertyGroup& group, std::uint32_t index,
                  bool is_clear);
  Material make_material(const Model& model, const PropertyGroup& group, std::uint32_t index, bool is_clear);
  int image_of(const Model& model, const PropertyGroup& group);
  int default_material();
  int add_mesh(Mesh mesh, const Object& object, int material);
  Mesh part_of(const Mesh& mesh, std::span<const Found> found, std::span<const std::uint32_t> triangles);
  std::vector<int> make(const Model& model, Object& object);

  PartContents contents_;
  ModelFolder& files_;
  FlawList& flaws_;
  ImportBudget& budget_;
  Scene& scene_;
  std::map<const Object*, std::vector<int>> made_;
  /// By the model, the group, the index of a base material, and whether it is transparent.
  std::map<std::tuple<const Model*, std::uint32_t, std::uint32_t, bool>, int> materials_;
  std::map<std::pair<std::string, std::array<float, 4>>, int> images_;  ///< by part and the colour below
  int default_material_ = -1;
};

}  // namespace zoneplate
