#include "zoneplate/cli/aov.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "zoneplate/image/png.h"

namespace zoneplate::cli {
namespace {

// Three pixels: near, far, and one where nothing is.
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
  f.error = plane(0.003f, 0.0015f, 0.0f);
  return f;
}

PngImage picture(std::string_view name) {
  for (const Aov& aov : aovs())
    if (aov.name == name) return decode_png(aov.encode(frame()), std::string(name));
  ADD_FAILURE() << "no data pass " << name;
  return {};
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
  const std::vector<std::uint8_t> bytes = aovs()[0].encode(frame());
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_NE(text.find(std::string("tEXtnear\0002", 10)), std::string::npos);
  EXPECT_NE(text.find(std::string("tEXtfar\0006", 9)), std::string::npos);
}

TEST(Aov, NormalsAreHalved) {
  const PngImage png = picture("normal");
  EXPECT_EQ(png.pixels(0, 0), (Rgba8{128, 128, 255, 255}));
  EXPECT_EQ(png.pixels(1, 0), (Rgba8{0, 128, 128, 255}));
  EXPECT_EQ(png.pixels(2, 0), nothing);
}

TEST(Aov, AlbedoIsSrgb) {
  const PngImage png = picture("albedo");
  EXPECT_EQ(png.pixels(0, 0), (Rgba8{255, 0, 124, 255}));  // encode_srgb(0.2) = 0.4845
  EXPECT_EQ(png.pixels(2, 0), nothing);
}

TEST(Aov, UvShowsFractions) {
  const PngImage png = picture("uv");
  EXPECT_EQ(png.pixels(0, 0), (Rgba8{128, 64, 0, 255}));
  EXPECT_EQ(png.pixels(1, 0), (Rgba8{191, 0, 0, 255}));
}

TEST(Aov, IdsHaveDistinctColoursAndNothingHasNone) {
  for (const char* name : {"object-id", "material-id", "primitive-id"}) {
    const PngImage png = picture(name);
    EXPECT_NE(png.pixels(0, 0), png.pixels(1, 0));
    EXPECT_GE(png.pixels(0, 0).g, 64);
    EXPECT_EQ(png.pixels(2, 0), nothing);
  }
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
  const std::vector<std::uint8_t> bytes = aovs().back().encode(frame());
  EXPECT_NE(std::string(bytes.begin(), bytes.end()).find(std::string("tEXtgreatest\0000.003", 18)), std::string::npos);
}

}  // namespace
}  // namespace zoneplate::cli
