// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/jpeg_encode.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

#include <string>

#include "zoneplate/base/error.h"

namespace zoneplate {

std::vector<std::uint8_t> encode_jpeg(const Rgba8Image& image, int quality, std::span<const std::uint8_t> icc) {
  if (image.width() < 1 || image.height() < 1 || image.width() > JPEG_MAX_DIMENSION ||
      image.height() > JPEG_MAX_DIMENSION)
    throw Error(ErrorKind::Failed, "an image of " + std::to_string(image.width()) + " x " +
                                       std::to_string(image.height()) + " pixels cannot be encoded as JPEG");
  // From here on only memory allocation can fail, in which case libjpeg exits the process.
  jpeg_error_mgr errors{};
  jpeg_compress_struct jpeg{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = static_cast<JDIMENSION>(image.width());
  jpeg.image_height = static_cast<JDIMENSION>(image.height());
  jpeg.input_components = 4;
  jpeg.in_color_space = JCS_EXT_RGBX;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, quality, TRUE);
  jpeg.dct_method = JDCT_ISLOW;
  jpeg.optimize_coding = TRUE;
  for (int c = 0; c < jpeg.num_components; ++c) jpeg.comp_info[c].h_samp_factor = jpeg.comp_info[c].v_samp_factor = 1;
  jpeg_start_compress(&jpeg, TRUE);
  if (!icc.empty()) jpeg_write_icc_profile(&jpeg, icc.data(), static_cast<unsigned>(icc.size()));
  static_assert(sizeof(Rgba8) == 4, "rows are handed to libjpeg as they lie");
  for (int y = 0; y < image.height(); ++y) {
    auto* row = const_cast<JSAMPLE*>(reinterpret_cast<const JSAMPLE*>(image.row(y).data()));
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  std::vector<std::uint8_t> out(bytes, bytes + size);
  std::free(bytes);
  return out;
}

}  // namespace zoneplate
