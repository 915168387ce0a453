// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/model_path.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/maker_for_test.h"

namespace zoneplate {
namespace {

using Paths = std::vector<std::string>;
const Paths any_path = {"/"};

std::string text_of(const std::optional<std::vector<std::uint8_t>>& bytes) {
  return bytes ? std::string(bytes->begin(), bytes->end()) : "nothing";
}

TEST(GltfUri, PercentDecoding) {
  const std::pair<const char*, const char*> texts[] = {
      {"a%20b%2fc%C3%A9", "a b/c\xc3\xa9"}, {"100%", "100%"}, {"%4", "%4"}, {"%zz%41", "%zzA"}, {"", ""},
  };
  for (const auto& [coded, text] : texts) EXPECT_EQ(decode_percent(coded), text) << coded;
}

TEST(GltfUri, Base64OfRfc4648) {
  const std::pair<const char*, const char*> texts[] = {
      {"", ""}, {"Zg==", "f"}, {"Zm8=", "fo"}, {"Zm9v", "foo"}, {"Zm9vYmFy", "foobar"}, {"Zm9\nvYg", "foob"},
  };
  for (const auto& [coded, text] : texts) EXPECT_EQ(text_of(decode_base64(coded)), text) << coded;
  EXPECT_EQ(decode_base64("+/8A")->at(0), 0xfb);
  EXPECT_EQ(decode_base64("-_8A")->at(1), 0xff);
  EXPECT_FALSE(decode_base64("Zm9*"));
  EXPECT_FALSE(decode_base64("Zm9vY"));
  EXPECT_FALSE(decode_base64("Zg==Zg=="));
}

TEST(GltfUri, Schemes) {
  EXPECT_TRUE(has_scheme("http://a/b"));
  EXPECT_TRUE(has_scheme("data:,x"));
  EXPECT_TRUE(has_scheme("FILE:///etc/passwd"));
  EXPECT_FALSE(has_scheme("a/b.png"));
  EXPECT_FALSE(has_scheme("a b:c.png"));
  EXPECT_FALSE(has_scheme(":x"));
  EXPECT_FALSE(has_scheme("1a:b"));
}

TEST(GltfUri, StaysInTheFolder) {
  const TestFolder folder;
  folder.write("model/in.bin", std::string("x"));
  folder.write("out.bin", std::string("x"));
  const std::string model = folder.path("model");
  EXPECT_TRUE(find_path(model, "in.bin", {}));
  EXPECT_TRUE(find_path(model, "sub/../in.bin", {}));
  EXPECT_TRUE(find_path(model, "not%20there.bin", {}));
  EXPECT_FALSE(find_path(model, "../out.bin", {}));
  EXPECT_FALSE(find_path(model, "%2e%2e/out.bin", {}));
  EXPECT_FALSE(find_path(model, "sub/../../out.bin", {}));
  EXPECT_FALSE(find_path(model, "/etc/passwd", {}));
  EXPECT_FALSE(find_path(model, ".", {}));
  EXPECT_FALSE(find_path(model, "", {}));
  EXPECT_FALSE(find_path(model, "in.bin%00.png", {}));
  EXPECT_FALSE(find_path(model, "in.bin%00.png", any_path));
  EXPECT_TRUE(find_path(model, "../out.bin", any_path));
  EXPECT_TRUE(find_path(model, "../out.bin", Paths{folder.path("out.bin")}));
  EXPECT_FALSE(find_path(model, "../out.bin", Paths{folder.path("model2"), folder.path("not there")}));
  EXPECT_TRUE(find_path(model, "../model2/x", Paths{folder.path("model2")}));
  EXPECT_FALSE(find_path(model, "../model2/x", {}));
}

TEST(GltfUri, AStreamIsNotAFile) {
  // Opening a pipe without a writer blocks forever.
  const TestFolder folder;
  const std::string pipe = folder.path("pipe.bin");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(is_stream(pipe));
  EXPECT_TRUE(is_stream("/dev/zero"));
  EXPECT_FALSE(is_stream(folder.write("in.bin", std::string("x"))));
  EXPECT_FALSE(is_stream(folder.path("")));
  EXPECT_FALSE(is_stream(folder.path("not there.bin")));
  const std::string model = folder.write("m.gltf", std::string(R"({"asset":{"version":"2.0"},"scene":0,
    "scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"pipe.bin"}]})"));
  try {
    load_gltf(model, {});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), model + ": buffer 0: uri 'pipe.bin' is not a regular file");
  }
}

