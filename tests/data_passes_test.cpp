// SPDX-License-Identifier: Apache-2.0
// Data passes as the command writes them: layers of one file, files beside an image, frames of a sequence.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <set>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

class DataPasses : public testing::Test {
 protected:
  DataPasses() : place_(fs::temp_directory_path() / ("zoneplate_passes_" + std::to_string(::getpid()))) {
    fs::create_directories(place_);
  }
  ~DataPasses() override { fs::remove_all(place_); }

  int run(const std::string& words) const {
    return std::system(("cd " + place_.string() + " && " + program_file + " " + words + " 2> complaint").c_str());
  }
  Bytes file(const std::string& name) const {
    const FileBytes bytes((place_ / name).string());
    return {bytes.bytes().begin(), bytes.bytes().end()};
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(place_)) names.insert(entry.path().filename());
    names.erase("complaint");
    return names;
  }

 private:
  fs::path place_;
};

TEST_F(DataPasses, AnExrHoldsThemItself) {
  ASSERT_EQ(run("teapot --size 60,50 -o a.exr --aov depth,normal,crypto-object --background '#333'"), 0);
  ASSERT_EQ(run("teapot --size 60,50 -o a.png --tone-mapping none"), 0);
  EXPECT_EQ(files(), (std::set<std::string>{"a.exr", "a.png"}));
  const LinearImage light = decode_exr(file("a.exr"), "a.exr");
  const Rgba8Image codes = decode_png(file("a.png"), "a.png").pixels;
  ASSERT_EQ(light.width(), 60);
  ASSERT_EQ(light.height(), 50);
  // Within a half's rounding where no highlight is clamped at an edge.
  int equal = 0;
  for (std::size_t i = 0; i < light.values().size(); ++i)
    equal += std::abs(encode_srgb8(light.values()[i].g) - codes.values()[i].g) <= 1;
  EXPECT_GT(equal, 2950);
  const Bytes bytes = file("a.exr");
  const std::string text(bytes.begin(), bytes.end());
  for (const char* name : {"CryptoObject02.A", "N.Z", "\"handle\":\"48865902\"", "MurmurHash3_32"})
    EXPECT_NE(text.find(name), std::string::npos) << name;
}

TEST_F(DataPasses, LieBesideAFloatMapAsFloats) {
  ASSERT_EQ(run("teapot --size 60,50 -o a.pfm --aov depth"), 0);
  EXPECT_EQ(files(), (std::set<std::string>{"a.depth.pfm", "a.pfm"}));
  const Bytes depth = file("a.depth.pfm");
  EXPECT_EQ(std::string(depth.begin(), depth.begin() + 14), "Pf\n60 50\n-1.0\n");
  EXPECT_EQ(depth.size(), 14u + 60 * 50 * 4);
}

TEST_F(DataPasses, RawCodesAreThoseOfThePicture) {
  for (const char* depth : {"8", "16"}) {
    const std::string words = std::string("teapot --size 40,30 --no-background --bit-depth ") + depth;
    ASSERT_EQ(run(words + " -o a.png"), 0);
    ASSERT_EQ(run(words + " -o - --output-format rgba > a.raw"), 0);
    const PngImage png = decode_png(file("a.png"), "a.png");
    const Bytes raw = file("a.raw");
    const auto as_raw = [](const auto& pixels) {
      const auto bytes = std::as_bytes(pixels.values());
      Bytes out(bytes.size());
      std::memcpy(out.data(), bytes.data(), bytes.size());
      return out;
    };
    EXPECT_EQ(raw, png.pixels16.empty() ? as_raw(png.pixels) : as_raw(png.pixels16));
    EXPECT_EQ(raw.size(), 40u * 30 * (png.pixels16.empty() ? 4 : 8));
  }
}

TEST_F(DataPasses, AFramesMotionDoesNotDependOnTheOthers) {
  ASSERT_EQ(run("cyclic --size 50,40 --turntable 36 -s 0 -e 2 -o all.##.pfm --aov motion,flow"), 0);
  ASSERT_EQ(run("cyclic --size 50,40 --turntable 36 -s 1 -e 1 -o one.##.pfm --aov motion"), 0);
  const Bytes motion = file("all.01.motion.pfm");
  EXPECT_EQ(motion, file("one.01.motion.pfm"));
  EXPECT_NE(motion, file("all.01.flow.pfm"));
  // A camera that goes round moves everything but what lies on its axis.
  std::vector<float> values((motion.size() - 14) / sizeof(float));
  std::memcpy(values.data(), motion.data() + 14, values.size() * sizeof(float));
  float greatest = 0;
  for (const float v : values) greatest = std::max(greatest, std::abs(v));
  EXPECT_GT(greatest, 0.5f);
  EXPECT_LT(greatest, 20);
}

TEST_F(DataPasses, MotionWantsFrames) {
  EXPECT_EQ(WEXITSTATUS(run("cyclic -o a.exr --aov motion")), 2);
  const Bytes complaint = file("complaint");
  EXPECT_EQ(std::string(complaint.begin(), complaint.end()),
            "zoneplate: error: --aov motion requires a sequence, or a frame of one: -s 5 -e 5\n");
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace zoneplate
