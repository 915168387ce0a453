// SPDX-License-Identifier: Apache-2.0
// Lines along the edges of meshes (edges/scene_edges.h) in finished images.
#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"
#include "zoneplate/scene/fit.h"
#include "zoneplate/scene/geometry/solids_for_test.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

constexpr int width = 64, height = 48;

/// A camera in front of the plane z = 0, of which a unit is a pixel; (0, 0) is the image's centre.
Camera pixel_camera() {
  Camera camera;
  camera.world_from_camera.column[3] = {0, 0, 100, 1};
  camera.is_orthographic = true, camera.half_height = height / 2.0f;
  camera.near = 1, camera.far = 200;
  return camera;
}

RenderSettings settings_with(const EdgeOptions& edges) {
  RenderSettings settings;
  settings.options.width = width, settings.options.height = height;
  settings.options.edges = edges;
  settings.options.display.background = {1, 1, 1, 1};
  return settings;
}

Rgba8Image image_of(Scene scene, const Camera& camera, const RenderSettings& settings,
                    const std::string& method = "none") {
  if (scene.lights.empty()) scene.lights = default_lights();
  light_unlit(scene);
  return Renderer(PreparedScene(std::move(scene)), upscale::make_method(method)).render_still(camera, settings).display;
}

/// Black lines over white without surfaces: the light that they take from a column, in pixels.
double darkness_of_column(const Rgba8Image& image, int x) {
  double sum = 0;
  for (int y = 0; y < image.height(); ++y) sum += 1 - decode_srgb8(image(x, y).r);
  return sum;
}

constexpr float4 black{0, 0, 0, 1}, red{1, 0, 0, 1};

TEST(Edges, WidthIsInPixelsWhateverThePosition) {
  for (const float line_width : {0.4f, 1.0f, 2.5f, 7.0f})
    for (const float move : {0.0f, 0.3f, 0.5f}) {
      // The sides of a box seen from the front: two horizontal and two vertical lines.
      const Box box{{-20, -10 + move, -5}, {20, 10 + move, 5}};
      const RenderSettings settings =
          settings_with({.kind = EdgeKind::Features, .width = line_width, .color = black, .has_surfaces = false});
      const Rgba8Image image = image_of(scene_of({box_mesh(box)}), pixel_camera(), settings);
      EXPECT_NEAR(darkness_of_column(image, width / 2), 2 * line_width, 0.03) << line_width << ' ' << move;
    }
}

TEST(Edges, FeaturesLeaveOutDiagonalsAndMeshHasThem) {
  const Scene scene = scene_of({box_mesh({{-20, -10, -5}, {20, 10, 5}})});
  const auto middle = [&](EdgeKind kind, float angle = 0.5f) {
    const RenderSettings settings =
        settings_with({.kind = kind, .crease_angle = angle, .color = black, .has_surfaces = false});
    return darkness_of_column(image_of(scene, pixel_camera(), settings), width / 2);
  };
  EXPECT_NEAR(middle(EdgeKind::Features), 2, 0.03);
  EXPECT_GT(middle(EdgeKind::Mesh), 2.9);  // and the diagonal of the front
}

TEST(Edges, CreasesDependOnTheAngle) {
  // A roof that rises by 20 degrees to both sides of its ridge, seen from above.
  Mesh roof;
  const float z = 20 * 0.36397f;
  roof.position = {{-20, -10, -z}, {0, -10, 0}, {0, 10, 0}, {-20, 10, -z}, {20, -10, -z}, {20, 10, -z}};
  roof.normal.assign(6, {0, 0, 1});
  roof.index = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
  const auto ridge = [&](float degrees) {
    const RenderSettings settings = settings_with({.kind = EdgeKind::Features,
                                                   .crease_angle = degrees * 3.14159265f / 180,
                                                   .color = black,
                                                   .has_surfaces = false});
    return 255 - image_of(scene_of({roof}), pixel_camera(), settings)(width / 2, height / 2).r;
  };
  EXPECT_GT(ridge(39), 50);  // half of each of two columns
  EXPECT_EQ(ridge(41), 0);
}

TEST(Edges, SurfacesHideLinesBehindThem) {
  // A small box behind a large one, whose front it would cross.
  Scene scene = scene_of({box_mesh({{-20, -15, 0}, {20, 15, 5}}), box_mesh({{-10, -5, -20}, {30, 5, -10}})});
  EdgeOptions edges{.kind = EdgeKind::Features, .color = black, .has_surfaces = false};
  Rgba8Image image = image_of(scene, pixel_camera(), settings_with(edges));
  EXPECT_NEAR(darkness_of_column(image, width / 2 + 5), 2, 0.03);   // the large one alone
  EXPECT_NEAR(darkness_of_column(image, width / 2 + 25), 2, 0.03);  // where the small box extends beyond it
  edges.hides = false;
  image = image_of(scene, pixel_camera(), settings_with(edges));
  EXPECT_NEAR(darkness_of_column(image, width / 2 + 5), 4, 0.06);

  // What is alpha-tested away, or glass, hides nothing.
  edges.hides = true;
  scene.materials.push_back(scene.materials[0]);
  scene.meshes[1].material = 1;
  scene.materials[0].alpha_mode = AlphaMode::Mask, scene.materials[0].base_color.w = 0.2f;
  image = image_of(scene, pixel_camera(), settings_with(edges));
  EXPECT_NEAR(darkness_of_column(image, width / 2 + 5), 4, 0.06);
}

