// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/several_images.h"

#include <avif/avif.h>
#include <gtest/gtest.h>
#include <jxl/encode.h>

#include <vector>

#include "zoneplate/codec/png.h"
#include "zoneplate/codec/system/tiff_file_for_test.h"
#include "zoneplate/image/pixel.h"
#include "zoneplate/os/library.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(SeveralImages, PagesOfTiffAreCountedWithoutReducedCopies) {
  const auto file = [](const char* mode, std::vector<bool> are_copies) {
    return tiff_of(
        {.width = 2, .height = 1, .mode = mode, .are_copies = std::move(are_copies), .data = {1, 2, 3, 4, 5, 6}});
  };
  for (const char* const mode : {"w", "wb", "w8"}) {
    EXPECT_EQ(several_images(file(mode, {false})), "") << mode;
    EXPECT_EQ(several_images(file(mode, {false, true})), "") << mode;
    EXPECT_EQ(several_images(file(mode, {false, false, true, false})), "has 3 pages") << mode;
    Bytes cut = file(mode, {false, false, false});
    for (; !cut.empty(); cut.pop_back()) several_images(cut);
  }
}

TEST(SeveralImages, ADirectoryThatIsItsOwnNextIsOnePage) {
  const Bytes file = {'I', 'I', 42, 0, 8, 0, 0, 0, 0, 0, 8, 0, 0, 0};
  EXPECT_EQ(several_images(file), "");
}

TEST(SeveralImages, FramesOfAvifAreCounted) {
  if (!open_library(Library::Avif)) GTEST_SKIP() << "libavif is not installed";
  const SharedLibrary library(Library::Avif, "test");
  decltype(&avifImageCreate) make_image = library.find("avifImageCreate");
  decltype(&avifImageDestroy) free_image = library.find("avifImageDestroy");
  decltype(&avifImageAllocatePlanes) allocate = library.find("avifImageAllocatePlanes");
  decltype(&avifEncoderCreate) make_encoder = library.find("avifEncoderCreate");
  decltype(&avifEncoderDestroy) free_encoder = library.find("avifEncoderDestroy");
  decltype(&avifEncoderAddImage) add = library.find("avifEncoderAddImage");
  decltype(&avifEncoderFinish) finish = library.find("avifEncoderFinish");
  decltype(&avifRWDataFree) free_data = library.find("avifRWDataFree");
  for (const int frames : {1, 3}) {
    avifEncoder* const encoder = make_encoder();
    encoder->speed = AVIF_SPEED_FASTEST;
    for (int i = 0; i < frames; ++i) {
      avifImage* const image = make_image(16, 16, 8, AVIF_PIXEL_FORMAT_YUV444);
      allocate(image, AVIF_PLANES_YUV);
      for (const int plane : {AVIF_CHAN_Y, AVIF_CHAN_U, AVIF_CHAN_V})
        std::fill_n(image->yuvPlanes[plane], 16 * image->yuvRowBytes[plane], static_cast<std::uint8_t>(50 * i));
      EXPECT_EQ(add(encoder, image, 1, frames == 1 ? AVIF_ADD_IMAGE_FLAG_SINGLE : AVIF_ADD_IMAGE_FLAG_NONE),
                AVIF_RESULT_OK);
      free_image(image);
    }
    avifRWData data = AVIF_DATA_EMPTY;
    EXPECT_EQ(finish(encoder, &data), AVIF_RESULT_OK);
    const Bytes file(data.data, data.data + data.size);
    free_data(&data), free_encoder(encoder);
    EXPECT_EQ(several_images(file), frames == 1 ? "" : "is an animation of 3 frames");
  }
}

TEST(SeveralImages, AnAnimationOfJpegXlSaysSo) {
  if (!open_library(Library::Jxl)) GTEST_SKIP() << "libjxl is not installed";
  const SharedLibrary library(Library::Jxl, "test");
  decltype(&JxlEncoderCreate) make = library.find("JxlEncoderCreate");
  decltype(&JxlEncoderDestroy) destroy = library.find("JxlEncoderDestroy");
  decltype(&JxlEncoderUseContainer) use_container = library.find("JxlEncoderUseContainer");
  decltype(&JxlEncoderInitBasicInfo) init_info = library.find("JxlEncoderInitBasicInfo");
  decltype(&JxlEncoderSetBasicInfo) set_info = library.find("JxlEncoderSetBasicInfo");
  decltype(&JxlEncoderSetColorEncoding) set_color = library.find("JxlEncoderSetColorEncoding");
  decltype(&JxlColorEncodingSetToSRGB) set_srgb = library.find("JxlColorEncodingSetToSRGB");
  decltype(&JxlEncoderFrameSettingsCreate) make_settings = library.find("JxlEncoderFrameSettingsCreate");
  decltype(&JxlEncoderInitFrameHeader) init_frame = library.find("JxlEncoderInitFrameHeader");
  decltype(&JxlEncoderSetFrameHeader) set_frame = library.find("JxlEncoderSetFrameHeader");
  decltype(&JxlEncoderAddImageFrame) add = library.find("JxlEncoderAddImageFrame");
  decltype(&JxlEncoderCloseInput) close = library.find("JxlEncoderCloseInput");
  decltype(&JxlEncoderProcessOutput) process = library.find("JxlEncoderProcessOutput");
  for (const bool is_animation : {false, true})
    for (const bool has_more : {false, true}) {  // an orientation, a size to be displayed as, a container
      JxlEncoder* const encoder = make(nullptr);
      use_container(encoder, has_more ? JXL_TRUE : JXL_FALSE);
      JxlBasicInfo info;
      init_info(&info);
      info.xsize = 24, info.ysize = 10, info.bits_per_sample = 8, info.uses_original_profile = JXL_FALSE;
      if (has_more) info.orientation = JXL_ORIENT_ROTATE_180, info.intrinsic_xsize = 100, info.intrinsic_ysize = 77;
      if (is_animation) {
        info.have_animation = JXL_TRUE;
        info.animation.tps_numerator = 10, info.animation.tps_denominator = 1;
      }
      EXPECT_EQ(set_info(encoder, &info), JXL_ENC_SUCCESS);
      JxlColorEncoding color{};
      set_srgb(&color, JXL_FALSE);
      EXPECT_EQ(set_color(encoder, &color), JXL_ENC_SUCCESS);
      JxlEncoderFrameSettings* const settings = make_settings(encoder, nullptr);
      const Bytes codes(std::size_t{24} * 10 * 3, 99);
      const JxlPixelFormat format{3, JXL_TYPE_UINT8, JXL_NATIVE_ENDIAN, 0};
      for (int i = 0; i < (is_animation ? 2 : 1); ++i) {
        JxlFrameHeader header;
        init_frame(&header);
        header.duration = is_animation ? 1 : 0;
        EXPECT_EQ(set_frame(settings, &header), JXL_ENC_SUCCESS);
        EXPECT_EQ(add(settings, &format, codes.data(), codes.size()), JXL_ENC_SUCCESS);
      }
      close(encoder);
      Bytes file(1 << 16);
      std::uint8_t* next = file.data();
      std::size_t left = file.size();
      EXPECT_EQ(process(encoder, &next, &left), JXL_ENC_SUCCESS);
      file.resize(file.size() - left);
      destroy(encoder);
      EXPECT_EQ(several_images(file), is_animation ? "is an animation of several frames" : "") << has_more;
    }
}

TEST(SeveralImages, OneImageIsNotSeveral) {
  EXPECT_EQ(several_images({}), "");
  EXPECT_EQ(several_images(encode_png(Rgba8Image(2, 2))), "");
}

}  // namespace
}  // namespace zoneplate
