// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/system/system_format.h"

#include <algorithm>
#include <array>

#include "zoneplate/codec/system/avif.h"
#include "zoneplate/codec/system/jxl.h"
#include "zoneplate/codec/system/tiff.h"

namespace zoneplate {
namespace {

constexpr std::array formats = {SystemFormat{is_tiff, find_tiff_size, find_tiff_colors, decode_tiff},
                                SystemFormat{is_avif, find_avif_size, find_avif_colors, decode_avif},
                                SystemFormat{is_jxl, find_jxl_size, nullptr, decode_jxl}};

}  // namespace

const SystemFormat* find_system_format(std::span<const std::uint8_t> bytes) {
  const auto found = std::ranges::find_if(formats, [&](const SystemFormat& f) { return f.matches(bytes); });
  return found == formats.end() ? nullptr : &*found;
}

}  // namespace zoneplate
