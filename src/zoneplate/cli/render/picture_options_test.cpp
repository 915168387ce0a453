// SPDX-License-Identifier: Apache-2.0
// Options of images that are of the program: edges, sections, views, camera paths, lenses and animated WebP.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/codec/animated/animation_reader.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/program_for_test.h"

namespace zoneplate {
namespace {

class PictureOptions : public ProgramTest {
 protected:
  Rgba8Image image(const std::string& name) const {
    const FileBytes file((place / name).string());
    return decode_png(file.bytes(), name).pixels;
  }
  /// Renders to a file, which must succeed.
  Rgba8Image rendered(const std::string& arguments) const {
    const ProgramAnswer answer = run(arguments + " -o a.png");
    EXPECT_EQ(answer.code, 0) << arguments << '\n' << answer.out;
    return image("a.png");
  }
  void expect_refused(const std::string& arguments, std::string_view part) const {
    const ProgramAnswer answer = run(arguments + " -o a.png");
    EXPECT_EQ(answer.code, 2) << arguments;
    EXPECT_TRUE(contains(answer.out, part)) << answer.out;
  }
};

TEST_F(PictureOptions, EdgesHaveKindsWidthsAndColours) {
  const std::string model = "teapot --size 160x120 ";
  const Rgba8Image plain = rendered(model);
  const auto reds = [&](const std::string& options) {
    return std::ranges::count(rendered(model + options).values(), Rgba8{255, 0, 0, 255});
  };
  const auto thin = reds("--edges features:width=2 --edge-color red");
  EXPECT_GT(thin, 20);
  EXPECT_GT(2 * reds("--edges features:width=4 --edge-color red"), 3 * thin);
  EXPECT_GT(reds("--edges mesh:width=2 --edge-color red"), 2 * thin);
  EXPECT_GT(reds("--edges wireframe:width=2 --edge-color red"), reds("--edges mesh:width=2 --edge-color red"));
  EXPECT_EQ(rendered(model + "--edges none"), plain);
  // Without surfaces, black lines would hardly show on the usual background.
  EXPECT_GT(std::ranges::count(rendered(model + "--edges features:surfaces=none,width=2").values(),
                               Rgba8{255, 255, 255, 255}),
            20);
  expect_refused(model + "--edges silhouettes", "features");
  expect_refused(model + "--edge-color red", "--edge-color requires --edges");
  expect_refused(model + "--wireframe", "did you mean --edges?");
}

TEST_F(PictureOptions, EdgesOfCropsAndShardsAreThoseOfTheWhole) {
  const std::string options = "teapot --size 120x90 --edges features:width=1.5 ";
  const Rgba8Image whole = rendered(options), crop = rendered(options + "--crop 31,22,50,40");
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 50; ++x) ASSERT_EQ(crop(x, y), whole(31 + x, 22 + y));
}

// A cube of 2 units far from the origin, as of a survey: positions are those of the file.
constexpr const char* cube =
    "v 1000000 0 0\nv 1000002 0 0\nv 1000002 2 0\nv 1000000 2 0\nv 1000000 0 2\nv 1000002 0 2\nv 1000002 2 2\n"
    "v 1000000 2 2\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST_F(PictureOptions, SectionsCutInTheFilesCoordinates) {
  save("cube.obj", {cube, cube + std::string_view(cube).size()});
  const auto covered = [&](const std::string& options) {
    const Rgba8Image picture = rendered(
        "cube.obj --size 100x100 --no-background --camera-position 1000001,1,50 --camera-focal-point "
        "1000001,1,1 --camera-view-angle 4 " +
        options);
    return std::ranges::count_if(picture.values(), [](Rgba8 c) { return c.a == 255; });
  };
  const auto whole = static_cast<double>(covered(""));
  EXPECT_NEAR(static_cast<double>(covered("--section 1,0,0,1000001")), whole / 2, whole / 40);
  EXPECT_NEAR(static_cast<double>(covered("--section 1,0,0,1000001 --section 0,-1,0,-1")), whole / 4, whole / 40);
  // The cap: seen from the side that is cut away, in its colour.
  const Rgba8Image cap = rendered(
      "cube.obj --size 64 --camera-position 1000010,1,1 --camera-focal-point 1000000,1,1 --section "
      "1,0,0,1000001 --section-color red --shading-model unlit");
  EXPECT_EQ(cap(32, 32), (Rgba8{255, 0, 0, 255}));
  EXPECT_EQ(run("cube.obj -o none.png --size 64 --section 1,0,0,0").code, 0);
  expect_refused("panning-wires --section 1,0,0,0 --frames 1 --size 64 --aa taa", "excludes --aov motion");
  expect_refused("cube.obj --section 0,0,0,1", "normal");
  expect_refused("cube.obj --section 1,0,1", "plane x,y,z,offset");
  expect_refused("cube.obj --section-color red", "--section-color requires --section");
}

