// SPDX-License-Identifier: Apache-2.0
// Layers of EXR images in every verb that opens images: tests that run the built program.
#include "zoneplate/process/exr_layer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/program_for_test.h"

namespace zoneplate {
namespace {

constexpr int side = 12;

class ExrLayers : public ProgramTest {
 protected:
  std::vector<std::uint8_t> bytes_of(const std::string& name) const {
    const std::string text = text_of(place / name);
    return {text.begin(), text.end()};
  }
  LinearImage layer_of(const std::string& name, const std::string& layer = {}, ExrArea area = ExrArea::Display) const {
    return decode_exr_as_stored(bytes_of(name), name, 1 << 20, {layer, area});
  }
  /// A file of constant channels.
  void save_exr(const std::string& name, const std::vector<std::pair<std::string, float>>& values,
                ExrType type = ExrType::Half, const ExrWindow& data = {0, 0, side - 1, side - 1},
                const ExrAttributes& attributes = {}) const {
    std::vector<std::vector<float>> planes;
    ExrPartImage part{data, {0, 0, side - 1, side - 1}, {}, attributes};
    for (const auto& [channel, value] : values) planes.emplace_back(data.pixels(), value);
    for (std::size_t i = 0; i < values.size(); ++i)
      part.channels.push_back({.name = values[i].first, .type = type, .value = planes[i].data()});
    const ExrPartBytes only = encode_exr_part(std::move(part));
    save(name, join_exr_parts({only}));
  }
  /// As Blender writes it: every layer has the name of its view layer.
  void save_layers(const std::string& name, float red = 0.5f) const {
    save_exr(name, {{"ViewLayer.Combined.A", 1},
                    {"ViewLayer.Combined.B", 0.25f},
                    {"ViewLayer.Combined.G", 0.25f},
                    {"ViewLayer.Combined.R", red},
                    {"ViewLayer.Depth.Z", 4},
                    {"ViewLayer.Normal.X", -0.75f},
                    {"ViewLayer.Normal.Y", 0.5f},
                    {"ViewLayer.Normal.Z", 0.125f}});
  }
  /// Requires this exit code and text.
  void expect_answer(const std::string& arguments, int code, const std::string& text) const {
    const ProgramAnswer answer = run(arguments);
    EXPECT_EQ(answer.code, code) << arguments << "\n" << answer.out;
    EXPECT_TRUE(contains(answer.out, text)) << arguments << "\n" << answer.out;
  }
};

constexpr const char* layers = "ViewLayer.Combined, ViewLayer.Depth, ViewLayer.Normal";

TEST_F(ExrLayers, TheObviousLayerIsReadAndNamed) {
  save_layers("a.exr");
  const std::string said =
      fmt::format("a.exr: reads layer ViewLayer.Combined; --layer chooses one of {}", std::string(layers));
  expect_answer("filter a.exr --upscale bilinear --size 24x24 -o b.exr", 0, said);
  expect_answer("signal resample a.exr --size 50% -o b.pfm", 0, said);
  expect_answer("metrics a.exr a.exr", 0, said);
  expect_answer("texture levels a.exr", 0, said);
  const LinearImage small = decode_pfm(bytes_of("b.pfm"), "b.pfm");
  EXPECT_EQ(small(0, 0), (Linear{0.5f, 0.25f, 0.25f, 1}));
}

TEST_F(ExrLayers, ALayerIsChosenByName) {
  save_layers("a.exr"), save_layers("b.exr", 0.75f);
  const auto normal = [&](const std::string& name) {
    const LinearImage image = decode_pfm(bytes_of(name), name);
    EXPECT_EQ(image(1, 1), (Linear{-0.75f, 0.5f, 0.125f, 1}));
  };
  for (const char* const name : {"ViewLayer.Normal", "Normal"}) {
    expect_answer(fmt::format("signal convolve a.exr --kernel 1 --layer {} -o n.pfm", name), 0, "a.exr");
    normal("n.pfm");
    expect_answer(fmt::format("filter a.exr --layer {} --upscale bilinear --size 24x24 -o n.pfm", name), 0, "");
    normal("n.pfm");
  }
  EXPECT_EQ(run("metrics a.exr b.exr --layer Normal --metric mae --threshold 0").code, 0);
  EXPECT_EQ(run("metrics a.exr b.exr --layer Combined --metric mae --threshold 0").code, 1);
  expect_answer("metrics a.exr b.exr --layer Normal", 1, "ViewLayer.Combined.R in 144 pixels");
  expect_answer("texture normal-from-height a.exr --layer Depth -o n.png", 0, "least z of a normal 1.000");
}

TEST_F(ExrLayers, AnUnknownLayerIsRefusedWithTheList) {
  save_layers("a.exr");
  save("p.pfm", encode_pfm(LinearImage(side, side, {1, 1, 1, 1})));
  const std::string text = fmt::format("a.exr: EXR: has no layer 'beauty', only: {}", std::string(layers));
  for (const char* const verb :
       {"filter a.exr --upscale bilinear -o b.exr", "metrics a.exr a.exr", "signal resample a.exr --size 50% -o b.exr",
        "signal spectrum a.exr", "texture levels a.exr", "sdf to-mask a.exr"})
    expect_answer(std::string(verb) + " --layer beauty", 2, text);
  expect_answer("compare triangles --aa none --reference a.exr --layer beauty --size 12x12 -o out", 2, text);
  expect_answer("compare triangles --aa none --layer beauty --size 12x12 -o out", 2, "--layer: requires --reference");
  expect_answer("signal resample p.pfm --size 50% --layer beauty -o b.exr", 2, "p.pfm: is no EXR image");
  expect_answer("signal resample zone-plate --size 50% --layer beauty -o b.exr", 2, "zone-plate: is a pattern");
}

TEST_F(ExrLayers, SignalKeepsWhatElseTheFileHas) {
  save_exr("a.exr", {{"A", 1}, {"B", -2}, {"G", 3}, {"R", 70000}, {"Z", 5}, {"n.X", -1}}, ExrType::Float,
           {-4, -4, side + 3, side + 3}, {{"timeCode", ExrTimeCode{7}}, {"owner", std::string("me")}});
  for (const char* const verb : {"convolve a.exr --kernel gaussian:sigma=1", "filter a.exr --low-pass 0.3",
                                 "resample a.exr --size 100% --kernel nearest"}) {
    expect_answer(std::string("signal ") + verb + " -o b.exr", 0, "a.exr");
    const std::vector<std::uint8_t> file = bytes_of("b.exr");
    const ExrPart part = *read_exr_part(file);
    EXPECT_EQ(part.data.left, -4) << verb;
    EXPECT_EQ(part.data.bottom, side + 3);
    EXPECT_EQ(part.display.right, side - 1);
    EXPECT_EQ(exr_channel_names(file), (std::vector<std::string>{"A", "B", "G", "R", "Z", "n.X"}));
    for (const char* const name : {"timeCode", "owner"})
      EXPECT_TRUE(std::ranges::find(part.attributes, name, &ExrAttributeView::name) != part.attributes.end());
    const Linear middle = layer_of("b.exr")(6, 6);
    EXPECT_NEAR(middle.r, 70000, 0.1f) << verb;
    EXPECT_NEAR(middle.b, -2, 1e-5f);
    EXPECT_EQ(layer_of("b.exr", "Z")(0, 0).r, 5);
  }
  expect_answer("signal resample a.exr --size 50% -o b.exr", 0,
                "b.exr: lacks what a.exr has beside the layer: Z, n.X, the pixels outside the display window");
  EXPECT_EQ(layer_of("b.exr").width(), side / 2);
}

TEST_F(ExrLayers, LinearUpscalersKeepSignRangeAndType) {
  save_exr("a.exr", {{"A", 0}, {"B", -0.25f}, {"G", 2}, {"R", 40000}}, ExrType::Float, {0, 0, side - 1, side - 1},
           {{"timeCode", ExrTimeCode{7}}});
  for (const char* const method : {"bilinear", "bicubic", "lanczos"}) {
    const ProgramAnswer answer = run(fmt::format("filter a.exr --upscale {} --size 24x24 -o b.exr", method));
    EXPECT_EQ(answer.code, 0);
    EXPECT_FALSE(contains(answer.out, "warning")) << answer.out;
    const Linear c = layer_of("b.exr")(7, 7);
    EXPECT_NEAR(c.r, 40000, 0.02f) << method;
    EXPECT_NEAR(c.g, 2, 1e-6f);
    EXPECT_NEAR(c.b, -0.25f, 1e-6f);
    EXPECT_EQ(c.a, 0);
    const std::vector<std::uint8_t> file = bytes_of("b.exr");
    const ExrPart part = *read_exr_part(file);
    EXPECT_EQ(part.channels[3].type, ExrType::Float);
    EXPECT_TRUE(std::ranges::find(part.attributes, "timeCode", &ExrAttributeView::name) != part.attributes.end());
  }
  for (const char* const method : {"fsr1", "nis", "sgsr1"})
    expect_answer(fmt::format("filter a.exr --upscale {} --size 24x24 -o b.exr", method), 0,
                  "a.exr: this upscaler maps light to [0, 1], of pixels: 144 below 0, which count as 0, 144 with light "
                  "at alpha 0, which counts as none");
  save_exr("sun.exr", {{"B", 1000}, {"G", 1000}, {"R", 1000}}, ExrType::Float);
  expect_answer("filter sun.exr --upscale fsr1 --size 24x24 -o b.exr", 0,
                "the brightest light, 1000, which becomes 230");
  EXPECT_FALSE(contains(run("filter sun.exr --upscale fsr1:math=three --size 24x24 -o b.exr").out, "warning"));
  save_exr("h.exr", {{"B", 0.5f}, {"G", 0.5f}, {"R", 0.5f}});
  EXPECT_FALSE(contains(run("filter h.exr --upscale fsr1 --size 24x24 -o b.exr").out, "warning"));
  const std::vector<std::uint8_t> file = bytes_of("b.exr");
  EXPECT_EQ(exr_channel_names(file), (std::vector<std::string>{"B", "G", "R"}));
  EXPECT_EQ(read_exr_part(file)->channels[0].type, ExrType::Half);
}

TEST_F(ExrLayers, PixelsThatAreNotFiniteAreCountedBySignalToo) {
  save_exr("a.exr", {{"B", 1}, {"G", 1}, {"R", std::nanf("")}}, ExrType::Float);
  expect_answer("signal resample a.exr --size 50% -o b.exr", 3, "a.exr: no pixel is finite");
  LinearImage image(side, side, {1, 2, 3, 1});
  image(3, 4).g = std::numeric_limits<float>::infinity(), image(7, 7).r = std::nanf("");
  save("p.pfm", encode_pfm(image));
  expect_answer("signal resample p.pfm --size 100% --kernel nearest -o b.exr", 0,
                "p.pfm: 2 pixels are not finite, and take the mean of neighbours");
  EXPECT_EQ(layer_of("b.exr")(3, 4), (Linear{1, 2, 3, 1}));
}

TEST_F(ExrLayers, FramesKeepTheirLayers) {
  for (int i = 0; i < 3; ++i)
    save_exr(fmt::format("c.{}.exr", i),
             {{"A", 1}, {"B", 0.5f}, {"G", 0.5f}, {"R", 0.5f}, {"Z", 4}, {"motion.X", 0}, {"motion.Y", 0}},
             ExrType::Float, {0, 0, side - 1, side - 1}, {{"timeCode", ExrTimeCode{static_cast<std::uint32_t>(i)}}});
  ASSERT_EQ(run("filter c.#.exr --aa taa -o out").code, 0);
  const std::vector<std::uint8_t> file = bytes_of("out/c.2.exr");
  EXPECT_EQ(exr_channel_names(file), (std::vector<std::string>{"A", "B", "G", "R", "Z", "motion.X", "motion.Y"}));
  const ExrPart part = *read_exr_part(file);
  const auto code = std::ranges::find(part.attributes, "timeCode", &ExrAttributeView::name);
  ASSERT_TRUE(code != part.attributes.end());
  EXPECT_EQ(code->value[0], 2);
  EXPECT_EQ(layer_of("out/c.2.exr", "Z")(1, 1).r, 4);
  const ProgramAnswer large = run("filter c.#.exr --upscale taau --size 24x24 -o large");
  EXPECT_EQ(large.code, 0);
  const std::string said = "lacks what ./c.0.exr has beside the layer: Z, motion.X, motion.Y";
  EXPECT_TRUE(contains(large.out, said)) << large.out;
  EXPECT_EQ(large.out.find("lacks", large.out.find("lacks") + 1), std::string::npos);  // once
}

}  // namespace
}  // namespace zoneplate
