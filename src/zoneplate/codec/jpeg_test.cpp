// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/jpeg.h"

#include <gtest/gtest.h>

#include <cstdio>

#include <jpeglib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/math/random.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Kind {
  J_COLOR_SPACE given = JCS_RGB;
  J_COLOR_SPACE stored = JCS_YCbCr;
  int channels = 3;
  bool is_progressive = false;
  bool is_subsampled = false;
};

/// A smooth image: a good JPEG encoder changes each of its codes by only a few units.
int smooth(int x, int y, int channel) {
  const double phase = 0.11 * x + 0.07 * y * (channel + 1) + channel;
  return static_cast<int>(std::lround(128 + 100 * std::sin(phase)));
}

/// Compresses a JPEG: `set_up(jpeg)` changes the default parameters, `fill(y, row)` fills each row.
template <class SetUp, class Fill>
Bytes compressed(int width, int height, int channels, J_COLOR_SPACE space, SetUp set_up, Fill fill) {
  jpeg_error_mgr errors;
  jpeg_compress_struct jpeg;
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &data, &size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = channels;
  jpeg.in_color_space = space;
  jpeg_set_defaults(&jpeg);
  set_up(jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  Bytes row(static_cast<std::size_t>(width * channels));
  for (int y = 0; y < height; ++y) {
    fill(y, row);
    JSAMPROW pointer = row.data();
    jpeg_write_scanlines(&jpeg, &pointer, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const Bytes bytes(data, data + size);
  std::free(data);
  return bytes;
}

Bytes jpeg_of(int width, int height, const Kind& kind) {
  const auto set_up = [&](jpeg_compress_struct& jpeg) {
    jpeg_set_colorspace(&jpeg, kind.stored);
    jpeg_set_quality(&jpeg, 100, TRUE);
    for (int c = 0; c < kind.channels; ++c) jpeg.comp_info[c].h_samp_factor = jpeg.comp_info[c].v_samp_factor = 1;
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = kind.is_subsampled ? 2 : 1;
    if (kind.is_progressive) jpeg_simple_progression(&jpeg);
  };
  return compressed(width, height, kind.channels, kind.given, set_up, [&](int y, Bytes& row) {
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < kind.channels; ++c)
        row[static_cast<std::size_t>(x * kind.channels + c)] = static_cast<std::uint8_t>(smooth(x, y, c));
  });
}

/// The greatest difference between a code and `expected`, the smooth image after its channels were mixed.
template <class Wanted>
int worst_difference(const Rgba8Image& image, Wanted expected) {
  int worst = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const Rgba8 found = image(x, y);
      worst = std::max({worst, std::abs(found.r - expected(x, y, 0)), std::abs(found.g - expected(x, y, 1)),
                        std::abs(found.b - expected(x, y, 2)), 255 - found.a});
    }
  }
  return worst;
}

TEST(Jpeg, DecodesColorAndGrey) {
  for (const bool is_progressive : {false, true}) {
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{17, 9}, std::pair{64, 50}}) {
      const Bytes color = jpeg_of(width, height, {.is_progressive = is_progressive});
      // Errors: luma, chroma and each coefficient are rounded, and chroma is multiplied by up to 1.8.
      EXPECT_LE(worst_difference(decode_jpeg(color, "a").pixels, smooth), 4);
      const Bytes grey = jpeg_of(width, height, {JCS_GRAYSCALE, JCS_GRAYSCALE, 1, is_progressive});
      const auto expected = [](int x, int y, int) { return smooth(x, y, 0); };
      EXPECT_LE(worst_difference(decode_jpeg(grey, "a").pixels, expected), 2);
      // Subsampled chroma blurs the image; the tolerance still rejects a different image.
      const Bytes half = jpeg_of(width, height, {.is_progressive = is_progressive, .is_subsampled = true});
      EXPECT_LE(worst_difference(decode_jpeg(half, "a").pixels, smooth), 20);
    }
  }
}

TEST(Jpeg, MixesInks) {
  // libjpeg writes Adobe's marker here: the codes are transmittance, not ink.
  const auto expected = [](int x, int y, int c) { return (smooth(x, y, c) * smooth(x, y, 3) + 127) / 255; };
  for (const J_COLOR_SPACE stored : {JCS_CMYK, JCS_YCCK}) {
    EXPECT_LE(worst_difference(decode_jpeg(jpeg_of(40, 30, {JCS_CMYK, stored, 4}), "a").pixels, expected), 5);
  }
}

std::string error_of(const Bytes& bytes, std::uint64_t max_pixels = std::uint64_t{1} << 28) {
  try {
    decode_jpeg(bytes, "a.jpg", max_pixels);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "";
}

TEST(Jpeg, SaysWhatIsWrong) {
  EXPECT_EQ(error_of({}), "a.jpg: not a JPEG file");
  EXPECT_EQ(error_of({0x89, 'P', 'N', 'G'}), "a.jpg: not a JPEG file");
  const Bytes good = jpeg_of(20, 10, {});
  EXPECT_EQ(error_of(good, 200), "");
  EXPECT_EQ(error_of(good, 199), "a.jpg: JPEG: 20 x 10 pixels, at most 199 are allowed");
}

Bytes first_of(const Bytes& bytes, std::size_t count) {
  return {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count)};
}

