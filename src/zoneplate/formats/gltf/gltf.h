// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/mesh.h"
#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// The error about a file of glTF 1.0, text or binary: its version begins with 1.
class Gltf1Error : public Error {
 public:
  using Error::Error;
};

/// Loads a glTF 2.0 file, .gltf (with its buffers and images) or .glb: one scene of it, in one variant, at one time.
///
/// Missing normals are flat, missing tangents (if a normal texture needs them) are MikkTSpace's, as in the
/// specification; strips, fans and loops become lists; primitives with vertices that are not finite are dropped, with a
/// warning. Without an animation, nodes and morph targets have the file's default pose; skins follow their joints.
///
/// Space     the transforms of cameras and lights have no scale and no mirroring.
/// Errors    ErrorKind::Input, one line naming the file, the place and the cause; a required extension that is not
///           supported is named. An optional one gives a warning that names it. ErrorKind::Usage for a choice that the
///           file does not have. Gltf1Error.
Scene load_gltf(const std::string& path, const LoadLimits& limits = {}, const SceneChoice& choice = {});

/// Whether the bytes begin as a binary glTF file does, of any version.
bool is_binary_gltf(std::span<const std::uint8_t> bytes);

/// A glTF file that stays open, for loading at several times: its materials and images are read once.
class GltfModel {
 public:
  explicit GltfModel(const std::string& path, const LoadLimits& limits = {});
  /// A file that is read in parts, as GltfFile.
  GltfModel(const std::string& path, const LoadLimits& limits, std::span<const std::uint8_t> bytes);
  ~GltfModel();

  /// Loads a scene as load_gltf does. `Images::Without` omits the images, for callers that need only geometry.
  enum class Images { With, Without };
  Scene scene(const SceneChoice& choice, Images images = Images::With);
  /// The same scene with meshes by another reader, whose arguments and result are those of load_gltf_mesh. Instances of
  /// a mesh without vertices are all kept.
  using MeshReader =
      std::function<std::vector<GltfPrimitive>(GltfFile&, std::size_t, const GltfPose&, std::span<const Material>)>;
  Scene scene(const SceneChoice& choice, Images images, const MeshReader& read_mesh);
  /// The file, with the budget that remains for a scene, for a reader of the meshes of `scene` to go on.
  GltfFile& restarted_file();
  /// GltfFile::forget.
  void forget() const;
  /// Times at which the chosen animations may move something the farthest, the most important first (key_times.h).
  std::vector<double> key_times(const SceneChoice& choice);

 private:
  struct Open;
  std::unique_ptr<Open> open_;
};

}  // namespace zoneplate
