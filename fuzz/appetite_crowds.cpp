// SPDX-License-Identifier: Apache-2.0
// What takes little to read and much to render: crowds of surfaces over the same pixels, and large images.
#include "appetite_gltf.h"

namespace zoneplate::appetite {
namespace {

using Json = Gltf::Json;

/// Colours of a square's corners whose alpha goes from 0 to 1, so that no part of it is all or nothing.
std::size_t slanted_alpha(Gltf& file) {
  return file.floats("VEC4", 4, {1, 0, 0, 0.1f, 0, 1, 0, 0.9f, 0, 0, 1, 0.4f, 1, 1, 1, 0.6f});
}

/// Places behind each other along the view, or all in one.
std::size_t places(Gltf& file, std::size_t count, bool are_apart) {
  if (!are_apart) return file.zeros(count, "VEC3");
  std::vector<float> list;
  for (std::size_t i = 0; i < count; ++i) list.insert(list.end(), {0, 0, -1e-4f * static_cast<float>(i)});
  return file.floats("VEC3", 3, list);
}

/// Squares over the same pixels, all of one mode of alpha.
Gltf squares(const char* alpha_mode, std::size_t count, bool are_apart) {
  Gltf file;
  file.append("materials", {{"alphaMode", alpha_mode}, {"doubleSided", true}});
  const std::size_t mesh = file.square({{"COLOR_0", slanted_alpha(file)}}, {{"material", 0}});
  file.place(mesh, places(file, count, are_apart));
  return file;
}

void add_transparent(Collection& out, const char* kind, const char* mode) {
  const auto add = [&](const std::string& name, std::size_t count, bool are_apart, const char* size, const char* aa) {
    out.add(kind, kind + ("-" + name) + ".glb", squares(mode, count, are_apart).glb(), within_limits,
            {{"size", size}, {"aa", aa}});
  };
  add("4k", 4000, false, "64x64", "msaa:n=8");
  add("20k", 20000, false, "64x64", "msaa:n=8");
  add("20k-apart", 20000, true, "512x512", "none");
  add("4k-msaa-16", 4000, true, "64x64", "msaa:n=16");
  add("4k-ssaa-8", 4000, true, "64x64", "ssaa:n=8");
  add("4k-csaa", 4000, true, "256x256", "csaa");
  add("4k-adaptive", 4000, true, "256x256", "adaptive");
  add("1k-analytic", 1000, true, "64x64", "analytic");
  add("1k-converged", 1000, true, "64x64", "converged");
}

void add_opaque(Collection& out) {
  const auto add = [&](const std::string& name, std::size_t count, const char* size, const char* aa) {
    out.add("opaque", "opaque-" + name + ".glb", squares("OPAQUE", count, true).glb(), within_limits,
            {{"size", size}, {"aa", aa}});
  };
  add("100k-none", 100000, "1024x1024", "none");
  add("20k-msaa-16", 20000, "512x512", "msaa:n=16");
  add("20k-analytic", 20000, "256x256", "analytic");
  add("20k-csaa", 20000, "512x512", "csaa");
  add("20k-gbaa", 20000, "512x512", "gbaa");
  add("20k-sraa", 20000, "512x512", "sraa");
  out.add_builtin("opaque", "foliage", within_limits, {{"size", "16x12"}, {"aa", "analytic"}});
}

/// A camera at the origin that looks down -Z.
void add_camera(Gltf& file) {
  file.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.01}}}});
  file.add_root({{"camera", 0}});
}

/// Triangles that reach from behind the camera to far before it, and others whose corners lie far outside the image.
void add_clipped(Collection& out) {
  for (const char* aa : {"none", "msaa:n=16", "analytic"}) {
    Gltf file;
    add_camera(file);
    file.append("materials", {{"doubleSided", true}});
    const std::size_t mesh = file.mesh(
        {{"POSITION", file.floats("VEC3", 3, {-5, -1, 9, 5, -1.1f, 9, 0, -1, -90, -5, 2, 9, 5, 2, -9, 3, -90, 9})}},
        {{"material", 0}});
    file.place_at_zero(mesh, aa == std::string("analytic") ? 5000 : 200000);
    const std::string name(aa, std::string(aa).find(':') == std::string::npos ? std::string(aa).size() : 4);
    out.add("clipped", "clipped-" + name + ".glb", file.glb(), within_limits, {{"size", "400x300"}, {"aa", aa}});
  }
}

void add_displaced(Collection& out) {
  Gltf file;
  add_camera(file);
  file.append("materials", {{"doubleSided", true}});
  const std::size_t mesh = file.mesh(
      {{"POSITION", file.floats("VEC3", 3, {-1e9f, -1e9f, -1, 1e9f, -1e9f, -2, 0, 1e9f, -3})}}, {{"material", 0}});
  file.place_at_zero(mesh, 100000);
  out.add("displaced", "displaced-large.glb", file.glb(), within_limits, {{"size", "400x300"}, {"aa", "msaa:n=8"}});

  Gltf slivers;  // long and thin: through many tiles, each of which has little of it
  add_camera(slivers);
  slivers.append("materials", {{"doubleSided", true}});
  const std::size_t sliver = slivers.mesh(
      {{"POSITION", slivers.floats("VEC3", 3, {-10, -10, -9, 10, 9.99f, -9, 10, 10, -9})}}, {{"material", 0}});
  slivers.place_at_zero(sliver, 200000);
  out.add("displaced", "displaced-slivers.glb", slivers.glb(), within_limits, {{"size", "2048x2048"}});
}

void add_lights(Collection& out) {
  Gltf file;
  file.place(file.square(), file.zeros(1, "VEC3"));
  file.root["extensionsUsed"].push_back("KHR_lights_punctual");
  file.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 0.01}}};
  for (int i = 0; i < 20000; ++i)
    file.add_root({{"translation", {0, 0, 2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  out.add("lights", "lights-20k.glb", file.glb(), within_limits, {{"size", "800x600"}});
}

/// Images and films of more pixels than bytes are allowed.
void add_large_pictures(Collection& out) {
  const auto add = [&](const char* kind, const char* scene, const Options& options) {
    out.add_builtin(kind, scene, within_limits, options);
  };
  add("large", "teapot", {{"size", "16384x16384"}});
  add("large", "triangles", {{"size", "1800x1800"}, {"aa", "ssaa:n=16"}});
  add("large", "wires", {{"size", "1800x1800"}, {"aa", "msaa:n=16"}});
  add("large", "city", {{"size", "1500x1500"}, {"aa", "converged"}});
  add("large", "teapot", {{"size", "5000x5000"}, {"output", "large.exr"}, {"aov", "depth,normal,position,uv"}});
  add("films", "teapot", {{"turntable", "500"}, {"size", "1280x720"}, {"output", "film.apng"}});
  add("films", "sphere:triangles=1000", {{"turntable", "100000"}, {"size", "16x16"}, {"output", "film.webp"}});
  add("films", "wheel", {{"frames", "1"}, {"shutter", "360"}, {"shutter-samples", "1024"}, {"output", "film.###.png"}});
}

}  // namespace

void add_crowds(Collection& out) {
  add_transparent(out, "masked", "MASK");
  add_transparent(out, "blended", "BLEND");
  add_opaque(out);
  add_clipped(out);
  add_displaced(out);
  add_lights(out);
  add_large_pictures(out);
}

}  // namespace zoneplate::appetite
