// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/level_mix.h"

#include <cstddef>
#include <new>

#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/environment/lookup.h"
#include "zoneplate/shade/environment/lookup_lanes.h"

namespace zoneplate {

LevelMix::LevelMix(const EnvironmentView& view, float roughness) : view_(view) {
  const auto levels = level_weights(view, scalar::Float(roughness));
  middle_ = levels.middle.v, side_ = view.common_side[middle_];
  for (int k = 0; k < 3; ++k) weights_[k] = levels.weights.of[k].v;
}

MixedLevel LevelMix::for_lookups(int count) {
  if (side_ == 0) return {};
  const auto mixed = [&] { return MixedLevel{texels_.load(std::memory_order_acquire), side_}; };
  if (const MixedLevel level = mixed(); level.texels != nullptr) return level;
  if (lookups_.load(std::memory_order_relaxed) < points() / points_per_lookup) {
    lookups_.fetch_add(count, std::memory_order_relaxed);
    return {};
  }
  // One thread mixes the levels; the others look up all three until it is done.
  if (!is_begun_.exchange(true, std::memory_order_relaxed)) mix();
  return mixed();
}

void LevelMix::mix() {
  // Whole groups of 16 floats, as kernels work on them: the irradiance follows the last level, so that they exist. A
  // look-up may load one float after the last texel.
  constexpr int group = 16;
  const int count = (3 * points() + 1 + group - 1) / group * group;
  memory_.reset(new (std::nothrow) float[static_cast<std::size_t>(count)]);
  if (memory_ == nullptr) return;
  const float* level[3];
  for (int k = 0; k < 3; ++k) level[k] = view_.texels + 3 * view_.offset[middle_ - 1 + k];
  LookupKernels::of().mix_levels(level, weights_, memory_.get(), count);
  texels_.store(memory_.get(), std::memory_order_release);
}

}  // namespace zoneplate
