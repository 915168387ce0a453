// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_chroma.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/image/half.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ValueAt = std::function<float(int x, int y)>;

/// A channel of half floats with a sample at columns and rows that are multiples.
struct Subsampled {
  std::string name;
  int step_x = 1, step_y = 1;
  ValueAt value;
};

struct Origin {
  int x = 0, y = 0;
};

enum Packing : std::uint8_t { Raw = 0, Zip = 3, B44 = 6 };

template <class T>
void append(Bytes& out, T value) {
  const std::size_t at = out.size();
  out.resize(at + sizeof value);
  std::memcpy(out.data() + at, &value, sizeof value);
}

void append_text(Bytes& out, const std::string& text) {
  out.insert(out.end(), text.c_str(), text.c_str() + text.size() + 1);
}

template <class... Values>
void append_attribute(Bytes& out, const std::string& name, const std::string& type, Values... values) {
  append_text(out, name), append_text(out, type);
  append(out, static_cast<std::uint32_t>((sizeof values + ... + 0)));
  (append(out, values), ...);
}

/// The samples of a row, channel after channel.
Bytes row_of(const std::vector<Subsampled>& channels, int width, int x0, int y) {
  Bytes out;
  for (const Subsampled& c : channels)
    for (int x = x0; y % c.step_y == 0 && x < x0 + width; ++x)
      if (x % c.step_x == 0) append(out, half_bits(c.value(x, y)));
  return out;
}

Bytes header_of(int width, int height, const std::vector<Subsampled>& channels, Origin at, Packing packing) {
  Bytes out, list;
  append(out, std::uint32_t{20000630}), append(out, std::uint32_t{2});
  for (const Subsampled& c : channels) {
    append_text(list, c.name);
    for (const std::int32_t word : {1, 0, c.step_x, c.step_y}) append(list, word);
  }
  list.push_back(0);
  append_text(out, "channels"), append_text(out, "chlist");
  append(out, static_cast<std::uint32_t>(list.size()));
  out.insert(out.end(), list.begin(), list.end());
  append_attribute(out, "compression", "compression", packing);
  for (const char* const window : {"dataWindow", "displayWindow"})
    append_attribute(out, window, "box2i", at.x, at.y, at.x + width - 1, at.y + height - 1);
  append_attribute(out, "lineOrder", "lineOrder", std::uint8_t{0});
  append_attribute(out, "pixelAspectRatio", "float", 1.0f);
  append_attribute(out, "screenWindowCenter", "v2f", 0.0f, 0.0f);
  append_attribute(out, "screenWindowWidth", "float", 1.0f);
  out.push_back(0);
  return out;
}

/// An image with chunks of one row, or one chunk for all rows where it is stored as it is though packed.
Bytes exr_of(int width, int height, const std::vector<Subsampled>& channels, Origin at = {}, Packing packing = Raw) {
  Bytes out = header_of(width, height, channels, at, packing);
  std::vector<Bytes> chunks;
  for (int y = at.y; y < at.y + height; ++y) {
    const Bytes row = row_of(channels, width, at.x, y);
    if (packing == Raw || y == at.y) chunks.emplace_back();
    chunks.back().insert(chunks.back().end(), row.begin(), row.end());
  }
  std::uint64_t offset = out.size() + chunks.size() * sizeof offset;
  for (const Bytes& chunk : chunks) append(out, offset), offset += chunk.size() + 8;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    append(out, at.y + static_cast<std::int32_t>(i)), append(out, static_cast<std::uint32_t>(chunks[i].size()));
    out.insert(out.end(), chunks[i].begin(), chunks[i].end());
  }
  return out;
}

ValueAt constant(float value) {
  return [=](int, int) { return value; };
}

std::string refusal_of(const Bytes& bytes) {
  try {
    decode_exr(bytes, "a.exr");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return "no error";
}

void expect_color(const Linear& found, const Linear& expected, float tolerance) {
  EXPECT_NEAR(found.r, expected.r, tolerance);
  EXPECT_NEAR(found.g, expected.g, tolerance);
  EXPECT_NEAR(found.b, expected.b, tolerance);
  EXPECT_EQ(found.a, expected.a);
}

TEST(ExrChroma, WithoutChromaTheLuminanceKeepsItsBits) {
  const auto luminance = [](int x, int y) { return static_cast<float>(x * 16 + y) / 128; };
  const Bytes bytes = exr_of(8, 6, {{"BY", 2, 2, constant(0)}, {"RY", 2, 2, constant(0)}, {"Y", 1, 1, luminance}});
  const LinearImage image = decode_exr(bytes, "a.exr");
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) {
      const float v = luminance(x, y);
      EXPECT_EQ(image(x, y), (Linear{v, v, v, 1})) << x << " " << y;
    }
}

