// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/scene_contents.h"

#include <fmt/format.h>

#include "zoneplate/base/utf8.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {
namespace {

// "Drawn" counts every instance of a mesh, "stored" counts each mesh once.
struct Counts {
  std::uint64_t triangles = 0, lines = 0, points = 0, vertices = 0, stored_triangles = 0;
};

Counts count(const Scene& scene) {
  Counts counts;
  for (const Mesh& mesh : scene.meshes) {
    counts.vertices += mesh.position.size();
    if (mesh.topology == Topology::Triangles) counts.stored_triangles += mesh.primitives();
  }
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
    std::uint64_t& kind = mesh.topology == Topology::Triangles ? counts.triangles
                          : mesh.topology == Topology::Lines   ? counts.lines
                                                               : counts.points;
    kind += mesh.primitives();
  }
  return counts;
}

constexpr std::string_view topology_name(Topology topology) {
  return topology == Topology::Triangles ? "triangles" : topology == Topology::Lines ? "lines" : "points";
}

constexpr std::string_view model_name(ShadingModel model) {
  switch (model) {
    case ShadingModel::BlinnPhong:
      return "blinn-phong";
    case ShadingModel::Phong:
      return "phong";
    case ShadingModel::Unlit:
      return "unlit";
    case ShadingModel::MetallicRoughness:
      break;
  }
  return "pbr";
}

constexpr std::string_view alpha_name(AlphaMode mode) {
  return mode == AlphaMode::Opaque ? "opaque" : mode == AlphaMode::Mask ? "mask" : "blend";
}

constexpr std::string_view light_name(LightKind kind) {
  return kind == LightKind::Directional ? "directional" : kind == LightKind::Point ? "point" : "spot";
}

/// Coordinates of the file: the fewest digits of floats, or of doubles in a scene far from the file's origin.
Json triple(const Scene& scene, float3 p) {
  if (scene.origin == double3{}) return Json::Array{p.x, p.y, p.z};
  const double3 q = scene.in_file(p);
  return Json::Array{q.x, q.y, q.z};
}

template <class Row, class Write>
Json rows(const std::vector<Row>& values, Write write) {
  Json::Array out;
  for (const Row& value : values) out.emplace_back(write(value));
  return out;
}

}  // namespace

Json::Object scene_contents(const Scene& scene) {
  const Counts counts = count(scene);
  const Box box = scene.bounds();
  const Json bounds =
      box.empty() ? Json() : Json(Json::Object{{"min", triple(scene, box.low)}, {"max", triple(scene, box.high)}});
  return {
      {"triangles", counts.triangles},
      {"lines", counts.lines},
      {"points", counts.points},
      {"vertices", counts.vertices},
      {"instances", static_cast<std::uint64_t>(scene.instances.size())},
      {"bounds", bounds},
      {"meshes", rows(scene.meshes,
                      [](const Mesh& m) {
                        return Json::Object{{"name", m.name},
                                            {"kind", topology_name(m.topology)},
                                            {"primitives", static_cast<std::uint64_t>(m.primitives())},
                                            {"vertices", static_cast<std::uint64_t>(m.position.size())},
                                            {"material", m.material}};
                      })},
      {"objects", Json::Array(scene.objects.begin(), scene.objects.end())},
      {"materials", rows(scene.materials,
                         [](const Material& m) {
                           return Json::Object{{"name", m.name},
                                               {"model", model_name(m.model)},
                                               {"alpha", alpha_name(m.alpha_mode)},
                                               {"double_sided", m.double_sided}};
                         })},
      {"textures",
       rows(scene.images,
            [](const TextureImage& i) {
              return Json::Object{{"name", i.name}, {"width", i.pixels.width()}, {"height", i.pixels.height()}};
            })},
      {"lights", rows(scene.lights,
                      [](const Light& l) {
                        return Json::Object{{"name", l.name}, {"kind", light_name(l.kind)}, {"intensity", l.intensity}};
                      })},
      {"cameras", rows(scene.cameras,
                       [&](const Camera& c) {
                         return Json::Object{{"name", c.name},
                                             {"kind", c.is_orthographic ? "orthographic" : "perspective"},
                                             {"position", triple(scene, xyz(c.world_from_camera.column[3]))}};
                       })},
      {"animations", rows(scene.animations,
                          [](const AnimationSpan& a) {
                            return Json::Object{{"name", a.name}, {"begin", a.begin}, {"end", a.end}};
                          })},
      {"variants", Json::Array(scene.variants.begin(), scene.variants.end())},
      {"warnings", Json::Array(scene.warnings.begin(), scene.warnings.end())}};
}

std::string scene_contents_text(const Scene& scene) {
  const Counts counts = count(scene);
  const Box box = scene.bounds();
  const auto name_of = [](const auto& named) {
    return named.name.empty() ? std::string("unnamed") : printable(named.name);
  };
  std::string text = fmt::format("  triangles   {} drawn, {} stored in {} meshes, {} instances\n", counts.triangles,
                                 counts.stored_triangles, scene.meshes.size(), scene.instances.size());
  if (counts.lines + counts.points > 0)
    text += fmt::format("  others      {} lines, {} points\n", counts.lines, counts.points);
  text += fmt::format("  vertices    {}\n", counts.vertices);
  if (!box.empty()) {
    const double3 low = scene.in_file(box.low), high = scene.in_file(box.high);
    const int digits = scene.origin == double3{} ? 6 : 10;
    text += fmt::format("  bounds      {:.{}g}, {:.{}g}, {:.{}g}  to  {:.{}g}, {:.{}g}, {:.{}g}\n", low.x, digits,
                        low.y, digits, low.z, digits, high.x, digits, high.y, digits, high.z, digits);
  }

  text += fmt::format("  materials   {}\n", scene.materials.size());
  for (const Material& m : scene.materials)
    text += fmt::format("    {} ({}, {}{})\n", name_of(m), model_name(m.model), alpha_name(m.alpha_mode),
                        m.double_sided ? ", double-sided" : "");
  text += fmt::format("  textures    {}\n", scene.images.size());
  for (const TextureImage& image : scene.images)
    text += fmt::format("    {} {}x{}\n", printable(image.name), image.pixels.width(), image.pixels.height());
  text += fmt::format("  lights      {}\n", scene.lights.size());
  for (const Light& light : scene.lights)
    text += fmt::format("    {} ({}, {:.6g})\n", name_of(light), light_name(light.kind), light.intensity);
  text += fmt::format("  cameras     {}\n", scene.cameras.size());
  for (const Camera& camera : scene.cameras)
    text += fmt::format("    {} ({})\n", name_of(camera), camera.is_orthographic ? "orthographic" : "perspective");
  if (!scene.animations.empty()) text += fmt::format("  animations  {}\n", scene.animations.size());
  for (const AnimationSpan& a : scene.animations)
    text += fmt::format("    {} ({:.6g} to {:.6g} s)\n", name_of(a), a.begin, a.end);
  if (!scene.variants.empty())
    text += fmt::format("  variants    {}\n", printable(fmt::format("{}", fmt::join(scene.variants, ", "))));
  return text;
}

}  // namespace zoneplate
