// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/hdr.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes file_of(const std::string& scan, const Bytes& pixels, const std::string& lines = "FORMAT=32-bit_rle_rgbe\n") {
  const std::string head = "#?RADIANCE\n" + lines + "\n" + scan + "\n";
  Bytes out(head.begin(), head.end());
  out.insert(out.end(), pixels.begin(), pixels.end());
  return out;
}

std::string error_of(const Bytes& bytes, std::uint64_t most = 1000) {
  try {
    decode_hdr(bytes, "a.hdr", most);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "no error";
}

TEST(Hdr, MantissasAndExponent) {
  const LinearImage image = decode_hdr(file_of("-Y 2 +X 2", {128, 64, 255, 129, 7, 7, 7, 0,  //
                                                             255, 0, 1, 255, 1, 2, 3, 1}),
                                       "a.hdr");
  EXPECT_EQ(image(0, 0), (Linear{1, 0.5f, 255.0f / 128, 1}));
  EXPECT_EQ(image(1, 0), (Linear{0, 0, 0, 1}));
  EXPECT_EQ(image(0, 1), (Linear{255 * 0x1p119f, 0, 0x1p119f, 1}));
  EXPECT_EQ(image(1, 1), (Linear{0x1p-135f, 0x2p-135f, 0x3p-135f, 1}));
}

TEST(Hdr, AllEightOrders) {
  // Six pixels; the red channel is the index of the pixel in the file.
  Bytes pixels;
  for (std::uint8_t i = 0; i < 6; ++i) pixels.insert(pixels.end(), {static_cast<std::uint8_t>(10 + i), 0, 0, 136});
  const auto red = [&](const std::string& scan, int x, int y) {
    const LinearImage image = decode_hdr(file_of(scan, pixels), "a.hdr");
    EXPECT_EQ(find_hdr_size(file_of(scan, pixels)), (int2{3, 2}));
    return image(x, y).r;
  };
  EXPECT_EQ(red("-Y 2 +X 3", 2, 0), 12);
  EXPECT_EQ(red("-Y 2 -X 3", 2, 0), 10);
  EXPECT_EQ(red("+Y 2 +X 3", 2, 0), 15);
  EXPECT_EQ(red("+Y 2 -X 3", 2, 0), 13);
  EXPECT_EQ(red("+X 3 -Y 2", 2, 0), 14);
  EXPECT_EQ(red("+X 3 +Y 2", 2, 0), 15);
  EXPECT_EQ(red("-X 3 -Y 2", 2, 0), 10);
  EXPECT_EQ(red("-X 3 +Y 2", 2, 0), 11);
}

TEST(Hdr, NewRuns) {
  // Red is a run of 10, green consists of 4 + 6 literals, blue and exponent are runs.
  const Bytes line = {2, 2, 0, 10, 138, 50, 4, 1, 2, 3, 4, 6, 5, 6, 7, 8, 9, 10, 138, 9, 138, 136};
  Bytes two = line;
  two.insert(two.end(), line.begin(), line.end());
  const LinearImage image = decode_hdr(file_of("-Y 2 +X 10", two), "a.hdr");
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 10; ++x) EXPECT_EQ(image(x, y), (Linear{50, static_cast<float>(x + 1), 9, 1}));
  EXPECT_EQ(error_of(file_of("-Y 1 +X 9", line)), "a.hdr: HDR: scanline 0 is corrupt or cut off");  // it has 10 pixels
  for (std::size_t n = 0; n < line.size(); ++n)
    EXPECT_NE(error_of(file_of("-Y 1 +X 10", Bytes(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(n)))),
              "no error")
        << n;
  Bytes beyond = line;
  beyond[4] = 139;
  EXPECT_NE(error_of(file_of("-Y 1 +X 10", beyond)), "no error");
}