TEST(PathFinder, FindsNamesInAnotherCaseWithinTheFolder) {
  const TestFolder folder;
  for (const char* name : {"model/Sub/In.BIN", "model/b.png", "model/B.png", "out/Far.bin"})
    folder.write(name, std::string("x"));
  const std::string model = folder.path("model");
  const auto found = [&](const char* uri, const Paths& allowed = {}) {
    return PathFinder(model, allowed).find(uri).value_or("nothing");
  };
  EXPECT_EQ(found("sUB/iN.bin"), model + "/Sub/In.BIN");
  EXPECT_EQ(found("SUB/../sub/in%2ebin"), model + "/Sub/../Sub/In.BIN");
  EXPECT_EQ(found("b.png"), model + "/b.png");
  EXPECT_EQ(found("B.PNG"), model + "/B.png");
  EXPECT_EQ(found("sub/gone.bin"), model + "/sub/gone.bin");
  // Nothing outside is looked for, unless it is allowed.
  EXPECT_EQ(found("../OUT/far.bin"), "nothing");
  EXPECT_EQ(found("../out/far.bin", Paths{folder.path("out")}), model + "/../out/Far.bin");
  EXPECT_EQ(found("../OUT/far.bin", Paths{folder.path("out")}), "nothing");
  // A link of another name that leads out is not followed.
  std::filesystem::create_symlink("../out/Far.bin", folder.path("model/Link.bin"));
  EXPECT_EQ(found("link.BIN"), model + "/link.BIN");
  EXPECT_EQ(found("link.BIN", Paths{folder.path("out")}), model + "/Link.bin");
}

TEST(GltfUri, FollowsLinksBeforeItAnswers) {
  const TestFolder folder;
  folder.write("model/in.bin", std::string("x"));
  folder.write("out.bin", std::string("x"));
  std::filesystem::create_symlink("../out.bin", folder.path("model/link.bin"));
  std::filesystem::create_symlink("in.bin", folder.path("model/near.bin"));
  EXPECT_FALSE(find_path(folder.path("model"), "link.bin", {}));
  EXPECT_TRUE(find_path(folder.path("model"), "near.bin", {}));
}

/// Between find_path and the opening, another user may replace the file by a symbolic link.
TEST(GltfUri, WhatIsOpenedIsCheckedAgain) {
  const TestFolder folder;
  const std::string model = folder.path("model"), in = folder.write("model/in.bin", std::string("in"));
  const std::string out = folder.write("out.bin", std::string("out"));
  constexpr std::uint64_t limit = 100;
  const auto refusal = [&](const Paths& allowed) -> std::string {
    try {
      return std::to_string(open_found(model, in, allowed, limit).bytes().size()) + " bytes";
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal({}), "2 bytes");
  std::filesystem::remove(in);
  EXPECT_EQ(refusal({}), in + ": cannot be read: No such file or directory");
  std::filesystem::create_symlink(out, in);
  EXPECT_EQ(refusal({}), in + ": leads out of the model's folder");
  EXPECT_EQ(refusal(any_path), "3 bytes");
  std::filesystem::remove(in);
  ASSERT_EQ(::mkfifo(in.c_str(), 0600), 0);
  EXPECT_EQ(refusal({}), in + ": is not a regular file");
  std::filesystem::remove(in);
  folder.write("model/in.bin", std::string(101, 'x'));
  EXPECT_EQ(refusal({}).substr(0, in.size() + 2), in + ": ");
}

}  // namespace
}  // namespace zoneplate
