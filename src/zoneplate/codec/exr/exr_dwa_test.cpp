// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_dwa.h"

#include <gtest/gtest.h>

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

// An image that OpenEXR 3.1.5 has packed by DWAA, at level 300: 18 x 11 pixels with R, G, B and A as halves, v.Y and Z
// as floats and id as numbers, thus with every scheme of the format.
const Bytes dwaa = {
    118, 47,  49,  1,   2,   0,   0,   0,   99,  104, 97,  110, 110, 101, 108, 115, 0,   99,  104, 108, 105, 115, 116,
    0,   130, 0,   0,   0,   65,  0,   1,   0,   0,   0,   0,   0,   0,   0,   1,   0,   0,   0,   1,   0,   0,   0,
    66,  0,   1,   0,   0,   0,   0,   0,   0,   0,   1,   0,   0,   0,   1,   0,   0,   0,   71,  0,   1,   0,   0,
    0,   0,   0,   0,   0,   1,   0,   0,   0,   1,   0,   0,   0,   82,  0,   1,   0,   0,   0,   0,   0,   0,   0,
    1,   0,   0,   0,   1,   0,   0,   0,   90,  0,   2,   0,   0,   0,   0,   0,   0,   0,   1,   0,   0,   0,   1,
    0,   0,   0,   105, 100, 0,   0,   0,   0,   0,   0,   0,   0,   0,   1,   0,   0,   0,   1,   0,   0,   0,   118,
    46,  89,  0,   2,   0,   0,   0,   0,   0,   0,   0,   1,   0,   0,   0,   1,   0,   0,   0,   0,   99,  111, 109,
    112, 114, 101, 115, 115, 105, 111, 110, 0,   99,  111, 109, 112, 114, 101, 115, 115, 105, 111, 110, 0,   1,   0,
    0,   0,   8,   100, 97,  116, 97,  87,  105, 110, 100, 111, 119, 0,   98,  111, 120, 50,  105, 0,   16,  0,   0,
    0,   0,   0,   0,   0,   0,   0,   0,   0,   17,  0,   0,   0,   10,  0,   0,   0,   100, 105, 115, 112, 108, 97,
    121, 87,  105, 110, 100, 111, 119, 0,   98,  111, 120, 50,  105, 0,   16,  0,   0,   0,   0,   0,   0,   0,   0,
    0,   0,   0,   17,  0,   0,   0,   10,  0,   0,   0,   100, 119, 97,  67,  111, 109, 112, 114, 101, 115, 115, 105,
    111, 110, 76,  101, 118, 101, 108, 0,   102, 108, 111, 97,  116, 0,   4,   0,   0,   0,   0,   0,   150, 67,  108,
    105, 110, 101, 79,  114, 100, 101, 114, 0,   108, 105, 110, 101, 79,  114, 100, 101, 114, 0,   1,   0,   0,   0,
    0,   112, 105, 120, 101, 108, 65,  115, 112, 101, 99,  116, 82,  97,  116, 105, 111, 0,   102, 108, 111, 97,  116,
    0,   4,   0,   0,   0,   0,   0,   128, 63,  115, 99,  114, 101, 101, 110, 87,  105, 110, 100, 111, 119, 67,  101,
    110, 116, 101, 114, 0,   118, 50,  102, 0,   8,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   115, 99,
    114, 101, 101, 110, 87,  105, 110, 100, 111, 119, 87,  105, 100, 116, 104, 0,   102, 108, 111, 97,  116, 0,   4,
    0,   0,   0,   0,   0,   128, 63,  0,   174, 1,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   231, 3,   0,
    0,   2,   0,   0,   0,   0,   0,   0,   0,   48,  6,   0,   0,   0,   0,   0,   0,   98,  0,   0,   0,   0,   0,
    0,   0,   204, 2,   0,   0,   0,   0,   0,   0,   57,  0,   0,   0,   0,   0,   0,   0,   18,  0,   0,   0,   0,
    0,   0,   0,   48,  0,   0,   0,   0,   0,   0,   0,   140, 1,   0,   0,   0,   0,   0,   0,   233, 0,   0,   0,
    0,   0,   0,   0,   24,  0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   0,   22,  0,   82,
    0,   20,  1,   71,  0,   36,  1,   66,  0,   52,  1,   89,  0,   4,   2,   65,  0,   8,   1,   120, 218, 99,  96,
    160, 22,  56,  225, 68,  29,  236, 225, 76,  29,  60,  141, 74,  248, 4,   149, 240, 47,  42,  97,  49,  23,  234,
    96,  125, 42,  97,  15,  42,  225, 68,  42,  225, 42,  42,  97,  234, 128, 5,   109, 140, 84,  193, 14,  188, 204,
    84,  193, 15,  38,  179, 80,  5,   55,  72,  177, 81,  5,   43,  44,  100, 167, 10,  62,  160, 206, 73,  21,  156,
    176, 142, 139, 42,  152, 193, 148, 135, 42,  120, 193, 110, 94,  170, 96,  7,   39,  126, 170, 96,  0,   98,  98,
    32,  196, 0,   0,   0,   0,   15,  255, 0,   0,   28,  2,   0,   0,   219, 4,   0,   0,   0,   0,   0,   0,   15,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 254, 24,  143, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 253, 97,  63,  255, 255, 208, 111, 255, 255, 244, 27,  255, 255, 253,
    6,   255, 255, 255, 65,  127, 249, 31,  255, 145, 191, 255, 255, 208, 111, 254, 72,  252, 228, 143, 206, 72,  253,
    228, 127, 254, 72,  252, 228, 143, 238, 71,  253, 228, 127, 222, 72,  252, 228, 143, 238, 72,  255, 255, 243, 66,
    63,  185, 35,  243, 145, 255, 57,  31,  247, 146, 63,  57,  35,  243, 146, 63,  255, 253, 208, 143, 255, 255, 116,
    35,  243, 146, 63,  255, 255, 255, 255, 255, 212, 136, 253, 100, 143, 192, 71,  254, 36,  143, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 254, 68,  255, 255, 255, 255, 255, 255, 234, 27,  255, 145, 255, 249, 31,  255, 255, 253, 5,   253,
    228, 143, 255, 255, 244, 35,  247, 145, 255, 249, 27,  247, 145, 255, 255, 255, 208, 127, 254, 72,  253, 228, 143,
    222, 72,  255, 255, 247, 66,  63,  121, 35,  247, 145, 191, 121, 35,  247, 146, 63,  9,   35,  255, 255, 255, 255,
    31,  35,  241, 145, 255, 153, 35,  243, 146, 63,  185, 35,  253, 146, 63,  255, 255, 255, 255, 255, 255, 255, 201,
    35,  255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255,
    255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 232, 48,  6,
    24,  81,  199, 28,  80,  6,   0,   97,  197, 28,  36,  7,   133, 18,  171, 208, 201, 107, 64,  159, 46,  33,  135,
    64,  86,  57,  134, 177, 60,  195, 223, 12,  252, 83,  49,  171, 66,  144, 139, 171, 205, 27,  202, 94,  172, 159,
    76,  31,  47,  19,  122, 164, 249, 195, 130, 137, 99,  181, 87,  135, 179, 228, 21,  173, 214, 107, 217, 221, 81,
    123, 151, 58,  246, 17,  168, 1,   182, 28,  86,  112, 231, 4,   242, 202, 99,  88,  131, 47,  32,  185, 142, 122,
    22,  215, 18,  78,  66,  117, 192, 136, 131, 178, 137, 180, 204, 104, 249, 81,  148, 69,  56,  120, 96,  222, 6,
    42,  208, 36,  86,  90,  44,  19,  62,  250, 64,  199, 21,  35,  17,  203, 219, 68,  46,  6,   143, 162, 47,  223,
    194, 91,  167, 243, 60,  203, 117, 198, 27,  86,  144, 215, 73,  187, 255, 152, 137, 233, 22,  117, 159, 249, 136,
    158, 145, 103, 89,  224, 120, 94,  123, 209, 80,  193, 112, 163, 196, 145, 119, 237, 242, 252, 171, 223, 191, 59,
    112, 100, 48,  4,   52,  40,  221, 107, 80,  82,  169, 107, 104, 172, 111, 96,  168, 111, 108, 104, 108, 248, 255,
    169, 129, 249, 119, 195, 153, 19,  13,  22,  39,  26,  0,   49,  199, 23,  201, 120, 218, 171, 103, 112, 101, 96,
    181, 225, 54,  33,  22,  3,   0,   158, 44,  6,   69,
};

