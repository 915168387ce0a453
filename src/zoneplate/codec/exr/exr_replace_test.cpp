// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_replace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Names = std::vector<std::string>;

/// Values of a channel, of which some are not finite.
Plane<std::uint32_t> values_of(const ExrWindow& window, std::uint32_t seed, ExrType type) {
  Plane<std::uint32_t> out(static_cast<int>(window.width()), static_cast<int>(window.height()));
  for (std::uint32_t i = 0; i < out.values().size(); ++i) {
    const std::uint32_t bits = hash(i, seed);
    out.values()[i] = type == ExrType::Half ? bits & 0xffff : bits;
  }
  return out;
}

/// The file of one part with these channels, of values_of with the number of the channel as the seed.
struct Maker {
  ExrWindow data{0, 0, 7, 5}, display{0, 0, 7, 5};
  ExrAttributes attributes = {};
  ExrCompression compression = ExrCompression::Zips;
  std::vector<ExrChannel> channels = {};
  std::vector<Plane<std::uint32_t>> planes = {};

  void add(const std::string& name, ExrType type, int2 sampling = {1, 1}) {
    planes.push_back(values_of(data, static_cast<std::uint32_t>(planes.size()), type));
    channels.push_back({.name = name, .type = type, .sampling = sampling});
  }
  ExrPartBytes part(const std::string& name = {}) {
    for (std::size_t i = 0; i < channels.size(); ++i) channels[i].number = planes[i].values().data();
    return encode_exr_part({data, display, channels, attributes, compression}, name);
  }
  Bytes file() {
    const ExrPartBytes only = part();
    return join_exr_parts({only});
  }
};

ExrType type_of(const ExrPart& part, const std::string& channel) {
  return std::ranges::find(part.channels, channel, &ExrPartChannel::name)->type;
}

LinearImage constant(int width, int height, const Linear& color) {
  LinearImage out(width, height);
  std::ranges::fill(out.values(), color);
  return out;
}

TEST(ExrReplace, OtherChannelsKeepAllBits) {
  Maker maker;
  maker.add("A", ExrType::Half), maker.add("B", ExrType::Half), maker.add("G", ExrType::Half);
  maker.add("R", ExrType::Half), maker.add("Z", ExrType::Float), maker.add("half.X", ExrType::Half);
  maker.add("id", ExrType::Number), maker.add("mask", ExrType::Float, {2, 3});
  const Bytes file = maker.file();
  const ExrReplacement out = replace_exr_layer(file, "a.exr", {}, constant(8, 6, {0.25f, -3, 2, 0.5f}));
  EXPECT_TRUE(out.left_out.empty());
  EXPECT_EQ(decode_exr(out.bytes, "b.exr")(7, 5), (Linear{0.25f, -3, 2, 0.5f}));
  const Names others = {"Z", "half.X", "id", "mask"};
  EXPECT_EQ(decode_exr_stored(out.bytes, "b.exr", 0, others, maker.data),
            decode_exr_stored(file, "a.exr", 0, others, maker.data));
  const ExrPart part = *read_exr_part(out.bytes);
  EXPECT_EQ(type_of(part, "half.X"), ExrType::Half);
  EXPECT_EQ(type_of(part, "id"), ExrType::Number);
  EXPECT_EQ(type_of(part, "R"), ExrType::Half);
}

