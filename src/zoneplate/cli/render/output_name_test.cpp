// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/output_name.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"

namespace zoneplate::cli {
namespace {

TEST(OutputName, PlaceholdersDescribeTheInput) {
  const auto name = [](const std::string& output) { return output_name(output, "shop/old/chair.v2.glb", 7); };
  EXPECT_EQ(name("a.png"), "a.png");
  EXPECT_EQ(name("{model}.png"), "chair.v2.png");
  EXPECT_EQ(name("{dir}/{model}_{ext}.png"), "shop/old/chair.v2_glb.png");
  EXPECT_EQ(name("{index}-{index:3}.png"), "7-007.png");
  EXPECT_EQ(name("{model}/{model}.####.{frame:04}.png"), "chair.v2/chair.v2.####.{frame:04}.png");
  EXPECT_EQ(name("thumbs/"), "thumbs/chair.v2.png");
  EXPECT_EQ(name("{}{1}{a b}.png"), "{}{1}{a b}.png");
  EXPECT_EQ(output_name("{dir}/{model}.{ext}png", "sphere:triangles=12", 0), "./sphere_triangles=12.png");
}

// A model's own name may contain braces; they are not expanded again.
TEST(OutputName, InputsAreNotPatterns) { EXPECT_EQ(output_name("{model}.png", "{ext}.glb", 0), "{ext}.png"); }

TEST(OutputName, UnknownPlaceholdersAreRefused) {
  const auto message = [](const std::string& output) -> std::string {
    try {
      return output_name(output, "a.glb", 0);
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

TEST(OutputName, OneFileHasOneItem) {
  OutputNames names;
  RenderArgs args;
  args.output = "a.png";
  names.add(args, "a.glb");
  args.output = "b.####.png";
  args.sequence.first = 0, args.sequence.last = 9;
  names.add(args, "line 2");
  args.sequence.first = 10, args.sequence.last = 19;
  names.add(args, "line 3");
  args.output = "a.png";
  try {
    names.add(args, "b.glb");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "a.glb and b.glb would both be written to a.png: use {dir}, {ext} or {index} in the output's name");
  }
}

}  // namespace
}  // namespace zoneplate::cli
