// SPDX-License-Identifier: Apache-2.0
// Colour profiles and orientations on their way through the verbs: tests that run the built program.
#include "zoneplate/imaging/filter/color.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "zoneplate/codec/color/icc_for_test.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/codec/inspect/exif_for_test.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/system/tiff_file_for_test.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/image/orientation.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/library.h"
#include "zoneplate/os/program_for_test.h"

namespace zoneplate {
namespace {

constexpr ExrChromaticities aces = {0.7347f, 0.2653f, 0, 1, 0.0001f, -0.077f, 0.32168f, 0.33767f};

/// Colours without steps, but for a slanted edge in the lower half.
Rgba8Image ramps() {
  Rgba8Image image(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const auto code = [](int v) { return static_cast<std::uint8_t>(v); };
      image(x, y) = y < 32                ? Rgba8{code(4 * x), code(8 * y), code(255 - 4 * x), 255}
                    : 5 * y < 4 * x + 180 ? Rgba8{250, 20, 10, 255}
                                          : Rgba8{10, 20, 200, 255};
    }
  return image;
}

class Colors : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    if (!open_library(Library::Lcms)) GTEST_SKIP() << "liblcms2-2 is not installed";
    if (!open_library(Library::OpenExr)) GTEST_SKIP() << "libopenexr-3-1-30 is not installed";
  }
  std::vector<std::uint8_t> file(const std::string& name) const {
    const FileBytes bytes((place / name).string());
    return {bytes.bytes().begin(), bytes.bytes().end()};
  }
  ColorProfile profile(const std::string& name) const { return read_file_color(file(name)).profile; }
  Rgba8Image codes(const std::string& name) const { return decode_png(file(name), name).pixels; }
  metrics::Picture srgb(const std::string& name) const { return metrics::load_picture((place / name).string()); }
  std::string succeed(const std::string& arguments) const {
    const ProgramAnswer answer = run(arguments);
    EXPECT_EQ(answer.code, 0) << arguments << answer.out;
    return answer.out;
  }
  /// The greatest difference of sRGB codes.
  int apart(const std::string& a, const std::string& b) const {
    const Rgba8Image p = quantize8(srgb(a).display), q = quantize8(srgb(b).display);
    EXPECT_EQ(p.width(), q.width());
    int most = 0;
    for (std::size_t i = 0; i < p.values().size(); ++i)
      for (const auto channel : {&Rgba8::r, &Rgba8::g, &Rgba8::b, &Rgba8::a})
        most = std::max(most, std::abs(p.values()[i].*channel - q.values()[i].*channel));
    return most;
  }
};

TEST_F(Colors, FiltersOfCodesKeepThemAndTheirProfile) {
  const ColorProfile profiles[] = {
      {.icc = icc_display_p3()},
      {.gamma = 100000},
      {.gamma = 45455},
      {.cicp = {{9, 16, 0, 1}}},
      {.cicp = {{12, 13, 0, 1}}, .icc = icc_display_p3()},
      {.gamma = 55556, .primaries = {{31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000}}},
      {.icc = icc_of_table()}};
  save("plain.png", encode_png(ramps()));
  succeed("filter plain.png --aa smaa -o plain_out.png");
  EXPECT_TRUE(profile("plain_out.png").empty());
  for (const ColorProfile& one : profiles) {
    save("in.png", encode_png(ramps(), {.profile = one}));
    for (const char* how : {"--aa smaa -o out.png", "--aa smaa --bit-depth 16 -o out.png"}) {
      EXPECT_EQ(succeed(fmt::format("filter in.png {}", how)), "");
      EXPECT_EQ(profile("out.png"), one);
      EXPECT_EQ(codes("out.png"), codes("plain_out.png"));
    }
    succeed("filter in.png --upscale lanczos:scale=2 -o out.png");
    EXPECT_EQ(profile("out.png"), one);
  }
  for (const char* name : {"out.jpg", "out.webp"}) {
    save("in.png", encode_png(ramps(), {.profile = profiles[0]}));
    EXPECT_EQ(succeed(fmt::format("filter in.png --aa smaa -o {}", name)), "");
    EXPECT_EQ(profile(name), profiles[0]);
  }
  save("in.jpg", encode_jpeg(ramps(), 100, icc_display_p3()));
  save("in.webp", encode_webp(ramps(), false, std::nullopt, icc_display_p3()));
  for (const char* name : {"in.jpg", "in.webp"}) {
    succeed(fmt::format("filter {} --aa smaa -o out.png", name));
    EXPECT_EQ(profile("out.png"), profiles[0]);
  }
}

