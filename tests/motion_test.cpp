// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/prepared_scene.h"

namespace zoneplate {
namespace {

constexpr Planes followed{
    .uv = true, .object_id = true, .primitive_id = true, .position = true, .motion = true, .flow = true};

// What a scene looks like from a camera, at the pixels' centres.
struct Look {
  Scene scene;
  Camera camera;
  RenderOptions options{.width = 600, .height = 440, .cull_back_faces = false};

  Moment moment() const { return {std::make_shared<const Scene>(scene), camera}; }
  Frame frame() const { return render(PreparedScene(scene), camera, {.planes = followed}, options); }
};

// Gives every vertex a name: two coordinates of where it was at the first moment, as texture coordinates.
void name_vertices(Scene& scene, const Scene& first, bool is_third) {
  for (Material& material : scene.materials) material = {};
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    Mesh& mesh = scene.meshes[i];
    mesh.uv0.clear(), mesh.uv1.clear(), mesh.tangent.clear();
    for (const float3 p : first.meshes[i].position) mesh.uv0.push_back(is_third ? float2{p.z, 0} : float2{p.x, p.y});
  }
}

// A surface point's name at a place between pixels; nothing where the four around it are not of that primitive.
std::optional<float2> name_at(const Frame& frame, float x, float y, std::uint32_t instance, std::uint32_t primitive) {
  const float fx = std::floor(x - 0.5f), fy = std::floor(y - 0.5f);
  if (fx < 0 || fy < 0 || fx + 1 >= static_cast<float>(frame.uv.width()) ||
      fy + 1 >= static_cast<float>(frame.uv.height()))
    return std::nullopt;
  const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
  for (const int j : {0, 1})
    for (const int i : {0, 1})
      if (frame.instance(ix + i, iy + j) != instance || frame.primitive_id(ix + i, iy + j) != primitive)
        return std::nullopt;
  const float tx = x - 0.5f - fx, ty = y - 0.5f - fy;
  const float2 above = frame.uv(ix, iy) * (1 - tx) + frame.uv(ix + 1, iy) * tx;
  const float2 below = frame.uv(ix, iy + 1) * (1 - tx) + frame.uv(ix + 1, iy + 1) * tx;
  return above * (1 - ty) + below * ty;
}

struct Followed {
  int points = 0;
  float max_miss = 0, max_step = 0;  // pixels
};

// Follows every point back to the last image, and finds by its name how far beside itself it lands.
Followed follow(Look now, Look last) {
  const Scene first = last.scene;
  const Moment before = last.moment();
  Frame now_frame[2], last_frame[2];
  for (const int k : {0, 1}) {
    name_vertices(now.scene, first, k == 1);
    name_vertices(last.scene, first, k == 1);
    now.options.last = before;
    now_frame[k] = now.frame();
    last_frame[k] = last.frame();
  }
  Followed out;
  for (int y = 0; y < now.options.height; ++y)
    for (int x = 0; x < now.options.width; ++x) {
      const std::uint32_t instance = now_frame[0].instance(x, y), primitive = now_frame[0].primitive_id(x, y);
      if (instance == Frame::no_id) continue;
      const float2 step = now_frame[0].motion(x, y);
      const float px = static_cast<float>(x) + 0.5f - step.x, py = static_cast<float>(y) + 0.5f - step.y;
      // Names change by `dx` and `dy` a pixel; the miss is the step on the screen that explains the difference.
      float difference[3], dx[3], dy[3];
      bool is_seen = true;
      for (const int k : {0, 1}) {
        const auto at = [&](float ox, float oy) {
          return name_at(last_frame[k], px + ox, py + oy, instance, primitive);
        };
        const auto here = at(0, 0), right = at(0.5f, 0), down = at(0, 0.5f);
        is_seen = is_seen && here && right && down;
        if (!is_seen) break;
        const float2 expected = now_frame[k].uv(x, y);
        difference[2 * k] = here->x - expected.x, dx[2 * k] = 2 * (right->x - here->x),
                       dy[2 * k] = 2 * (down->x - here->x);
        if (k == 1) continue;
        difference[1] = here->y - expected.y, dx[1] = 2 * (right->y - here->y), dy[1] = 2 * (down->y - here->y);
      }
      if (!is_seen) continue;
      double xx = 0, xy = 0, yy = 0, xd = 0, yd = 0;
      for (int i = 0; i < 3; ++i) {
        xx += 1.0 * dx[i] * dx[i], xy += 1.0 * dx[i] * dy[i], yy += 1.0 * dy[i] * dy[i];
        xd += 1.0 * dx[i] * difference[i], yd += 1.0 * dy[i] * difference[i];
      }
      const double det = xx * yy - xy * xy;
      if (det <= 1e-4 * xx * yy) continue;  // seen nearly from its edge: the four names say little
      const double mx = (yy * xd - xy * yd) / det, my = (xx * yd - xy * xd) / det;
      ++out.points;
      out.max_miss = std::max(out.max_miss, static_cast<float>(std::sqrt(mx * mx + my * my)));
      out.max_step = std::max(out.max_step, length(step));
    }
  return out;
}

Camera camera_of(const Scene& scene) { return fit_camera(scene.bounds(), 300.0f / 220, {.margin = 0.15f}); }

TEST(Motion, APointOfATurningWheelIsFollowed) {
  const Scene now = load_scene("wheel:spokes=8,turn=0.08"), last = load_scene("wheel:spokes=8,turn=0.02");
  const Camera camera = camera_of(last);
  const RenderOptions large{.width = 1200, .height = 880};  // its triangles are small
  const Followed found = follow({now, camera, large}, {last, camera, large});
  EXPECT_GT(found.points, 5000);
  EXPECT_GT(found.max_step, 10);
  EXPECT_LT(found.max_miss, 1.0f / 16);
}

TEST(Motion, TheCamerasOwnWayIsPartOfIt) {
  const Scene scene = load_scene("teapot");
  const Camera last = camera_of(scene);
  Camera now = last;
  now.world_from_camera = rotation({0, 1, 0}, 0.05f) * translation({0.02f, 0.03f, -0.1f}) * now.world_from_camera;
  const Followed found = follow({scene, now}, {scene, last});
  EXPECT_GT(found.points, 2000);
  EXPECT_GT(found.max_step, 10);
  EXPECT_LT(found.max_miss, 1.0f / 16);
}

TEST(Motion, SignsAndUnits) {
  // An upright square at 20 pixels a metre; it was 0.25 m further left and 0.1 m higher, and will be 1 m further right.
  Scene scene = load_scene("checkerboard");
  scene.meshes.resize(1), scene.instances.resize(1);
  scene.meshes[0] = {.position = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}},
                     .normal = std::vector<float3>(4, {0, 0, 1}),
                     .index = {0, 1, 2, 0, 2, 3}};
  scene.instances[0] = {};
  Scene before = scene, after = scene;
  before.instances[0].world_from_object = translation({-0.25f, 0.1f, 0});
  after.instances[0].world_from_object = translation({1, 0, 0});
  const Camera camera{
      .world_from_camera = translation({0, 0, 5}), .is_orthographic = true, .half_height = 2.5f, .near = 1, .far = 10};
  const Moment last{std::make_shared<const Scene>(before), camera}, next{std::make_shared<const Scene>(after), camera};
  const RenderOptions options{.width = 120, .height = 100, .last = last, .next = next};
  const Frame frame = render(PreparedScene(scene), camera, {.planes = followed}, options);
  EXPECT_NEAR(frame.motion(60, 50).x, 5, 1e-5f);
  EXPECT_NEAR(frame.motion(60, 50).y, 2, 1e-5f);
  EXPECT_NEAR(frame.flow(60, 50).x, 20, 1e-5f);
  EXPECT_NEAR(frame.flow(60, 50).y, 0, 1e-5f);
  // The centre of pixel (60, 50) is half a pixel right of and below the middle.
  EXPECT_NEAR(frame.position(60, 50).x, 0.025f, 1e-6f);
  EXPECT_NEAR(frame.position(60, 50).y, -0.025f, 1e-6f);
  EXPECT_EQ(frame.motion(2, 2), (float2{0, 0}));  // nothing is there
}

