// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#pragma GCC visibility push(default)
namespace zoneplate {

/// Which triangle owns a sample that lies exactly on an edge.
enum class EdgeRule {
  TopLeft,  ///< a sample on a shared edge belongs to exactly one triangle
  Inside,   ///< for teaching: every triangle owns its edges
};

/// How hidden surfaces are removed.
enum class Visibility {
  ZBuffer,  ///< the nearest surface at each sample
  Painter,  ///< for teaching: triangles sorted by their mean depth, far first, no depth test
};

/// Capacities of buffers whose contents may exceed any memory. What does not fit is processed in parts, or computed
/// again where it is needed: capacities change the time, but no bit of an image.
struct RasterCapacity {
  std::size_t layer_samples = std::size_t{1} << 16;  ///< samples of transparent layers, per thread
  std::optional<std::size_t> screen_vertices{};      ///< as `kept` of number_draws
};

/// The options of rasterization that do not depend on the target.
struct RasterRules {
  EdgeRule edge_rule = EdgeRule::TopLeft;       ///< TopLeft, except for teaching
  Visibility visibility = Visibility::ZBuffer;  ///< ZBuffer, except for teaching
  RasterCapacity capacity{};                    ///< trades memory for time; changes no bit of an image
  /// Called by any thread after each tile, with the fraction of tiles that are complete; null: not called.
  const std::function<void(double)>* progress = nullptr;
};

}  // namespace zoneplate
#pragma GCC visibility pop
