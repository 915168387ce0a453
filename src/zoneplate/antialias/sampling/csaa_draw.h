#pragma once

#include <array>
#include <cstdint>

#include "zoneplate/raster/geometry/setup.h"
#include "zoneplate/render/custom_draw.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate::antialias {

/// What is drawn into a tile at once: a triangle, a piece of a clipped one, or one sample of a small one.
struct Drawn {
  std::int32_t id;
  const Triangle* triangle;  ///< null: a sample
  bool is_masked;
  std::uint32_t at;  ///< as in SampleBin
  float depth;
};

/// The order of drawing, a total one whichever thread found what: by id; of one id pieces before samples, pieces by
/// their shape and samples by pixel, sample and depth. Requires: depths are numbers.
bool comes_before(const Drawn& p, const Drawn& q);

/// What a pixel of few slots remembers of the surfaces that were drawn into it: which samples are whose, as long as
/// there is a slot for it.
class CoverageSlots {
 public:
  static constexpr std::size_t most = 8;

  /// The background's, at all samples.
  explicit CoverageSlots(std::uint32_t all_samples) { slots_[0] = {background, all_samples}, count_ = 1; }

  /// A surface comes to own these samples. Where there is no slot left the surface that has the fewest samples loses
  /// its own, of equals the last to come: nothing is known of these until something else is drawn there.
  void draw(std::int32_t surface, std::uint32_t samples, std::size_t slots);

  /// The samples of which something is known; never none.
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

/// Draws the colour of a frame with samples of coverage and depth, and `slots` colours a pixel.
///
/// Surfaces take slots in the order of drawing. A masked one takes that of the samples that it keeps to the end,
/// because alpha is asked of no others; a blended one takes none, and colours what is there.
/// Exact     with as many slots as surfaces it is multisampling.
void draw_with_slots(const CustomDraw& drawing, const SamplePattern& samples, std::size_t slots);

}  // namespace zoneplate::antialias
