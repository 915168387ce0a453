// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/sampling/csaa_draw.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/antialias/shots_for_test.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/scene/default_lights.h"

namespace zoneplate::antialias {
namespace {

std::size_t differing(const LinearImage& a, const LinearImage& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) count += std::abs(a.values()[i].g - b.values()[i].g) > 1e-5f;
  return count;
}

/// The triangles of every mesh in reverse order.
Scene drawn_backwards(Scene scene) {
  for (Mesh& mesh : scene.meshes) {
    std::vector<std::uint32_t> index;
    for (std::size_t t = mesh.index.size() / 3; t-- > 0;)
      index.insert(index.end(), mesh.index.begin() + static_cast<std::ptrdiff_t>(3 * t),
                   mesh.index.begin() + static_cast<std::ptrdiff_t>(3 * t + 3));
    mesh.index = index;
  }
  std::reverse(scene.instances.begin(), scene.instances.end());
  return scene;
}

TEST(CoverageSlots, TheSmallestIsForgottenUntilItsSamplesAreDrawnAgain) {
  CoverageSlots pixel(0xff);
  pixel.draw(1, 0b00001111, 2);
  EXPECT_EQ(pixel.known(), 0xffu);
  pixel.draw(2, 0b01110000, 2);  // the background is left with one sample and is dropped
  EXPECT_EQ(pixel.known(), 0b01111111u);
  pixel.draw(3, 0b10000000, 2);  // the new surface has the fewest samples and is dropped
  EXPECT_EQ(pixel.known(), 0b01111111u);
  pixel.draw(4, 0b11110000, 2);  // covers the samples of 2 and the unknown ones
  EXPECT_EQ(pixel.known(), 0xffu);
  pixel.draw(5, 0b00000011, 2);  // 1 and 5 have equally many samples: the later one is dropped
  EXPECT_EQ(pixel.known(), 0b11111100u);
  pixel.draw(4, 0b00000001, 2);  // another piece of a surface with a slot needs no additional one
  EXPECT_EQ(pixel.known(), 0b11111101u);
}

TEST(CoverageSlots, OneSlotIsTheLargest) {
  CoverageSlots pixel(0xf);
  pixel.draw(1, 0b0011, 1);
  EXPECT_EQ(pixel.known(), 0b1100u);
  pixel.draw(2, 0b0111, 1);
  EXPECT_EQ(pixel.known(), 0b0111u);
}

// The order is independent of threads, for pieces of one triangle and for samples, including those at position 0.
TEST(Csaa, TheOrderOfDrawingIsTotal) {
  Triangle shapes[2] = {};
  shapes[0].min_x = 5;
  const std::vector<Drawn> sorted = {{1, nullptr, false, 3, 0.5f},  {2, &shapes[1], false, 0, 0},
                                     {2, &shapes[0], false, 0, 0},  {2, nullptr, false, 0, 0.25f},
                                     {2, nullptr, false, 0, 0.5f},  {2, nullptr, false, 4096, 0.25f},
                                     {2, nullptr, false, 1, 0.25f}, {3, &shapes[0], true, 0, 0}};
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t j = 0; j < sorted.size(); ++j)
      EXPECT_EQ(comes_before(sorted[i], sorted[j]), i < j) << i << " " << j;
}

TEST(Csaa, SlotsAreFilledInTheOrderOfDrawing) {
  // Includes small triangles, which the renderer stores as samples.
  for (const char* name : {"wires", "sphere:triangles=20000"}) {
    Scene scene = *make_builtin_scene(name);
    if (scene.cameras.empty()) scene.cameras.push_back(fit_camera(scene.bounds(), 4 / 3.0f, {}));
    if (scene.lights.empty()) scene.lights = default_lights();
    const Scene backwards = drawn_backwards(scene);
    const LinearImage multisampled = shot(scene, "msaa:n=8");
    EXPECT_EQ(differing(shot(scene, "csaa:n=8,slots=8"), multisampled), 0u) << name;
    const LinearImage own = shot(scene, "csaa:n=8,slots=2"), other = shot(backwards, "csaa:n=8,slots=2");
    EXPECT_GT(differing(own, multisampled), 0u) << name;
    EXPECT_GT(differing(own, other), 0u) << name;
  }
}

TEST(Csaa, CropsThreadsAndInstructionSetsLeaveNoTrace) {
  const Scene scene = *make_builtin_scene("foliage");
  LinearImage whole;
  with_threads(1, [&] { whole = shot(scene, "csaa:n=8,slots=2"); });
  RenderOptions options{.width = 160, .height = 120};
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] {
      with_threads(3, [&] { EXPECT_EQ(shot(scene, "csaa:n=8,slots=2", options), whole) << name_of(isa); });
    });
  options.crop = Crop{50, 39, 70, 43};
  const LinearImage part = shot(scene, "csaa:n=8,slots=2", options);
  for (int y = 0; y < 43; ++y)
    for (int x = 0; x < 70; ++x) ASSERT_EQ(part(x, y), whole(50 + x, 39 + y));
}

}  // namespace
}  // namespace zoneplate::antialias