TEST(Motion, FollowsATextureThatMovesOverItsSurface) {
  // An upright square of 4 m at 20 pixels a metre, on which the texture's image is repeated four times along each axis.
  Scene scene = load_scene("checkerboard");
  scene.meshes.resize(1), scene.instances.resize(1);
  scene.meshes[0] = {.position = {{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}},
                     .normal = std::vector<float3>(4, {0, 0, 1}),
                     .uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}},
                     .index = {0, 1, 2, 0, 2, 3}};
  scene.instances[0] = {};
  const auto image_of = [&](float2 offset, float rotation) {
    Scene out = scene;
    TextureUse& use = out.materials[static_cast<std::size_t>(out.meshes[0].material)].base_color_texture;
    use.image = 0, use.scale = {4, 4}, use.offset = offset, use.rotation = rotation;
    return out;
  };
  const Camera camera{
      .world_from_camera = translation({0, 0, 5}), .is_orthographic = true, .half_height = 2.5f, .near = 1, .far = 10};
  const auto seen = [&](const Scene& last, const Scene& now, const Scene& next) {
    const Moment before{std::make_shared<const Scene>(last), camera},
        after{std::make_shared<const Scene>(next), camera};
    const RenderOptions options{.width = 120, .height = 100, .last = before, .next = after};
    return render(PreparedScene(now), camera, {.planes = followed}, options);
  };
  // An offset of 0.1 of a metre moves the image by 2 pixels the other way; one of 1 is that of 0.
  const Frame frame = seen(image_of({0, 0}, 0), image_of({0.1f, 0.2f}, 0), image_of({1, 0.2f}, 0));
  EXPECT_NEAR(frame.motion(60, 50).x, -2, 1e-4f);
  EXPECT_NEAR(frame.motion(60, 50).y, -4, 1e-4f);
  EXPECT_NEAR(frame.flow(60, 50).x, 2, 1e-4f);
  EXPECT_NEAR(frame.flow(60, 50).y, 0, 1e-4f);
  // A quarter of a turn about the texture's origin, the upper left corner of the square: the point of (u, v) has the
  // texel that was at (v, -u).
  const Frame turned = seen(image_of({0, 0}, 0), image_of({0, 0}, 1.57079633f), image_of({0, 0}, 1.57079633f));
  EXPECT_NEAR(turned.motion(60, 50).x, 0, 1e-3f);
  EXPECT_NEAR(turned.motion(60, 50).y, 81, 1e-3f);
  EXPECT_EQ(turned.flow(60, 50), (float2{0, 0}));
}

