#pragma once

#include <memory>
#include <string>

#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Loads a glTF 2.0 file, .gltf (with its buffers and images) or .glb: one scene of it, in one variant, at one moment.
///
/// Missing normals are flat, missing tangents (where a normal texture wants them) are MikkTSpace's, as the
/// specification says; strips, fans and loops become lists; a vertex that is not finite drops its primitives, with a
/// warning. Where no animation is chosen nodes and morph targets have the file's default pose; skins follow their
/// joints.
///
/// Space     a camera's transform has no scale and no mirroring; lights likewise.
/// Errors    ErrorKind::Input, one line naming the file, the place and the cause; a required extension that is not
///           supported is named. An optional one gives a warning that names it. ErrorKind::Usage for a choice that the
///           file does not have.
Scene load_gltf(const std::string& path, const LoadLimits& limits = {}, const SceneChoice& choice = {});

/// A glTF file that stays open, to be loaded at several moments: its materials and images are read once.
class GltfModel {
 public:
  explicit GltfModel(const std::string& path, const LoadLimits& limits = {});
  ~GltfModel();

  /// What load_gltf gives. `Images::Without` leaves the images out, for who only wants to know where things are.
  enum class Images { With, Without };
  Scene scene(const SceneChoice& choice, Images images = Images::With);

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace zoneplate
