// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/inspect/exr_parts_for_test.h"
#include "zoneplate/image/half.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Values of all magnitudes, so that both kinds of block occur: rows of noise are stored uncompressed.
LinearImage make_image(int width, int height) {
  LinearImage image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto noise = [&](std::uint32_t k) {
        return unit_float(hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), k));
      };
      image(x, y) = y < height / 2 ? Linear{0.25f, static_cast<float>(x), -0.5f, 1}
                                   : Linear{noise(0) * 1000, noise(1), noise(2) * 1e-3f, noise(3)};
    }
  return image;
}

std::vector<ExrChannel> channels_of(const LinearImage& image, ExrType type) {
  const Linear* first = image.values().data();
  return {{"R", type, &first->r, nullptr, 4},
          {"G", type, &first->g, nullptr, 4},
          {"B", type, &first->b, nullptr, 4},
          {"A", type, &first->a, nullptr, 4}};
}

Bytes exr_of(const LinearImage& image, ExrType type) {
  return encode_exr(image.width(), image.height(), channels_of(image, type), {{"comments", "none"}});
}

std::string error_of(const Bytes& bytes, std::uint64_t most = 10'000) {
  try {
    decode_exr(bytes, "a.exr", most);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "no error";
}

TEST(Exr, ChannelsOfAnyNameAreReadAsTheyAre) {
  const float values[] = {0.5f, std::numeric_limits<float>::infinity(), -3, 1e30f, 2, 65519};
  const std::uint32_t numbers[] = {7, 0, 1, 2, 3, 1 << 20};
  const Bytes file =
      encode_exr(3, 2, {{"Z", ExrType::Float, values, nullptr, 1}, {"objectId", ExrType::Number, nullptr, numbers, 1}});
  EXPECT_EQ(exr_channel_names(file), (std::vector<std::string>{"Z", "objectId"}));
  const std::string names[] = {"objectId", "Z"};
  const std::vector<Plane<float>> planes = decode_exr_channels(file, "a.exr", names);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(planes[0].values()[i], static_cast<float>(numbers[i]));
    EXPECT_EQ(planes[1].values()[i], values[i]);
  }
  const LinearImage image = make_image(8, 4);
  const std::string some[] = {"G", "B"};  // two of four half floats, for which the library has a fast path
  const Plane<float> green = decode_exr_channels(exr_of(image, ExrType::Half), "a.exr", some)[0];
  EXPECT_EQ(green(3, 1), image(3, 1).g);
  const std::string missing[] = {"Y"};
  EXPECT_THROW(decode_exr_channels(file, "a.exr", missing), Error);
}

TEST(Exr, TheLibraryReadsFloatsAsTheyWereWritten) {
  for (const int height : {1, 16, 17, 40}) {
    const LinearImage image = make_image(33, height);
    const Bytes bytes = exr_of(image, ExrType::Float);
    EXPECT_EQ(find_exr_size(bytes), (int2{33, height}));
    EXPECT_EQ(decode_exr(bytes, "a.exr"), image) << height;
  }
}

TEST(Exr, EveryCompressionHoldsTheSameImage) {
  const LinearImage image = make_image(33, 40);
  for (const ExrCompression compression : {ExrCompression::None, ExrCompression::Zips, ExrCompression::Zip}) {
    const Bytes bytes = encode_exr(33, 40, channels_of(image, ExrType::Float), {}, compression);
    EXPECT_EQ(decode_exr(bytes, "a.exr"), image) << static_cast<int>(compression);
  }
}

TEST(Exr, HalvesAreTheNearest) {
  const LinearImage image = make_image(20, 30);
  const LinearImage out = decode_exr(exr_of(image, ExrType::Half), "a.exr");
  const auto near = [](float v) { return half_value(half_bits(v)); };
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 20; ++x) {
      const Linear c = image(x, y);
      EXPECT_EQ(out(x, y), (Linear{near(c.r), near(c.g), near(c.b), near(c.a)}));
    }
}

TEST(Exr, NumbersKeepTheirBits) {
  // The library converts integers to floats; these integers are exact in both types.
  Plane<std::uint32_t> ids(5, 18);
  for (std::uint32_t i = 0; i < 90; ++i) ids.values()[i] = i * 0x0a0b00u;
  const ExrChannel y{"Y", ExrType::Number, nullptr, ids.values().data()};
  const LinearImage out = decode_exr(encode_exr(5, 18, {y}), "a.exr");
  for (std::size_t i = 0; i < 90; ++i) {
    EXPECT_EQ(out.values()[i].r, static_cast<float>(ids.values()[i]));
    EXPECT_EQ(out.values()[i].b, out.values()[i].r);  // grey
    EXPECT_EQ(out.values()[i].a, 1);
  }
}

TEST(Exr, ThreadsLeaveNoTrace) {
  const LinearImage image = make_image(50, 100);
  Bytes one, four;
  with_threads(1, [&] { one = exr_of(image, ExrType::Half); });
  with_threads(4, [&] { four = exr_of(image, ExrType::Half); });
  EXPECT_EQ(one, four);
}

TEST(Exr, WhatIsNotFiniteBecomesSo) {
  LinearImage image(2, 1);
  image(0, 0) = {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), std::nanf(""), 1};
  const LinearImage out = decode_exr(exr_of(image, ExrType::Float), "a.exr");
  EXPECT_EQ(out(0, 0), (Linear{65504, -65504, 0, 1}));
}