TEST(Motion, NothingMovesWithoutALastMoment) {
  const Scene scene = load_scene("cyclic");
  const Look look{scene, camera_of(scene)};
  const Frame frame = look.frame();
  for (const float2 m : frame.motion.values()) EXPECT_EQ(m, (float2{0, 0}));
}

TEST(Motion, ACropAndSamplesOffTheCentreHaveTheSamePoints) {
  const Scene scene = load_scene("teapot:divisions=6");
  Look look{scene, camera_of(scene)};
  const Request request{.samples = standard_pattern(8), .planes = followed};
  const Frame whole = render(PreparedScene(scene), look.camera, request, look.options);
  look.options.crop = Crop{200, 120, 90, 80};
  const Frame part = render(PreparedScene(scene), look.camera, request, look.options);
  const float4x4 clip_from_world = look.camera.clip_from_camera(300.0f / 220) * inverse(look.camera.world_from_camera);
  int edges = 0;
  for (int y = 0; y < 80; ++y)
    for (int x = 0; x < 90; ++x) {
      ASSERT_EQ(part.position(x, y), whole.position(200 + x, 120 + y));
      if (part.instance(x, y) == Frame::no_id) continue;
      // The point lies within the pixel, wherever its surface shows there.
      const float3 p = part.position(x, y);
      const float4 clip = clip_from_world * float4{p.x, p.y, p.z, 1};
      const float sx = (clip.x / clip.w + 1) * 300 - static_cast<float>(200 + x);
      const float sy = (1 - clip.y / clip.w) * 220 - static_cast<float>(120 + y);
      ASSERT_GT(std::min(sx, sy), -0.01f);
      ASSERT_LT(std::max(sx, sy), 1.01f);
      edges += std::abs(sx - 0.5f) > 0.02f || std::abs(sy - 0.5f) > 0.02f;
    }
  EXPECT_GT(edges, 20);
}

