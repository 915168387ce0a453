// SPDX-License-Identifier: Apache-2.0
#include <avif/avif.h>
#include <gtest/gtest.h>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/color/icc.h"
#include "zoneplate/codec/system/avif.h"
#include "zoneplate/codec/system/jxl.h"
#include "zoneplate/codec/system/jxl_file_for_test.h"
#include "zoneplate/codec/system/system_format.h"
#include "zoneplate/math/random.h"
#include "zoneplate/os/library.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

Rgba8Image noise(int width, int height, bool has_alpha) {
  Rgba8Image image(width, height);
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    const std::uint32_t word = hash(static_cast<std::uint32_t>(i));
    image.values()[i] = {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8),
                         static_cast<std::uint8_t>(word >> 16),
                         static_cast<std::uint8_t>(has_alpha ? word >> 24 : 255)};
  }
  return image;
}

/// A format and what writes it.
struct Codec {
  const char* name;
  Library library;
  Bytes (*encode)(const Rgba8Image&, bool);
};
class SystemFormats : public testing::TestWithParam<Codec> {
 protected:
  void SetUp() override {
    if (!open_library(GetParam().library)) GTEST_SKIP() << "the library is not installed";
  }
  static StoredImage decode(const Bytes& file, std::uint64_t max_pixels = 1 << 20) {
    const SystemFormat* const format = find_system_format(file);
    if (!format) throw Error(ErrorKind::Input, "no format");
    return format->decode(file, "a", max_pixels);
  }
  static std::string error_of(const Bytes& file, std::uint64_t max_pixels = 1 << 20) {
    try {
      decode(file, max_pixels);
      return "";
    } catch (const Error& error) {
      return error.what();
    }
  }
};

TEST_P(SystemFormats, FilesAreLossless) {
  for (const bool has_alpha : {false, true})
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(33, 17), std::pair(64, 48), std::pair(96, 128)}) {
      const Rgba8Image image = noise(width, height, has_alpha);
      const Bytes file = GetParam().encode(image, has_alpha);
      const StoredImage stored = decode(file);
      EXPECT_EQ(std::get<Rgba8Image>(stored.pixels), image) << width << " " << has_alpha;
      EXPECT_EQ(stored.orientation, 1);
      EXPECT_EQ(GetParam().encode(image, has_alpha), file);
      const std::optional<int2> size = find_system_format(file)->find_size(file);
      ASSERT_TRUE(size);
      EXPECT_EQ(size->x, width);
      EXPECT_EQ(size->y, height);
    }
}

TEST_P(SystemFormats, SizesAreCheckedFirst) {
  EXPECT_EQ(error_of(GetParam().encode(noise(33, 17, false), false), 560),
            std::string("a: ") + GetParam().name + ": 33 x 17 pixels, at most 560 are allowed");
}

TEST_P(SystemFormats, DamageIsAnError) {
  const Bytes file = GetParam().encode(noise(16, 12, true), true);
  for (std::size_t size = 0; size < file.size(); size += 1 + file.size() / 50)
    EXPECT_NE(error_of({file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)}), "") << size;
  for (std::uint32_t i = 0; i < 100; ++i) {
    Bytes changed = file;
    for (std::uint32_t k = 0; k < 2; ++k)
      changed[hash(i, k) % changed.size()] = static_cast<std::uint8_t>(hash(i, k + 10));
    EXPECT_EQ(error_of(changed).find('\n'), std::string::npos) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SystemFormats,
                         testing::Values(Codec{"AVIF", Library::Avif, encode_avif},
                                         Codec{"JPEG XL", Library::Jxl, encode_jxl}),
                         [](const auto& test) { return test.index == 0 ? "Avif" : "Jxl"; });

// Boxes that contain each other deeper than a stack reaches.
TEST(Avif, DeepBoxesAreNotFollowed) {
  Bytes file = {0, 0, 0, 16, 'f', 't', 'y', 'p', 'a', 'v', 'i', 'f', 0, 0, 0, 0};
  constexpr std::uint32_t size = 8 << 20;
  for (std::uint32_t left = size; left >= 8; left -= 8)
    for (const std::uint32_t byte : {left >> 24, left >> 16, left >> 8, left, std::uint32_t{'m'}, std::uint32_t{'o'},
                                     std::uint32_t{'o'}, std::uint32_t{'v'}})
      file.push_back(static_cast<std::uint8_t>(byte));
  EXPECT_FALSE(find_avif_size(file));
  EXPECT_TRUE(find_avif_colors(file).profile.empty());
}