// A background is a colour of sRGB, and is seen as that whatever the space of the image is.
TEST_F(Colors, BackgroundsAreColoursOfSrgb) {
  constexpr Rgba8 behind{200, 40, 90, 255};
  const auto near_behind = [&](const std::string& name, float tolerance) {
    const Rgba8Image found = quantize8(srgb(name).display);
    for (const auto channel : {&Rgba8::r, &Rgba8::g, &Rgba8::b, &Rgba8::a})
      EXPECT_NEAR(found(20, 4).*channel, behind.*channel, tolerance) << name;
  };
  const auto clear_above = [](Rgba8Image image) {
    for (int y = 0; y < 32; ++y) std::ranges::fill(image.row(y), Rgba8{10, 250, 20, 0});
    return image;
  };
  for (const ColorProfile& one :
       {ColorProfile{.icc = icc_display_p3()}, ColorProfile{.gamma = 100000}, ColorProfile{.cicp = {{9, 16, 0, 1}}}}) {
    save("in.png", encode_png(clear_above(ramps()), {.profile = one}));
    EXPECT_EQ(succeed("filter in.png --aa smaa --background '#c8285a' -o out.png --bit-depth 16"), "");
    EXPECT_EQ(profile("out.png"), one);
    near_behind("out.png", 1);
    EXPECT_EQ(codes("out.png")(5, 60), ramps()(5, 60));
  }
  // Of a space that light gives no codes of, the image becomes sRGB, but not where the background is not seen.
  save("in.png", encode_png(clear_above(ramps()), {.profile = {.icc = icc_of_table()}}));
  EXPECT_TRUE(
      contains(succeed("filter in.png --aa smaa --background '#c8285a' -o out.png"), "gives light but no codes"));
  EXPECT_TRUE(profile("out.png").empty());
  near_behind("out.png", 0);
  save("in.png", encode_png(ramps(), {.profile = {.icc = icc_of_table()}}));
  EXPECT_EQ(succeed("filter in.png --aa smaa --background '#c8285a' -o out.png"), "");
  EXPECT_FALSE(profile("out.png").empty());

  const LinearImage clear(32, 32, {0, 0, 0, 0});
  save("in.exr", encode_exr(32, 32, rgba_channels(clear), {{"chromaticities", aces}}));
  succeed("filter in.exr --aa smaa --background '#c8285a' -o out.exr");
  EXPECT_EQ(read_exr_part(file("out.exr"))->chromaticities, aces);
  near_behind("out.exr", 1);
}

TEST_F(Colors, TiffHasItsProfileAndOrientation) {
  if (!open_library(Library::Tiff)) GTEST_SKIP() << "libtiff6 is not installed";
  const Rgba8Image upright = ramps(), stored = oriented(upright, 3);
  TiffForTest tiff{.width = 64, .height = 64, .orientation = 3, .profile = icc_display_p3()};
  for (const Rgba8& c : stored.values()) tiff.data.insert(tiff.data.end(), {c.r, c.g, c.b});
  save("in.tif", tiff_of(tiff));
  save("in.png", encode_png(upright, {.profile = {.icc = icc_display_p3()}}));
  EXPECT_EQ(apart("in.tif", "in.png"), 0);
  EXPECT_TRUE(contains(succeed("metrics in.png in.tif"), "identical"));
  for (const char* name : {"in.tif", "in.png"})
    EXPECT_EQ(succeed(fmt::format("filter {0} --aa smaa -o {0}.png", name)), "");
  EXPECT_EQ(codes("in.tif.png"), codes("in.png.png"));
  EXPECT_EQ(profile("in.tif.png").icc, icc_display_p3());
  for (const char* name : {"in.tif", "in.png"}) succeed(fmt::format("signal resample {0} --size 50% -o {0}.pfm", name));
  EXPECT_EQ(file("in.tif.pfm"), file("in.png.pfm"));

  // Light has no codes that a profile could describe.
  const float light[] = {0.5f, 2, 0};
  tiff = {.width = 1, .height = 1, .bits = 32, .kind = SAMPLEFORMAT_IEEEFP, .profile = icc_display_p3()};
  tiff.data.resize(sizeof light);
  std::memcpy(tiff.data.data(), light, sizeof light);
  save("light.tif", tiff_of(tiff));
  EXPECT_TRUE(contains(succeed("filter light.tif --upscale bilinear:scale=2 -o light.exr"), "is not applied to light"));
  EXPECT_EQ(srgb("light.tif").linear(0, 0), (Linear{0.5f, 2, 0, 1}));
}

