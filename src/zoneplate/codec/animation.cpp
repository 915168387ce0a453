// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/animation.h"

#include <cassert>

#include "zoneplate/base/parallel.h"

namespace zoneplate {

std::vector<std::uint8_t> encode_animation(AnimationEncoder& encoder, const Animation& animation) {
  assert(!animation.frames.empty());
  std::vector<std::function<void()>> works;
  for (const Rgba8Image& frame : animation.frames)
    works.push_back(encoder.add(std::shared_ptr<const Rgba8Image>(std::shared_ptr<void>(), &frame)));
  parallel_for(works.size(), [&](std::size_t i) { works[i](); });
  return encoder.finish();
}

}  // namespace zoneplate
