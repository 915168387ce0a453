// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <jxl/encode.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "zoneplate/os/library.h"

namespace zoneplate {

/// What a JPEG XL file made by libjxl has; all its values are 200.
struct JxlForTest {
  std::uint32_t width = 8, height = 8, channels = 3;
  JxlPrimaries primaries = JXL_PRIMARIES_SRGB;
  JxlTransferFunction curve = JXL_TRANSFER_FUNCTION_SRGB;
  bool is_lossless = true;
  int frames = 1;              ///< more than one: an animation
  bool has_container = false;  ///< boxes around the codestream
  JxlOrientation orientation = JXL_ORIENT_IDENTITY;
  std::uint32_t displayed_width = 0, displayed_height = 0;  ///< the intrinsic size; 0: none
};

/// Makes the file.
///
/// Requires  open_library(Library::Jxl).
inline std::vector<std::uint8_t> jxl_of(const JxlForTest& t) {
  const SharedLibrary library(Library::Jxl, "test");
  decltype(&JxlEncoderCreate) make = library.find("JxlEncoderCreate");
  decltype(&JxlEncoderDestroy) destroy = library.find("JxlEncoderDestroy");
  decltype(&JxlEncoderUseContainer) use_container = library.find("JxlEncoderUseContainer");
  decltype(&JxlEncoderInitBasicInfo) init_info = library.find("JxlEncoderInitBasicInfo");
  decltype(&JxlEncoderSetBasicInfo) set_info = library.find("JxlEncoderSetBasicInfo");
  decltype(&JxlEncoderSetColorEncoding) set_color = library.find("JxlEncoderSetColorEncoding");
  decltype(&JxlEncoderFrameSettingsCreate) make_settings = library.find("JxlEncoderFrameSettingsCreate");
  decltype(&JxlEncoderSetFrameLossless) set_lossless = library.find("JxlEncoderSetFrameLossless");
  decltype(&JxlEncoderInitFrameHeader) init_frame = library.find("JxlEncoderInitFrameHeader");
  decltype(&JxlEncoderSetFrameHeader) set_frame = library.find("JxlEncoderSetFrameHeader");
  decltype(&JxlEncoderAddImageFrame) add = library.find("JxlEncoderAddImageFrame");
  decltype(&JxlEncoderCloseInput) close = library.find("JxlEncoderCloseInput");
  decltype(&JxlEncoderProcessOutput) process = library.find("JxlEncoderProcessOutput");
  const std::unique_ptr<JxlEncoder, void (*)(JxlEncoder*)> encoder(make(nullptr), destroy);
  use_container(encoder.get(), t.has_container ? JXL_TRUE : JXL_FALSE);
  JxlBasicInfo info;
  init_info(&info);
  info.xsize = t.width, info.ysize = t.height, info.bits_per_sample = 8, info.num_color_channels = t.channels;
  info.uses_original_profile = t.is_lossless ? JXL_TRUE : JXL_FALSE;
  info.orientation = t.orientation;
  if (t.displayed_width > 0) info.intrinsic_xsize = t.displayed_width, info.intrinsic_ysize = t.displayed_height;
  if (t.frames > 1) {
    info.have_animation = JXL_TRUE;
    info.animation.tps_numerator = 10, info.animation.tps_denominator = 1;
  }
  EXPECT_EQ(set_info(encoder.get(), &info), JXL_ENC_SUCCESS);
  JxlColorEncoding color{};
  color.color_space = t.channels == 1 ? JXL_COLOR_SPACE_GRAY : JXL_COLOR_SPACE_RGB;
  color.white_point = JXL_WHITE_POINT_D65, color.primaries = t.primaries, color.transfer_function = t.curve;
  color.rendering_intent = JXL_RENDERING_INTENT_RELATIVE;
  EXPECT_EQ(set_color(encoder.get(), &color), JXL_ENC_SUCCESS);
  JxlEncoderFrameSettings* const settings = make_settings(encoder.get(), nullptr);
  EXPECT_EQ(set_lossless(settings, t.is_lossless ? JXL_TRUE : JXL_FALSE), JXL_ENC_SUCCESS);
  const std::vector<std::uint8_t> codes(std::size_t{t.width} * t.height * t.channels, 200);
  const JxlPixelFormat format{t.channels, JXL_TYPE_UINT8, JXL_NATIVE_ENDIAN, 0};
  for (int i = 0; i < t.frames; ++i) {
    JxlFrameHeader header;
    init_frame(&header);
    header.duration = t.frames > 1 ? 1 : 0;
    EXPECT_EQ(set_frame(settings, &header), JXL_ENC_SUCCESS);
    EXPECT_EQ(add(settings, &format, codes.data(), codes.size()), JXL_ENC_SUCCESS);
  }
  close(encoder.get());
  std::vector<std::uint8_t> file(1 << 16);
  std::uint8_t* next = file.data();
  std::size_t left = file.size();
  EXPECT_EQ(process(encoder.get(), &next, &left), JXL_ENC_SUCCESS);
  file.resize(file.size() - left);
  return file;
}

}  // namespace zoneplate
