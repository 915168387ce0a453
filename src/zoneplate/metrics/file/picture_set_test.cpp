// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/file/picture_set.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/file.h"

namespace zoneplate::metrics {
namespace {

namespace fs = std::filesystem;

class PictureSets : public testing::Test {
 protected:
  PictureSets() : folder_(fs::temp_directory_path() / ("zoneplate_picture_set_test_" + std::to_string(::getpid()))) {}
  ~PictureSets() override { fs::remove_all(folder_); }

  void save(const std::string& name, std::uint8_t code = 0) const {
    fs::create_directories((folder_ / name).parent_path());
    save_bytes((folder_ / name).string(), encode_png(Rgba8Image(16, 16, {code, code, code, 255})));
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

 private:
  fs::path folder_;
};

TEST_F(PictureSets, DirectoriesIncludeTheirSubfolders) {
  for (const char* name : {"a/x10.png", "a/x9.png", "a/sub/y.png", "a/notes.txt"}) save(name);
  const PictureSet set = open_pictures(at("a"));
  EXPECT_EQ(set.names, (std::vector<std::string>{"sub/y.png", "x9.png", "x10.png"}));
  EXPECT_TRUE(set.is_directory);
  EXPECT_FALSE(set.are_frames);
}

TEST_F(PictureSets, DirectoriesPairByPathAndThenByStem) {
  for (const char* name :
       {"a/x.png", "a/y.png", "a/sub/x.png", "a/gone.png", "b/x.png", "b/y.webp", "b/sub/x.png", "b/new.png"})
    save(name);
  const PictureSet a = open_pictures(at("a")), b = open_pictures(at("b"));
  const auto partner = [&](const std::string& name) -> std::string {
    for (const PicturePair& pair : pair_pictures(a, b))
      if (pair.name == name)
        return (pair.reference ? a.names[*pair.reference] : "-") + " " + (pair.test ? b.names[*pair.test] : "-");
    return "";
  };
  EXPECT_EQ(pair_pictures(a, b).size(), 5u);
  EXPECT_EQ(partner("x.png"), "x.png x.png");
  EXPECT_EQ(partner("sub/x.png"), "sub/x.png sub/x.png");
  EXPECT_EQ(partner("y.webp"), "y.png y.webp");
  EXPECT_EQ(partner("gone.png"), "gone.png -");
  EXPECT_EQ(partner("new.png"), "- new.png");
}

TEST_F(PictureSets, SequencesPairByTheNumbersOfTheirFrames) {
  for (const char* name : {"p8.png", "p9.png", "p11.png", "q09.png", "q10.png", "q11.png"}) save(name);
  const PictureSet reference = open_pictures(at("p#.png")), test = open_pictures(at("q##.png"));
  const auto pairs = pair_pictures(reference, test);
  ASSERT_EQ(pairs.size(), 4u);
  const auto text = [&](const PicturePair& pair) {
    return (pair.reference ? reference.names[*pair.reference] : "-") + " " + (pair.test ? test.names[*pair.test] : "-");
  };
  EXPECT_EQ(text(pairs[0]), "p8.png -");
  EXPECT_EQ(text(pairs[1]), "p9.png q09.png");
  EXPECT_EQ(text(pairs[2]), "- q10.png");
  EXPECT_EQ(text(pairs[3]), "p11.png q11.png");
  EXPECT_EQ(pairs[0].name, "p8.png");
  EXPECT_EQ(pairs[1].name, "q09.png");
}

TEST_F(PictureSets, VideosAreDecodedByFfmpeg) {
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  for (int i = 0; i < 3; ++i) save("f" + std::to_string(i) + ".png", static_cast<std::uint8_t>(60 * i));
  const std::string command = "ffmpeg -v error -i '" + at("f%d.png") + "' -c:v png '" + at("film.mkv") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const PictureSet set = open_pictures(at("film.mkv"));
  ASSERT_EQ(set.names, (std::vector<std::string>{"frame 1", "frame 2", "frame 3"}));
  EXPECT_TRUE(set.are_frames);
  EXPECT_EQ(set.load(2).display(3, 3), (Display{120 / 255.0f, 120 / 255.0f, 120 / 255.0f, 1}));
}

TEST_F(PictureSets, DamagedVideosAreErrors) {
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  save("text.png");
  fs::rename(at("text.png"), at("text.mp4"));
  try {
    open_pictures(at("none.mp4"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), at("none.mp4") + ": no such file");
  }
  save_bytes(at("bad.mp4"), std::vector<std::uint8_t>(100, 7));
  EXPECT_THROW(open_pictures(at("bad.mp4")), Error);
}

}  // namespace
}  // namespace zoneplate::metrics