// A file of more than a band of rows: 80 channels of a wide image, encoded and decoded in bands.
TEST(ExrReplace, BandsOfRowsKeepAllBits) {
  Maker maker;
  maker.data = maker.display = {0, 0, 16383, 39}, maker.compression = ExrCompression::Zip;
  for (const char* const name : {"B", "G", "R"}) maker.add(name, ExrType::Half);
  for (Plane<std::uint32_t>& plane : maker.planes)
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 16384; ++x) plane(x, y) = static_cast<std::uint32_t>(y * 100 + x / 512);
  const Plane<std::uint32_t> shared = maker.planes[0];
  Names others;
  for (int i = 0; i < 80; ++i) {
    others.push_back("d." + std::to_string(i));
    maker.channels.push_back({.name = others.back(), .number = shared.values().data()});
  }
  maker.channels.back().sampling = {1, 8};  // rows that are counted from the top of the image
  for (std::size_t i = 0; i < 3; ++i) maker.channels[i].number = maker.planes[i].values().data();
  const ExrPartBytes part = encode_exr_part({maker.data, maker.display, maker.channels, {}, maker.compression});
  const Bytes file = join_exr_parts({part});
  ASSERT_LT(exr_band_rows(*read_exr_part(file), others.size()), 40);

  LinearImage image = constant(16384, 40, {0, 0, 0, 1});
  for (int y = 0; y < 40; ++y) std::ranges::fill(image.row(y), Linear{static_cast<float>(y), 2, 3, 1});
  const Bytes out = replace_exr_layer(file, "a.exr", {}, image).bytes;
  const auto found = decode_exr(out, "b.exr"), before = decode_exr(file, "a.exr");
  EXPECT_EQ(found, image);
  EXPECT_NE(before, image);
  const auto kept = decode_exr_stored(out, "b.exr", 0, others, maker.data);
  for (std::size_t i = 0; i + 1 < kept.size(); ++i) EXPECT_EQ(kept[i], shared) << i;
  EXPECT_EQ(kept.back(), decode_exr_stored(file, "a.exr", 0, {&others.back(), 1}, maker.data)[0]);
  EXPECT_EQ(kept.back()(5, 16), shared(5, 16));
  EXPECT_EQ(kept.back()(5, 17), 0u);
}

