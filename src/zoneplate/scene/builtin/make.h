#pragma once

#include <cstdint>
#include <span>

#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// A number that changes a built-in scene: whole, or with decimals and then held as a whole number of the last of them
/// (0.5 with three decimals is 500), so that no rounding comes between the text and the scene.
struct BuiltinParam {
  const char* name;
  const char* meaning;
  std::int64_t otherwise, low, high;
  int decimals = 0;
};

/// How a built-in scene is made: its parameters arrive in the order in which it lists them.
struct BuiltinMaker {
  const char* name;
  const char* summary;
  std::span<const BuiltinParam> params;
  Scene (*make)(std::span<const std::int64_t> values);
  const char* failure = "";    ///< the class of failure that the scene is there to show
  const char* complaint = "";  ///< where users complained of it, and of what
};

// One function for each family of scenes, each in a file of its own.
BuiltinMaker builtin_teapot();
BuiltinMaker builtin_checkerboard();
BuiltinMaker builtin_triangles();
BuiltinMaker builtin_cyclic();
BuiltinMaker builtin_crossing();
BuiltinMaker builtin_sphere();
BuiltinMaker builtin_tri10k();
BuiltinMaker builtin_tri1m();
BuiltinMaker builtin_city();
BuiltinMaker builtin_city_trilinear();
BuiltinMaker builtin_fill();
BuiltinMaker builtin_fillblend();
BuiltinMaker builtin_micro();
BuiltinMaker builtin_wheel();
BuiltinMaker builtin_near_axis();
BuiltinMaker builtin_wires();
BuiltinMaker builtin_stars();
BuiltinMaker builtin_sun_roof();
BuiltinMaker builtin_foliage();
BuiltinMaker builtin_tiles();
BuiltinMaker builtin_metal();
BuiltinMaker builtin_text_ui();
BuiltinMaker builtin_thin_diagonal();

/// A camera at `eye` that looks at `target`, upright.
Camera camera_at(float3 eye, float3 target, float vertical_fov, float near, float far);

/// Adds a mesh as an object of its own, placed where it is.
void add_object(Scene& scene, const char* name, Mesh mesh);

}  // namespace zoneplate