TEST_F(Colors, OutputsThatCannotStateASpaceAreConverted) {
  save("in.png", encode_png(ramps(), {.profile = {.gamma = 100000}}));
  const std::string said = succeed("filter in.png --aa smaa -o out.webp");
  EXPECT_TRUE(contains(said, "in.png: has gAMA 1, which out.webp cannot state: its colours are converted to sRGB"))
      << said;
  EXPECT_TRUE(profile("out.webp").empty());
  const Rgba8Image exact = quantize8(srgb("in.png").display), found = quantize8(srgb("out.webp").display);
  for (int x = 0; x < 64; x += 7) EXPECT_EQ(found(x, 10), exact(x, 10));
  // Grey pixels become red, green and blue, which a profile of grey does not describe.
  const auto grey = encode_png(Plane<std::uint16_t>(8, 8, std::uint16_t{30000}), {.is_srgb = false});
  const IccBytes icc = icc_of({.pixels = "GRAY"}, {{"desc", icc_text("grey")}, {"kTRC", icc_power(1.8)}});
  const auto chunks = encode_png(Rgba8Image(1, 1), {.profile = {.icc = icc}});
  std::vector<std::uint8_t> chunk;
  for_png_chunks(chunks, [&](std::string_view name, std::span<const std::uint8_t> data) {
    if (name == "iCCP") chunk.assign(data.begin(), data.end());
    return true;
  });
  save("grey.png", png_with(grey, "iCCP", chunk));
  succeed("filter grey.png --aa smaa -o out.png");
  EXPECT_TRUE(profile("out.png").empty());
  EXPECT_EQ(codes("out.png")(4, 4).r, encode_srgb8(std::pow(30000 / 65535.0f, 1.8f)));
  for (const char* options : {"", "--codes "}) {
    const std::string told = succeed(fmt::format("signal resample grey.png --size 50% {}-o out.png", options));
    EXPECT_TRUE(contains(told, "which out.png cannot state: its colours are converted to sRGB")) << told;
  }
  EXPECT_EQ(codes("out.png")(2, 2).r, encode_srgb8(std::pow(30000 / 65535.0f, 1.8f)));
}

TEST_F(Colors, ResamplingDecodesAndEncodesByTheProfile) {
  for (const ColorProfile& one :
       {ColorProfile{.icc = icc_display_p3()}, ColorProfile{.gamma = 100000}, ColorProfile{.cicp = {{9, 16, 0, 1}}},
        ColorProfile{.icc = icc_of_primaries(p3_primaries, icc_table({0, 0.1, 0.3, 0.6, 1}), "a table")}}) {
    save("in.png", encode_png(ramps(), {.profile = one}));
    for (const char* options : {"", "--codes"}) {
      succeed(fmt::format("signal resample in.png --size 100% --kernel box {} -o out.png", options));
      EXPECT_EQ(profile("out.png"), one);
      EXPECT_EQ(codes("out.png"), ramps()) << options;
    }
    for (const char* verb : {"convolve in.png --kernel 1", "filter in.png --low-pass 0.7"}) {
      succeed(fmt::format("signal {} -o out.png", verb));
      EXPECT_EQ(profile("out.png"), one);
      EXPECT_LE(apart("out.png", "in.png"), 1) << verb;
    }
  }
  // The mean of black and white is half of the light.
  Rgba8Image halves(2, 2, {0, 0, 0, 255});
  halves(0, 0) = halves(1, 1) = {255, 255, 255, 255};
  save("in.png", encode_png(halves, {.profile = {.gamma = 100000}}));
  succeed("signal resample in.png --size 50% --kernel box -o out.png");
  EXPECT_EQ(codes("out.png")(0, 0).g, 128);
  // A space without codes of light is left for sRGB, and files of light have that of Rec.709.
  save("in.png", encode_png(ramps(), {.profile = {.icc = icc_of_table()}}));
  succeed("signal resample in.png --size 100% --kernel box -o out.png");
  EXPECT_TRUE(profile("out.png").empty());
  EXPECT_LE(apart("out.png", "in.png"), 1);
  save("in.png", encode_png(ramps(), {.profile = {.icc = icc_display_p3()}}));
  succeed("signal resample in.png --size 100% --kernel box -o out.exr");
  EXPECT_LE(apart("out.exr", "in.png"), 1);
}