TEST(Jxl, CodesOfOtherSpacesHaveAProfile) {
  if (!open_library(Library::Jxl)) GTEST_SKIP() << "libjxl is not installed";
  const auto decoded = [](std::uint32_t channels, JxlPrimaries primaries, JxlTransferFunction curve, bool is_lossless) {
    return decode_jxl(
        jxl_of({.channels = channels, .primaries = primaries, .curve = curve, .is_lossless = is_lossless}), "a", 100);
  };
  const StoredImage wide = decoded(3, JXL_PRIMARIES_P3, JXL_TRANSFER_FUNCTION_SRGB, true);
  EXPECT_EQ(icc_pixels(wide.profile), "RGB ");
  EXPECT_EQ(std::get<Rgba8Image>(wide.pixels)(3, 3), (Rgba8{200, 200, 200, 255}));
  EXPECT_EQ(icc_pixels(decoded(1, JXL_PRIMARIES_SRGB, JXL_TRANSFER_FUNCTION_LINEAR, true).profile), "GRAY");
  EXPECT_TRUE(decoded(3, JXL_PRIMARIES_SRGB, JXL_TRANSFER_FUNCTION_SRGB, true).profile.empty());
  EXPECT_TRUE(decoded(1, JXL_PRIMARIES_SRGB, JXL_TRANSFER_FUNCTION_SRGB, true).profile.empty());
  // What is lossy is stored in a space of its own, and comes out as sRGB.
  EXPECT_TRUE(decoded(3, JXL_PRIMARIES_P3, JXL_TRANSFER_FUNCTION_SRGB, false).profile.empty());
}

TEST(Avif, RotationsAreOrientationsAndTenBitsStay) {
  if (!open_library(Library::Avif)) GTEST_SKIP() << "libavif is not installed";
  const SharedLibrary library(Library::Avif, "test");
  decltype(&avifImageCreate) make_image = library.find("avifImageCreate");
  decltype(&avifImageDestroy) free_image = library.find("avifImageDestroy");
  decltype(&avifImageAllocatePlanes) allocate = library.find("avifImageAllocatePlanes");
  decltype(&avifEncoderCreate) make_encoder = library.find("avifEncoderCreate");
  decltype(&avifEncoderDestroy) free_encoder = library.find("avifEncoderDestroy");
  decltype(&avifEncoderWrite) write = library.find("avifEncoderWrite");
  decltype(&avifRWDataFree) free_data = library.find("avifRWDataFree");
  const auto orientation_of = [&](int angle, int mirror) {
    avifImage* const image = make_image(8, 4, 10, AVIF_PIXEL_FORMAT_YUV444);
    image->yuvRange = AVIF_RANGE_FULL, image->matrixCoefficients = AVIF_MATRIX_COEFFICIENTS_IDENTITY;
    image->colorPrimaries = AVIF_COLOR_PRIMARIES_BT2020;
    image->transferCharacteristics = AVIF_TRANSFER_CHARACTERISTICS_SMPTE2084;
    allocate(image, AVIF_PLANES_YUV);
    for (const int plane : {AVIF_CHAN_Y, AVIF_CHAN_U, AVIF_CHAN_V})
      for (std::uint32_t y = 0; y < 4; ++y)
        for (std::uint32_t x = 0; x < 8; ++x)
          reinterpret_cast<std::uint16_t*>(image->yuvPlanes[plane] + y * image->yuvRowBytes[plane])[x] =
              static_cast<std::uint16_t>(100 * (plane + 1));
    if (angle > 0) image->transformFlags |= AVIF_TRANSFORM_IROT, image->irot.angle = static_cast<std::uint8_t>(angle);
    if (mirror >= 0) image->transformFlags |= AVIF_TRANSFORM_IMIR, image->imir.mode = static_cast<std::uint8_t>(mirror);
    avifEncoder* const encoder = make_encoder();
    encoder->minQuantizer = encoder->maxQuantizer = AVIF_QUANTIZER_LOSSLESS;
    avifRWData data = AVIF_DATA_EMPTY;
    EXPECT_EQ(write(encoder, image, &data), AVIF_RESULT_OK);
    const Bytes file(data.data, data.data + data.size);
    free_data(&data), free_encoder(encoder), free_image(image);
    EXPECT_EQ(find_avif_colors(file).cicp, (std::array<std::uint8_t, 2>{9, 16}));
    const StoredImage stored = decode_avif(file, "a", 100);
    const auto& pixels = std::get<Rgba16Image>(stored.pixels);
    EXPECT_EQ(pixels.width(), 8);
    // Green, blue and red of 10 bits as 16.
    EXPECT_EQ(pixels(3, 2),
              (Rgba16{300 * 65535 / 1023, (100 * 65535 + 511) / 1023, (200 * 65535 + 511) / 1023, 65535}));
    return stored.orientation;
  };
  EXPECT_EQ(orientation_of(0, -1), 1);
  EXPECT_EQ(orientation_of(0, 1), 2);
  EXPECT_EQ(orientation_of(2, -1), 3);
  EXPECT_EQ(orientation_of(0, 0), 4);
  EXPECT_EQ(orientation_of(1, 0), 5);
  EXPECT_EQ(orientation_of(3, -1), 6);
  EXPECT_EQ(orientation_of(3, 0), 7);
  EXPECT_EQ(orientation_of(1, -1), 8);
}

}  // namespace
}  // namespace zoneplate
