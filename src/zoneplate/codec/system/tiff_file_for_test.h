// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tiffio.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace zoneplate {

/// What a TIFF file made by libtiff has.
struct TiffForTest {
  int width = 0, height = 0;
  std::uint16_t samples = 3, bits = 8, kind = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_RGB,
                compression = COMPRESSION_NONE, planes = PLANARCONFIG_CONTIG, orientation = 1;
  int alpha = -1;                           ///< EXTRASAMPLE_ of the last sample; negative: it is none
  int tile = 0;                             ///< side of square tiles; 0: strips
  int rows_per_strip = 0;                   ///< 0: one strip
  const char* mode = "w";                   ///< "wb": big-endian; "w8": BigTIFF
  std::vector<std::uint8_t> profile = {};   ///< ICC
  std::vector<std::uint16_t> palette = {};  ///< all red, then all green, all blue
  std::vector<bool> are_copies = {false};   ///< the pages, which are alike, and whether one is a reduced copy
  std::vector<std::uint8_t> data = {};      ///< of one row after the other, of each plane, in this machine's order
};

/// Makes the file.
inline std::vector<std::uint8_t> tiff_of(const TiffForTest& t) {
  struct Memory {
    std::vector<std::uint8_t> bytes;
    std::size_t at = 0;
  } memory;
  const auto of = [](thandle_t handle) -> Memory& { return *static_cast<Memory*>(handle); };
  static const auto memory_of = of;
  TIFF* const file = TIFFClientOpen(
      "", t.mode, &memory,
      [](thandle_t h, void* out, tmsize_t size) -> tmsize_t {
        Memory& m = memory_of(h);
        const std::size_t n = std::min(static_cast<std::size_t>(size), m.bytes.size() - std::min(m.at, m.bytes.size()));
        if (n > 0) std::memcpy(out, m.bytes.data() + m.at, n);
        m.at += n;
        return static_cast<tmsize_t>(n);
      },
      [](thandle_t h, void* from, tmsize_t size) -> tmsize_t {
        Memory& m = memory_of(h);
        const auto n = static_cast<std::size_t>(size);
        if (m.bytes.size() < m.at + n) m.bytes.resize(m.at + n);
        if (n > 0) std::memcpy(m.bytes.data() + m.at, from, n);
        m.at += n;
        return size;
      },
      [](thandle_t h, toff_t offset, int whence) -> toff_t {
        Memory& m = memory_of(h);
        m.at = static_cast<std::size_t>(offset) + (whence == SEEK_CUR ? m.at : whence == SEEK_END ? m.bytes.size() : 0);
        return m.at;
      },
      [](thandle_t) { return 0; }, [](thandle_t h) -> toff_t { return memory_of(h).bytes.size(); }, nullptr, nullptr);
  for (const bool is_copy : t.are_copies) {
    if (is_copy) TIFFSetField(file, TIFFTAG_SUBFILETYPE, FILETYPE_REDUCEDIMAGE);
    TIFFSetField(file, TIFFTAG_IMAGEWIDTH, t.width), TIFFSetField(file, TIFFTAG_IMAGELENGTH, t.height);
    TIFFSetField(file, TIFFTAG_BITSPERSAMPLE, t.bits), TIFFSetField(file, TIFFTAG_SAMPLESPERPIXEL, t.samples);
    TIFFSetField(file, TIFFTAG_SAMPLEFORMAT, t.kind), TIFFSetField(file, TIFFTAG_PHOTOMETRIC, t.photometric);
    TIFFSetField(file, TIFFTAG_COMPRESSION, t.compression), TIFFSetField(file, TIFFTAG_PLANARCONFIG, t.planes);
    TIFFSetField(file, TIFFTAG_ORIENTATION, t.orientation);
    if (t.photometric == PHOTOMETRIC_YCBCR) TIFFSetField(file, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
    if (t.alpha >= 0) {
      const auto kind = static_cast<std::uint16_t>(t.alpha);
      TIFFSetField(file, TIFFTAG_EXTRASAMPLES, 1, &kind);
    }
    if (!t.profile.empty())
      TIFFSetField(file, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(t.profile.size()), t.profile.data());
    if (!t.palette.empty()) {
      const std::size_t n = t.palette.size() / 3;
      TIFFSetField(file, TIFFTAG_COLORMAP, t.palette.data(), t.palette.data() + n, t.palette.data() + 2 * n);
    }
    const int planes = t.planes == PLANARCONFIG_SEPARATE ? t.samples : 1;
    const std::size_t pixel_bits = static_cast<std::size_t>(t.bits) * (planes > 1 ? 1 : t.samples);
    const std::size_t row = (static_cast<std::size_t>(t.width) * pixel_bits + 7) / 8;
    if (t.tile == 0) {
      TIFFSetField(file, TIFFTAG_ROWSPERSTRIP, t.rows_per_strip > 0 ? t.rows_per_strip : t.height);
      for (int p = 0; p < planes; ++p)
        for (int y = 0; y < t.height; ++y) {
          std::vector<std::uint8_t> line(row);
          std::memcpy(line.data(), t.data.data() + (static_cast<std::size_t>(p * t.height + y)) * row, row);
          TIFFWriteScanline(file, line.data(), static_cast<std::uint32_t>(y), static_cast<std::uint16_t>(p));
        }
    } else {
      TIFFSetField(file, TIFFTAG_TILEWIDTH, t.tile), TIFFSetField(file, TIFFTAG_TILELENGTH, t.tile);
      const std::size_t pixel = pixel_bits / 8, tile_row = static_cast<std::size_t>(t.tile) * pixel;
      for (int p = 0; p < planes; ++p)
        for (int y = 0; y < t.height; y += t.tile)
          for (int x = 0; x < t.width; x += t.tile) {
            std::vector<std::uint8_t> part(tile_row * static_cast<std::size_t>(t.tile));
            for (int j = 0; j < std::min(t.tile, t.height - y); ++j)
              std::memcpy(part.data() + static_cast<std::size_t>(j) * tile_row,
                          t.data.data() + static_cast<std::size_t>(p * t.height + y + j) * row +
                              static_cast<std::size_t>(x) * pixel,
                          static_cast<std::size_t>(std::min(t.tile, t.width - x)) * pixel);
            TIFFWriteTile(file, part.data(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0,
                          static_cast<std::uint16_t>(p));
          }
    }
    TIFFWriteDirectory(file);
  }
  TIFFClose(file);
  return memory.bytes;
}

}  // namespace zoneplate
