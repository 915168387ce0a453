// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "zoneplate/codec/system/color_tags.h"
#include "zoneplate/codec/system/stored_image.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// A format that a shared library of the system decodes, which is opened by the first such file: TIFF, AVIF, JPEG XL.
struct SystemFormat {
  bool (*matches)(std::span<const std::uint8_t> bytes);
  /// Width and height as stored, or more; nothing if the file states none.
  std::optional<int2> (*find_size)(std::span<const std::uint8_t> bytes);
  ColorTags (*find_colors)(std::span<const std::uint8_t> bytes);  ///< null: not found in the header
  StoredImage (*decode)(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels);
};

/// The format of these bytes; null for others.
const SystemFormat* find_system_format(std::span<const std::uint8_t> bytes);

}  // namespace zoneplate
