// SPDX-License-Identifier: Apache-2.0
// Images through calibrated lenses (lens/lens_warp.h): every pixel shows what OpenCV's model projects to it.
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/lens/lens_warp.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

constexpr int lens_width = 80, lens_height = 60;

const Lens barrel{.width = lens_width,
                  .height = lens_height,
                  .fx = 76,
                  .fy = 74,
                  .cx = 42.5,
                  .cy = 27,
                  .k1 = -0.31,
                  .k2 = 0.12,
                  .k3 = -0.02,
                  .p1 = 0.0012,
                  .p2 = -0.0007};
const Lens rational{.width = lens_width,
                    .height = lens_height,
                    .fx = 76,
                    .fy = 74,
                    .cx = 42.5,
                    .cy = 27,
                    .k1 = 0.41,
                    .k2 = -0.22,
                    .k3 = 0.05,
                    .k4 = 0.75,
                    .k5 = -0.13,
                    .k6 = 0.021,
                    .p1 = 0.0008,
                    .p2 = -0.0011};

PreparedScene teapot() {
  Scene scene = *make_builtin_scene("teapot");
  if (scene.lights.empty()) scene.lights = default_lights();
  light_unlit(scene);
  return PreparedScene(std::move(scene));
}

Camera camera_with(const PreparedScene& scene, const Lens& lens) {
  return choose_camera(scene.scene(), View{.lens = lens}, 1.0f * lens_width / lens_height);
}

RenderSettings settings() {
  RenderSettings out;
  out.options.width = lens_width, out.options.height = lens_height;
  return out;
}

RenderedImage image_of(const PreparedScene& scene, const Camera& camera, const RenderSettings& settings,
                       const char* method = "msaa:n=4") {
  return Renderer(scene, upscale::make_method(method)).render_still(camera, settings);
}

TEST(LensImage, PositionsProjectToTheirPixels) {
  const PreparedScene scene = teapot();
  Lens pinhole = barrel;
  pinhole.k1 = pinhole.k2 = pinhole.k3 = pinhole.p1 = pinhole.p2 = 0;
  for (const Lens& lens : {pinhole, barrel, rational}) {
    const Camera camera = camera_with(scene, lens);
    RenderSettings own = settings();
    own.planes.position = own.planes.object_id = own.planes.depth = true;
    const Frame data = image_of(scene, camera, own, "none").data;
    const float4x4 camera_from_world = inverse(camera.world_from_camera);
    int surfaces = 0;
    for (int y = 0; y < lens_height; ++y)
      for (int x = 0; x < lens_width; ++x) {
        if (data.object_id(x, y) == Frame::no_id) continue;
        ++surfaces;
        const float3 p = transform_point(camera_from_world, data.position(x, y));
        const LensPoint at = distorted(lens, {p.x / -p.z, -p.y / -p.z});
        // Data are those of the nearest pixel of the frame, at most half of one of the image.
        ASSERT_NEAR(lens.fx * at.x + lens.cx, x, 0.5) << y;
        ASSERT_NEAR(lens.fy * at.y + lens.cy, y, 0.5) << x;
      }
    EXPECT_GT(surfaces, lens_width * lens_height / 8);
  }
}

TEST(LensImage, KeepsItsBitsInCropsUnderEveryMethod) {
  const PreparedScene scene = teapot();
  const Camera camera = camera_with(scene, barrel);
  for (const char* const method : {"msaa:n=4", "smaa", "taa:frames=2", "fsr1:scale=1.5"}) {
    RenderSettings own = settings();
    own.options.edges.kind = EdgeKind::Features;
    const Rgba8Image whole = image_of(scene, camera, own, method).display;
    ASSERT_EQ(whole.width(), lens_width);
    if (std::string_view(method).starts_with("taa")) continue;  // histories of crops are those of their pixels
    own.options.crop = Crop{21, 17, 30, 19};
    const RenderedImage part = image_of(scene, camera, own, method);
    for (int y = 0; y < 19; ++y)
      for (int x = 0; x < 30; ++x) ASSERT_EQ(part.display(x, y), whole(21 + x, 17 + y)) << method;
  }
}

TEST(LensImage, FormsAgree) {
  const PreparedScene scene = teapot();
  const Camera camera = camera_with(scene, rational);
  RenderSettings own = settings();
  own.options.display.is_transparent = true;
  const Rgba8Image display = image_of(scene, camera, own).display;
  own.form = ImageForm::Linear;
  const LinearImage linear = image_of(scene, camera, own).linear;
  double difference = 0;
  for (int y = 0; y < lens_height; ++y)
    for (int x = 0; x < lens_width; ++x)
      difference = std::max(difference, std::abs(linear(x, y).a - display(x, y).a / 255.0));
  EXPECT_LT(difference, 0.0021);
}

TEST(LensImage, RefusesParallelProjections) {
  const PreparedScene scene = teapot();
  EXPECT_THROW(choose_camera(scene.scene(), View{.is_orthographic = true, .lens = barrel}, 1), Error);
}

}  // namespace
}  // namespace zoneplate