TEST_F(PictureOptions, ViewsAreTheirDirections) {
  const ProgramAnswer answer = run("teapot --size 64x48 --views front,left,top,iso -o v.##.png");
  ASSERT_EQ(answer.code, 0) << answer.out;
  const std::string angles[] = {"0 --camera-elevation-angle 0", "-90 --camera-elevation-angle 0",
                                "0 --camera-elevation-angle 90", "45 --camera-elevation-angle 35.26439"};
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(image("v.0" + std::to_string(i) + ".png"),
              rendered("teapot --size 64x48 --camera-azimuth-angle " + angles[i]))
        << i;
  EXPECT_FALSE(exists("v.04.png"));
  expect_refused("teapot --views front,rear", "view");
  expect_refused("teapot --views front --turntable 4", "give one of them");
}

TEST_F(PictureOptions, CameraPathsLeadThroughTheirKeys) {
  const std::string path = R"({"keys": [{"time": 0, "position": [0, 2, 8], "focal_point": [0, 1, 0]},)"
                           R"( {"time": 0.5, "position": [6, 3, 6], "focal_point": [0, 1, 0], "view_angle": 30},)"
                           R"( {"time": 1, "position": [8, 2, 0], "focal_point": [0, 1, 0], "view_angle": 40}]})";
  save("path.json", {path.begin(), path.end()});
  const ProgramAnswer answer = run("teapot --size 64x48 --camera-path path.json --frame-rate 4 -o p.##.png");
  ASSERT_EQ(answer.code, 0) << answer.out;
  EXPECT_TRUE(exists("p.04.png") && !exists("p.05.png"));
  EXPECT_EQ(image("p.02.png"), rendered("teapot --size 64x48 --camera-position 6,3,6 --camera-focal-point 0,1,0 "
                                        "--camera-view-angle 30"));
  EXPECT_EQ(image("p.04.png"), rendered("teapot --size 64x48 --camera-position 8,2,0 --camera-focal-point 0,1,0 "
                                        "--camera-view-angle 40"));
  EXPECT_NE(image("p.01.png"), image("p.00.png"));
  // A part of the frames is that of the whole.
  ASSERT_EQ(run("teapot --size 64x48 --camera-path path.json --frame-rate 4 -s 3 -e 3 -o one.##.png").code, 0);
  EXPECT_EQ(image("one.03.png"), image("p.03.png"));

  const std::string wrong = R"({"keys": [{"time": 1, "position": [0, 2, 8], "focal_point": [0, 1, 0]},)"
                            R"( {"time": 1, "position": [0, 2, 9], "focal_point": [0, 1, 0]}]})";
  save("wrong.json", {wrong.begin(), wrong.end()});
  const ProgramAnswer refused = run("teapot --camera-path wrong.json -o p.##.png");
  EXPECT_EQ(refused.code, 3);
  EXPECT_TRUE(contains(refused.out, "wrong.json: key 1: is not later than the key before") ||
              contains(refused.out, "wrong.json key 1"))
      << refused.out;
}

