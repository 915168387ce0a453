// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "zoneplate/capi/guard.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/job/job.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/scene.h"
#include "zoneplate/zoneplate.h"

/// A scene that is being built, or the prepared scene that frames are rendered from.
struct zoneplate_scene {
  /// Calls body(scene) with the scene under construction, alone.
  /// Errors    ErrorKind::Usage for a scene that has been rendered.
  template <class Body>
  void change(const Body& body) {
    const std::scoped_lock lock(mutex_);
    if (!scene_) throw zoneplate::Error(zoneplate::ErrorKind::Usage, "the scene has been rendered: it cannot change");
    body(*scene_);
  }

  /// Calls body(scene) with the scene in either state, while nothing changes it.
  template <class Body>
  decltype(auto) read(const Body& body) const {
    const std::scoped_lock lock(mutex_);
    if (!scene_ && !prepared_) throw zoneplate::Error(zoneplate::ErrorKind::Failed, "the scene could not be prepared");
    return body(scene_ ? *scene_ : prepared_->scene());
  }

  /// The prepared scene, which the first call makes.
  /// Errors    ErrorKind::Usage naming what is invalid in the scene; OutOfMemory.
  zoneplate::PreparedScene prepared();

  /// The same with the materials of a job, by which the model of a file is read anew if it was loaded otherwise.
  /// Errors    those of `prepared` and of reading; ErrorKind::Usage if textures are needed that are already prepared.
  zoneplate::PreparedScene prepared(const zoneplate::Job& job);

  /// A job of this scene: its input, and the options by which it was loaded.
  zoneplate::Job job() const {
    zoneplate::Job out;
    out.input = name, out.load = load;
    return out;
  }

  std::string name;             ///< of the file or the built-in scene; empty: made from arrays
  zoneplate::LoadOptions load;  ///< by which it was loaded

  /// What a scene far from the origin of its coordinates needs while it is built (Scene::origin), by their indices: the
  /// centres that the positions of meshes far from their own origin are relative to, and the positions of lights.
  std::map<std::int32_t, zoneplate::double3> mesh_centres;
  std::map<std::size_t, zoneplate::double3> light_places;

  zoneplate_scene() : scene_(std::in_place) {}
  explicit zoneplate_scene(zoneplate::Scene scene) : scene_(std::move(scene)) {}

 private:
  mutable std::mutex mutex_;
  std::optional<zoneplate::Scene> scene_;
  std::optional<zoneplate::PreparedScene> prepared_;
};

namespace zoneplate::capi {

/// Loads a file or makes a built-in scene.
std::unique_ptr<zoneplate_scene> loaded(const std::string& name, const LoadOptions& load);

/// A camera in the coordinates of a scene with this origin.
/// Errors    ErrorKind::Usage for one that is not rigid, or shows nothing.
Camera camera_of(const zoneplate_camera* given, double3 origin, int width, int height);

/// An image of a job with its data passes.
std::unique_ptr<zoneplate_image> image_of(const Job& job, RenderedImage image, const Scene& scene);

/// Renders a still image of a job that check_job has completed, whose output ends in .png or, for linear light, .pfm.
std::unique_ptr<zoneplate_image> render_image(Job job, const PreparedScene& scene, const zoneplate_camera* camera);

}  // namespace zoneplate::capi

/// Arrays by name, and the memory that they are views of.
struct zoneplate_image {
  using Color = std::variant<std::monostate, zoneplate::Rgba8Image, zoneplate::Rgba16Image, zoneplate::LinearImage>;

  /// An image without "color".
  zoneplate_image() = default;
  /// An image with "color".
  zoneplate_image(Color color, bool has_alpha);

  /// Adds a view of memory that `owner` keeps.
  void add(std::string name, const zoneplate_array& array, std::shared_ptr<const void> owner);
  /// Adds a plane of numbers.
  void add(std::string name, zoneplate::Plane<float> plane);
  /// Adds numbers.
  void add(std::string name, std::vector<double> values);

  const std::vector<std::pair<std::string, zoneplate_array>>& arrays() const { return arrays_; }
  const Color& color() const { return color_; }
  bool has_alpha() const { return has_alpha_; }

 private:
  Color color_;
  bool has_alpha_ = false;
  std::vector<std::pair<std::string, zoneplate_array>> arrays_;
  std::vector<std::shared_ptr<const void>> memory_;
};