TEST(Exr, BitsOfEveryPartAreReadAsStored) {
  const float values[] = {std::nanf(""), -std::numeric_limits<float>::infinity(), -0.0f, 1e30f};
  const std::uint32_t numbers[] = {0x7f800001, 0, 1, ~std::uint32_t{0}};  // not exact as floats
  const Bytes file =
      encode_exr(2, 2, {{"R", ExrType::Float, values, nullptr, 1}, {"id", ExrType::Number, nullptr, numbers, 1}});
  const std::string names[] = {"R", "id"};
  const auto planes = decode_exr_bits(file, "a.exr", 0, names);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(planes[0].values()[i], std::bit_cast<std::uint32_t>(values[i]));
    EXPECT_EQ(planes[1].values()[i], numbers[i]);
  }
  EXPECT_TRUE(std::isnan(decode_exr_as_stored(file, "a.exr")(0, 0).r));
  EXPECT_EQ(decode_exr(file, "a.exr")(0, 0).r, 0);

  const Bytes two = exr_of_parts(4, {{"left", {{"R", 1}}}, {"right", {{"R", 2}, {"Z", 3}}}});
  const std::vector<ExrPart> parts = read_exr_parts(two);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[1].name, "right");
  ASSERT_EQ(parts[1].channels.size(), 2u);
  EXPECT_EQ(parts[1].channels[1].name, "Z");
  const std::string depth[] = {"Z"};
  EXPECT_EQ(decode_exr_bits(two, "a.exr", 1, depth)[0](3, 3), std::bit_cast<std::uint32_t>(3.0f));
  EXPECT_THROW(decode_exr_bits(two, "a.exr", 0, depth), Error);
  EXPECT_THROW(decode_exr_bits(two, "a.exr", 2, depth), Error);
  for (std::size_t size = 0; size < 700; ++size) EXPECT_LE(read_exr_parts(std::span(two).first(size)).size(), 2u);
}

TEST(Exr, TheDisplayWindowIsWhatIsSeen) {
  const LinearImage image = make_image(8, 4);
  Bytes bytes = exr_of(image, ExrType::Float);
  const std::string name = "displayWindow";
  const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
  const std::int32_t window[4] = {-2, 1, 6, 5};
  std::memcpy(&*(at + 14 + 6 + 4), window, sizeof window);
  const LinearImage out = decode_exr(bytes, "a.exr");
  ASSERT_EQ(out.width(), 9);
  ASSERT_EQ(out.height(), 5);
  EXPECT_EQ(out(1, 0), (Linear{0, 0, 0, 0}));
  EXPECT_EQ(out(2, 0), image(0, 1));
  EXPECT_EQ(out(8, 2), image(6, 3));
  EXPECT_EQ(out(5, 3), (Linear{0, 0, 0, 0}));
}

TEST(Exr, RefusalsNameTheCause) {
  const LinearImage image = make_image(40, 40);
  const Bytes good = exr_of(image, ExrType::Float);
  EXPECT_EQ(error_of(good, 1599), "a.exr: EXR: 40 x 40 pixels, at most 1599 are allowed");
  EXPECT_EQ(error_of(Bytes(good.begin(), good.begin() + 100)), "a.exr: EXR: the header is wrong");
  EXPECT_EQ(error_of({1, 2, 3}), "a.exr: EXR: the header is wrong");
  const float values[4] = {};
  EXPECT_EQ(error_of(encode_exr(2, 2, {{"Z", ExrType::Float, values}, {"d", ExrType::Float, values}})),
            "a.exr: EXR: has no channel R, G, B or Y, and which of its layers is the image is not stated: Z, d");
}

TEST(Exr, AClaimOfManyPixelsTakesNoMemory) {
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "a sanitizer's own memory counts too";
#endif
  Bytes bytes = exr_of(make_image(2, 2), ExrType::Float);
  for (const std::string name : {"displayWindow", "dataWindow"}) {
    const auto at = std::search(bytes.begin(), bytes.end(), name.begin(), name.end());
    const std::int32_t window[4] = {0, 0, 8191, 8191};
    std::memcpy(&*(at + static_cast<std::ptrdiff_t>(name.size()) + 1 + 6 + 4), window, sizeof window);
  }
  bytes.resize(bytes.size() + (1 << 17));  // space for the table of chunk offsets
  const auto max_of_children = [] {
    rusage usage{};
    ::getrusage(RUSAGE_CHILDREN, &usage);
    return usage.ru_maxrss;  // KiB
  };
  const long before = max_of_children();
  EXPECT_TRUE(error_of(bytes, 1 << 28).starts_with("a.exr: EXR: is corrupt"));
  EXPECT_LT(max_of_children() - before, 200 << 10);
}

TEST(Exr, DamageEndsInOneLine) {
  const Bytes good = exr_of(make_image(20, 40), ExrType::Half);
  int refused = 0;
  for (std::uint32_t i = 0; i < 60; ++i) {
    Bytes bad = good;
    bad[hash(i) % bad.size()] ^= static_cast<std::uint8_t>(1u << hash(i, 1) % 8);
    if (i % 3 == 0) bad.resize(hash(i, 2) % bad.size());
    const std::string line = error_of(bad);
    EXPECT_EQ(line.find('\n'), std::string::npos);
    refused += line != "no error";
  }
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace zoneplate
