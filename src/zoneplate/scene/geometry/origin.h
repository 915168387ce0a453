// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "zoneplate/math/affine.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// Chooses Scene::origin from places of a scene in the coordinates of its file: 0 for a scene near their origin, which
/// keeps its floats, otherwise the centre of its bounds.
///
/// A scene is near if no coordinate exceeds 64 times the longest side of its bounds: rounding a coordinate to a float
/// then moves it by at most 2^-19 of that side. As soon as a part of the scene is near, all of it is, up to 65 times:
/// callers add places until `is_near`, so that scenes near the origin cost nearly nothing.
///
/// Exact     the same for any number of threads, if places are added in the same order. Places that no float has, and
///           those that are not finite, do not count.
class OriginChoice {
 public:
  void add(double3 place);
  void add(float3 place) { add(widened(place)); }
  /// Adds positions until the scene is near.
  void add(std::span<const float3> positions);
  /// Adds `place_of(vertex)` of the vertices that a mesh's indices use, until the scene is near.
  template <class PlaceOf>
  void add_used(std::span<const std::uint32_t> indices, const PlaceOf& place_of) {
    constexpr std::size_t block = 256;
    for (std::size_t begin = 0; begin < indices.size() && !is_near(); begin += block)
      for (const std::uint32_t vertex : indices.subspan(begin, std::min(block, indices.size() - begin)))
        add(place_of(vertex));
  }
  /// Adds the places of another choice.
  void add(const OriginChoice& other) { add(other.low_), add(other.high_); }

  bool is_empty() const { return low_.x > high_.x; }
  /// True once a part of the scene is near.
  bool is_near() const { return !is_empty() && reach() <= farthest_near * extent(); }

  /// The origin: 0 for a near scene or one without places; otherwise the centre of the bounds, rounded to a multiple of
  /// the least power of two that is above a sixteenth of their longest side, so that it is a short number.
  double3 origin() const;

 private:
  static constexpr double farthest_near = 64;
  double reach() const;   ///< the greatest absolute coordinate
  double extent() const;  ///< the longest side; 1 for a single place, which the whole-scene view shows from 1 away

  double3 low_{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity()};
  double3 high_{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                -std::numeric_limits<double>::infinity()};
};

/// A vertex relative to `origin`; 0 where no float has that, as it may be of a vertex that nothing uses.
inline float3 relative_to(double3 origin, double3 vertex) {
  const float3 out = narrowed(vertex - origin);
  return is_finite(out) ? out : float3{};
}

/// Moves a mesh that lies far from its own origin, as OriginChoice decides, to lie around it; returns how far it was
/// moved back. Differences of floats of one magnitude are exact.
double3 center_far_mesh(Mesh& mesh);

/// Sets Scene::origin of a scene whose world has been the file's coordinates, in floats: of files that hold floats.
/// Meshes, instances, lights and cameras become relative to it.
void center_far_scene(Scene& scene);
/// The same for a scene whose instances a reader has placed in doubles: `placed` has world from object of each, of
/// which a near scene keeps the floats that it has.
void center_far_scene(Scene& scene, std::span<Affine> placed);

}  // namespace zoneplate
