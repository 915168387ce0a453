// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/inspect/several_images.h"

#include <avif/avif.h>
#include <gtest/gtest.h>

#include <vector>

#include "zoneplate/codec/png.h"
#include "zoneplate/codec/system/jxl_file_for_test.h"
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
  for (const int frames : {1, 2}) {
    const std::string expected = frames > 1 ? "is an animation of several frames" : "";
    EXPECT_EQ(several_images(jxl_of({.width = 24, .height = 10, .frames = frames})), expected);
    EXPECT_EQ(several_images(jxl_of({.width = 24,
                                     .height = 10,
                                     .is_lossless = false,
                                     .frames = frames,
                                     .has_container = true,
                                     .orientation = JXL_ORIENT_ROTATE_180,
                                     .displayed_width = 100,
                                     .displayed_height = 77})),
              expected);
  }
}

TEST(SeveralImages, OneImageIsNotSeveral) {
  EXPECT_EQ(several_images({}), "");
  EXPECT_EQ(several_images(encode_png(Rgba8Image(2, 2))), "");
}

}  // namespace
}  // namespace zoneplate
