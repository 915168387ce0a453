// SPDX-License-Identifier: Apache-2.0
// Outlines of models: of shapes whose outline a camera's equations give in closed form, and of models as other
// renderers draw them: babylon.js, Blender's Cycles, Filament, the glTF Sample Viewer, three.js' path tracer,
// model-viewer.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/render.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

/// A model seen from the front: its camera as the images were made with.
struct Scenario {
  const char *name, *model;
  float3 target;
  float distance;
  int width, height;
};

constexpr Scenario scenarios[] = {
    {"khronos-Suzanne", "Suzanne/Suzanne.gltf", {0, 0, 0}, 3, 512, 512},
    {"khronos-TextureSettingsTest", "TextureSettingsTest.glb", {0, 0, 0}, 15, 512, 512},
    {"khronos-AlphaBlendModeTest", "AlphaBlendModeTest.glb", {0, 1.1f, 0}, 6, 512, 256},
    {"khronos-TextureTransformTest", "TextureTransformTest/TextureTransformTest.gltf", {0, 0, 0}, 4, 512, 512},
};

/// The share of pixels that two masks have in common, of those that either has.
template <class Ours, class Theirs>
double overlap(int width, int height, const Ours& ours, const Theirs& theirs) {
  double both = 0, either = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      both += ours(x, y) && theirs(x, y), either += ours(x, y) || theirs(x, y);
    }
  return both / either;
}

struct Pinhole {
  double eye[3];  ///< looks along -z, y up
  double fov;     ///< from the lower to the upper side, in radians
};

/// Draws a model of one glTF file through that camera.
Frame drawn(const GltfMaker& model, const Pinhole& pinhole, int width, int height) {
  const TestFolder folder;
  const Scene scene = load_scene(folder.write("model.glb", model.glb()));
  const Camera camera{
      .world_from_camera = translation(
          {static_cast<float>(pinhole.eye[0]), static_cast<float>(pinhole.eye[1]), static_cast<float>(pinhole.eye[2])}),
      .vertical_fov = static_cast<float>(pinhole.fov),
      .near = 0.1f,
      .far = 100};
  const Request request = make_resolver(antialias::methods(), "none")->request({});
  return render(PreparedScene(scene), camera, request, {.width = width, .height = height, .cull_back_faces = false});
}

/// A ball of 200 × 100 quads about a place, given by its node's translation.
GltfMaker ball(double radius, const char* place) {
  constexpr int across = 200, down = 100;
  std::vector<float> position;
  std::vector<std::uint32_t> index;
  for (int j = 0; j <= down; ++j)
    for (int i = 0; i <= across; ++i) {
      const double longitude = 2 * M_PI * i / across, latitude = M_PI * j / down;
      for (const double c :
           {std::sin(latitude) * std::cos(longitude), std::cos(latitude), std::sin(latitude) * std::sin(longitude)})
        position.push_back(static_cast<float>(radius * c));
      if (i == across || j == down) continue;
      for (const int c : {0, 1, across + 2, 0, across + 2, across + 1})
        index.push_back(static_cast<std::uint32_t>(j * (across + 1) + i + c));
    }
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", position), R"(,"indices":)" + m.values<std::uint32_t>("SCALAR", index));
  m.nodes = std::string(R"({"mesh":0,"translation":)") + place + "}";
  return m;
}

// A pixel shows a ball if the ray through its centre passes the ball's middle within its radius.
TEST(Outlines, ABallIsWhereRaysMeetIt) {
  struct {
    const char* place;
    double middle[3], radius;
    Pinhole pinhole;
    int width, height;
  } const cases[] = {{"[0,0,0]", {0, 0, 0}, 1, {{0, 0, 4}, 0.8}, 301, 201},
                     {"[1,0.5,-2]", {1, 0.5, -2}, 0.75, {{0, 0, 4}, 0.8}, 301, 201},  // an ellipse, right and above
                     {"[-2,-1,0]", {-2, -1, 0}, 1.2, {{0.5, 0.25, 3}, 1.4}, 160, 256}};
  for (const auto& c : cases) {
    const Frame frame = drawn(ball(c.radius, c.place), c.pinhole, c.width, c.height);
    const auto is_met = [&](int x, int y) {
      const double half = std::tan(c.pinhole.fov / 2);
      const double ray[3] = {half * (2 * (x + 0.5) - c.width) / c.height, half * (1 - 2 * (y + 0.5) / c.height), -1};
      double to_middle[3], along = 0, squared = 0, ray_squared = 0;
      for (int k = 0; k < 3; ++k) {
        to_middle[k] = c.middle[k] - c.pinhole.eye[k];
        along += ray[k] * to_middle[k], squared += to_middle[k] * to_middle[k], ray_squared += ray[k] * ray[k];
      }
      return squared - along * along / ray_squared <= c.radius * c.radius;
    };
    EXPECT_GE(overlap(
                  c.width, c.height, [&](int x, int y) { return frame.color(x, y).a >= 0.5f; }, is_met),
              0.995)
        << c.place;
  }
}

