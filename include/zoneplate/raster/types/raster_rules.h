// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#pragma GCC visibility push(default)
namespace zoneplate {

/// Capacities of buffers whose contents may exceed any memory. What does not fit is processed in parts, or computed
/// again where it is needed: capacities change the time, but no bit of an image.
struct RasterCapacity {
  std::size_t layer_samples = std::size_t{1} << 16;  ///< samples of transparent layers, per thread
  std::optional<std::size_t> screen_vertices;        ///< as `kept` of number_draws
};

}  // namespace zoneplate
#pragma GCC visibility pop