TEST_F(Colors, ChromaticitiesOfExrAreKept) {
  LinearImage light(32, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      light(x, y) = {static_cast<float>(x) / 64, static_cast<float>(y) / 64, x > y ? 0.5f : 0.1f, 1};
  light(1, 1).r = 1000, light(2, 1).g = -2;
  save("in.exr", encode_exr(32, 32, rgba_channels(light), {{"chromaticities", aces}}));
  for (const char* verb : {"filter in.exr --aa smaa", "filter in.exr --upscale bilinear:scale=2",
                           "signal resample in.exr --size 100% --kernel box", "signal convolve in.exr --kernel 1"}) {
    succeed(fmt::format("{} -o out.exr", verb));
    EXPECT_EQ(read_exr_part(file("out.exr"))->chromaticities, aces) << verb;
  }
  const LinearImage stored = decode_exr(file("in.exr"), "in"), found = decode_exr(file("out.exr"), "out");
  EXPECT_EQ(found, stored);  // of the last one
  const std::string said = succeed("filter in.exr --aa smaa -o out.exr");
  const LinearImage filtered = decode_exr(file("out.exr"), "out");
  int blended = 0;
  for (std::size_t i = 0; i < stored.values().size(); ++i) blended += filtered.values()[i] != stored.values()[i];
  EXPECT_GT(blended, 0);
  EXPECT_LT(blended, 200);
  EXPECT_EQ(filtered(20, 4), stored(20, 4));
  // Codes are those of sRGB, which the chromaticities do not describe.
  succeed("signal resample in.exr --codes --size 100% --kernel box -o out.exr");
  EXPECT_FALSE(read_exr_part(file("out.exr"))->chromaticities);
  // Formats without chromaticities have light of Rec.709 primaries.
  succeed("signal resample in.exr --size 100% --kernel box -o out.pfm");
  EXPECT_LE(apart("out.pfm", "in.exr"), 1);
  const std::string converted = succeed("filter in.exr --aa smaa -o out.png");
  EXPECT_TRUE(contains(converted, "has its chromaticities, which out.png cannot state")) << converted;
  EXPECT_TRUE(contains(converted, "light outside 0 to 1, which is clamped")) << converted;
  EXPECT_EQ(quantize8(srgb("out.png").display)(20, 4), quantize8(srgb("in.exr").display)(20, 4));
}

// A layer of data has no colours that chromaticities would convert, whichever part it lies in.
TEST_F(Colors, ChromaticitiesAreThoseOfColours) {
  const LinearImage light(16, 16, {0.5f, 0.25f, 0.125f, 1}), normal(16, 16, {0.6f, -0.48f, 0.64f, 1});
  std::vector<ExrChannel> channels = rgba_channels(light), data = rgba_channels(normal);
  for (const auto& [slot, name] : {std::pair(0, "N.X"), std::pair(1, "N.Y"), std::pair(2, "N.Z")}) {
    data[static_cast<std::size_t>(slot)].name = name;
    channels.push_back(data[static_cast<std::size_t>(slot)]);
  }
  save("in.exr", encode_exr(16, 16, channels, {{"chromaticities", aces}}));
  data.pop_back();
  const auto part = [](const std::vector<ExrChannel>& of, const ExrAttributes& attributes, const std::string& name) {
    const ExrWindow window{0, 0, 15, 15};
    return encode_exr_part({.data = window, .display = window, .channels = of, .attributes = attributes}, name);
  };
  const std::vector<ExrPartBytes> parts = {part(rgba_channels(light), {}, "plain"),
                                           part(rgba_channels(light), {{"chromaticities", aces}}, "wide"),
                                           part(data, {{"chromaticities", aces}}, "N")};
  save("parts.exr", join_exr_parts(parts));
  const auto stored = [&](const std::string& arguments) {
    succeed(arguments + " -o out.pfm");
    return srgb("out.pfm").linear(8, 8);
  };
  const Linear whole = stored("signal resample in.exr --layer N --size 100% --kernel box");
  EXPECT_NEAR(whole.r, 0.6f, 1e-3f);
  EXPECT_NEAR(whole.g, -0.48f, 1e-3f);
  EXPECT_NEAR(whole.b, 0.64f, 1e-3f);
  EXPECT_EQ(stored("filter in.exr --layer N --upscale bilinear:scale=2"), whole);
  EXPECT_EQ(stored("filter parts.exr --layer N --upscale bilinear:scale=2"), whole);
  // The luminance of the data itself, by Rec.709's weights.
  EXPECT_TRUE(contains(succeed("signal spectrum in.exr --layer N"), "mean -0.1695"))
      << succeed("signal spectrum in.exr --layer N");
  // Colours are those of their own part.
  const auto is_near = [](const Linear& a, const Linear& b) {
    return std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) < 0.01f;
  };
  const char* const resample = "signal resample parts.exr --size 100% --kernel box --layer ";
  EXPECT_TRUE(is_near(stored(std::string(resample) + "plain"), light(0, 0)));
  EXPECT_FALSE(is_near(stored(std::string(resample) + "wide"), light(0, 0)));
  // Layers of data are equal whatever the colours beside them mean, which is said.
  save("plain.exr", encode_exr(16, 16, channels));
  const ProgramAnswer compared = run("metrics in.exr plain.exr --layer N --metric psnr --threshold 200");
  EXPECT_EQ(compared.code, 0) << compared.out;
  EXPECT_TRUE(contains(compared.out, "the colours beside the layer mean chromaticities 0.7347")) << compared.out;
}

