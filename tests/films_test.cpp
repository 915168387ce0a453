// SPDX-License-Identifier: Apache-2.0
// What videos are made of: the frames that the program gives to ffmpeg, and the files that ffmpeg writes.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/os/program_for_test.h"

namespace {

namespace fs = std::filesystem;
using zoneplate::contains;
using zoneplate::text_of;

class Films : public zoneplate::ProgramTest {
 protected:
  /// Runs the program with an ffmpeg that keeps what it is given in the file `frames`.
  zoneplate::ProgramAnswer run_recorded(const std::string& arguments) const {
    fs::create_directory(place / "bin");
    std::ofstream(place / "bin/ffmpeg") << "#!/bin/sh\necho \"$@\" >words\ncat >frames\necho film\n";
    fs::permissions(place / "bin/ffmpeg", fs::perms::owner_all);
    return run(arguments, "PATH=\"$PWD/bin:$PATH\"");
  }
};

// H.264 with subsampled chroma requires even sides. A black border would be seen.
TEST_F(Films, OddSidesRepeatTheLastColumnAndRow) {
  const auto sides = {std::pair{63, 47}, {64, 47}, {63, 48}, {64, 48}};
  for (const char* name : {"f.mp4", "f.mov", "f.mkv"})
    for (const auto& [width, height] : sides) {
      const std::string size = std::to_string(width) + "x" + std::to_string(height);
      ASSERT_EQ(run_recorded(std::string("teapot --turntable 2 --aa none --size ") + size + " -o " + name).code, 0);
      EXPECT_TRUE(contains(text_of(place / "words"), "-s 64x48 ")) << name << size;
      const std::string frames = text_of(place / "frames");
      ASSERT_EQ(frames.size(), 2u * 64 * 48 * 4) << name << size;
      const auto pixel = [&](std::size_t frame, std::size_t x, std::size_t y) {
        return frames.substr(((frame * 48 + y) * 64 + x) * 4, 4);
      };
      ASSERT_EQ(run("teapot --turntable 2 --aa none --size " + size + " -o f.#.rgba").code, 0);
      for (std::size_t frame = 0; frame < 2; ++frame) {
        const std::string image = text_of(place / ("f." + std::to_string(frame) + ".rgba"));
        for (std::size_t y = 0; y < 48; ++y)
          for (std::size_t x = 0; x < 64; ++x) {
            const auto w = static_cast<std::size_t>(width), h = static_cast<std::size_t>(height);
            ASSERT_EQ(pixel(frame, x, y), image.substr((std::min(y, h - 1) * w + std::min(x, w - 1)) * 4, 4))
                << name << size << ' ' << frame << ' ' << x << ' ' << y;
          }
      }
    }
}

TEST_F(Films, OpaqueVideosRefuseATransparentBackground) {
  for (const char* name : {"f.mp4", "f.mov", "f.mkv"}) {
    const auto answer = run_recorded(std::string("teapot --turntable 2 --size 16 --no-background -o ") + name);
    EXPECT_EQ(answer.code, 2) << name;
    EXPECT_TRUE(contains(answer.out, "H.264 video has no alpha: write a .webm, .webp or .apng")) << answer.out;
  }
  EXPECT_EQ(run_recorded("teapot --turntable 2 --size 16 --no-background -o f.webm").code, 0);
}

/// The delays of the frames of a GIF in hundredths of a second.
std::vector<int> delays_of(const std::string& gif) {
  std::vector<int> out;
  for (std::size_t at = 0; (at = gif.find(std::string("\x21\xf9\x04", 3), at)) != std::string::npos; at += 8)
    out.push_back(static_cast<unsigned char>(gif[at + 4]) + 256 * static_cast<unsigned char>(gif[at + 5]));
  return out;
}

// Browsers show shorter delays as a tenth of a second.
TEST_F(Films, DelaysOfAGifAreAtLeastTwoHundredths) {
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  for (const char* rate : {"24", "30", "50", "60", "100"}) {
    const auto answer = run(std::string("teapot --turntable 24 --size 16 --aa none -o f.gif --frame-rate ") + rate);
    ASSERT_EQ(answer.code, 0) << answer.out;
    int sum = 0;
    for (const int delay : delays_of(text_of(place / "f.gif"))) {
      EXPECT_GE(delay, 2) << rate;
      sum += delay;
    }
    EXPECT_NEAR(sum, 24 * 100.0 / std::stod(rate), 2) << rate;
    EXPECT_EQ(contains(answer.out, "as many as a GIF can have in browsers"), std::stod(rate) > 50) << answer.out;
  }
}

}  // namespace
