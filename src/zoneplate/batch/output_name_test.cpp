// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/output_name.h"

#include <gtest/gtest.h>

#include <string>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

TEST(OutputName, PlaceholdersDescribeTheInput) {
  const auto name = [](const std::string& output) { return output_name(output, "shop/old/chair.v2.glb", 7).text; };
  EXPECT_EQ(name("a.png"), "a.png");
  EXPECT_EQ(name("{model}.png"), "chair.v2.png");
  EXPECT_EQ(name("{dir}/{model}_{ext}.png"), "shop/old/chair.v2_glb.png");
  EXPECT_EQ(name("{index}-{index:3}.png"), "7-007.png");
  EXPECT_EQ(name("{model}/{model}.####.{frame:04}.png"), "chair.v2/chair.v2.####.{frame:04}.png");
  EXPECT_EQ(name("thumbs/"), "thumbs/chair.v2.png");
  EXPECT_EQ(name("{}{1}{a b}.png"), "{}{1}{a b}.png");
  EXPECT_EQ(output_name("{dir}/{model}.{ext}png", "sphere:triangles=12", 0).text, "./sphere_triangles=12.png");
}

// A model's own name may contain braces; they are not expanded again.
TEST(OutputName, InputsAreNotPatterns) {
  EXPECT_EQ(output_name("{model}.png", "{ext}.glb", 0).text, "{ext}.png");
  for (const char* input : {"chair@2x.obj", "chair@.obj", "a%d.obj", "a%04d.obj", "a#.obj", "a####.obj", "x$F.obj"}) {
    const OutputName name = output_name("out/", input, 0);
    EXPECT_EQ(name.text, "out/" + std::string(input).substr(0, std::string(input).size() - 4) + ".png");
    EXPECT_FALSE(name.frame) << input;
  }
  const OutputName name = output_name("{model}/{dir}.####.{ext}", "##/a%d@.glb", 0);
  ASSERT_TRUE(name.frame);
  EXPECT_EQ(frame_name(name.text, *name.frame, 7), "a%d@/##.0007.glb");
}

TEST(OutputName, AFolderStandsForNumberedFramesOfASequence) {
  const OutputName name = output_name("turn/", "a#.glb", 0, true);
  ASSERT_TRUE(name.frame);
  EXPECT_EQ(frame_name(name.text, *name.frame, 7), "turn/a#.0007.png");
}

TEST(OutputName, NoValueLeadsOutOfTheFolder) {
  const auto name = [](const std::string& output, const std::string& input) {
    return output_name(output, input, 0).text;
  };
  for (const char* folder : {"../models", "/models", "models", "./models", "a/../models", "../../models/."})
    EXPECT_EQ(name("thumbs/{dir}/{model}.png", std::string(folder) + "/duck.obj"), "thumbs/models/duck.png") << folder;
  EXPECT_EQ(name("thumbs/{dir}/x.png", "../duck.obj"), "thumbs/./x.png");
  EXPECT_EQ(name("{dir}_{model}.png", "/models/duck.obj"), "models_duck.png");
  EXPECT_EQ(name("deep/{model}/view.png", "...obj"), "deep/__/view.png");
  EXPECT_EQ(name("deep/{model}/view.png", "..obj"), "deep/_/view.png");
  EXPECT_EQ(name("deep/{model}/view.png", "shop/"), "deep/_/view.png");
  EXPECT_EQ(name("{dir}/{model}.png", "../models/duck.obj"), "../models/duck.png");  // beside its model
}

TEST(OutputName, ADigitAfterTheFrameNumberIsRefused) {
  EXPECT_EQ(output_name("{model}####{ext}.png", "a1.glb", 0).text, "a1####glb.png");
  EXPECT_THROW(output_name("{model}####{ext}.png", "a1.3ds", 0), Error);
  EXPECT_THROW(output_name("{frame}{index}.png", "a1.3ds", 0), Error);
}

TEST(OutputName, UnknownPlaceholdersAreRefused) {
  const auto message = [](const std::string& output) -> std::string {
    try {
      return output_name(output, "a.glb", 0).text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Usage);
      return error.what();
    }
  };
  EXPECT_EQ(message("{nodel}.png"), "--output: there is no placeholder {nodel}; did you mean {model}?");
  EXPECT_EQ(message("{camera}.png"),
            "--output: there is no placeholder {camera}; there are {model}, {ext}, {dir}, {index} and {frame}");
  EXPECT_EQ(message("{model:3}.png"),
            "--output: there is no placeholder {model}; there are {model}, {ext}, {dir}, {index} and {frame}");
}

TEST(OutputName, SomeNameTheirInput) {
  for (const char* name : {"thumbs/", "{model}.png", "{index:3}.png", "x.{frame}.{ext}.png", "{other}.png"})
    EXPECT_TRUE(names_input(name)) << name;
  for (const char* name : {"a.png", "a.####.png", "a.{frame:04}.png", "{}.png"})
    EXPECT_FALSE(names_input(name)) << name;
}

}  // namespace
}  // namespace zoneplate
