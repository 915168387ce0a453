// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

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
  return find_invalid(s).value_or("");
}

TEST(FindFlaw, EveryPromiseIsLookedThrough) {
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
            "instance 0: its bounds are not finite");
  EXPECT_EQ(flaw_after([](Scene& s) { s.warnings = {"two\nlines"}; }), "a warning of several lines");
}

TEST(FindFlaw, NumbersOfMaterialsAreWithinWhatShadingTakes) {
  const auto with = [](const std::function<void(Material&)>& change) {
    return flaw_after([&](Scene& s) { change(s.materials[0]); });
  };
  EXPECT_EQ(with([](Material& m) { m.base_color.x = NAN; }), "material 0: a base colour out of range");
  EXPECT_EQ(with([](Material& m) { m.base_color.w = 1.5f; }), "material 0: a base colour out of range");
  EXPECT_EQ(with([](Material& m) { m.base_color.y = 3; }), "");  // valid in MTL
  EXPECT_EQ(with([](Material& m) { m.emissive.z = INFINITY; }), "material 0: a colour out of range");
  EXPECT_EQ(with([](Material& m) { m.ambient.x = -1; }), "material 0: a colour out of range");
  for (float Material::*factor : {&Material::alpha_cutoff, &Material::normal_scale, &Material::occlusion_strength,
                                  &Material::metallic, &Material::roughness, &Material::exponent})
    EXPECT_EQ(with([&](Material& m) { m.*factor = NAN; }), "material 0: a factor out of range");
  EXPECT_EQ(with([](Material& m) { m.roughness = 2; }), "material 0: a factor out of range");
  EXPECT_EQ(with([](Material& m) { m.normal_texture.rotation = INFINITY; }),
            "material 0: a texture transform that is not finite");
  EXPECT_EQ(with([](Material& m) { m.normal_texture.sampler.anisotropy = 1 << 30; }),
            "material 0: an anisotropy out of range");
  EXPECT_EQ(with([](Material& m) { m.emissive_texture.uv_set = 2; }),
            "material 0: no texture coordinates of that number");
  EXPECT_EQ(flaw_after([](Scene& s) {
              s.images.resize(1);
              s.materials[0].base_color_texture.image = 0;
            }),
            "material 0: an image of nothing");
}

TEST(FindFlaw, LightsAndCamerasAreWithinWhatRenderingTakes) {
  const auto with_light = [](const std::function<void(Light&)>& change) {
    return flaw_after([&](Scene& s) { change(s.lights.emplace_back()); });
  };
  EXPECT_EQ(with_light([](Light&) {}), "");
  EXPECT_EQ(with_light([](Light& l) { l.intensity = -1; }), "light 0: a colour or intensity out of range");
  EXPECT_EQ(with_light([](Light& l) { l.color.y = NAN; }), "light 0: a colour or intensity out of range");
  EXPECT_EQ(with_light([](Light& l) { l.position.x = INFINITY; }), "light 0: a place or direction that is none");
  EXPECT_EQ(with_light([](Light& l) { l.direction = {}; }), "light 0: a place or direction that is none");
  EXPECT_EQ(with_light([](Light& l) { l.direction = {1, 2, 3}; }), "light 0: a place or direction that is none");
  EXPECT_EQ(with_light([](Light& l) { l.direction = {1, 2, 3}, l.is_in_camera_space = true; }), "");
  EXPECT_EQ(with_light([](Light& l) { l.range = 0; }), "light 0: a falloff out of range");
  EXPECT_EQ(with_light([](Light& l) { l.attenuation.z = -1; }), "light 0: a falloff out of range");
  EXPECT_EQ(with_light([](Light& l) { l.inner_cone = l.outer_cone; }), "light 0: a cone out of range");
  EXPECT_EQ(with_light([](Light& l) { l.outer_cone = 3; }), "light 0: a cone out of range");

  const auto with_camera = [](const std::function<void(Camera&)>& change) {
    return flaw_after([&](Scene& s) { change(s.cameras.emplace_back()); });
  };
  EXPECT_EQ(with_camera([](Camera& c) { c.far = INFINITY; }), "");
  EXPECT_EQ(with_camera([](Camera& c) { c.world_from_camera.column[2].y = NAN; }),
            "camera 0: a place that is not finite");
  EXPECT_EQ(with_camera([](Camera& c) { c.aspect = -1; }), "camera 0: an aspect out of range");
  EXPECT_EQ(with_camera([](Camera& c) { c.vertical_fov = 4; }), "camera 0: a field of view out of range");
  EXPECT_EQ(with_camera([](Camera& c) { c.is_orthographic = true, c.half_height = 0; }),
            "camera 0: a field of view out of range");
  EXPECT_EQ(with_camera([](Camera& c) { c.near = 0; }), "camera 0: a near or far distance out of range");
  EXPECT_EQ(with_camera([](Camera& c) { c.far = c.near; }), "camera 0: a near or far distance out of range");
  EXPECT_EQ(with_camera([](Camera& c) { c.is_orthographic = true, c.far = INFINITY; }),
            "camera 0: a near or far distance out of range");
}

TEST(FindFlaw, WhatIsOfTheWholeSceneIsLookedAtToo) {
  EXPECT_EQ(flaw_after([](Scene& s) { s.up = {0, 0, 0}; }), "its upward axis has no unit length");
  EXPECT_EQ(flaw_after([](Scene& s) { s.environment.color.x = -1; }),
            "environment: a radiance or rotation out of range");
  EXPECT_EQ(flaw_after([](Scene& s) { s.environment.rotation = NAN; }),
            "environment: a radiance or rotation out of range");
  EXPECT_EQ(flaw_after([](Scene& s) { s.environment.image = 99; }), "environment: no image of that number");
  EXPECT_EQ(flaw_after([](Scene& s) { s.ambient_light.y = NAN; }), "its ambient light is out of range");
  EXPECT_EQ(flaw_after([](Scene& s) { s.animations = {{"a", 2, 1}}; }), "animation 0: a time out of range");
  EXPECT_EQ(flaw_after([](Scene& s) {
              s.meshes[0].position[1].x = 3e38f;
              s.instances[0].world_from_object.column[0].x = 2;
            }),
            "instance 0: its bounds are not finite");
  // A vertex that no primitive uses may have any position.
  EXPECT_EQ(flaw_after([](Scene& s) {
              s.meshes[0].position.push_back({3e38f, 0, 0}), s.meshes[0].normal.push_back({});
              s.instances[0].world_from_object.column[0].x = 2;
            }),
            "");
}

}  // namespace
}  // namespace zoneplate
