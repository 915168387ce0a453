// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/animated/animation_reader.h"

#include <algorithm>

#include "zoneplate/codec/animated/apng_reader.h"
#include "zoneplate/codec/animated/gif.h"
#include "zoneplate/codec/animated/webp_reader.h"

namespace zoneplate {

std::unique_ptr<AnimationReader> open_animation(std::span<const std::uint8_t> bytes, const std::string& name,
                                                std::uint64_t max_pixels) {
  if (count_frames(bytes) < 2) return nullptr;
  if (is_gif(bytes)) return open_gif(bytes, name, max_pixels);
  return is_animated_webp(bytes) ? open_webp_animation(bytes, name, max_pixels) : open_apng(bytes, name, max_pixels);
}

std::size_t count_frames(std::span<const std::uint8_t> bytes) {
  return std::max<std::size_t>(1, is_gif(bytes)             ? count_gif_frames(bytes)
                                  : is_animated_webp(bytes) ? count_webp_frames(bytes)
                                                            : count_apng_frames(bytes));
}

}  // namespace zoneplate
