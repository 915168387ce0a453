// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/output/aov_file.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <utility>

#include "zoneplate/codec/png.h"

namespace zoneplate {
namespace {

// Three pixels: a near one, a far one, and an empty one.
Frame frame() {
  constexpr float nothing = std::numeric_limits<float>::infinity();
  Frame f;
  const auto plane = [](auto a, auto b, auto c) {
    Plane<decltype(a)> p(3, 1);
    p(0, 0) = a, p(1, 0) = b, p(2, 0) = c;
    return p;
  };
  f.depth = plane(2.0f, 6.0f, nothing);
  f.normal = plane(float3{0, 0, 1}, float3{-1, 0, 0}, float3{});
  f.albedo = plane(float3{1, 0, 0.2f}, float3{1, 1, 1}, float3{});
  f.uv = plane(float2{0.5f, 1.25f}, float2{-0.25f, 0}, float2{});
  f.object_id = f.material_id = f.primitive_id = plane(0u, 1u, Frame::no_id);
  f.coverage = plane(1.0f, 0.5f, 0.0f);
  f.mip_level = plane(4.0f, -2.0f, 0.0f);
  f.anisotropy = plane(16.0f, 1.0f, 0.0f);
  f.position = plane(float3{1, 2, 3}, float3{2, 0, 3}, float3{});
  f.motion = plane(float2{4, 0}, float2{0, 2}, float2{});
  f.flow = plane(float2{-4, 0}, float2{}, float2{});
  f.sample_triangle = {plane(0u, 1u, Frame::no_id), plane(0u, 0u, Frame::no_id)};
  f.error = plane(0.003f, 0.0015f, 0.0f);
  return f;
}

// Two triangles with an object and a material each.
Scene scene() {
  Scene s;
  s.objects = {"one", "two"};
  s.materials.resize(2);
  for (int i = 0; i < 2; ++i) {
    s.meshes.push_back({.position = std::vector<float3>(3), .index = {0, 1, 2}, .material = i});
    s.instances.push_back({.mesh = i, .object = i});
  }
  return s;
}

const Aov& aov_of(std::string_view name) {
  for (const Aov& aov : aovs())
    if (aov.name == name) return aov;
  ADD_FAILURE() << "no data pass " << name;
  return aovs()[0];
}

PngImage picture(std::string_view name) {
  return decode_png(encode_data_png(aov_of(name), frame(), scene()), std::string(name));
}

constexpr Rgba8 nothing{0, 0, 0, 0};

TEST(Aov, DepthIsLinearFromTheNearestToTheFarthestSeen) {
  const PngImage png = picture("depth");
  ASSERT_EQ(png.pixels16.width(), 3);
  EXPECT_EQ(png.pixels16(0, 0).r, 0);
  EXPECT_EQ(png.pixels16(1, 0).r, 65534);
  EXPECT_EQ(png.pixels16(2, 0).r, 65535);
}

TEST(Aov, DepthTellsItsDistances) {
  const std::vector<std::uint8_t> bytes = encode_data_png(aovs()[0], frame(), {});
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_NE(text.find(std::string("tEXtnear\0002", 10)), std::string::npos);
  EXPECT_NE(text.find(std::string("tEXtfar\0006", 9)), std::string::npos);
}

/// The three pixels of an image: two surfaces, and an empty pixel.
using ThreePixels = std::array<Rgba8, 3>;
ThreePixels pixels_of(const PngImage& png) { return {png.pixels(0, 0), png.pixels(1, 0), png.pixels(2, 0)}; }

TEST(Aov, NormalsAlbedoAndPositionsHaveTheirColours) {
  const std::pair<const char*, ThreePixels> pictures[] = {
      {"normal", {{{128, 128, 255, 255}, {0, 128, 128, 255}, nothing}}},  // 0.5 + 0.5 n
      {"albedo", {{{255, 0, 124, 255}, {255, 255, 255, 255}, nothing}}},  // encode_srgb(0.2) = 0.4845
      {"position", {{{0, 255, 128, 255}, {255, 0, 128, 255}, nothing}}},  // relative to their range
  };
  for (const auto& [name, pixels] : pictures) EXPECT_EQ(pixels_of(picture(name)), pixels) << name;
}

TEST(Aov, UvShowsFractions) {
  const PngImage png = picture("uv");
  EXPECT_EQ(png.pixels(0, 0), (Rgba8{128, 64, 0, 255}));
  EXPECT_EQ(png.pixels(1, 0), (Rgba8{191, 0, 0, 255}));
}

TEST(Aov, WhatIsNotFiniteHasAColourToo) {
  Frame odd = frame();
  constexpr float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  odd.uv(0, 0) = {nan, 0.25f}, odd.uv(1, 0) = {infinity, -infinity};
  const PngImage uv = decode_png(encode_data_png(aov_of("uv"), odd, scene()), "uv");
  EXPECT_EQ(uv.pixels(0, 0), (Rgba8{0, 64, 0, 255}));
  EXPECT_EQ(uv.pixels(1, 0), (Rgba8{0, 0, 0, 255}));
  for (const float2 step : {float2{infinity, 0}, float2{0, -infinity}, float2{nan, 1}, float2{infinity, nan}}) {
    odd.motion(1, 0) = step;
    const PngImage motion = decode_png(encode_data_png(aov_of("motion"), odd, scene()), "motion");
    EXPECT_EQ(motion.pixels(0, 0), (Rgba8{255, 0, 0, 255}));  // the longest finite motion
    EXPECT_EQ(motion.pixels(1, 0), (Rgba8{0, 0, 0, 255}));
  }
}

TEST(Aov, IdsHaveDistinctColoursAndNothingHasNone) {
  for (const char* name : {"object-id", "material-id", "primitive-id"}) {
    const PngImage png = picture(name);
    EXPECT_NE(png.pixels(0, 0), png.pixels(1, 0));
    EXPECT_GE(png.pixels(0, 0).g, 64);
    EXPECT_EQ(png.pixels(2, 0), nothing);
  }
}

TEST(Aov, MotionIsAHueOfItsDirection) {
  const PngImage motion = picture("motion");
  EXPECT_EQ(motion.pixels(0, 0), (Rgba8{255, 0, 0, 255}));  // to the right, with the greatest length
  const Rgba8 down = motion.pixels(1, 0);                   // half the length: half way to white
  EXPECT_EQ(down.g, 255);
  EXPECT_NEAR(down.r, 191, 1);
  EXPECT_NEAR(down.b, 128, 1);
  EXPECT_EQ(motion.pixels(2, 0), nothing);
  const PngImage flow = picture("flow");
  EXPECT_EQ(flow.pixels(0, 0), (Rgba8{0, 255, 255, 255}));  // to the left
  EXPECT_EQ(flow.pixels(1, 0), (Rgba8{255, 255, 255, 255}));
}

TEST(Aov, MattesMixTheirOwnersColours) {
  const PngImage png = picture("crypto-object");
  EXPECT_EQ(png.pixels(0, 0).a, 255);
  EXPECT_NE(png.pixels(0, 0), png.pixels(1, 0));
  EXPECT_EQ(png.pixels(2, 0), nothing);
  EXPECT_NE(png.pixels(0, 0), picture("crypto-material").pixels(0, 0));  // the names differ
}

TEST(Aov, LevelsAndAnisotropyAreFalseColours) {
  const PngImage levels = picture("mip-level"), ratios = picture("anisotropy");
  EXPECT_EQ(levels.pixels(0, 0), (Rgba8{0, 255, 255, 255}));    // level 4: half around the circle from red
  EXPECT_EQ(levels.pixels(1, 0), (Rgba8{255, 255, 255, 255}));  // magnified
  EXPECT_EQ(levels.pixels(2, 0), (Rgba8{0, 0, 0, 0}));          // nothing
  EXPECT_GT(ratios.pixels(0, 0).g, 240);
  EXPECT_LT(ratios.pixels(1, 0).g, 10);
  EXPECT_EQ(ratios.pixels(2, 0).a, 0);
}

TEST(Aov, ChannelsAreNamedAsPipelinesExpectThem) {
  const Frame f = frame();
  const Scene s = scene();
  std::string names;
  for (const Aov& aov : aovs()) {
    DataChannels channels;
    aov.add_channels(f, s, channels);
    for (const DataChannel& c : channels.list) names += c.name + ' ';
  }
  EXPECT_EQ(names,
            "Z N.X N.Y N.Z P.X P.Y P.Z albedo.R albedo.G albedo.B UV.U UV.V motion.X motion.Y flow.X flow.Y objectId "
            "materialId primId CryptoObject00.R CryptoObject00.G CryptoObject00.B CryptoObject00.A CryptoObject01.R "
            "CryptoObject01.G CryptoObject01.B CryptoObject01.A CryptoObject02.R CryptoObject02.G CryptoObject02.B "
            "CryptoObject02.A CryptoMaterial00.R CryptoMaterial00.G CryptoMaterial00.B CryptoMaterial00.A "
            "CryptoMaterial01.R CryptoMaterial01.G CryptoMaterial01.B CryptoMaterial01.A CryptoMaterial02.R "
            "CryptoMaterial02.G CryptoMaterial02.B CryptoMaterial02.A mipLevel anisotropy diffuse.R "
            "diffuse.G diffuse.B specular.R specular.G specular.B transmission.R transmission.G transmission.B "
            "emission.R emission.G emission.B coverage error ");
}

TEST(Aov, ChannelsAreTheValuesThemselves) {
  const Frame f = frame();
  DataChannels channels;
  aov_of("normal").add_channels(f, {}, channels);
  aov_of("primitive-id").add_channels(f, {}, channels);
  const auto value = [&](std::size_t channel, std::size_t pixel) {
    return channels.list[channel].value[pixel * channels.list[channel].step];
  };
  EXPECT_EQ(value(0, 1), -1);
  EXPECT_EQ(value(2, 0), 1);
  EXPECT_EQ(channels.list[3].number[2], Frame::no_id);
}

TEST(Aov, FloatMapsHoldTheValues) {
  const auto text = [&](std::string_view name) {
    const auto bytes = encode_data_pfm(aov_of(name), frame(), scene());
    return bytes ? std::string(bytes->begin(), bytes->end()) : "none";
  };
  const auto floats = [](std::initializer_list<float> values) {
    return std::string(reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(float));
  };
  EXPECT_EQ(text("depth"), "Pf\n3 1\n-1.0\n" + floats({2, 6, std::numeric_limits<float>::infinity()}));
  EXPECT_EQ(text("motion"), "PF\n3 1\n-1.0\n" + floats({4, 0, 0, 0, 2, 0, 0, 0, 0}));
  EXPECT_EQ(text("crypto-object"), "none");
}

TEST(Aov, CoverageIsAShare) {
  const PngImage png = picture("coverage");
  EXPECT_EQ(png.pixels16(0, 0).r, 65535);
  EXPECT_EQ(png.pixels16(1, 0).r, 32768);
  EXPECT_EQ(png.pixels16(2, 0).r, 0);
}

TEST(Aov, ErrorIsShownAgainstTheGreatestAndTellsIt) {
  const PngImage png = picture("error");
  EXPECT_EQ(png.pixels16(0, 0).r, 65535);
  EXPECT_EQ(png.pixels16(1, 0).r, 32768);
  EXPECT_EQ(png.pixels16(2, 0).r, 0);
  const std::vector<std::uint8_t> bytes = encode_data_png(aovs().back(), frame(), {});
  EXPECT_NE(std::string(bytes.begin(), bytes.end()).find(std::string("tEXtgreatest\0000.003", 18)), std::string::npos);
}

}  // namespace
}  // namespace zoneplate
