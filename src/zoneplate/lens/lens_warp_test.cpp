// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/lens/lens_warp.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

Lens lens_with(double k1, double k2, double p1, double p2, double k3 = 0, double k4 = 0, double k5 = 0, double k6 = 0) {
  return {.width = 640,
          .height = 480,
          .fx = 610,
          .fy = 598,
          .cx = 331.5,
          .cy = 236.25,
          .k1 = k1,
          .k2 = k2,
          .k3 = k3,
          .k4 = k4,
          .k5 = k5,
          .k6 = k6,
          .p1 = p1,
          .p2 = p2};
}
const Lens lenses[] = {lens_with(0, 0, 0, 0), lens_with(-0.28, 0.09, 0.0012, -0.0007),
                       lens_with(-0.31, 0.12, 0.0012, -0.0007, -0.021),
                       lens_with(0.41, -0.22, 0.0008, -0.0011, 0.05, 0.75, -0.13, 0.021)};

// The pixels are those of cv2.projectPoints of OpenCV 4.6.0, for points (x, y, z) in front of its camera.
TEST(Lens, ProjectsAsOpenCv) {
  constexpr double points[][3] = {{0, 0, 1}, {0.3, -0.2, 1}, {-0.45, 0.33, 1}, {0.9, 0.7, 2}, {-0.1, -0.4, 1.5}};
  constexpr LensPoint pixels[][5] = {
      {{331.5, 236.25}, {514.5, 116.65}, {57, 433.59}, {606, 445.55}, {290.833333333333, 76.783333333333}},
      {{331.5, 236.25},
       {507.896933, 121.0224564},
       {78.0152543382, 418.609853511576},
       {583.548835625, 428.770531125},
       {291.662734518519, 80.216402607407}},
      {{331.5, 236.25},
       {507.267570929, 121.4337771852},
       {79.955153127938, 417.215246490931},
       {581.544398023437, 427.242193092187},
       {291.748316100038, 80.551994645105}},
      {{331.5, 236.25},
       {506.605466240533, 121.814670304002},
       {81.930014070003, 415.666394338614},
       {579.120138984271, 425.376475216422},
       {291.802671289342, 80.819356939338}}};
  for (std::size_t l = 0; l < std::size(lenses); ++l)
    for (std::size_t i = 0; i < std::size(points); ++i) {
      const auto& [x, y, z] = points[i];
      const LensPoint at = distorted(lenses[l], {x / z, y / z});
      EXPECT_NEAR(lenses[l].fx * at.x + lenses[l].cx, pixels[l][i].x, 1e-9) << l << ' ' << i;
      EXPECT_NEAR(lenses[l].fy * at.y + lenses[l].cy, pixels[l][i].y, 1e-9) << l << ' ' << i;
    }
}

// The frame without distortion: clip space by the lens.
TEST(Lens, CameraProjectsThePrincipalPointAndFocalLengths) {
  Camera camera;
  camera.lens = lenses[0];
  const float4x4 clip = camera.clip_from_camera(640.0f / 480);
  const auto pixel = [&](float x, float y, float z) {
    const float4 c = clip * float4{x, -y, -z, 1};  // OpenCV's axes: y downwards, z ahead
    return LensPoint{(c.x / c.w + 1) * 320 - 0.5, (1 - c.y / c.w) * 240 - 0.5};
  };
  EXPECT_NEAR(pixel(0.3f, -0.2f, 1).x, 514.5, 1e-3);
  EXPECT_NEAR(pixel(0.3f, -0.2f, 1).y, 116.65, 1e-3);
  EXPECT_NEAR(pixel(-0.1f, -0.4f, 1.5f).x, 290.8333, 1e-3);
  EXPECT_NEAR(pixel(-0.1f, -0.4f, 1.5f).y, 76.7833, 1e-3);
}

TEST(Lens, InverseReturnsToTheDirection) {
  for (const Lens& lens : lenses)
    for (double y = -0.4; y <= 0.4; y += 0.1)
      for (double x = -0.55; x <= 0.55; x += 0.1) {
        const std::optional<LensPoint> back = undistorted(lens, distorted(lens, {x, y}));
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->x, x, 1e-12);
        EXPECT_NEAR(back->y, y, 1e-12);
      }
}