/// A file with another value of its attribute `compression`: of `dwaa`, DWAB differs in the number of rows to a chunk
/// alone, and that image has one chunk in both.
Bytes with_compression(Bytes out, int compression) {
  const std::string name = "compression";
  const auto at = std::search(out.begin(), out.end(), name.begin(), name.end());
  *(at + 2 * 12 + 4) = static_cast<std::uint8_t>(compression);
  return out;
}

TEST(ExrDwa, DecodesWhatOpenExrDoes) {
  struct Pixel {
    int x, y;
    Linear color;
    float luma, depth;
    std::uint32_t id;
  };
  constexpr Pixel expected[] = {
      {0, 0, {4.29296875f, 0.500976562f, -1.84774399e-06f, 1}, 0, 0, 0},
      {4, 3, {4.28125f, 0.490722656f, -6.38961792e-05f, 1}, 0, 300, 300000},
      {5, 3, {4.29296875f, 0.489501953f, -3.09944153e-06f, 1}, 0, 300, 300000},
      {7, 7, {4.2265625f, 0.504882812f, -0.226196289f, 0.25f}, 0, 700, 700000},
      {8, 8, {0.249755859f, 0.497314453f, -0.253662109f, 0.25f}, 1, 800, 800000},
      {17, 10, {0.249755859f, 0.500976562f, -0.5234375f, 0.25f}, 2.00195312f, 1000, 1000000},
      {17, 0, {0.249145508f, 0.503417969f, 6.55651093e-07f, 0.25f}, 2.00195312f, 0, 0},
      {3, 9, {0.253662109f, 0.501953125f, -0.094543457f, 1}, 0, 900, 900000},
  };
  for (const int compression : {8, 9}) {
    const Bytes file = with_compression(dwaa, compression);
    const LinearImage image = decode_exr(file, "a.exr");
    const std::string names[] = {"v.Y", "Z", "id"};
    const auto planes = decode_exr_bits(file, "a.exr", 0, names);
    for (const Pixel& p : expected) {
      // Half of a unit in the last place of a half, on either side; values near 0 are sums of greater ones.
      const auto near = [](float found, float value) {
        EXPECT_NEAR(found, value, std::max(1e-4f, std::abs(value) / 1024));
      };
      const Linear c = image(p.x, p.y);
      near(c.r, p.color.r), near(c.g, p.color.g), near(c.b, p.color.b);
      EXPECT_EQ(c.a, p.color.a);
      near(std::bit_cast<float>(planes[0](p.x, p.y)), p.luma);
      EXPECT_EQ(std::bit_cast<float>(planes[1](p.x, p.y)), p.depth);
      EXPECT_EQ(planes[2](p.x, p.y), p.id);
    }
  }
}

