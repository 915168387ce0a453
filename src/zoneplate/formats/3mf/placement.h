// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/formats/3mf/flaws.h"
#include "zoneplate/formats/3mf/mesh.h"
#include "zoneplate/formats/3mf/model.h"

namespace zoneplate {

/// The objects of a model that are no components of others, placed where they are; and of objects that contain each
/// other and that nothing else contains, one, so that all objects are in one of those that are returned.
std::vector<model_3mf::Placement> top_objects(const model_3mf::Model& model, ImportBudget& budget);

/// Places objects and their components in the scene. Each placed mesh is an object of the scene.
class ObjectPlacer {
 public:
  /// The model of a part; null if there is none.
  using FindModel = std::function<model_3mf::Model*(const std::string& part)>;

  /// Requires  the references outlive the object, and the models that `find_model` returns do.
  ObjectPlacer(FindModel find_model, PartContents contents, ModelFolder& files, FlawList& flaws)
      : find_model_(std::move(find_model)),
        budget_(files.budget()),
        scene_(files.scene()),
        flaws_(flaws),
        meshes_(std::move(contents), files, flaws) {}

  /// Places objects of a model. Those that are not there, or that contain themselves, are flaws.
  ///
  /// A scene far from the origin gets its Scene::origin: it is called once.
  ///
  /// Errors    ErrorKind::Input: components deeper than LoadLimits::node_depth, limits of the budget exceeded.
  void place_all(model_3mf::Model& root, const std::vector<model_3mf::Placement>& items);

 private:
  using Model = model_3mf::Model;
  using Object = model_3mf::Object;
  using Placement = model_3mf::Placement;

  /// The object that a placement names, and its model; nothing, with a flaw, if it is not there.
  struct Target {
    Model* model = nullptr;
    Object* object = nullptr;
  };
  enum class Content { Open, Nothing, Triangles };

  /// A product of transforms, in floats for scenes near the origin and in doubles for others.
  struct World {
    float4x4 from_object;
    Affine from_object_far;
  };

  Target find_target(Model& from, const Placement& placement);
  bool has_triangles(Model& model, Object& object, int depth);
  void check_depth(const Object& object, int depth) const;
  void place(Model& from, const Placement& placement, const World& parent, int depth);
  void add_instances(const Model& model, Object& object, const World& world);

  FindModel find_model_;
  ImportBudget& budget_;
  Scene& scene_;
  FlawList& flaws_;
  MeshMaker3mf meshes_;
  std::vector<Affine> placed_;                  ///< world from object of each instance
  std::map<const Object*, Content> contents_;   ///< of has_triangles
  std::map<const Object*, std::size_t> names_;  ///< the first item of Scene::objects of an object
};

}  // namespace zoneplate
