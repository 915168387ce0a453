// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/png/png_color.h"

#include <zlib.h>

#include <new>
#include <string_view>

#include "zoneplate/codec/png/png_chunk.h"

namespace zoneplate {

std::vector<std::uint8_t> png_color_chunks(const ColorProfile& profile) {
  std::vector<std::uint8_t> out, data;
  if (profile.cicp) put_png_chunk(out, "cICP", *profile.cicp);
  if (!profile.icc.empty()) {
    constexpr std::string_view name("ICC profile\0\0", 13);  // with the end of the text, and the method: zlib
    data.assign(name.begin(), name.end());
    uLongf size = compressBound(static_cast<uLong>(profile.icc.size()));
    data.resize(name.size() + size);
    // With a buffer of this size, only memory can lack.
    if (compress(data.data() + name.size(), &size, profile.icc.data(), static_cast<uLong>(profile.icc.size())) != Z_OK)
      throw std::bad_alloc();
    data.resize(name.size() + size);
    put_png_chunk(out, "iCCP", data);
  }
  if (profile.gamma) {
    data.clear();
    put_png_word(data, *profile.gamma);
    put_png_chunk(out, "gAMA", data);
  }
  if (profile.primaries) {
    data.clear();
    for (const std::uint32_t value : *profile.primaries) put_png_word(data, value);
    put_png_chunk(out, "cHRM", data);
  }
  return out;
}

}  // namespace zoneplate
