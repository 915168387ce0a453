// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/pfm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/base/error.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes file_of(const std::string& head, const Bytes& pixels) {
  Bytes out(head.begin(), head.end());
  out.insert(out.end(), pixels.begin(), pixels.end());
  return out;
}

std::string error_of(const Bytes& bytes, std::uint64_t most = 1000) {
  try {
    decode_pfm(bytes, "a.pfm", most);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "no error";
}

TEST(Pfm, RowsRunFromTheBottomUp) {
  LinearImage image(1, 2);
  image(0, 0) = {1, 2, 3, 1};
  image(0, 1) = {0.5f, 0, 0, 1};
  const std::vector<std::uint8_t> bytes = encode_pfm(image);
  const std::string head = "PF\n1 2\n-1.0\n";
  ASSERT_EQ(bytes.size(), head.size() + 24);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + 12), head);
  EXPECT_EQ(bytes[head.size() + 3], 0x3f);   // the last byte of 0.5f
  EXPECT_EQ(bytes[head.size() + 23], 0x40);  // the last byte of 3.0f
}

TEST(Pfm, WhatIsWrittenIsReadAgain) {
  LinearImage image(3, 2);
  for (std::uint32_t i = 0; i < 6; ++i)
    image.values()[i] = {unit_float(hash(i)) * 1e6f, -unit_float(hash(i, 1)), 1e-40f * static_cast<float>(i), 1};
  EXPECT_EQ(decode_pfm(encode_pfm(image), "a.pfm"), image);

  Plane<float> grey(2, 2);
  grey(0, 0) = 3, grey(1, 1) = -0.5f, grey(1, 0) = std::numeric_limits<float>::infinity();
  const LinearImage read = decode_pfm(encode_pfm(grey), "a.pfm");
  EXPECT_EQ(read(0, 0), (Linear{3, 3, 3, 1}));
  EXPECT_EQ(read(1, 1), (Linear{-0.5f, -0.5f, -0.5f, 1}));
  EXPECT_EQ(read(1, 0).g, grey(1, 0));
}

TEST(Pfm, EitherByteOrderAndAnyWhiteSpace) {
  const Bytes one_and_two_big = {0x3f, 0x80, 0, 0, 0x40, 0, 0, 0},
              one_and_two_little = {0, 0, 0x80, 0x3f, 0, 0, 0, 0x40};
  for (const char* head : {"Pf\n1 2\n1.0\n", "Pf 1\t2\r\n0.5\n", "Pf\n1\n2\n2e3 "}) {
    const LinearImage image = decode_pfm(file_of(head, one_and_two_big), "a.pfm");
    EXPECT_EQ(image(0, 1).r, 1) << head;  // the bottom row is stored first
    EXPECT_EQ(image(0, 0).r, 2) << head;
  }
  EXPECT_EQ(decode_pfm(file_of("Pf\n2 1\n-1\n", one_and_two_little), "a.pfm")(1, 0).b, 2);
}

TEST(Pfm, RefusalsNameTheCause) {
  const Bytes pixels(2 * 3 * 12, 0);
  EXPECT_EQ(error_of(file_of("PF\n2 3\n-1.0\n", pixels)), "no error");
  EXPECT_EQ(error_of(file_of("PF\n2 3\n-1.0\n", pixels), 5), "a.pfm: PFM: 2 x 3 pixels, at most 5 are allowed");
  EXPECT_EQ(error_of(file_of("Pf\n2 3\n-1.0\n", pixels)), "a.pfm: PFM: 72 bytes of pixels, the header states 24");
  // The header ends with a single white-space character: the pixels would begin one byte early.
  EXPECT_EQ(error_of(file_of("PF\n2 3\n-1.0\r\n", pixels)), "a.pfm: PFM: 73 bytes of pixels, the header states 72");
  EXPECT_EQ(error_of(file_of("PF\n2 4\n-1.0\n", pixels)), "a.pfm: PFM: 72 bytes of pixels, the header states 96");
  for (const char* head : {"PF", "PF\n", "P6\n2 3\n-1.0\n", "PF\n2\n-1.0\n", "PF\n0 3\n-1.0\n", "PF\n-2 3\n-1.0\n",
                           "PF\n2 3\n0\n", "PF\n2 3\nnan\n", "PF\n2 3\ninf\n", "PF\n2 3\nx\n", "PF\n2 3\n-1.0x",
                           "PF\n99999999999 3\n-1.0\n", "PF4\n2 3\n-1.0\n", "PF\n2,3\n-1.0\n"})
    EXPECT_EQ(error_of(file_of(head, pixels)), "a.pfm: PFM: the header is wrong") << head;
}

TEST(Pfm, DamageNeverReachesBeyondTheBytes) {
  const Bytes good = file_of("PF\n2 3\n-1.0\n", Bytes(2 * 3 * 12, 7));
  for (std::uint32_t i = 0; i < 2000; ++i) {
    Bytes bad = good;
    bad[hash(i) % (i % 3 ? 12 : bad.size())] = static_cast<std::uint8_t>(hash(i, 1));
    if (i % 2) bad.resize(hash(i, 2) % (bad.size() + 1));
    EXPECT_EQ(error_of(bad).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace zoneplate
