// SPDX-License-Identifier: Apache-2.0
// Rendering with an upscaler: sizes, crops, data passes and texture detail.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/base/error.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/fit.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

constexpr int odd_width = 161, odd_height = 121;  // no multiple of any scale

PreparedScene prepared(const std::string& name) {
  Scene scene = *make_builtin_scene(name);
  light_unlit(scene);
  return PreparedScene(std::move(scene));
}

Camera camera_of(const PreparedScene& prepared) {
  const Scene& scene = prepared.scene();
  return scene.cameras.empty() ? fit_camera(scene, static_cast<float>(odd_width) / odd_height, {}) : scene.cameras[0];
}

RenderedImage rendered(const PreparedScene& scene, std::string_view method, const RenderSettings& settings) {
  return Renderer(scene, make_method(method)).render(camera_of(scene), settings);
}

RenderSettings settings_with(std::optional<Crop> crop, Planes planes = {}) {
  return {.options = {.width = odd_width, .height = odd_height, .crop = crop}, .planes = planes};
}

TEST(Upscaled, ACropHasTheBitsOfTheWholeImage) {
  const PreparedScene scene = prepared("wires");
  for (const char* method : {"smaa+fsr1:scale=2", "msaa:n=4+bicubic", "fxaa+lanczos:scale=1.7", "bilinear:scale=3",
                             "smaa+fsr1:scale=1.3,sharpen=none", "none+nis:scale=2", "none+sgsr1"}) {
    const Rgba8Image whole = rendered(scene, method, settings_with({})).display;
    ASSERT_EQ(whole.width(), odd_width) << method;
    ASSERT_EQ(whole.height(), odd_height) << method;
    for (const Crop& crop : {Crop{0, 0, 33, 21}, Crop{60, 40, 50, 31}, Crop{140, 100, 21, 21}}) {
      const Rgba8Image part = rendered(scene, method, settings_with(crop)).display;
      ASSERT_EQ(part.width(), crop.width) << method;
      for (int y = 0; y < crop.height; ++y)
        for (int x = 0; x < crop.width; ++x)
          ASSERT_EQ(part(x, y), whole(crop.x + x, crop.y + y)) << method << " " << x << " " << y;
    }
  }
}

TEST(Upscaled, RendersFewerPixelsAndDataOfTheImage) {
  const PreparedScene scene = prepared("teapot");
  const Planes planes{.depth = true, .normal = true, .object_id = true};
  const RenderedImage direct = rendered(scene, "none", settings_with({}, planes));
  const RenderedImage upscaled = rendered(scene, "none+fsr1:scale=2", settings_with({}, planes));
  EXPECT_EQ(upscaled.data.depth, direct.data.depth);
  EXPECT_EQ(upscaled.data.normal, direct.data.normal);
  EXPECT_EQ(upscaled.data.object_id, direct.data.object_id);
  EXPECT_NEAR(static_cast<double>(upscaled.counts.shaded) / static_cast<double>(direct.counts.shaded), 0.25, 0.01);
  EXPECT_TRUE(rendered(scene, "none+fsr1:scale=2", settings_with({})).data.depth.empty());
}

// The view is that of the image, although its sides are not multiples of the scale: surfaces stay where they are.
TEST(Upscaled, SurfacesStayInPlace) {
  const PreparedScene scene = prepared("triangles");
  const Rgba8Image direct = rendered(scene, "ssaa:n=4", settings_with({})).display;
  const auto error = [&](int shift) {
    const Rgba8Image image = rendered(scene, "ssaa:n=4+bilinear:scale=1.5", settings_with({})).display;
    double sum = 0;
    for (int y = 0; y < odd_height; ++y)
      for (int x = 1; x < odd_width - 1; ++x) sum += std::abs(int{image(x + shift, y).g} - int{direct(x, y).g});
    return sum;
  };
  EXPECT_LT(1.8 * error(0), error(1));
  EXPECT_NEAR(error(1), error(-1), 0.02 * error(1));
}

TEST(Upscaled, TexturesAreFilteredForThePixelsOfTheImage) {
  const PreparedScene scene = prepared("checkerboard");
  RenderSettings settings = settings_with({}, {.mip_level = true});
  const Frame whole = rendered(scene, "none", settings).data;
  // The method's own data planes, of the smaller frame.
  class Levels : public Resolver {
   public:
    Levels(std::unique_ptr<Resolver> method, Plane<float>& levels) : method_(std::move(method)), levels_(levels) {}
    Request request(const FrameContext& context) override {
      Request request = method_->request(context);
      request.planes.mip_level = true;
      return request;
    }
    DisplayImage post_process(DisplayImage image, const Frame& frame) override {
      levels_ = frame.mip_level;
      return method_->post_process(std::move(image), frame);
    }

   private:
    std::unique_ptr<Resolver> method_;
    Plane<float>& levels_;
  };
  Plane<float> levels;
  Renderer(scene, std::make_unique<Levels>(make_method("bilinear:scale=2"), levels))
      .render(camera_of(scene), settings_with({}));
  ASSERT_EQ(levels.width(), odd_width / 2);
  EXPECT_NEAR(levels(40, 50), whole.mip_level(81, 101), 0.1f);
}

/// Requests a frame of half the size, and measures how far the motion of surfaces at rest is from that of the camera.
class CameraFollower : public Resolver {
 public:
  explicit CameraFollower(float& greatest) : max_(greatest) {}
  Request request(const FrameContext& context) override {
    context_ = context;
    Request request;
    request.planes.depth = request.planes.motion = true;
    request.frame = frame_size(context.image, 2);
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    const antialias::CameraMotion camera(context_, frame.depth.width(), frame.depth.height());
    for (int y = 0; y < frame.depth.height(); ++y)
      for (int x = 0; x < frame.depth.width(); ++x) {
        if (!std::isfinite(frame.depth(x, y))) continue;
        const float2 found = camera.at(x + 0.5, y + 0.5, double{frame.depth(x, y)}), own = frame.motion(x, y);
        max_ = std::max({max_, std::abs(found.x - own.x), std::abs(found.y - own.y)});
      }
    return LinearImage(context_.image.width, context_.image.height);
  }

 private:
  float& max_;
  FrameContext context_;
};

// A point at rest moves as the camera does, within the tolerance by which sgsr2 knows objects: 1/256 pixel.
TEST(Upscaled, PointsAtRestMoveWithTheCameraInFramesOfAnotherRatio) {
  const PreparedScene scene = prepared("teapot");
  const RenderSettings settings{.options = {.width = 101, .height = 43}};
  float greatest = 0;
  Renderer renderer(scene, std::make_unique<CameraFollower>(greatest));
  Camera camera = fit_camera(scene.scene(), 101.0f / 43, {});
  renderer.render(camera, settings);
  EXPECT_EQ(greatest, 0);
  camera.world_from_camera = camera.world_from_camera * rotation(float3{0, 1, 0}, 0.05f);
  renderer.render(camera, settings);
  EXPECT_GT(greatest, 0);
  EXPECT_LT(greatest, 1.0f / 256);
}

TEST(Upscaled, LinearImagesAreRefused) {
  const PreparedScene scene = prepared("teapot");
  RenderSettings settings = settings_with({});
  settings.form = ImageForm::Linear;
  EXPECT_THROW(rendered(scene, "none+fsr1", settings), Error);
}

}  // namespace
}  // namespace zoneplate::upscale