/// A bent sheet of 8 × 8 squares that moves in one of the ways of glTF: its node by keys with straight or curved ways
/// between them, its vertices by the weights of targets, or by the two joints of a skin.
GltfMaker moving_sheet(const std::string& kind) {
  constexpr int n = 8;
  std::vector<float> position, bend, weights;
  std::vector<std::uint8_t> joints;
  std::vector<std::uint16_t> index;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      const float u = static_cast<float>(x) / n * 2 - 1, v = static_cast<float>(y) / n * 2 - 1;
      for (const float c : {u, v, 0.2f * u * v}) position.push_back(c);
      for (const float c : {0.3f * v * v, 0.2f * u, 0.5f * u * u}) bend.push_back(c);
      for (const float c : {(1 - u) / 2, (1 + u) / 2, 0.0f, 0.0f}) weights.push_back(c);
      for (const int c : {0, 1, 0, 0}) joints.push_back(static_cast<std::uint8_t>(c));
      if (x == n || y == n) continue;
      for (const int c : {0, 1, n + 2, 0, n + 2, n + 1})
        index.push_back(static_cast<std::uint16_t>(y * (n + 1) + x + c));
    }
  GltfMaker m;
  const std::string times = m.floats("SCALAR", {0, 1});
  const auto animate = [&](int node, const std::string& path, const std::string& output, const std::string& way) {
    m.rest += R"(,"animations":[{"channels":[{"sampler":0,"target":{"node":)" + std::to_string(node) + R"(,"path":")" +
              path + R"("}}],"samplers":[{"input":)" + times + R"(,"output":)" + output + R"(,"interpolation":")" +
              way + "\"}]}]";
  };
  const bool is_skinned = kind == "Skin", is_morphed = kind == "Morph";
  std::string attributes = R"("POSITION":)" + m.floats("VEC3", position);
  if (is_skinned)
    attributes +=
        R"(,"JOINTS_0":)" + m.values<std::uint8_t>("VEC4", joints) + R"(,"WEIGHTS_0":)" + m.floats("VEC4", weights);
  const std::string targets = is_morphed ? R"(,"targets":[{"POSITION":)" + m.floats("VEC3", bend) + "}]" : "";
  m.mesh(attributes, R"(,"indices":)" + m.values<std::uint16_t>("SCALAR", index) + targets);
  if (is_skinned) {
    m.nodes = R"({"mesh":0,"skin":0},{},{})";
    m.scene_nodes = "0,1,2";
    m.rest = R"(,"skins":[{"joints":[1,2]}])";
  }
  const std::vector<float> turn = {0, 0, 0, 1, 0.2f, 0.1f, 0.3f, 0.9273618f};
  if (is_morphed) animate(0, "weights", m.floats("SCALAR", {0, 1}), "LINEAR");
  if (kind == "Curve")
    animate(0, "translation", m.floats("VEC3", {0, 0, 0, 0, 0, 0, 1, 2, 0, -1, 1, 0, 0.5f, 0.2f, -0.5f, 0, 0, 0}),
            "CUBICSPLINE");
  if (kind == "Turn" || is_skinned) animate(is_skinned ? 2 : 0, "rotation", m.floats("VEC4", turn), "LINEAR");
  return m;
}

/// Follows a model at two moments, each from a frame before.
void expect_followed(const std::string& path) {
  SceneSource source(path, {});
  const auto at = [&](double time) {
    return source.load_shape({.animation = SceneChoice::all_animations, .time = time});
  };
  int points = 0;
  float max_step = 0;
  for (const double time : {0.3, 0.8}) {
    const Scene now = at(time), last = at(time - 1.0 / 24);
    const Camera camera = camera_of(last);
    const Followed found = follow({now, camera}, {last, camera});
    points += found.points;
    max_step = std::max(max_step, found.max_step);
    EXPECT_LT(found.max_miss, 1.0f / 16) << time;
  }
  EXPECT_GT(points, 2000);
  EXPECT_GT(max_step, 1);
}

class MovingSheet : public testing::TestWithParam<const char*> {};
TEST_P(MovingSheet, IsFollowed) {
  const TestFolder folder;
  expect_followed(folder.write("sheet.glb", moving_sheet(GetParam()).glb()));
}
INSTANTIATE_TEST_SUITE_P(Motion, MovingSheet, testing::Values("Turn", "Curve", "Morph", "Skin"),
                         [](const auto& tested) { return std::string(tested.param); });

// Models of the Khronos Group, where they lie beside the sources.
class MovingModel : public testing::TestWithParam<std::string> {};
TEST_P(MovingModel, IsFollowed) { expect_followed(GetParam()); }
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(MovingModel);
INSTANTIATE_TEST_SUITE_P(Motion, MovingModel,
                         testing::ValuesIn(shared_files("data/models/gltf",
                                                        {"AnimatedCube/AnimatedCube.gltf", "InterpolationTest.glb",
                                                         "RiggedSimple.glb", "Fox.glb", "AnimatedMorphCube.glb",
                                                         "AnimatedMorphCube-Quantized/AnimatedMorphCube.gltf"})));

}  // namespace
}  // namespace zoneplate
