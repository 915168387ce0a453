// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/animation.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "zoneplate/base/parallel.h"

namespace zoneplate {

// The convergents of the continued fraction approach the time, and each is the nearest of its size.
FrameTime FrameTime::of_microseconds(std::int64_t microseconds) {
  constexpr std::int64_t most = 65535;
  std::int64_t above = std::max(microseconds, std::int64_t{0}), below = 1'000'000;
  if (above / below >= most) return {static_cast<int>(most), 1};
  std::int64_t before[2] = {0, 1}, now[2] = {1, 0};
  while (below != 0) {
    const std::int64_t whole = above / below;
    const std::int64_t next[2] = {whole * now[0] + before[0], whole * now[1] + before[1]};
    if (next[0] > most || next[1] > most) break;
    std::ranges::copy(now, before), std::ranges::copy(next, now);
    above -= whole * below, std::swap(above, below);
  }
  return {static_cast<int>(now[0]), static_cast<int>(now[1])};
}

std::vector<std::uint8_t> encode_animation(AnimationEncoder& encoder, const Animation& animation) {
  assert(!animation.frames.empty());
  std::vector<std::function<void()>> works;
  for (const Rgba8Image& frame : animation.frames)
    works.push_back(encoder.add(std::shared_ptr<const Rgba8Image>(std::shared_ptr<void>(), &frame)));
  parallel_for(works.size(), [&](std::size_t i) { works[i](); });
  return encoder.finish();
}

}  // namespace zoneplate