TEST(Edges, CulledFacesNeitherHideNorHaveLines) {
  // A room seen from outside: its near wall faces inwards and is not drawn.
  Scene room = scene_of({box_mesh({{-20, -15, -20}, {20, 15, 5}}, true), box_mesh({{-8, -8, -10}, {8, 8, -8}})});
  EdgeOptions edges{.kind = EdgeKind::Features, .color = black, .has_surfaces = false};
  EXPECT_NEAR(darkness_of_column(image_of(room, pixel_camera(), settings_with(edges)), width / 2), 4, 0.06);
  room.materials[0].double_sided = true;
  EXPECT_NEAR(darkness_of_column(image_of(room, pixel_camera(), settings_with(edges)), width / 2), 2, 0.03);
}

TEST(Edges, HaveTheirColourUnderEveryMethodAndForm) {
  const Scene scene = *make_builtin_scene("teapot");
  const Camera camera = fit_camera(scene, 4.0f / 3, {});
  const RenderSettings settings = settings_with({.kind = EdgeKind::Features, .width = 3, .color = red});
  RenderSettings without = settings;
  without.options.edges = {};
  for (const char* const method : {"none", "msaa:n=4", "fxaa", "smaa", "taa:frames=3", "fsr1:scale=2",
                                   "none+taau:scale=2", "analytic", "converged:samples=64"}) {
    const Rgba8Image image = image_of(scene, camera, settings, method);
    const Rgba8Image plain = image_of(scene, camera, without, method);
    int lines = 0, same = 0;
    for (std::size_t i = 0; i < image.values().size(); ++i) {
      lines += image.values()[i] == Rgba8{255, 0, 0, 255};
      same += image.values()[i] == plain.values()[i];
    }
    EXPECT_GT(lines, 100) << method;
    EXPECT_GT(same, width * height / 2) << method;
  }
}

TEST(Edges, KeepTheirBitsInCropsOnThreadsAndInstructionSets) {
  const Scene scene = *make_builtin_scene("teapot");
  const Camera camera = fit_camera(scene, 4.0f / 3, {});
  for (const EdgeKind kind : {EdgeKind::Features, EdgeKind::Mesh})
    for (const char* const method : {"msaa:n=4", "smaa", "fsr1:scale=1.5"}) {
      RenderSettings settings = settings_with({.kind = kind, .width = 1.7f});
      const Rgba8Image whole = image_of(scene, camera, settings, method);
      with_threads(3, [&] { EXPECT_EQ(image_of(scene, camera, settings, method), whole); });
      with_isa(Isa::Scalar, [&] { EXPECT_EQ(image_of(scene, camera, settings, method), whole); });
      for (const Crop crop : {Crop{13, 7, 30, 21}, Crop{0, 0, 9, 48}, Crop{31, 20, 1, 1}}) {
        settings.options.crop = crop;
        const Rgba8Image part = image_of(scene, camera, settings, method);
        ASSERT_EQ(part.width(), crop.width);
        for (int y = 0; y < crop.height; ++y)
          for (int x = 0; x < crop.width; ++x) ASSERT_EQ(part(x, y), whole(crop.x + x, crop.y + y)) << method;
      }
    }
}

TEST(Edges, LinearImagesShowTheColourAfterExposure) {
  Scene scene = scene_of({box_mesh({{-20, -10, -5}, {20, 10, 5}})});
  scene.lights = default_lights();
  light_unlit(scene);
  RenderSettings settings = settings_with({.kind = EdgeKind::Features, .width = 6, .color = red});
  settings.form = ImageForm::Linear;
  settings.options.display.exposure = 4;
  Renderer renderer(PreparedScene(std::move(scene)), upscale::make_method("none"));
  const LinearImage image = renderer.render_still(pixel_camera(), settings).linear;
  EXPECT_EQ(image(width / 2, height / 2 + 10), (Linear{0.25f, 0, 0, 1}));
}

TEST(Edges, MotionBlurIsTheMeanOfItsMoments) {
  const RenderSettings settings = settings_with({.kind = EdgeKind::Features, .color = black, .has_surfaces = false});
  Scene scene = scene_of({box_mesh({{-40, -10, -5}, {40, 10, 5}})});
  scene.lights = default_lights();
  light_unlit(scene);
  const PreparedScene prepared(std::move(scene));
  Renderer renderer(prepared, upscale::make_method("none"));
  const auto moment = [&](int i) {
    Camera camera = pixel_camera();
    camera.world_from_camera.column[3].y = static_cast<float>(5 * i);
    return SceneView{prepared, camera};
  };
  const Rgba8Image image = renderer.render_mean(2, moment, settings).display;
  for (const int y : {height / 2 - 10, height / 2 - 5})
    EXPECT_NEAR(1 - (decode_srgb8(image(width / 2, y - 1).r) + decode_srgb8(image(width / 2, y).r)) / 2, 0.25, 0.02);
}

TEST(Edges, RefuseAWidthOfNothing) {
  EXPECT_THROW(image_of(scene_of({box_mesh({{0, 0, 0}, {1, 1, 1}})}), pixel_camera(),
                        settings_with({.kind = EdgeKind::Mesh, .width = 0})),
               Error);
}

}  // namespace
}  // namespace zoneplate