TEST(Lens, RefusesWhatTheModelFolds) {
  EXPECT_FALSE(undistorted(lens_with(-0.5, 0, 0, 0), {0.9, 0}));
  EXPECT_THROW(LensWarp(lens_with(-1.5, 0, 0, 0), 640, 480, 0, 0, 640, 480), Error);
}

TEST(Lens, ScalesAboutCornersOfPixels) {
  const Lens twice = scaled_to(lenses[1], 1280, 960);
  EXPECT_EQ(twice.fx, 1220);
  EXPECT_EQ(twice.cx, 663.5);
  const Lens wide = scaled_to(lenses[1], 840, 480);
  EXPECT_EQ(wide.fx, 610);
  EXPECT_EQ(wide.cx, 431.5);
  EXPECT_EQ(wide.k1, -0.28);
}

/// A frame whose colour is a function of the direction of each pixel.
LinearImage ramp(const LensWarp& warp) {
  const LensWarp::Part& part = warp.frame_part();
  LinearImage image(part.width, part.height);
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x)
      image(x, y) = {static_cast<float>((part.x + x - warp.frame().cx) / warp.frame().fx),
                     static_cast<float>((part.y + y - warp.frame().cy) / warp.frame().fy), 0.5f, 1};
  return image;
}

TEST(LensWarp, PixelsShowTheirDirections) {
  for (const Lens& lens : lenses) {
    const LensWarp warp(lens, 64, 48, 0, 0, 64, 48);
    const LinearImage image = warp.warped(ramp(warp));
    const Lens own = scaled_to(lens, 64, 48);
    for (const auto& [x, y] : {std::pair{0, 0}, {63, 0}, {31, 22}, {5, 47}, {63, 47}}) {
      const LensPoint there = distorted(lens, {image(x, y).r, image(x, y).g});
      // The mean over a pixel of a curved function: within a hundredth of a pixel.
      EXPECT_NEAR(own.fx * there.x + own.cx, x, 0.02);
      EXPECT_NEAR(own.fy * there.y + own.cy, y, 0.02);
      EXPECT_EQ(image(x, y).a, 1);
    }
  }
}

TEST(LensWarp, HasAtLeastTwoPixelsOfTheFrameForEachOfTheImage) {
  for (const Lens& lens : lenses) {
    const LensWarp warp(lens, 64, 48, 0, 0, 64, 48);
    for (const auto& [x, y] : {std::pair{1, 1}, {32, 24}, {62, 46}}) {
      const Lens own = scaled_to(lens, 64, 48);
      const auto at = [&](double px, double py) {
        const LensPoint p = *undistorted(own, {(px - own.cx) / own.fx, (py - own.cy) / own.fy});
        return LensPoint{p.x * warp.frame().fx, p.y * warp.frame().fy};
      };
      EXPECT_GE(std::hypot(at(x + 1, y).x - at(x, y).x, at(x + 1, y).y - at(x, y).y), 1.999);
      EXPECT_GE(std::hypot(at(x, y + 1).x - at(x, y).x, at(x, y + 1).y - at(x, y).y), 1.999);
    }
  }
}

TEST(LensWarp, APartHasTheBitsOfTheWhole) {
  const LensWarp whole(lenses[3], 64, 48, 0, 0, 64, 48), part(lenses[3], 64, 48, 17, 9, 20, 30);
  EXPECT_EQ(whole.frame(), part.frame());
  const LinearImage image = whole.warped(ramp(whole)), cut = part.warped(ramp(part));
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 20; ++x) ASSERT_EQ(cut(x, y), image(17 + x, 9 + y));
}

TEST(LensWarp, StepsOfPointsAreThoseOnTheImage) {
  const LensWarp warp(lenses[2], 64, 48, 0, 0, 64, 48);
  const Lens own = scaled_to(lenses[2], 64, 48);
  const LensWarp::Part& part = warp.frame_part();
  const Plane<float2> motion(part.width, part.height, float2{6, -4});
  const float2 step = warp.nearest_steps(motion, -1, 0)(50, 12);
  const LensPoint to = *undistorted(own, {(50 - own.cx) / own.fx, (12 - own.cy) / own.fy});
  const LensPoint from = distorted(own, {to.x - 6 / warp.frame().fx, to.y + 4 / warp.frame().fy});
  EXPECT_NEAR(step.x, 50 - (own.fx * from.x + own.cx), 1e-3);
  EXPECT_NEAR(step.y, 12 - (own.fy * from.y + own.cy), 1e-3);
}

}  // namespace
}  // namespace zoneplate