// A letter F in the ground's plane, seen from above at a slant: its sides are told apart, left and right, near and far.
TEST(Outlines, ALetterIsTurnedAndMovedByItsNode) {
  // Bars of (x, y) from corner to corner, turned by -90 degrees about x: y becomes -z.
  const double bars[3][4] = {{-0.5, -1, -0.2, 1}, {-0.2, 0.7, 0.6, 1}, {-0.2, -0.1, 0.4, 0.2}};
  std::vector<float> position;
  std::vector<std::uint16_t> index;
  for (const auto& [x0, y0, x1, y1] : bars) {
    const auto first = static_cast<std::uint16_t>(position.size() / 3);
    for (const auto& [x, y] : {std::pair{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}})
      for (const double c : {x, y, 0.0}) position.push_back(static_cast<float>(c));
    for (const int c : {0, 1, 2, 0, 2, 3}) index.push_back(static_cast<std::uint16_t>(first + c));
  }
  GltfMaker m;
  m.mesh(R"("POSITION":)" + m.floats("VEC3", position), R"(,"indices":)" + m.values<std::uint16_t>("SCALAR", index));
  m.nodes = R"({"mesh":0,"translation":[0.3,-1,0],"rotation":[-0.70710678,0,0,0.70710678]})";
  const Pinhole pinhole{{0, 0, 4}, 0.7};
  const int width = 320, height = 240;
  const Frame frame = drawn(m, pinhole, width, height);
  // A pixel shows the letter if its ray meets the plane y = -1 within a bar.
  const auto is_met = [&](int px, int py) {
    const double half = std::tan(pinhole.fov / 2);
    const double dx = half * (2 * (px + 0.5) - width) / height, dy = half * (1 - 2 * (py + 0.5) / height);
    if (dy >= 0) return false;
    const double t = -1 / dy, x = t * dx - 0.3, y = -(4 - t);
    for (const auto& [x0, y0, x1, y1] : bars)
      if (x >= x0 && x <= x1 && y >= y0 && y <= y1) return true;
    return false;
  };
  EXPECT_GE(overlap(
                width, height, [&](int x, int y) { return frame.color(x, y).a >= 0.5f; }, is_met),
            0.995);
}

class SharedOutlines : public testing::TestWithParam<Scenario> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedOutlines);

TEST_P(SharedOutlines, AgreeWithOtherRenderers) {
  const Scenario& scenario = GetParam();
  const fs::path data = fs::path(source_root) / "../shared/data";
  const fs::path model = data / "models/gltf" / scenario.model,
                 pictures = data / "goldens-calibration/images" / scenario.name;

  const Scene scene = load_scene(model.string());
  const Camera camera{.world_from_camera = translation(scenario.target + float3{0, 0, scenario.distance}),
                      .vertical_fov = 0.7853982f,
                      .near = 0.1f,
                      .far = 100};
  const Request request = make_resolver(antialias::methods(), "msaa:n=16")->request({});
  const Frame frame =
      render(PreparedScene(scene), camera, request, {.width = scenario.width, .height = scenario.height});

  int count = 0;
  for (const auto& entry : fs::directory_iterator(pictures)) {
    const FileBytes file(entry.path().string());
    const Rgba8Image other = decode_png(file.bytes(), entry.path().string()).pixels;
    ASSERT_EQ(other.width(), scenario.width);
    ASSERT_EQ(other.height(), scenario.height);
    EXPECT_GE(overlap(
                  scenario.width, scenario.height, [&](int x, int y) { return frame.color(x, y).a >= 0.5f; },
                  [&](int x, int y) { return other(x, y).a >= 128; }),
              0.995)
        << entry.path().filename();
    ++count;
  }
  EXPECT_EQ(count, 6);
}

std::vector<Scenario> scenarios_that_are_there() {
  std::vector<Scenario> out(std::begin(scenarios), std::end(scenarios));
  std::erase_if(out, [](const Scenario& s) {
    return shared_files("data/models/gltf", {s.model}).empty() ||
           shared_files("data/goldens-calibration/images", {s.name}).empty();
  });
  return out;
}
INSTANTIATE_TEST_SUITE_P(Pictures, SharedOutlines, testing::ValuesIn(scenarios_that_are_there()),
                         [](const auto& tested) { return std::string(tested.param.name).substr(8); });

}  // namespace
}  // namespace zoneplate