TEST_F(PictureOptions, LensesAreThoseOfOptionsAndFiles) {
  const std::string calibration =
      R"({"image_width": 128, "image_height": 96, "camera_matrix": {"type_id": "opencv-matrix", "rows": 3, "cols": 3,)"
      R"( "dt": "d", "data": [200, 0, 60, 0, 196, 50, 0, 0, 1]}, "distortion_coefficients": {"rows": 5, "cols": 1,)"
      R"( "data": [-0.2, 0.05, 0.001, -0.002, 0.01]}})";
  save("lens.json", {calibration.begin(), calibration.end()});
  const Rgba8Image by_file = rendered("teapot --size 128x96 --camera-calibration lens.json");
  EXPECT_EQ(by_file, rendered("teapot --size 128x96 --camera-intrinsics 200,196,60,50 --camera-distortion "
                              "-0.2,0.05,0.001,-0.002,0.01"));
  EXPECT_NE(by_file, rendered("teapot --size 128x96 --camera-intrinsics 200,196,60,50"));
  // A centred lens of square pixels is a view angle: 2 atan(48 / 200).
  const Rgba8Image by_pixels =
      rendered("teapot --size 128x96 --camera-position 0,2,9 --camera-intrinsics 200,200,63.5,47.5");
  const Rgba8Image by_angle = rendered("teapot --size 128x96 --camera-position 0,2,9 --camera-view-angle 26.9914665");
  for (std::size_t i = 0; i < by_pixels.values().size(); ++i)
    ASSERT_NEAR(by_pixels.values()[i].g, by_angle.values()[i].g, 3);
  expect_refused("teapot --size 128x100 --camera-calibration lens.json", "is for an image of 128x96");
  expect_refused("teapot --camera-distortion 1,2,3,4", "--camera-distortion requires --camera-intrinsics");
  expect_refused("teapot --camera-intrinsics 1,2,3", "fx,fy,cx,cy");
  expect_refused("teapot --camera-intrinsics 200,200,63,47 --camera-view-angle 20", "--camera-view-angle");
  expect_refused("teapot --camera-intrinsics 200,200,63,47 --camera-distortion -9,0,0,0", "has no inverse");
}

TEST_F(PictureOptions, AnimatedWebpHasAQuality) {
  ASSERT_EQ(run("teapot --size 120x90 --turntable 6 -o lossless.webp").code, 0);
  ASSERT_EQ(run("teapot --size 120x90 --turntable 6 -o lossy.webp --webp-quality 60").code, 0);
  EXPECT_LT(std::filesystem::file_size(place / "lossy.webp"), std::filesystem::file_size(place / "lossless.webp") / 2);
  const FileBytes file((place / "lossy.webp").string());
  EXPECT_EQ(count_frames(file.bytes()), 6u);
}

TEST_F(PictureOptions, BestQualityIsItsOptionsAndKeepsExrTransparent) {
  const std::string small = "teapot --size 48x36 ";
  EXPECT_EQ(rendered(small + "--quality best"),
            rendered(small + "--aa msaa:n=16,alpha=samples --anisotropy 16 --shadows soft:samples=64,spacing=8 "
                             "--ambient-occlusion rays:samples=64,spacing=8 --ground shadow --specular-aa full "
                             "--background '#e8e6e0'"));
  EXPECT_EQ(rendered(small + "--quality best --background '#123456'")(0, 0), (Rgba8{0x12, 0x34, 0x56, 255}));
  ASSERT_EQ(run(small + "--quality best -o a.exr").code, 0);
  ASSERT_EQ(run("filter a.exr --tone-mapping none -o shown.png").code, 0);
  EXPECT_EQ(image("shown.png")(0, 0).a, 0);
}

}  // namespace
}  // namespace zoneplate