// What is computed on codes is no light, which the file of its origin would hold beside its other layers.
TEST_F(Colors, CodesOfLightAreNotPutInPlaceOfIt) {
  const LinearImage light(16, 16, {0.5f, 0.25f, 0.125f, 1});
  const std::vector<float> depth(256, 3.0f);
  std::vector<ExrChannel> channels = rgba_channels(light);
  channels.push_back({"Z", ExrType::Float, depth.data(), nullptr, 1});
  save("in.exr", encode_exr(16, 16, channels, {{"chromaticities", rec709_chromaticities}, {"whiteLuminance", 100.0f}}));
  const auto names = [&] { return exr_channel_names(file("out.exr")); };
  EXPECT_FALSE(contains(succeed("signal resample in.exr --size 100% --kernel box -o out.exr"), "warning"));
  EXPECT_EQ(names(), (std::vector<std::string>{"A", "B", "G", "R", "Z"}));
  EXPECT_TRUE(read_exr_part(file("out.exr"))->find("whiteLuminance"));
  EXPECT_TRUE(contains(succeed("signal resample in.exr --codes --size 100% --kernel box -o out.exr"), "lacks"));
  EXPECT_EQ(names(), (std::vector<std::string>{"A", "B", "G", "R"}));
  EXPECT_FALSE(read_exr_part(file("out.exr"))->find("whiteLuminance"));
}

TEST_F(Colors, BrokenProfilesAreNamedAndTheImageIsSrgb) {
  const IccBytes p3 = icc_display_p3();
  const IccBytes broken[] = {{p3.begin(), p3.begin() + 200},
                             IccBytes(500, 7),
                             icc_of_primaries(p3_primaries, icc_srgb_curve(), "", {.pixels = "CMYK"}),
                             icc_of_primaries(p3_primaries, icc_srgb_curve(), "", {.kind = "link"}),
                             icc_of({.pixels = "GRAY"}, {{"kTRC", icc_power(1.8)}})};
  const char* const causes[] = {"is cut off", "has no header", "is of CMYK pixels", "is of class link",
                                "is of GRAY pixels"};
  for (std::size_t i = 0; i < std::size(broken); ++i) {
    save("in.png", encode_png(ramps(), {.profile = {.icc = broken[i]}}));
    for (const char* verb : {"filter in.png --aa smaa", "signal resample in.png --size 100% --kernel box"}) {
      const std::string said = succeed(fmt::format("{} -o out.png", verb));
      EXPECT_TRUE(contains(said, fmt::format("warning: in.png: its ICC profile {}", causes[i]))) << said;
      EXPECT_TRUE(contains(said, "the image is taken as sRGB")) << said;
      EXPECT_TRUE(profile("out.png").empty());
    }
  }
}

