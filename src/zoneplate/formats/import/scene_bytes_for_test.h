// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/formats/import/scene_bytes.h"

namespace zoneplate {

/// The bytes that write_scene writes.
inline std::vector<std::uint8_t> written(const Scene& scene) {
  std::vector<std::uint8_t> out;
  write_scene(scene, [&](const void* data, std::size_t size) {
    const auto* at = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), at, at + size);
  });
  return out;
}

}  // namespace zoneplate
