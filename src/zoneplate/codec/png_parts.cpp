// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/png_parts.h"

#include <zlib.h>

#include <algorithm>

#include "zoneplate/base/parallel.h"
#include "zoneplate/codec/png/deflate.h"
#include "zoneplate/codec/png/png_chunk.h"
#include "zoneplate/codec/png/png_rows.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

// The size of a part: large enough to amortize its own Huffman code, small enough for that code to adapt to the data.
constexpr std::size_t part_size = std::size_t{1} << 17;

/// A compressed group of rows, the contents of one IDAT chunk.
struct Part {
  Bytes data;
  std::uint32_t crc = 0;    ///< of the chunk's name and data
  std::uint32_t adler = 1;  ///< of the filtered rows
  std::size_t size = 0;     ///< of the filtered rows
};

class PartWriter {
 public:
  PartWriter(const Rgba8Image& image, bool has_alpha)
      : image_(image), has_alpha_(has_alpha), above_first_(static_cast<std::size_t>(image.width())) {
    std::fill(above_first_.begin(), above_first_.end(), Rgba8{0, 0, 0, 0});
  }

  std::size_t row_size() const { return 1 + above_first_.size() * (has_alpha_ ? 4 : 3); }

  Part write(int first_row, int end_row) const {
    constexpr std::uint8_t filter_up = 2;
    Bytes rows(row_size() * static_cast<std::size_t>(end_row - first_row));
    std::uint8_t* out = rows.data();
    for (int y = first_row; y < end_row; ++y, out += row_size()) {
      const auto* row = reinterpret_cast<const std::uint8_t*>(image_.row(y).data());
      const auto* above = reinterpret_cast<const std::uint8_t*>(y > 0 ? image_.row(y - 1).data() : above_first_.data());
      *out = filter_up;
      if (has_alpha_)
        kernels_.up(row, above, 4 * above_first_.size(), out + 1);
      else
        kernels_.up_rgb(row, above, above_first_.size(), out + 1);
    }

    Part part{.adler = kernels_.adler(rows.data(), rows.size()), .size = rows.size()};
    // The zlib header: the method, a window of 32 KiB, and the compression level.
    if (first_row == 0) part.data = {0x78, 0x01};
    deflate_part(rows, end_row == image_.height(), part.data);
    part.crc = png_checksum(png_checksum(0, Bytes{'I', 'D', 'A', 'T'}), part.data);
    return part;
  }

 private:
  const Rgba8Image& image_;
  bool has_alpha_;
  std::vector<Rgba8> above_first_;
  const PngRowKernels& kernels_ = PngRowKernels::of();
};

}  // namespace

std::vector<std::uint8_t> encode_png_parts(const Rgba8Image& image, const PngOptions& options) {
  const PartWriter writer(image, options.has_alpha);
  const auto height = static_cast<std::size_t>(image.height());
  const std::size_t rows = std::max<std::size_t>(1, part_size / writer.row_size());
  std::vector<Part> parts((height + rows - 1) / rows);
  parallel_for(parts.size(), [&](std::size_t i) {
    parts[i] = writer.write(static_cast<int>(i * rows), static_cast<int>(std::min(height, (i + 1) * rows)));
  });
  uLong adler = 1;
  std::size_t size = 0;
  for (const Part& part : parts) {
    adler = adler32_combine(adler, part.adler, static_cast<z_off_t>(part.size));
    size += part.data.size() + 12;
  }
  // The stream ends with the checksum of all filtered rows.
  Bytes sum;
  put_png_word(sum, static_cast<std::uint32_t>(adler));
  parts.back().data.insert(parts.back().data.end(), sum.begin(), sum.end());
  parts.back().crc = png_checksum(parts.back().crc, sum);

  Bytes out = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  out.reserve(size + 128);
  Bytes header;
  put_png_word(header, static_cast<std::uint32_t>(image.width()));
  put_png_word(header, static_cast<std::uint32_t>(image.height()));
  const std::uint8_t color_type = options.has_alpha ? 6 : 2;
  header.insert(header.end(), {8, color_type, 0, 0, 0});
  put_png_chunk(out, "IHDR", header);
  if (options.is_srgb) put_png_chunk(out, "sRGB", Bytes{0});
  for (const Part& part : parts) put_png_chunk(out, "IDAT", part.data, part.crc);
  put_png_chunk(out, "IEND", {});
  return out;
}

}  // namespace zoneplate
