// SPDX-License-Identifier: Apache-2.0
// Texture filters on a checkerboard to the horizon, turned by 45 degrees, against 1024 samples a pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate {
namespace {

constexpr int floor_width = 96, floor_height = 72, first_row = 28;  // below the horizon

LinearImage render_board(const std::string& method, const TextureFilter& filter) {
  Scene scene = make_builtin_scene("checkerboard").value();
  scene.instances.at(0).world_from_object = rotation({0, 1, 0}, 0.78539816f);
  const Camera camera = scene.cameras.at(0);
  Renderer renderer(PreparedScene(std::move(scene)), make_resolver(antialias::methods(), method));
  const RenderOptions options{.width = floor_width, .height = floor_height, .texture_filter = filter};
  return std::move(renderer.render(camera, {.options = options, .form = ImageForm::Linear}).linear);
}

double rms(const LinearImage& a, const LinearImage& b) {
  double sum = 0;
  for (int y = first_row; y < floor_height; ++y)
    for (int x = 0; x < floor_width; ++x)
      sum += std::pow(static_cast<double>(a(x, y).g) - static_cast<double>(b(x, y).g), 2);
  return std::sqrt(sum / (floor_width * (floor_height - first_row)));
}

TEST(TextureFilters, AreOrderedByTheirErrorOnATurnedCheckerboard) {
  const LinearImage reference = render_board("ssaa:samples=1024", parse_texture_filter("bilinear"));
  std::map<std::string, double> error;
  for (const char* name : {"nearest", "bilinear", "trilinear", "ripmap", "probes:anisotropy=16", "ewa:anisotropy=16",
                           "sat", "catmull-rom", "b-spline", "mitchell"}) {
    error[name] = rms(render_board("none", parse_texture_filter(name)), reference);
    RecordProperty(name, std::to_string(error[name]));
  }
  EXPECT_GT(error["nearest"], error["bilinear"]);
  EXPECT_GT(error["bilinear"], error["trilinear"]);
  EXPECT_GT(error["trilinear"], error["ripmap"]);
  EXPECT_GT(error["ripmap"], error["probes:anisotropy=16"]);
  EXPECT_GT(error["ripmap"], error["ewa:anisotropy=16"]);
}

}  // namespace
}  // namespace zoneplate
