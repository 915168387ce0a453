// SPDX-License-Identifier: Apache-2.0
// SMAA with several samples per pixel, in one frame (S2x), over two (T2x), or both (4x).
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/smaa/smaa.h"
#include "zoneplate/antialias/temporal/sequences_for_test.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate::antialias {
namespace {

constexpr int side = 48;

/// A white half-plane before black; its edge has a slope, and a distance from the image's centre in pixels.
MovingScene half_plane(double slope, double offset) {
  MovingScene moving;
  moving.width = moving.height = side;
  moving.scene = [=](int) {
    const double scale = 1 / std::sqrt(1 + slope * slope), dx = scale, dy = slope * scale, far = 6;
    const auto at = [&](double along, double across) {
      const double a = across + offset * 2 / side;
      return float3{static_cast<float>(along * dx - a * dy), static_cast<float>(along * dy + a * dx), -1};
    };
    Mesh black, white;
    add_quad(black, {{-9, -9, -2}, {9, -9, -2}, {9, 9, -2}, {-9, 9, -2}});
    add_quad(white, {at(-far, -far), at(far, -far), at(far, 0), at(-far, 0)});
    Scene scene;
    add_part(scene, unlit("black", {0, 0, 0}), std::move(black));
    add_part(scene, unlit("white", {1, 1, 1}), std::move(white));
    return scene;
  };
  moving.camera = [](int) { return flat_camera(1); };
  return moving;
}

RenderSettings display_settings(const MovingScene& moving) {
  RenderSettings settings = moving.settings();
  settings.form = ImageForm::Display8;
  return settings;
}

Rgba8Image settled(const MovingScene& moving, const std::string& method) {
  Renderer renderer(PreparedScene(moving.scene(0)), make_resolver(methods(), method));
  return renderer.render_still(moving.camera(0), display_settings(moving)).display;
}

/// The root mean square error of coverage, away from the image's sides.
double coverage_error(const Rgba8Image& image, const LinearImage& exact) {
  constexpr int border = 12;
  double sum = 0;
  for (int y = border; y < side - border; ++y)
    for (int x = border; x < side - border; ++x) {
      const double d = static_cast<double>(decode_srgb8(image(x, y).g)) - static_cast<double>(exact(x, y).g);
      sum += d * d;
    }
  return std::sqrt(sum) / (side - 2 * border);
}

constexpr double slopes[] = {0.05, 0.1, 0.2, 1.0 / 3, 0.5, 2, 3, 5, 10, 20};

double mean_error(const std::string& method) {
  double sum = 0;
  int count = 0;
  for (const double slope : slopes)
    for (const double offset : {0.03, 0.28, 0.53, 0.78}) {
      const MovingScene moving = half_plane(slope, offset);
      sum += coverage_error(settled(moving, method), last_frame(moving, "analytic", 1)), ++count;
    }
  return sum / count;
}

TEST(SmaaModes, MoreSamplesHaveLessError) {
  const double one = mean_error("smaa"), two = mean_error("smaa:mode=s2x"), over_time = mean_error("smaa:mode=t2x");
  const double four = mean_error("smaa:mode=4x");
  EXPECT_LT(two, one);
  EXPECT_LT(four, 0.85 * two);
  EXPECT_LT(four, 1.1 * mean_error("msaa:n=8"));
  // The same samples, in two frames instead of one.
  EXPECT_NEAR(over_time, two, 1e-9);
}

// Over frames a scene at rest is the mean of both of them, which are those of S2x.
TEST(SmaaModes, ASceneAtRestDoesNotFlicker) {
  const MovingScene moving = half_plane(0.2, 0.3);
  for (const char* method : {"smaa:mode=t2x", "smaa:mode=4x"}) {
    Renderer renderer(PreparedScene(moving.scene(0)), make_resolver(methods(), method));
    std::vector<Rgba8Image> images;
    for (int i = 0; i < 6; ++i) images.push_back(renderer.render(moving.camera(0), display_settings(moving)).display);
    EXPECT_NE(images[0], images[1]) << method;
    for (std::size_t i = 2; i < images.size(); ++i)
      for (std::size_t p = 0; p < images[i].values().size(); ++p)
        ASSERT_LE(std::abs(images[i].values()[p].g - images[1].values()[p].g), 1) << method;
  }
  EXPECT_EQ(settled(moving, "smaa:mode=t2x"), settled(moving, "smaa:mode=s2x"));
}

// The areas for the other frame's sample make the error of a half-plane greater than without any areas of its own.
TEST(SmaaModes, ExchangedSamplesAndAreasAreWrong) {
  constexpr std::array<int, 4> slots[] = {{1, 1, 1, 0}, {2, 2, 2, 0}};
  const auto error = [&](bool is_exchanged) {
    double sum = 0;
    for (const double slope : {0.1, 0.2, 1.0 / 3})
      for (const double offset : {0.03, 0.28, 0.53, 0.78}) {
        const MovingScene moving = half_plane(slope, offset);
        LinearImage mean(side, side, Linear{0, 0, 0, 1});
        for (std::size_t s = 0; s < 2; ++s) {
          const Request request{.samples = {standard_pattern(2)[s]}};
          const Frame frame =
              render(PreparedScene(moving.scene(0)), moving.camera(0), request, moving.settings().options);
          SmaaOptions options;
          options.slots = slots[is_exchanged ? 1 - s : s];
          const Rgba8Image image = apply_smaa(quantize8(make_display(frame.color, {})), nullptr, options);
          for (std::size_t p = 0; p < mean.values().size(); ++p)
            mean.values()[p].g += 0.5f * decode_srgb8(image.values()[p].g);
        }
        sum += coverage_error(quantize8(make_display(mean, {})), last_frame(moving, "analytic", 1));
      }
    return sum;
  };
  EXPECT_LT(error(false), 0.8 * error(true));
}

// A ghost lasts for one frame.
TEST(SmaaModes, HistoryIsThatOfOneFrame) {
  const MovingScene moving = square_before_wall([](int i) { return i < 4 ? float2{-28, 4} : float2{25, -3}; });
  for (const char* method : {"smaa:mode=t2x", "smaa:mode=4x"}) {
    PreparedScene prepared(moving.scene(0));
    Renderer renderer(prepared, make_resolver(methods(), method));
    std::vector<Rgba8Image> images;
    for (int i = 0; i < 6; ++i) {
      if (i > 0) renderer.set_scene(PreparedScene(moving.scene(i), prepared));
      images.push_back(renderer.render(moving.camera(i), display_settings(moving)).display);
    }
    const Rgba8 wall = images[5](90, 60);
    int ghosts = 0;
    for (int y = 0; y < moving.height; ++y)
      for (int x = 0; x < 45; ++x) ghosts += std::abs(images[5](x, y).g - wall.g) > 1;
    EXPECT_EQ(ghosts, 0) << method;
  }
}

// Nothing moves in a first frame, but what has moved in the second one has left its place.
TEST(SmaaModes, TheSecondFrameHasNoGhost) {
  constexpr int step = 12;  // pixels per frame
  const MovingScene moving = square_before_wall([](int i) { return float2{static_cast<float>(step * i), 0}; });
  for (const char* method : {"smaa:mode=t2x", "smaa:mode=4x"}) {
    PreparedScene prepared(moving.scene(0));
    Renderer renderer(prepared, make_resolver(methods(), method));
    renderer.render(moving.camera(0), display_settings(moving));
    renderer.set_scene(PreparedScene(moving.scene(1), prepared));
    const Rgba8Image image = renderer.render(moving.camera(1), display_settings(moving)).display;
    const Rgba8 wall = image(90, 60);
    const int left = moving.width / 2 - 10, top = moving.height / 2 - 10;  // of the square in the first frame
    for (int y = top + 2; y < top + 18; ++y)
      for (int x = left + 2; x < left + step - 2; ++x) ASSERT_LE(std::abs(image(x, y).g - wall.g), 1) << method << x;
  }
}

}  // namespace
}  // namespace zoneplate::antialias
