// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>

#include "zoneplate/shade/environment/environment_view.h"

namespace zoneplate {

/// The levels of an environment map about one roughness, mixed as soon as enough look-ups have that roughness.
///
/// All threads of a frame share it. A look-up has the same bits with and without the mixed level.
class LevelMix {
 public:
  /// `view` must outlive the mix. The roughness is in [0, 1].
  LevelMix(const EnvironmentView& view, float roughness);
  LevelMix(const LevelMix&) = delete;
  LevelMix& operator=(const LevelMix&) = delete;

  /// The level for that many look-ups more. It is not mixed before the look-ups of all calls are worth the work, nor
  /// where the three levels differ in size.
  MixedLevel for_lookups(int count);

 private:
  /// A look-up in a mixed level saves about as much time as mixing this many control points takes (Zen 4).
  static constexpr int points_per_lookup = 8;
  int points() const { return EnvironmentView::faces * (side_ + 2) * (side_ + 2); }
  void mix();

  const EnvironmentView& view_;
  int middle_, side_;
  float weights_[3];
  std::atomic<int> lookups_{0};
  std::atomic<bool> is_begun_{false};
  std::unique_ptr<float[]> memory_;
  std::atomic<const float*> texels_{nullptr};  ///< `memory_`, once it is complete
};

}  // namespace zoneplate
