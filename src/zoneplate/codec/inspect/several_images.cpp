// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/several_images.h"

#include <fmt/format.h>

#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/codec/system/avif.h"
#include "zoneplate/codec/system/jxl.h"
#include "zoneplate/codec/system/tiff.h"

namespace zoneplate {

std::string several_images(std::span<const std::uint8_t> bytes) {
  if (is_tiff(bytes)) {
    const std::size_t pages = count_tiff_pages(bytes);
    return pages > 1 ? fmt::format("has {} pages", pages) : "";
  }
  if (is_jxl(bytes)) return is_animated_jxl(bytes) ? "is an animation of several frames" : "";
  const std::size_t frames = is_avif(bytes) ? count_avif_frames(bytes) : count_frames(bytes);
  return frames > 1 ? fmt::format("is an animation of {} frames", frames) : "";
}

}  // namespace zoneplate
