// What methods that know geometry at more places than they shade must keep, on rendered scenes.
#include <gtest/gtest.h>

#include "zoneplate/antialias/shots_for_test.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/builtin.h"

namespace zoneplate::antialias {
namespace {

/// A white half-plane below the line y = 60 + slope (x - 80) of a picture of 160 × 120.
Scene half_plane(float slope) {
  Mesh mesh;
  const float run = 400, rise = slope * run;
  mesh.position = {{-run, rise, 0}, {-run, -900, 0}, {run, -900, 0}, {run, -rise, 0}};
  mesh.index = {0, 1, 2, 0, 2, 3};
  Scene scene = facing_scene(std::move(mesh));
  scene.cameras[0].half_height = 60;
  return scene;
}

TEST(Gbaa, AHalfPlaneIsItsOneDimensionalCoverage) {
  for (const float slope : {0.0f, 0.05f, 0.3f, 0.8f}) {
    const LinearImage own = shot(half_plane(slope), "gbaa");
    EXPECT_EQ(own, shot(half_plane(slope), "gbaa:edges=surfaces"));
    int partial = 0;
    for (int y = 5; y < 115; ++y)
      for (int x = 5; x < 155; ++x) {
        // The share of the pixel's middle column that lies below the line; 1/64 is half a place.
        const float line = 60 + slope * (static_cast<float>(x) + 0.5f - 80);
        const float share = std::clamp(static_cast<float>(y) + 1 - line, 0.0f, 1.0f);
        ASSERT_NEAR(own(x, y).a, share, 1 / 64.0f + 1e-4f) << slope << " at " << x << "," << y;
        partial += share > 0 && share < 1;
      }
    if (slope > 0) {
      EXPECT_GT(partial, 100);
    }
  }
}

TEST(Gbaa, EdgesWithinASurfaceDoNotHideWhereItEnds) {
  // A sphere of triangles smaller than pixels, as bright everywhere: its outline is all that there is to be smoothed.
  Scene scene = *make_builtin_scene("sphere:triangles=20000");
  scene.cameras.push_back(fit_camera(scene.bounds(), 4 / 3.0f, {}));
  for (Material& material : scene.materials) material.model = ShadingModel::Unlit;
  const LinearImage truth = shot(scene, "ssaa:n=16");
  const double of_triangles = mean_error(shot(scene, "gbaa"), truth);
  EXPECT_LT(mean_error(shot(scene, "gbaa:edges=surfaces"), truth), 0.8 * of_triangles);
}

TEST(Sraa, WithOneShadedPlaceAPixelItComesNearToMultisampling) {
  const Scene scene = *make_builtin_scene("cyclic");
  const LinearImage none = shot(scene, "none"), truth = shot(scene, "ssaa:n=16");
  for (const char* method : {"sraa:n=8", "gbaa"})
    EXPECT_LT(mean_error(shot(scene, method), truth), 0.5 * mean_error(none, truth)) << method;
}

TEST(Geometry, CropsThreadsAndInstructionSetsLeaveNoTrace) {
  const Scene scene = *make_builtin_scene("cyclic");
  for (const char* method : {"sraa", "gbaa", "gbaa:edges=surfaces"}) {
    LinearImage whole;
    with_threads(1, [&] { whole = shot(scene, method); });
    RenderOptions options{.width = 160, .height = 120};
    options.crop = Crop{50, 39, 32, 23};  // with a halo of 1
    LinearImage part;
    with_threads(3, [&] { part = shot(scene, method, options); });
    for (int y = 1; y < 22; ++y)
      for (int x = 1; x < 31; ++x) ASSERT_EQ(part(x, y), whole(50 + x, 39 + y)) << method;
    options.crop.reset();
    for (const Isa isa : supported_isas()) {
      options.isa = isa;
      EXPECT_EQ(shot(scene, method, options), whole) << method << " " << name_of(isa);
    }
  }
}

}  // namespace
}  // namespace zoneplate::antialias