TEST(Hdr, OldRuns) {
  // One pixel, 2 repetitions of it, another pixel, and 256 + 3 repetitions of that: a run directly after a run counts
  // 256 times as much.
  const Bytes pixels = {5, 0, 0, 136, 1, 1, 1, 2, 6, 0, 0, 136, 1, 1, 1, 3, 1, 1, 1, 1};
  const LinearImage image = decode_hdr(file_of("-Y 1 +X 263", pixels), "a.hdr");
  for (int x = 0; x < 263; ++x) EXPECT_EQ(image(x, 0).r, x < 3 ? 5 : 6);
  EXPECT_NE(error_of(file_of("-Y 1 +X 262", pixels)), "no error");
  EXPECT_NE(error_of(file_of("-Y 1 +X 264", pixels)), "no error");
}

TEST(Hdr, RefusalsNameTheCause) {
  const Bytes pixels(4 * 6, 100);
  EXPECT_EQ(error_of(file_of("-Y 2 +X 3", pixels)), "no error");
  EXPECT_EQ(error_of(file_of("-Y 2 +X 3", pixels), 5), "a.hdr: HDR: 3 x 2 pixels, at most 5 are allowed");
  EXPECT_EQ(error_of(file_of("-Y 2 +X 3", pixels, "FORMAT=32-bit_rle_xyze\n")), "a.hdr: HDR: its pixels are not RGBE");
  for (const char* scan : {"-Y 2 +Y 3", "-Y 0 +X 3", "-Y2 +X 3", "Y 2 X 3", "-Y 2", "-Y 2 +X 3 4", ""})
    EXPECT_EQ(error_of(file_of(scan, pixels)), "a.hdr: HDR: the header is wrong") << scan;
  EXPECT_EQ(error_of(file_of("-Y 99999999 +X 1", pixels), 1u << 30), "a.hdr: HDR: the file ends early");
  EXPECT_EQ(error_of({'#', '?'}), "a.hdr: HDR: the header is wrong");
}

TEST(Hdr, ASmallFileThatClaimsMuchIsLookedThroughFirst) {
  // Each line is one pixel and its repetitions; the repetitions of the last line are missing. The whole image would
  // take a gigabyte.
  constexpr int side = 8192;
  Bytes pixels = {5, 0, 0, 136};
  for (int line = 0; line + 1 < side; ++line) pixels.insert(pixels.end(), {1, 1, 1, 255, 1, 1, 1, 31, 5, 0, 0, 136});
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  EXPECT_EQ(error_of(file_of("-Y 8192 +X 8192", pixels), side * side),
            "a.hdr: HDR: scanline 8191 is corrupt or cut off");
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 100 << 10);
}

TEST(Hdr, RgbaIsTheSameLight) {
  const Bytes file = file_of("-Y 1 +X 3", {128, 8, 0, 150, 100, 50, 25, 128, 0, 0, 0, 0});
  const Plane<float4> rgba = decode_hdr_rgba(file, "a.hdr", 3);
  EXPECT_EQ(rgba(0, 0), (float4{0x1p21f, 0x1p17f, 0, 1}));
  EXPECT_EQ(rgba(1, 0), (float4{100 / 256.0f, 50 / 256.0f, 25 / 256.0f, 1}));
  EXPECT_EQ(rgba(2, 0), (float4{0, 0, 0, 1}));
}

TEST(Hdr, DamageNeverReachesBeyondTheBytes) {
  const Bytes line = {2, 2, 0, 10, 138, 50, 4, 1, 2, 3, 4, 6, 5, 6, 7, 8, 9, 10, 138, 9, 138, 136};
  const Bytes good = file_of("-Y 1 +X 10", line);
  for (std::uint32_t i = 0; i < 2000; ++i) {
    Bytes bad = good;
    bad[hash(i) % bad.size()] = static_cast<std::uint8_t>(hash(i, 1));
    if (i % 2) bad.resize(hash(i, 2) % (bad.size() + 1));
    EXPECT_EQ(error_of(bad).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace zoneplate
