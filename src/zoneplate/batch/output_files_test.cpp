// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/output_files.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>

#include "zoneplate/base/clock.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

struct Frames {
  std::string name;
  std::int64_t first = 0, last = 0, jump = 1;
};

void add(OutputFiles& files, const Frames& frames, std::uint64_t item) {
  const std::optional<FramePlace> place = find_frame_place(frames.name);
  if (place)
    files.add(frames.name, *place, {frames.first, frames.last, frames.jump}, item);
  else
    files.add(frames.name, item);
}

// In both orders.
bool meet(const Frames& a, const Frames& b) {
  bool found[2] = {};
  for (const int order : {0, 1}) {
    OutputFiles files;
    add(files, order == 0 ? a : b, 0);
    add(files, order == 0 ? b : a, 1);
    const auto collision = files.find_collision();
    found[order] = collision.has_value();
    if (collision) {
      EXPECT_TRUE(collision->first == 0 && collision->second == 1);
    }
  }
  EXPECT_EQ(found[0], found[1]);
  return found[0];
}

TEST(OutputFiles, OneFileHasManyNames) {
  std::string name = (fs::temp_directory_path() / "zoneplate_files_XXXXXX").string();
  ASSERT_NE(::mkdtemp(name.data()), nullptr);
  const fs::path place = name;
  fs::create_directories(place / "o/deep");
  fs::create_symlink(place / "o", place / "link");
  fs::create_symlink("x.png", place / "o/other.png");
  const std::string o = (place / "o").string(), link = (place / "link").string();
  for (const std::string& other : {o + "/./x.png", o + "//x.png", o + "/deep/../x.png", link + "/x.png",
                                   link + "/deep/../x.png", o + "/other.png", fs::proximate(o).string() + "/x.png"})
    EXPECT_TRUE(meet({o + "/x.png"}, {other})) << other;
  for (const std::string& other : {o + "/y.png", o + "/deep/x.png", (place / "x.png").string(), o + "/X.png"})
    EXPECT_FALSE(meet({o + "/x.png"}, {other})) << other;
  EXPECT_TRUE(meet({o + "/x.####.png", 0, 1}, {link + "/x.%04d.png", 1, 2}));
  EXPECT_TRUE(meet({o + "/x.####.png", 0, 1}, {o + "/./x.0001.png"}));
  fs::remove_all(place);
}

TEST(OutputFiles, FramesAreNumbersInAName) {
  EXPECT_TRUE(meet({"x.####.png", 0, 1}, {"x.0001.png"}));
  EXPECT_FALSE(meet({"x.####.png", 0, 1}, {"x.0002.png"}));
  EXPECT_FALSE(meet({"x.####.png", 0, 1}, {"x.1.png"}));
  EXPECT_FALSE(meet({"x.####.png", 0, 9, 2}, {"x.0003.png"}));
  EXPECT_TRUE(meet({"x.##.png", 0, 1000}, {"x.123.png"}));
  EXPECT_FALSE(meet({"x.##.png", 0, 1000}, {"x.0123.png"}));
  EXPECT_TRUE(meet({"x_%03d.png", -5, 5}, {"x_-005.png"}));
  EXPECT_TRUE(meet({"x1#.png", 0, 9}, {"x12.png"}));
  EXPECT_FALSE(meet({"x.####.depth.png", 0, 9}, {"x.0001.png"}));
  EXPECT_TRUE(meet({"x.####.depth.png", 0, 9}, {"x.0001.depth.png"}));
  EXPECT_TRUE(meet({"shot/####/x.png", 0, 9}, {"shot/0001/x.png"}));
  EXPECT_FALSE(meet({"shot/####/x.png", 0, 9}, {"shot/0010/x.png"}));
  EXPECT_FALSE(meet({"shot/####/x.png", 0, 9}, {"shot/0001/y.png"}));
}

TEST(OutputFiles, ItemsShareAPatternIfTheirFramesDiffer) {
  EXPECT_FALSE(meet({"x.####.png", 0, 9}, {"x.####.png", 10, 19}));
  EXPECT_FALSE(meet({"x.####.png", 0, 9}, {"x.@@@@.png", 10, 19}));
  EXPECT_FALSE(meet({"x.####.png", 0, 8, 2}, {"x.####.png", 1, 9, 2}));
  EXPECT_TRUE(meet({"x.####.png", 0, 2}, {"x.####.png", 1, 3}));
  EXPECT_TRUE(meet({"x.####.png", 0, 2}, {"x.{frame:04}.png", 2, 3}));
  EXPECT_TRUE(meet({"x.####.png", 0, 9, 3}, {"x.####.png", 1, 9, 2}));  // 3 and 9
  EXPECT_FALSE(meet({"x.####.png", 0, 2, 3}, {"x.####.png", 1, 9, 2}));
  EXPECT_FALSE(meet({"x.####.png", -4, -1}, {"x.####.png", 0, 9}));
}

TEST(OutputFiles, PatternsOfOtherWidthsMeetInLongNumbers) {
  EXPECT_FALSE(meet({"x.#.png", 0, 9}, {"x.####.png", 0, 9}));
  EXPECT_TRUE(meet({"x.#.png", 0, 1500}, {"x.####.png", 1000, 1001}));
  EXPECT_FALSE(meet({"a1####.png", 0, 99}, {"a####.png", 0, 99}));
  EXPECT_FALSE(meet({"a1####.png", 0, 9999}, {"a11####.png", 0, 9999}));
  EXPECT_TRUE(meet({"a1####.png", 0, 10'000}, {"a11####.png", 0, 9}));
  EXPECT_TRUE(meet({"a1#.png", 0, 9}, {"a#.png", 0, 19}));
  EXPECT_FALSE(meet({"a2#.png", 0, 9}, {"a#.png", 0, 19}));
  EXPECT_TRUE(meet({"a-#.png", 0, 9}, {"a#.png", -3, 0}));
  EXPECT_TRUE(meet({"take1_#.png", 0, 9}, {"take#_1.png", 0, 9}));
  EXPECT_FALSE(meet({"take1_#.png", 0, 9}, {"take2_#.png", 0, 9}));
}

TEST(OutputFiles, NoItemWritesWhatIsRead) {
  OutputFiles files;
  files.add("sky.exr", 0, true);
  files.add("sky.exr", 1, true);
  files.add("a.png", 0);
  EXPECT_FALSE(files.find_collision());
  files.add("./sky.exr", 1);
  const auto collision = files.find_collision();
  ASSERT_TRUE(collision);
  EXPECT_TRUE(collision->is_read);
  EXPECT_EQ(collision->first, 1u);
  EXPECT_EQ(collision->path, "sky.exr");
}

// Whatever the number of frames: 60,000 items with 10^9 of them, and each frame of a sequence as an item.
TEST(OutputFiles, ManyItemsTakeLittleTime) {
  const Stopwatch watch;
  OutputFiles files;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    add(files, {"model" + std::to_string(i) + "####.png", 0, 9999}, i);
    add(files, {"shot.####.png", static_cast<std::int64_t>(i), static_cast<std::int64_t>(i)}, i);
    add(files, {"still" + std::to_string(i) + ".png"}, i);
  }
  EXPECT_FALSE(files.find_collision());
  EXPECT_LT(watch.ms(), 20'000);
}

}  // namespace
}  // namespace zoneplate
