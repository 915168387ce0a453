#pragma once

#include <cstddef>
#include <optional>

namespace zoneplate {

/// How much is held at once of what there may be more of than memory; the rest is drawn part by part, or found again
/// where it is needed. It changes times, no bits.
struct RasterRoom {
  std::size_t layer_samples = std::size_t{1} << 16;  ///< of masked and blended layers, by thread
  std::optional<std::size_t> screen_vertices;        ///< as `kept` of number_draws
};

}  // namespace zoneplate
