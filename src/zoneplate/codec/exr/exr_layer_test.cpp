// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_layer.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

using Names = std::vector<std::string>;

ExrPart part(const std::string& name, const Names& channels) {
  ExrPart out{.name = name};
  for (const std::string& channel : channels) out.channels.push_back({.name = channel});
  return out;
}

Names names_of(const std::vector<ExrPart>& parts) {
  Names names;
  for (const ExrLayer& layer : exr_layers(parts)) names.push_back(layer.name);
  return names;
}

using Slots = std::array<std::string, 4>;

Slots chosen(const std::vector<ExrPart>& parts, const std::string& name) {
  return choose_exr_layer(parts, name, "a.exr").channels;
}

std::string refusal(const std::vector<ExrPart>& parts, const std::string& name, ErrorKind kind) {
  try {
    choose_exr_layer(parts, name, "a.exr");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  return "no error";
}

const std::vector<ExrPart> blender = {
    part("", {"ViewLayer.Combined.A", "ViewLayer.Combined.B", "ViewLayer.Combined.G", "ViewLayer.Combined.R",
              "ViewLayer.Depth.Z", "ViewLayer.Vector.W", "ViewLayer.Vector.X", "ViewLayer.Vector.Y",
              "ViewLayer.Vector.Z", "ViewLayer.DiffDir.B", "ViewLayer.DiffDir.G", "ViewLayer.DiffDir.R"})};

TEST(ExrLayer, EachPrefixIsALayer) {
  EXPECT_EQ(names_of(blender),
            (Names{"ViewLayer.Combined", "ViewLayer.Depth", "ViewLayer.Vector", "ViewLayer.DiffDir"}));
  EXPECT_EQ(names_of({part("", {"A", "B", "G", "R", "Z", "id", "n.X", "n.Y", "n.Z"})}),
            (Names{"RGBA", "Z", "id", "n"}));
  EXPECT_EQ(names_of({part("rgb", {"B", "G", "R", "Z"}), part("depth", {"Z"}), part("n", {"n.X", "n.Y"})}),
            (Names{"rgb", "rgb.Z", "depth", "n.n"}));
}

TEST(ExrLayer, ColorsComeFirst) {
  const auto main = choose_exr_layer(std::vector{part("", {"A", "B", "G", "R", "Z", "a.B", "a.G", "a.R"})}, "", "a");
  EXPECT_TRUE(main.is_main());
  EXPECT_EQ(main.channels, (Slots{"R", "G", "B", "A"}));
  EXPECT_EQ(chosen({part("", {"R", "Z"})}, ""), (Slots{"R", "", "", ""}));
  const auto grey = choose_exr_layer(std::vector{part("", {"A", "X", "Y"})}, "", "a");
  EXPECT_EQ(grey.kind, ExrLayer::Kind::Grey);
  EXPECT_EQ(grey.channels, (Slots{"Y", "", "", "A"}));
  const auto chroma = choose_exr_layer(std::vector{part("", {"BY", "RY", "Y"})}, "", "a");
  EXPECT_EQ(chroma.kind, ExrLayer::Kind::Chroma);
  EXPECT_EQ(chroma.channels, (Slots{"RY", "Y", "BY", ""}));
  const std::vector<ExrPart> depth_first = {part("depth", {"Z"}), part("beauty", {"B", "G", "R"})};
  const auto second = choose_exr_layer(depth_first, "", "a");
  EXPECT_EQ(second.part, 1);
  EXPECT_FALSE(second.is_main());
}

TEST(ExrLayer, OfNamedLayersTheObviousOneIsChosen) {
  EXPECT_EQ(chosen(blender, "")[0], "ViewLayer.Combined.R");
  EXPECT_EQ(chosen({part("", {"d.B", "d.G", "d.R", "Beauty.B", "Beauty.G", "Beauty.R"})}, "")[2], "Beauty.B");
  EXPECT_EQ(chosen({part("", {"x.Z", "only.B", "only.G", "only.R"})}, "")[1], "only.G");
  EXPECT_EQ(chosen({part("", {"Z"})}, "")[0], "Z");
  EXPECT_EQ(refusal({part("", {"N.X", "N.Y", "Z"})}, "", ErrorKind::Input),
            "a.exr: EXR: has no channel R, G, B or Y, and which of its layers is the image is not stated: N, Z");
  EXPECT_EQ(refusal({part("", {"d.R", "s.R"})}, "", ErrorKind::Input),
            "a.exr: EXR: has no channel R, G, B or Y, and which of its layers is the image is not stated: d, s");
}

TEST(ExrLayer, NamesMayBeShort) {
  const Slots combined = {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B",
                          "ViewLayer.Combined.A"};
  for (const std::string name : {"ViewLayer.Combined", "Combined"}) EXPECT_EQ(chosen(blender, name), combined);
  EXPECT_EQ(chosen(blender, "Vector"),
            (Slots{"ViewLayer.Vector.X", "ViewLayer.Vector.Y", "ViewLayer.Vector.Z", "ViewLayer.Vector.W"}));
  EXPECT_EQ(chosen(blender, "Depth")[0], "ViewLayer.Depth.Z");
  EXPECT_EQ(chosen(blender, "ViewLayer.Vector.Y"), (Slots{"ViewLayer.Vector.Y", "", "", ""}));
  EXPECT_EQ(choose_exr_layer(blender, "Depth", "a").kind, ExrLayer::Kind::Grey);
}

TEST(ExrLayer, PartsAreNamesToo) {
  const std::vector<ExrPart> parts = {part("beauty", {"B", "G", "R"}), part("light", {"key.B", "key.G", "key.R"}),
                                      part("data", {"N.X", "N.Y", "N.Z", "Z", "uv.A", "uv.U", "uv.V"})};
  EXPECT_EQ(choose_exr_layer(parts, "light", "a").part, 1);
  for (const std::string name : {"light.key", "key"}) EXPECT_EQ(chosen(parts, name)[0], "key.R");
  EXPECT_EQ(chosen(parts, "data.N"), (Slots{"N.X", "N.Y", "N.Z", ""}));
  EXPECT_EQ(chosen(parts, "uv"), (Slots{"uv.U", "uv.V", "", "uv.A"}));
  EXPECT_EQ(choose_exr_layer(parts, "data.Z", "a").part, 2);
  EXPECT_EQ(choose_exr_layer(parts, "data.N.Y", "a").channels[0], "N.Y");
}

TEST(ExrLayer, WhatIsNotThereIsRefusedWithWhatIs) {
  EXPECT_EQ(refusal(blender, "beauty", ErrorKind::Usage),
            "a.exr: EXR: has no layer 'beauty', only: ViewLayer.Combined, ViewLayer.Depth, ViewLayer.Vector, "
            "ViewLayer.DiffDir");
  const std::vector<ExrPart> twice = {part("left", {"d.R"}), part("right", {"d.R"})};
  EXPECT_EQ(refusal(twice, "d", ErrorKind::Usage), "a.exr: EXR: has several layers 'd': left.d, right.d");
  EXPECT_EQ(chosen(twice, "right.d")[0], "d.R");
  EXPECT_EQ(refusal({part("", {})}, "a", ErrorKind::Usage), "a.exr: EXR: has no layer 'a', only: none");
}

TEST(ExrLayer, DeepPartsAreNotChosenWhereOthersAre) {
  std::vector<ExrPart> parts = {part("deep", {"A", "B", "G", "R"}), part("flat", {"B", "G", "R"})};
  parts[0].is_deep = true;
  EXPECT_EQ(choose_exr_layer(parts, "", "a").part, 1);
  parts.pop_back();
  EXPECT_EQ(choose_exr_layer(parts, "", "a").part, 0);
}

}  // namespace
}  // namespace zoneplate