TEST(ExrChroma, AColorIsThatOfItsLuminanceAndChroma) {
  // Red 0.5, green 0.25 and blue 0.75 with Rec.709's weights, over a background at half of it.
  const float luminance = 0.2126f * 0.5f + 0.7152f * 0.25f + 0.0722f * 0.75f;
  const ValueAt red = constant((0.5f - luminance) / luminance), blue = constant((0.75f - luminance) / luminance);
  const auto alpha = [](int x, int) { return x % 3 == 0 ? 0.5f : 1.0f; };
  for (const int step : {1, 2})
    for (const Origin at : {Origin{0, 0}, Origin{-6, 4}})
      for (const Packing packing : {Raw, Zip, B44}) {
        const LinearImage image = decode_exr(exr_of(10, 8,
                                                    {{"A", 1, 1, alpha},
                                                     {"BY", step, step, blue},
                                                     {"RY", step, step, red},
                                                     {"Y", 1, 1, constant(luminance)}},
                                                    at, packing),
                                             "a.exr");
        for (int y = 0; y < 8; ++y)
          for (int x = 0; x < 10; ++x) expect_color(image(x, y), {0.5f, 0.25f, 0.75f, alpha(x + at.x, y)}, 1e-3f);
      }
}

TEST(ExrChroma, ChromaThatTheFileLacksIsZero) {
  const LinearImage image = decode_exr(exr_of(4, 2, {{"RY", 2, 2, constant(1)}, {"Y", 1, 1, constant(0.5f)}}), "a.exr");
  // Red is twice the luminance, blue is the luminance; green is what remains of it.
  const float green = (0.5f - 0.2126f - 0.0722f * 0.5f) / 0.7152f;
  for (const Linear& color : image.values()) expect_color(color, {1, green, 0.5f, 1}, 1e-3f);
}

TEST(ExrChroma, ReconstructsWhatOpenExrDoes) {
  // Colours that OpenEXR 3.1.5's RgbaInputFile reads from this file, some of them desaturated.
  const auto at = [](int x, int y, int k) { return static_cast<float>((x * 5 + y * 3 + k * 7) % 16) / 16; };
  const Bytes bytes = exr_of(16, 12,
                             {{"BY", 2, 2, [&](int x, int y) { return 3 * at(x, y, 1) - 1; }},
                              {"RY", 2, 2, [&](int x, int y) { return 2 * at(x, y, 2) - 1; }},
                              {"Y", 1, 1, [&](int x, int y) { return 0.25f + at(x, y, 0); }}});
  struct Pixel {
    int x, y;
    Linear color;
  };
  constexpr Pixel expected[] = {
      {0, 0, {0.4375f, 0.186401367f, 0.328125f, 1}},          {1, 0, {0.870117188f, 0.505859375f, 0.216674805f, 1}},
      {15, 0, {0.307617188f, 0.966308594f, 2.50585938f, 1}},  {6, 1, {0.272216797f, 0.301025391f, 0.545410156f, 1}},
      {7, 3, {0.239257812f, 1.14941406f, 1.7578125f, 1}},     {0, 5, {0.882324219f, 1.33007812f, 0.672851562f, 1}},
      {8, 6, {0.875f, 0.946777344f, 0.1640625f, 1}},          {13, 8, {0.714355469f, 0.780761719f, 1.41503906f, 1}},
      {14, 10, {0.125f, 0.558105469f, 1.03125f, 1}},          {0, 11, {0.468017578f, 0.275878906f, 0.218139648f, 1}},
      {5, 11, {0.603515625f, 0.984863281f, 0.586914062f, 1}}, {15, 11, {0.0765991211f, 1.10742188f, 2.6484375f, 1}},
  };
  const LinearImage image = decode_exr(bytes, "a.exr");
  for (const Pixel& p : expected) {
    SCOPED_TRACE(std::to_string(p.x) + " " + std::to_string(p.y));
    expect_color(image(p.x, p.y), p.color, 4e-3f);
  }
}