// Comparing each of 200,000 attributes with all before it would take minutes.
TEST(ExrReplace, ManyAttributesTakeNoLonger) {
  Maker maker;
  maker.add("R", ExrType::Half);
  for (int i = 0; i < 200'000; ++i) maker.attributes.emplace_back("attribute" + std::to_string(i), 1.0f);
  const Bytes file = maker.file();
  const Stopwatch clock;
  const Bytes out = replace_exr_layer(file, "a.exr", {}, constant(8, 6, {1, 0, 0, 1})).bytes;
  EXPECT_LT(clock.ms(), 15'000);
  EXPECT_TRUE(read_exr_part(out)->find("attribute199999"));
}

TEST(ExrReplace, OneLayerOfManyIsReplaced) {
  Maker maker;
  for (const char* const name : {"a.B", "a.G", "a.R", "b.B", "b.G", "b.R"}) maker.add(name, ExrType::Float);
  const Bytes file = maker.file();
  const ExrReplacement out = replace_exr_layer(file, "a.exr", {.layer = "b"}, constant(8, 6, {1, 2, 3, 1}));
  const Names a = {"a.B", "a.G", "a.R"};
  EXPECT_EQ(decode_exr_stored(out.bytes, "b.exr", 0, a, maker.data), decode_exr_stored(file, "", 0, a, maker.data));
  EXPECT_EQ(decode_exr_as_stored(out.bytes, "b.exr", 100, {.layer = "b"})(3, 3), (Linear{1, 2, 3, 1}));
  EXPECT_EQ(read_exr_part(out.bytes)->channels.size(), 6u);  // no alpha, since all pixels are opaque
  const ExrReplacement rounded =
      replace_exr_layer(file, "a.exr", {.layer = "b"}, constant(8, 6, {1, 2, 3, 0.9999999f}));
  EXPECT_EQ(read_exr_part(rounded.bytes)->channels.size(), 6u);
  const ExrReplacement veiled = replace_exr_layer(file, "a.exr", {.layer = "b"}, constant(8, 6, {1, 2, 3, 0.5f}));
  EXPECT_EQ(decode_exr_as_stored(veiled.bytes, "b.exr", 100, {.layer = "b"})(3, 3), (Linear{1, 2, 3, 0.5f}));
}

TEST(ExrReplace, AttributesAreCarriedWhateverTheirType) {
  Maker maker;
  maker.add("R", ExrType::Half);
  maker.attributes = {{"pixelAspectRatio", 2.0f},
                      {"timeCode", ExrTimeCode{0x01020304}},
                      {"chromaticities", ExrChromaticities{0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.3217f, 0.3377f}},
                      {"acesImageContainerFlag", ExrStoredValue{"int", {1, 0, 0, 0}}},
                      {"aNameOfMoreThanThirtyOneBytesThatNobodyKnows", ExrStoredValue{"unknownType", {1, 2, 3}}},
                      {"preview", ExrStoredValue{"preview", {0, 0, 0, 0, 0, 0, 0, 0}}}};
  const Bytes file = maker.file();
  for (const int2 size : {int2{8, 6}, int2{16, 12}}) {
    const Bytes out = replace_exr_layer(file, "a.exr", {}, constant(size.x, size.y, {1, 0, 0, 1})).bytes;
    const ExrPart before = *read_exr_part(file), after = *read_exr_part(out);
    for (std::size_t i = 0; i + 1 < maker.attributes.size(); ++i) {
      const ExrAttributeView *const a = before.find(maker.attributes[i].first), *const b = after.find(
                                                                                    maker.attributes[i].first);
      ASSERT_TRUE(a && b) << maker.attributes[i].first;
      EXPECT_EQ(a->type, b->type);
      EXPECT_TRUE(std::ranges::equal(a->value, b->value));
    }
    EXPECT_EQ(after.find("preview"), nullptr);
    EXPECT_EQ(decode_exr(out, "b.exr").width(), size.x);  // the library accepts the header
  }
}

TEST(ExrReplace, WindowsAreKeptAndGrowWithTheLight) {
  Maker maker;
  maker.data = {-3, -2, 9, 8}, maker.display = {0, 0, 5, 4};  // overscan
  for (const char* const name : {"B", "G", "R", "Z"}) maker.add(name, ExrType::Float);
  const Bytes overscan = maker.file();
  const auto whole = decode_exr_as_stored(overscan, "a.exr", 1000, {.area = ExrArea::Whole});
  EXPECT_EQ((int2{whole.width(), whole.height()}), (int2{13, 11}));
  const Bytes out = replace_exr_layer(overscan, "a.exr", {.area = ExrArea::Whole}, whole).bytes;
  const ExrPart part = *read_exr_part(out);
  EXPECT_EQ(part.data.left, -3);
  EXPECT_EQ(part.data.bottom, 8);
  EXPECT_EQ(part.display.right, 5);
  const Names all = {"B", "G", "R", "Z"};
  EXPECT_EQ(decode_exr_stored(out, "", 0, all, maker.data), decode_exr_stored(overscan, "", 0, all, maker.data));
  EXPECT_EQ(replace_exr_layer(overscan, "a.exr", {}, constant(6, 5, {1, 1, 1, 1})).left_out,
            Names{"the pixels outside the display window"});

  Maker small;
  small.data = {2, 1, 4, 3}, small.display = {0, 0, 5, 4};  // a crop
  for (const char* const name : {"A", "B", "G", "R", "Z"}) small.add(name, ExrType::Float);
  const Bytes crop = small.file();
  LinearImage image = decode_exr_as_stored(crop, "a.exr");
  EXPECT_EQ(read_exr_part(replace_exr_layer(crop, "a.exr", {}, image).bytes)->data.left, 2);
  image(0, 0) = {1, 1, 1, 1};
  const Bytes grown = replace_exr_layer(crop, "a.exr", {}, image).bytes;
  EXPECT_EQ(read_exr_part(grown)->data.left, 0);
  EXPECT_EQ(decode_exr_as_stored(grown, "b.exr")(0, 0), (Linear{1, 1, 1, 1}));
  const Names depth = {"Z"};
  EXPECT_EQ(decode_exr_stored(grown, "", 0, depth, small.display)[0](0, 0), 0u);
  EXPECT_EQ(decode_exr_stored(grown, "", 0, depth, small.data), decode_exr_stored(crop, "", 0, depth, small.data));
}

TEST(ExrReplace, ADisplayWindowBelowTheDataIsEmpty) {
  for (const int top : {6, 7, 37})
    for (const ExrCompression compression : {ExrCompression::Zips, ExrCompression::Zip}) {
      Maker maker{.display = {0, top, 7, top + 5}, .compression = compression};
      maker.add("R", ExrType::Float), maker.add("G", ExrType::Float), maker.add("B", ExrType::Float);
      const LinearImage image = decode_exr(maker.file(), "a.exr");
      for (const Linear& c : image.values()) ASSERT_EQ(c, (Linear{0, 0, 0, 0})) << top;
    }
}

TEST(ExrReplace, WindowsFarFromEachOtherAreRefused) {
  constexpr std::int32_t far = 500'000'000;
  Maker maker;
  maker.display = {far, far, far + 7, far + 5}, maker.data = {-far, -far, -far + 7, -far + 5};
  maker.add("R", ExrType::Half);
  const Bytes file = maker.file();
  EXPECT_EQ(decode_exr(file, "a.exr")(0, 0), (Linear{0, 0, 0, 0}));
  EXPECT_THROW(decode_exr_as_stored(file, "a.exr", ~std::uint64_t{0}, {.area = ExrArea::Whole}), Error);
}

TEST(ExrReplace, HalvesStayHalvesWhereTheyHoldTheValues) {
  Maker maker;
  for (const char* const name : {"B", "G", "R"}) maker.add(name, ExrType::Half);
  const Bytes file = maker.file();
  const Bytes out = replace_exr_layer(file, "a.exr", {}, constant(8, 6, {1e6f, 0.1f, -1, 1})).bytes;
  const ExrPart part = *read_exr_part(out);
  EXPECT_EQ(type_of(part, "R"), ExrType::Float);
  EXPECT_EQ(type_of(part, "G"), ExrType::Half);
  EXPECT_EQ(decode_exr(out, "b.exr")(0, 0).r, 1e6f);
  const Bytes floats =
      replace_exr_layer(file, "a.exr", {}, constant(8, 6, {1, 0.1f, -1, 1}), {.type = ExrType::Float}).bytes;
  EXPECT_EQ(decode_exr(floats, "b.exr")(0, 0).g, 0.1f);
}

TEST(ExrReplace, GreyStaysOneChannelUntilItIsColored) {
  Maker maker;
  maker.add("Y", ExrType::Float);
  const Bytes file = maker.file();
  const auto names = [&](const Linear& color) {
    return exr_channel_names(replace_exr_layer(file, "a.exr", {}, constant(8, 6, color)).bytes);
  };
  EXPECT_EQ(names({0.5f, 0.5f, 0.5f, 1}), Names{"Y"});
  EXPECT_EQ(names({0.5f, 0.5f, 0.5f, 0.5f}), (Names{"A", "Y"}));
  EXPECT_EQ(names({1, 0.5f, 0, 1}), (Names{"B", "G", "R"}));
}

TEST(ExrReplace, AnotherSizeNamesWhatIsLeftOut) {
  Maker maker;
  for (const char* const name : {"B", "G", "R", "Z", "n.X"}) maker.add(name, ExrType::Half);
  const ExrReplacement out = replace_exr_layer(maker.file(), "a.exr", {}, constant(4, 3, {1, 2, 3, 1}));
  EXPECT_EQ(out.left_out, (Names{"Z", "n.X"}));
  EXPECT_EQ(decode_exr(out.bytes, "b.exr")(3, 2), (Linear{1, 2, 3, 1}));
}

/// Three parts, of which the second is that of the image.
Bytes three_parts() {
  std::vector<ExrPartBytes> parts;
  for (const char* const name : {"depth", "beauty", "more"}) {
    Maker maker;
    maker.compression = name[0] == 'm' ? ExrCompression::None : ExrCompression::Zip;
    if (name[0] == 'd') maker.data = {-1, -1, 8, 6};
    for (const char* const channel : {"B", "G", "R"})
      if (name[0] != 'd') maker.add(channel, ExrType::Half);
    maker.add("Z", ExrType::Float);
    parts.push_back(maker.part(name));
  }
  return join_exr_parts(parts);
}

TEST(ExrReplace, AConvertedImageLeavesOutWhatHasTheChromaticities) {
  Maker maker;
  maker.data = {-1, 0, 8, 5};
  for (const char* const name : {"B", "G", "R", "Z"}) maker.add(name, ExrType::Float);
  maker.attributes = {{"chromaticities", ExrChromaticities{0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.3217f, 0.3377f}},
                      {"timeCode", ExrTimeCode{7}}};
  const ExrStorage converted{.is_converted = true};
  for (const int width : {10, 5}) {
    const ExrReplacement out =
        replace_exr_layer(maker.file(), "a.exr", {.area = ExrArea::Whole}, constant(width, 6, {1, 2, 3, 1}), converted);
    EXPECT_EQ(out.left_out.front(), "Z");
    const ExrPart part = *read_exr_part(out.bytes);
    EXPECT_EQ(part.find("chromaticities"), nullptr);
    EXPECT_NE(part.find("timeCode"), nullptr);
    EXPECT_EQ(part.data.left, width == 10 ? -1 : 0);
    EXPECT_EQ(part.channels.size(), 3u);
    EXPECT_EQ(decode_exr(out.bytes, "b.exr")(3, 3), (Linear{1, 2, 3, 1}));
  }
  const ExrReplacement alone = replace_exr_layer(three_parts(), "a.exr", {}, constant(8, 6, {1, 2, 3, 1}), converted);
  EXPECT_EQ(alone.left_out, (Names{"Z", "part depth", "part more"}));
  EXPECT_EQ(read_exr_parts(alone.bytes).size(), 1u);
}

TEST(ExrReplace, OtherPartsAreCopiedAsTheyArePacked) {
  const Bytes file = three_parts();
  const ExrReplacement out = replace_exr_layer(file, "a.exr", {}, constant(8, 6, {1, 2, 3, 1}));
  EXPECT_TRUE(out.left_out.empty());
  const std::vector<ExrPart> before = read_exr_parts(file), after = read_exr_parts(out.bytes);
  ASSERT_EQ(after.size(), 3u);
  for (const std::size_t i : {0u, 2u}) EXPECT_TRUE(std::ranges::equal(before[i].header, after[i].header));
  EXPECT_EQ(after[1].name, "beauty");
  const Names depth = {"Z"}, red = {"R"};
  for (const int i : {0, 1, 2}) {
    const ExrWindow window = before[static_cast<std::size_t>(i)].data;
    EXPECT_EQ(decode_exr_stored(out.bytes, "", i, depth, window), decode_exr_stored(file, "", i, depth, window));
  }
  const ExrWindow window{0, 0, 7, 5};
  EXPECT_EQ(decode_exr_stored(out.bytes, "", 2, red, window), decode_exr_stored(file, "", 2, red, window));
  EXPECT_EQ(decode_exr_as_stored(out.bytes, "b.exr")(7, 5), (Linear{1, 2, 3, 1}));
  EXPECT_EQ(replace_exr_layer(file, "a.exr", {}, constant(2, 2, {1, 2, 3, 1})).left_out,
            (Names{"Z", "part depth", "part more"}));
}

TEST(ExrReplace, DamageOfOtherPartsIsReported) {
  const Bytes good = three_parts();
  const LinearImage image = constant(8, 6, {1, 2, 3, 1});
  int refused = 0;
  for (std::uint32_t i = 0; i < 400; ++i) {
    Bytes bad = good;
    bad[hash(i) % bad.size()] ^= static_cast<std::uint8_t>(1u << hash(i, 1) % 8);
    if (i % 4 == 0) bad.resize(hash(i, 2) % bad.size());
    try {
      const ExrReplacement out = replace_exr_layer(bad, "a.exr", {}, image);
      EXPECT_LT(out.bytes.size(), 3 * good.size());
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace zoneplate