// DWAB packs 256 rows of all channels together, which takes more memory than the channel that is decoded.
TEST(ExrDwa, WideChunksHaveTheMemoryThatTheyNeed) {
  constexpr int width = 16384, rows = 256, layers = 8;
  const auto file_of = [](int columns, int channels) {
    ExrPartImage part{.data = {0, 0, columns - 1, rows - 1}, .display = {0, 0, columns - 1, rows - 1}, .channels = {}};
    for (int i = 0; i < channels; ++i)
      part.channels.push_back({.name = "id" + std::to_string(i), .type = ExrType::Number});
    const Bytes zeros(std::size_t{4} * static_cast<std::size_t>(columns) * rows * layers);
    uLongf size = compressBound(static_cast<uLong>(zeros.size()));
    Bytes deflated(size);
    compress2(deflated.data(), &size, zeros.data(), static_cast<uLong>(zeros.size()), 1);
    deflated.resize(size);
    // Eleven sizes, of which those of the version and of the deflated channels are not 0, and no rules.
    std::array<std::uint64_t, 11> head{};
    head[0] = 2, head[1] = zeros.size(), head[2] = deflated.size();
    const std::uint16_t rules = sizeof rules;
    const std::int32_t place[] = {0, static_cast<std::int32_t>(sizeof head + sizeof rules + deflated.size())};
    Bytes chunk;
    const auto put = [&](const void* from, std::size_t count) {
      const auto* const bytes = static_cast<const std::uint8_t*>(from);
      chunk.insert(chunk.end(), bytes, bytes + count);
    };
    put(place, sizeof place), put(&head, sizeof head), put(&rules, sizeof rules), put(deflated.data(), size);
    ExrPartHeader header = exr_part_header(part);
    header.chunks = 1;
    ExrFileWriter file({header}, chunk.size());
    file.add(chunk);
    return with_compression(file.finish(), 9);
  };
  const std::string names[] = {"id3"};
  EXPECT_EQ(decode_exr_bits(file_of(width, layers), "a.exr", 0, names)[0], Plane<std::uint32_t>(width, rows, 0u));
  try {
    decode_exr_bits(file_of(width, 200), "a.exr", 0, names);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "a.exr: EXR: packs 3200 MB together, at most 2047 are read");
  }
}

TEST(ExrDwa, DamageIsReported) {
  int refused = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    Bytes bad = dwaa;
    constexpr std::uint32_t header = 480;  // the bytes before the chunk
    bad[header + hash(i) % (bad.size() - header)] ^= static_cast<std::uint8_t>(1u << hash(i, 1) % 8);
    try {
      decode_exr(bad, "a.exr", 10'000);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

TEST(ExrDwa, SizesThatAreNotThoseOfTheChannelsAreRefused) {
  const DwaChannel channel{.name = "Z", .type = ExrType::Float, .width = 4, .height = 2};
  const DwaDecoder decoder;
  Bytes out(32), packed(88 + 2);
  packed[0] = 2;                                                // the version
  packed[88] = 2;                                               // no rules
  EXPECT_FALSE(decoder.unpack(packed, {&channel, 1}, 0, out));  // no samples of Z
  out.resize(31);
  EXPECT_FALSE(decoder.unpack(packed, {&channel, 1}, 0, out));
  for (std::size_t size = 0; size < packed.size(); ++size)
    EXPECT_FALSE(decoder.unpack(std::span(packed).first(size), {&channel, 1}, 0, out)) << size;
}

}  // namespace
}  // namespace zoneplate
