// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "zoneplate/raster/geometry/setup.h"
#include "zoneplate/render/custom_draw.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate::antialias {

/// A drawing step of a tile: a triangle, a piece of a clipped triangle, or one sample of a small triangle.
struct Drawn {
  std::int32_t id;
  const Triangle* triangle;  ///< null: a sample
  bool is_masked;
  std::uint32_t at;  ///< as in SampleBin
  float depth;
};

/// A total order of drawing that is independent of threads: by id; within an id, pieces before samples; pieces by their
/// shape, samples by pixel, sample and depth. Requires: depths are not NaN.
bool comes_before(const Drawn& p, const Drawn& q);

/// The slots of a pixel: the surfaces drawn into it, at most one per slot, each with its samples.
class CoverageSlots {
 public:
  static constexpr std::size_t most = 8;

  /// Initially all samples belong to the background.
  explicit CoverageSlots(std::uint32_t all_samples) { slots_[0] = {background, all_samples}, count_ = 1; }

  /// Assigns these samples to a surface. Without a free slot the surface with the fewest samples is dropped (of equal
  /// ones, the latest): its samples are unknown until they are drawn again.
  void draw(std::int32_t surface, std::uint32_t samples, std::size_t slots);

  /// The known samples; at least one.
  std::uint32_t known() const;

 private:
  static constexpr std::int32_t background = -1;
  struct Slot {
    std::int32_t surface;
    std::uint32_t samples;
  };
  std::array<Slot, most + 1> slots_{};
  std::size_t count_;
};

/// Draws the colour of a frame with coverage and depth samples, and `slots` colours per pixel.
///
/// Surfaces take slots in the order of drawing. An alpha-tested surface takes a slot only for samples at which it
/// remains visible, because alpha is tested at no others. A blended surface takes no slot; it is composited over the
/// slots.
/// Exact     with as many slots as surfaces, the result is that of multisampling.
void draw_with_slots(const CustomDraw& drawing, const SamplePattern& samples, std::size_t slots);

}  // namespace zoneplate::antialias
