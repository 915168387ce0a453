// Outlines of models beside those of other renderers: babylon.js, Blender's Cycles, Filament, the glTF Sample Viewer,
// three.js' path tracer, model-viewer.
#include <gtest/gtest.h>

#include <filesystem>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/file.h"
#include "zoneplate/image/png.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/render/render.h"
#include "zoneplate/scene/load.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

/// A model seen from the front: its camera as the pictures were made with.
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

class Outlines : public testing::TestWithParam<Scenario> {};

TEST_P(Outlines, AgreeWithOtherRenderers) {
  const Scenario& scenario = GetParam();
  const fs::path data = fs::path(ZONEPLATE_SOURCE_DIR) / "../shared/data";
  const fs::path model = data / "models/gltf" / scenario.model,
                 pictures = data / "goldens-calibration/images" / scenario.name;
  if (!fs::exists(model) || !fs::exists(pictures)) GTEST_SKIP() << pictures << " is not here";

  const Scene scene = load_scene(model.string());
  const Camera camera{.world_from_camera = translation(scenario.target + float3{0, 0, scenario.distance}),
                      .vertical_fov = 0.7853982f,
                      .near = 0.1f,
                      .far = 100};
  const Request request = make_resolver(antialias::methods(), "msaa:n=16")->ask(0);
  const Frame frame = render(scene, camera, request, {.width = scenario.width, .height = scenario.height});

  int count = 0;
  for (const auto& entry : fs::directory_iterator(pictures)) {
    const FileBytes file(entry.path().string());
    const Rgba8Image other = decode_png(file.bytes(), entry.path().string()).pixels;
    ASSERT_EQ(other.width(), scenario.width);
    ASSERT_EQ(other.height(), scenario.height);
    double both = 0, either = 0;
    for (std::size_t i = 0; i < other.values().size(); ++i) {
      const bool ours = frame.color.values()[i].a >= 0.5f, theirs = other.values()[i].a >= 128;
      both += ours && theirs, either += ours || theirs;
    }
    EXPECT_GE(both / either, 0.995) << entry.path().filename();
    ++count;
  }
  EXPECT_EQ(count, 6);
}

INSTANTIATE_TEST_SUITE_P(Pictures, Outlines, testing::ValuesIn(scenarios),
                         [](const auto& tested) { return std::string(tested.param.name).substr(8); });

}  // namespace
}  // namespace zoneplate
