// SPDX-License-Identifier: Apache-2.0
// Sequences and parts of them, by the built program.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/program_for_test.h"

namespace zoneplate::cli {
namespace {

class SequenceRun : public ProgramTest {
 protected:
  void write(const std::string& name, const GltfMaker& maker) const {
    const std::vector<std::uint8_t> bytes = maker.glb();
    std::ofstream(place / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  void expect_equal(const std::string& whole, const std::string& part) const {
    const std::string expected = text_of(place / whole);
    EXPECT_FALSE(expected.empty()) << whole;
    EXPECT_TRUE(text_of(place / part) == expected) << whole << " is not " << part;
  }
};

/// A square of side 1 around the origin, in the plane z = 0.
std::string square(GltfMaker& m) {
  return R"("POSITION":)" + m.floats("VEC3", {-0.5f, -0.5f, 0, 0.5f, -0.5f, 0, -0.5f, 0.5f, 0, 0.5f, -0.5f, 0, 0.5f,
                                              0.5f, 0, -0.5f, 0.5f, 0});
}

std::string animation(GltfMaker& m, const std::string& target, const std::string& type, const std::vector<float>& times,
                      const std::vector<float>& values, const std::string& interpolation) {
  return R"(,"animations":[{"channels":[{"sampler":0,"target":)" + target + R"(}],"samplers":[{"input":)" +
         m.floats("SCALAR", times) + R"(,"output":)" + m.floats(type, values) + R"(,"interpolation":")" +
         interpolation + "\"}]}]";
}

TEST_F(SequenceRun, AWarmUpGivesTheBitsOfTheWholeSequence) {
  for (const std::string method :
       {"taa", "history-guided", "oracle-taa", "smaa:mode=t2x", "fsr2:scale=2", "fsr2:scale=1", "fsr3:scale=2", "sgsr2",
        "taau", "learned", "learned:scale=1", "learned-table", "oracle-taau", "taa+fsr1"}) {
    const std::string usual = "teapot:divisions=4 --turntable 24 --size 40x30 --aa " + method;
    ASSERT_EQ(run(usual + " -s 0 -e 3 -o whole.##.png").code, 0) << method;
    const ProgramAnswer part = run(usual + " -s 3 -e 3 --warm-up 3 -o part.##.png");
    EXPECT_EQ(part.code, 0) << method << part.out;
    expect_equal("whole.03.png", "part.03.png");
    const ProgramAnswer resumed = run(usual + " -s 0 -e 4 --skip-existing -o whole.##.png");
    EXPECT_EQ(resumed.code, 2) << method;
    EXPECT_TRUE(contains(resumed.out, "averages frames, which excludes --skip-existing")) << resumed.out;
  }
  for (const std::string method : {"none", "msaa", "smaa", "fsr1", "ssaa+bicubic"}) {
    const ProgramAnswer answer =
        run("teapot:divisions=4 -s 0 -e 1 --warm-up 2 -o x.##.png --size 16x12 --aa " + method);
    EXPECT_EQ(answer.code, 2) << method;
    EXPECT_TRUE(contains(answer.out, "--warm-up is for methods that average frames")) << answer.out;
  }
}

// A built-in scene that does not move is seen as its still image.
TEST_F(SequenceRun, FramesOfAStillSceneAreItsStillImage) {
  for (const std::string scene : {"wires", "near-axis", "sphere"}) {
    ASSERT_EQ(run(scene + " --size 40x30 -o still.png").code, 0);
    ASSERT_EQ(run(scene + " --frames 2 --size 40x30 -o frame.##.png").code, 0);
    expect_equal("still.png", "frame.00.png");
    expect_equal("still.png", "frame.01.png");
  }
}

TEST_F(SequenceRun, PartsHaveTheExposureOfTheWhole) {
  for (const std::string scene : {"light-switch", "teapot:divisions=4 --turntable 21"}) {
    const std::string usual = scene + " --exposure auto --aa none --size 32x24";
    ASSERT_EQ(run(usual + " -s 0 -e 20 -o whole.##.png").code, 0);
    for (const int frame : {5, 20}) {
      ASSERT_EQ(run(usual + fmt::format(" -s {0} -e {0} -o part.##.png", frame)).code, 0);
      expect_equal(fmt::format("whole.{:02}.png", frame), fmt::format("part.{:02}.png", frame));
    }
  }
}

// The square flies towards the camera and back in 0.8 of 10 seconds.
TEST_F(SequenceRun, TheCameraSeesAShortJump) {
  GltfMaker m;
  m.mesh(square(m));
  m.rest = animation(m, R"({"node":0,"path":"translation"})", "VEC3", {0, 4.6f, 5, 5.4f, 10},
                     {0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0}, "LINEAR");
  write("jump.glb", m);
  ASSERT_EQ(run("jump.glb -o j.###.png -s 0 -e 120 -j 60 --size 64x48 --aa none --no-background").code, 0);
  const auto seen = [&](const char* name) {
    const Rgba8Image image = decode_png(FileBytes((place / name).string()).bytes(), name).pixels;
    return std::ranges::count_if(image.values(), [](const Rgba8& c) { return c.a > 0; });
  };
  EXPECT_GT(seen("j.000.png"), 30);
  EXPECT_GT(seen("j.120.png"), seen("j.000.png"));
}

// The first of three squares is hidden from 1 s on.
TEST_F(SequenceRun, AHiddenObjectChangesNoOther) {
  GltfMaker m;
  m.mesh(square(m));
  m.nodes = R"({"mesh":0,"translation":[-2,0,0],"extensions":{"KHR_node_visibility":{}}},{"mesh":0},
      {"mesh":0,"translation":[2,0,0]})";
  m.scene_nodes = "0,1,2";
  m.rest = animation(m,
                     R"({"path":"pointer","extensions":{"KHR_animation_pointer":
                     {"pointer":"/nodes/0/extensions/KHR_node_visibility/visible"}}})",
                     "SCALAR", {0, 1}, {1, 0}, "STEP");
  write("vis.glb", m);
  ASSERT_EQ(
      run("vis.glb -o v.##.exr -s 23 -e 25 --size 90x40 --aa none --camera-azimuth-angle 0 --camera-elevation-angle 0 "
          "--aov motion,flow,object-id")
          .code,
      0);
  for (const int frame : {23, 24, 25}) {
    const std::string name = fmt::format("v.{}.exr", frame);
    const FileBytes file((place / name).string());
    const std::vector<std::string> motion{"motion.X", "motion.Y", "flow.X", "flow.Y"}, id{"objectId"};
    for (const Plane<float>& plane : decode_exr_channels(file.bytes(), name, motion))
      EXPECT_TRUE(std::ranges::all_of(plane.values(), [](float v) { return v == 0; })) << name;
    const Plane<float> ids = decode_exr_channels(file.bytes(), name, id)[0];
    EXPECT_EQ(ids(45, 20), 1) << name;
    EXPECT_EQ(std::ranges::count(ids.values(), 2.0f), std::ranges::count(ids.values(), 1.0f)) << name;
    EXPECT_EQ(std::ranges::count(ids.values(), 0.0f) > 0, frame == 23) << name;
  }
}

