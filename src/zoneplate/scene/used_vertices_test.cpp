#include "zoneplate/scene/used_vertices.h"

#include <gtest/gtest.h>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"

namespace zoneplate {
namespace {

/// 100,000 vertices, of which primitives use those in odd places.
Scene many() {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.topology = Topology::Points;
  for (std::uint32_t i = 0; i < 100000; ++i) {
    mesh.position.push_back({unit_float(hash(i, 1)), unit_float(hash(i, 2)), unit_float(hash(i, 3))});
    if (i % 2 == 1) mesh.index.insert(mesh.index.end(), {i, i});
  }
  mesh.position[40000] = {50, 0, 0};
  mesh.position[40001] = {0, 60, 0};
  scene.materials.emplace_back();
  scene.instances.resize(2);
  scene.instances[1].world_from_object = translation({0, 0, 7});
  return scene;
}

TEST(UsedVertices, AreThoseOfPrimitives) {
  const Scene scene = many();
  for (const int threads : {1, 3})
    with_threads(threads, [&] {
      UsedVertices used(scene);
      const std::span<const std::uint8_t> flags = used.of(0);
      ASSERT_EQ(flags.size(), 100000u);
      for (std::size_t i = 0; i < flags.size(); ++i) ASSERT_EQ(flags[i], i % 2) << i;
      const Box box = used.bounds();
      EXPECT_EQ(box.high.y, 60);
      EXPECT_LT(box.high.x, 1);
      EXPECT_GT(box.high.z, 7);
    });
}

}  // namespace
}  // namespace zoneplate
