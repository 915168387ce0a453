#include "zoneplate/scene/sound.h"

#include <gtest/gtest.h>

#include <cmath>

namespace zoneplate {
namespace {

Scene triangle() {
  Scene s;
  s.materials.resize(1);
  s.objects = {"a"};
  s.meshes.push_back(
      {.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normal = std::vector<float3>(3, {0, 0, 1}), .index = {0, 1, 2}});
  s.instances = {{0, 0, {}}};
  return s;
}

std::string flaw_after(const std::function<void(Scene&)>& change) {
  Scene s = triangle();
  change(s);
  return find_flaw(s).value_or("");
}

TEST(Sound, EveryPromiseIsLookedThrough) {
  EXPECT_EQ(flaw_after([](Scene&) {}), "");
  EXPECT_EQ(flaw_after([](Scene& s) { s.meshes[0].index[1] = 3; }), "mesh 0: an index out of range");
  EXPECT_EQ(flaw_after([](Scene& s) { s.meshes[0].index.pop_back(); }), "mesh 0: half a primitive");
  EXPECT_EQ(flaw_after([](Scene& s) { s.meshes[0].position[1].y = NAN; }),
            "mesh 0: an attribute of another length, or not finite");
  EXPECT_EQ(flaw_after([](Scene& s) { s.meshes[0].uv0.resize(2); }),
            "mesh 0: an attribute of another length, or not finite");
  EXPECT_EQ(flaw_after([](Scene& s) { s.meshes[0].normal.clear(); }), "mesh 0: triangles without normals");
  EXPECT_EQ(flaw_after([](Scene& s) {
              s.meshes[0].normal[2] = {0, 0, 1.001f};
            }),
            "mesh 0: a normal that is not of unit length");
  EXPECT_EQ(flaw_after([](Scene& s) { s.meshes[0].material = 1; }), "mesh 0: no material of that number");
  EXPECT_EQ(flaw_after([](Scene& s) { s.materials[0].normal_texture.image = 0; }),
            "material 0: no image of that number");
  EXPECT_EQ(flaw_after([](Scene& s) { s.instances[0].mesh = -1; }), "instance 0: no mesh of that number");
  EXPECT_EQ(flaw_after([](Scene& s) { s.instances[0].object = 1; }), "instance 0: no object of that number");
  EXPECT_EQ(flaw_after([](Scene& s) { s.instances[0].world_from_object.column[0].x = INFINITY; }),
            "its bounds are not finite");
  EXPECT_EQ(flaw_after([](Scene& s) { s.warnings = {"two\nlines"}; }), "a warning of several lines");
}

}  // namespace
}  // namespace zoneplate