TEST_F(SequenceRun, WarnsOfTimesAtWhichNothingMoves) {
  GltfMaker m;
  m.mesh(square(m));
  m.rest = animation(m, R"({"node":0,"path":"translation"})", "VEC3", {0, 2}, {0, 0, 0, 1, 0, 0}, "LINEAR");
  write("a.glb", m);
  write("still.glb", triangle_maker());
  const auto warnings = [&](const std::string& arguments) {
    const ProgramAnswer answer = run(arguments + " --size 16x12");
    EXPECT_EQ(answer.code, 0) << answer.out;
    return answer.out;
  };
  constexpr const char* late = "--animation-time 99 is after the end of the animation at 2 s";
  EXPECT_TRUE(contains(warnings("a.glb -o a.png --animation-time 99"), late));
  EXPECT_TRUE(contains(warnings("a.glb -o a.##.png -s 0 -e 1 --animation-time 99"), late));
  EXPECT_FALSE(contains(warnings("a.glb -o a.png --animation-time 2"), "after the end"));
  EXPECT_TRUE(contains(warnings("still.glb -o s.##.png -s 0 -e 2"), "has no animation, so that all 3 frames"));
  EXPECT_FALSE(contains(warnings("still.glb -o s.##.png -s 2 -e 2"), "has no animation"));
  EXPECT_FALSE(contains(warnings("still.glb -o s.##.png --turntable 3"), "has no animation"));
  EXPECT_FALSE(contains(warnings("a.glb -o a.##.png -s 0 -e 2"), "warning"));
}

}  // namespace
}  // namespace zoneplate::cli