TEST(Jpeg, KeepsWhatIsLeftOfATruncatedFile) {
  for (const bool is_progressive : {false, true}) {
    const Bytes good = jpeg_of(20, 40, {.is_progressive = is_progressive});
    const Rgba8Image whole = decode_jpeg(good, "a.jpg").pixels;
    int pictures = 0;
    for (std::size_t size = 0; size < good.size(); ++size) {
      const Bytes cut = first_of(good, size);
      if (!error_of(cut).empty()) continue;
      ++pictures;
      EXPECT_TRUE(decode_jpeg(cut, "a.jpg").flaw.starts_with("a.jpg: JPEG: ")) << size;
    }
    EXPECT_GT(pictures, 100);
    // The mark of the end holds no pixels.
    const JpegImage endless = decode_jpeg(first_of(good, good.size() - 2), "a.jpg");
    EXPECT_EQ(endless.pixels, whole);
    EXPECT_EQ(endless.flaw, "a.jpg: JPEG: Premature end of JPEG file");
    const JpegImage short_one = decode_jpeg(first_of(good, good.size() - 20), "a.jpg");
    EXPECT_EQ(short_one.pixels(0, 0), whole(0, 0));
    EXPECT_NE(short_one.pixels, whole);
  }
}

TEST(Jpeg, RefusesAFileWithoutDataOfItsPixels) {
  const Bytes good = jpeg_of(20, 10, {});
  const Bytes mark = {0xff, 0xda};
  const auto scan =
      static_cast<std::size_t>(std::search(good.begin(), good.end(), mark.begin(), mark.end()) - good.begin());
  const std::size_t header = scan + 2 + good[scan + 3];
  Bytes empty = first_of(good, header);
  EXPECT_EQ(error_of(empty), "a.jpg: JPEG: has no data of its pixels");
  empty.insert(empty.end(), {0xff, 0xd9});
  EXPECT_EQ(error_of(empty), "a.jpg: JPEG: has no data of its pixels");
  EXPECT_EQ(error_of(first_of(good, header + 1)), "");
}

TEST(Jpeg, DecodesPastExtraneousBytes) {
  const Bytes good = jpeg_of(20, 10, {});
  Bytes padded = good;
  padded.insert(padded.end() - 2, 40, std::uint8_t{1});
  const JpegImage image = decode_jpeg(padded, "a.jpg");
  EXPECT_EQ(image.pixels, decode_jpeg(good, "a.jpg").pixels);
  EXPECT_EQ(image.flaw, "");
  EXPECT_EQ(decode_jpeg(good, "a.jpg").flaw, "");
  padded.resize(padded.size() - 2);
  EXPECT_EQ(decode_jpeg(padded, "a.jpg").flaw, "a.jpg: JPEG: Premature end of JPEG file");
}

TEST(Jpeg, DamageGivesAPictureOrAnError) {
  const Kind kinds[] = {{}, {.is_progressive = true, .is_subsampled = true}, {JCS_CMYK, JCS_YCCK, 4}};
  std::uint32_t variant = 0;
  int pictures = 0;
  for (const Kind& kind : kinds) {
    const Bytes good = jpeg_of(23, 17, kind);
    for (int i = 0; i < 1500; ++i) {
      Bytes bad = good;
      const std::uint32_t changes = 1 + hash(++variant) % 4;
      for (std::uint32_t c = 0; c < changes; ++c) {
        bad[3 + hash(variant, c, 1) % (bad.size() - 3)] = static_cast<std::uint8_t>(hash(variant, c, 2));
      }
      if (i % 3 == 0) bad.resize(3 + hash(variant, 3) % (bad.size() - 3));
      pictures += error_of(bad, 1 << 20).empty() ? 1 : 0;
    }
  }
  EXPECT_GT(pictures, 0);
}

class SharedJpeg : public testing::TestWithParam<std::string> {};
TEST_P(SharedJpeg, IsDecodedUnlessItIsInvalid) {
  const FileBytes file(GetParam());
  const std::string error = error_of(Bytes(file.bytes().begin(), file.bytes().end()));
  EXPECT_EQ(error.empty(), GetParam().find("/invalid/") == std::string::npos) << error;
  if (error.empty()) {
    EXPECT_EQ(decode_jpeg(file.bytes(), "a.jpg").flaw, "");
  }
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedJpeg);
INSTANTIATE_TEST_SUITE_P(Images, SharedJpeg, testing::ValuesIn(shared_files_ending("data/models", {".jpg"})));
INSTANTIATE_TEST_SUITE_P(Invalid, SharedJpeg, testing::ValuesIn(shared_files_ending("data/invalid", {".jpg"})));

/// A grey image with one scan per coefficient and bit: 1 + 63 * 3 scans.
Bytes in_many_scans(int size) {
  std::vector<jpeg_scan_info> scans = {{1, {0}, 0, 0, 0, 0}};
  for (int bit = 2; bit >= 0; --bit)
    for (int k = 1; k < 64; ++k) scans.push_back({1, {0}, k, k, bit == 2 ? 0 : bit + 1, bit});
  const auto set_up = [&](jpeg_compress_struct& jpeg) {
    jpeg.scan_info = scans.data();
    jpeg.num_scans = static_cast<int>(scans.size());
  };
  return compressed(size, size, 1, JCS_GRAYSCALE, set_up,
                    [](int, Bytes& row) { std::fill(row.begin(), row.end(), std::uint8_t{77}); });
}

TEST(Jpeg, TakesFewerScansOfALargerPicture) {
  EXPECT_EQ(decode_jpeg(in_many_scans(64), "small").pixels(9, 9).r, 77);
  // 2^31 / 3600^2 = 165.
  try {
    decode_jpeg(in_many_scans(3600), "large");
    ADD_FAILURE() << "decoded";
  } catch (const Error& error) {
    EXPECT_EQ(std::string(error.what()), "large: JPEG: more than 165 scans of 3600 x 3600 pixels");
  }
}

}  // namespace
}  // namespace zoneplate