TEST_F(Colors, ImagesAreTurnedAndTexturesAreNot) {
  Rgba8Image stored(32, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x)
      stored(x, y) = {static_cast<std::uint8_t>(8 * x), static_cast<std::uint8_t>(16 * y), 0, 255};
  const Rgba8Image shown = oriented(stored, 6);
  save("turned.png", png_with(encode_png(stored), "eXIf", exif_of(6)));
  save("turned.jpg", turned_jpeg(encode_jpeg(stored, 100), 6));
  save("shown.png", encode_png(shown));
  for (const char* verb : {"filter turned.png --aa fxaa", "signal resample turned.png --size 100% --kernel box"}) {
    succeed(fmt::format("{} -o out.png", verb));
    EXPECT_EQ(codes("out.png").width(), 16);
    EXPECT_EQ(read_file_color(file("out.png")).orientation, 1);
    EXPECT_EQ(codes("out.png")(3, 20), shown(3, 20));
  }
  succeed("filter turned.jpg --aa fxaa -o out.jpg");
  EXPECT_EQ(srgb("out.jpg").width(), 16);
  EXPECT_EQ(read_file_color(file("out.jpg")).orientation, 1);
  EXPECT_TRUE(contains(succeed("metrics shown.png turned.png"), "identical"));
  EXPECT_TRUE(contains(succeed("texture levels turned.png"), "32 × 16"));
  succeed("texture normal-from-height turned.png -o out.png");
  EXPECT_EQ(codes("out.png").width(), 32);
}

TEST_F(Colors, MetricsCompareInOneSpaceAndSaySo) {
  save("plain.png", encode_png(ramps()));
  save("linear.png", encode_png(ramps(), {.profile = {.gamma = 100000}}));
  save("p3.png", encode_png(ramps(), {.profile = {.icc = icc_display_p3()}}));
  save("p3_cicp.png", encode_png(ramps(), {.profile = {.cicp = {{12, 13, 0, 1}}}}));
  save("srgb.png",
       encode_png(ramps(), {.profile = {.icc = icc_of_primaries(srgb_icc_primaries, icc_srgb_curve(), "s")}}));
  save("converted.png", encode_png(quantize8(srgb("p3.png").display)));
  const ProgramAnswer apart = run("metrics plain.png linear.png --metric mae");
  EXPECT_EQ(apart.code, 1);
  EXPECT_TRUE(contains(apart.out,
                       "the values mean sRGB in the reference, gAMA 1 in the test image: they are compared "
                       "after conversion to sRGB"))
      << apart.out;
  EXPECT_EQ(run("metrics plain.png linear.png --metric psnr --threshold 30").code, 1);
  const std::string same = succeed("metrics p3.png p3.png --metric psnr");
  EXPECT_TRUE(contains(same, "both have the ICC profile 'Display P3': the values are compared as they are")) << same;
  EXPECT_EQ(run("metrics p3.png p3_cicp.png --metric psnr --threshold 55").code, 0);
  EXPECT_EQ(run("metrics p3.png converted.png --metric psnr --threshold 55").code, 0);
  EXPECT_EQ(run("metrics p3.png plain.png --metric psnr --threshold 40").code, 1);
  const std::string srgb = succeed("metrics plain.png srgb.png --metric psnr --threshold 200");
  EXPECT_TRUE(contains(srgb, "they are compared as they are")) << srgb;
  const LinearImage light(16, 16, {0.5f, 0.25f, 0.125f, 1});
  LinearImage wide = light;
  save("light.exr", encode_exr(16, 16, rgba_channels(light)));
  const std::optional<Matrix3> back = inverse(rec709_from({0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767}));
  ASSERT_TRUE(back);
  for (Linear& c : wide.values()) {
    const auto row = [&](std::size_t i) {
      return static_cast<float>((*back)[3 * i] * 0.5 + (*back)[3 * i + 1] * 0.25 + (*back)[3 * i + 2] * 0.125);
    };
    c = {row(0), row(1), row(2), 1};
  }
  save("wide.exr", encode_exr(16, 16, rgba_channels(wide), {{"chromaticities", aces}}));
  EXPECT_EQ(run("metrics light.exr wide.exr --metric psnr --threshold 60").code, 0);
}

}  // namespace
}  // namespace zoneplate