TEST(ExrChroma, ColorsBesideAChannelOfFewerSamplesAreRead) {
  const auto at = [](int x, int y, int k) { return static_cast<float>((x + 40 + (y + 40) * 8) * 4 + k); };
  const auto channel = [&](int k) { return [=](int x, int y) { return at(x, y, k); }; };
  for (const std::string name : {"AO", "Ga", "mask"})  // before, between and after the colours
    for (const int step : {2, 3, 6})
      for (const Packing packing : {Raw, Zip}) {
        std::vector<Subsampled> channels = {
            {"A", 1, 1, channel(3)}, {"B", 1, 1, channel(2)}, {"G", 1, 1, channel(1)}, {"R", 1, 1, channel(0)}};
        const auto place = std::ranges::find_if(channels, [&](const Subsampled& c) { return c.name > name; });
        channels.insert(place, {name, step, step == 6 ? 1 : step, constant(-7)});
        const LinearImage image = decode_exr(exr_of(12, 6, channels, {-6, 6}, packing), "a.exr");
        for (int y = 0; y < 6; ++y)
          for (int x = 0; x < 12; ++x)
            ASSERT_EQ(image(x, y),
                      (Linear{at(x - 6, y + 6, 0), at(x - 6, y + 6, 1), at(x - 6, y + 6, 2), at(x - 6, y + 6, 3)}))
                << name << " " << step << " " << x << " " << y;
      }
  const Bytes grey = exr_of(8, 4, {{"A", 1, 1, constant(0.5f)}, {"AO", 2, 2, constant(9)}, {"Y", 1, 1, channel(0)}});
  EXPECT_EQ(decode_exr(grey, "a.exr")(5, 3), (Linear{at(5, 3, 0), at(5, 3, 0), at(5, 3, 0), 0.5f}));
  const std::string names[] = {"Y"};
  EXPECT_EQ(decode_exr_channels(grey, "a.exr", names)[0](7, 2), at(7, 2, 0));
}

TEST(ExrChroma, WhatIsNotReadIsNamed) {
  const auto yc = [](int width, int step_x, int step_y) {
    return exr_of(width, 12,
                  {{"BY", step_x, step_y, constant(0)}, {"RY", step_x, step_y, constant(0)}, {"Y", 1, 1, constant(1)}});
  };
  EXPECT_EQ(refusal_of(yc(12, 4, 2)),
            "a.exr: EXR: has fewer samples in channel BY than in every second column and row, which is not read");
  EXPECT_EQ(refusal_of(yc(12, 1, 2)), "no error");
  EXPECT_TRUE(refusal_of(yc(11, 2, 2)).starts_with("a.exr: EXR: is corrupt"));  // the format forbids it
  EXPECT_EQ(refusal_of(exr_of(4, 4, {{"G", 2, 2, constant(0)}, {"R", 1, 1, constant(1)}})),
            "a.exr: EXR: has fewer samples in channel G than pixels, which is not read");
  const std::string names[] = {"RY"};
  EXPECT_THROW(decode_exr_channels(yc(12, 2, 2), "a.exr", names), Error);
}

TEST(ExrChroma, AFileCutOffShowsNoOtherMemory) {
  const Bytes good = exr_of(8, 6, {{"BY", 2, 2, constant(0)}, {"RY", 2, 2, constant(0)}, {"Y", 1, 1, constant(1)}});
  Bytes bad = good;
  const auto claim = static_cast<std::uint32_t>(15);  // bytes of the last row, which has 16
  std::memcpy(bad.data() + bad.size() - 16 - sizeof claim, &claim, sizeof claim);
  EXPECT_EQ(refusal_of(bad), "a.exr: EXR: is corrupt: a part has another size than its channels");
}

TEST(ExrChroma, WeightsAreThoseOfThePrimaries) {
  const auto expect_weights = [](const ExrChromaticities& c, float3 expected) {
    const std::optional<float3> found = luminance_weights(c);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->x, expected.x, 1e-4f);
    EXPECT_NEAR(found->y, expected.y, 1e-4f);
    EXPECT_NEAR(found->z, expected.z, 1e-4f);
  };
  expect_weights(rec709_chromaticities, {0.2126f, 0.7152f, 0.0722f});
  expect_weights({0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f},
                 {0.34397f, 0.72817f, -0.07213f});  // ACES, SMPTE ST 2065-1
  EXPECT_FALSE(luminance_weights({0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3f, 0.3127f, 0.329f}));
  EXPECT_FALSE(luminance_weights({0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3f, 0}));
}

}  // namespace
}  // namespace zoneplate
