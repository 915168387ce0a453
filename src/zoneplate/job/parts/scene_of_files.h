// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/base/ranks/ranks.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// A scene whose parts are in several files, of which each rank has read some.
///
/// Instances, objects, materials and lights are those of all files, in their order, so that every id is that of the
/// whole. Of the files of other ranks there are no vertices and images, and of their materials only what light and
/// order depend on.
struct SceneOfFiles {
  Scene scene;
  std::vector<std::uint32_t> elsewhere;  ///< by instance: the triangles that other ranks have
  std::vector<Box> bounds;               ///< of each file, in world space
  double points = 0;                     ///< of all files
};

/// The rank that reads a file: consecutive files for each rank.
inline int rank_of_file(std::size_t file, std::size_t files, int ranks) {
  return static_cast<int>(file * static_cast<std::size_t>(ranks) / files);
}

/// Joins the scenes of the files that this rank has read to those of the others: `own` has a scene for each file, empty
/// where another rank has read it.
///
/// Errors    on every rank, ErrorKind::Input naming a file that cannot be joined: of another up axis or origin than the
///           first one, or with an environment of its own.
SceneOfFiles join_files(const std::vector<std::string>& files, std::vector<Scene> own, Ranks& ranks);

/// Points with the bounds of the files, in the coordinates of `scene`: the whole-scene view of several files is that of
/// their boxes, for any number of ranks.
Scene scene_of_bounds(std::span<const Box> bounds, const Scene& scene);

}  // namespace zoneplate
