// SPDX-License-Identifier: Apache-2.0
// Scenes: loading them, and building them from arrays.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "zoneplate/capi/arrays.h"
#include "zoneplate/capi/handles.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/scene/geometry/flat_normals.h"
#include "zoneplate/scene/geometry/origin.h"
#include "zoneplate/scene/geometry/smooth_normals.h"
#include "zoneplate/scene/geometry/tangent.h"
#include "zoneplate/scene/sanitize.h"
#include "zoneplate/scene/validate.h"

namespace zoneplate::capi {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::Usage, message); }

float3 vector_of(const float* v, float3 otherwise) { return v == nullptr ? otherwise : float3{v[0], v[1], v[2]}; }
float number_of(const float* x, float otherwise) { return x == nullptr ? otherwise : *x; }
const char* text_of(const char* text) { return text == nullptr ? "" : text; }

void give(std::int32_t* index, std::size_t value) {
  if (index != nullptr) *index = static_cast<std::int32_t>(value);
}

LoadOptions load_options_of(const zoneplate_load_options* given) {
  const auto o = completed(given, "zoneplate_load_options");
  LoadOptions out{.format = text_of(o.format), .is_sandboxed = o.is_sandboxed != 0};
  out.choice.variant = text_of(o.variant);
  if (o.scene != nullptr) out.choice.scene = *o.scene;
  if (o.animation != nullptr) out.choice.animation = *o.animation;
  out.choice.animation_name = text_of(o.animation_name);
  if (o.animation != nullptr && !out.choice.animation_name.empty())
    refuse("zoneplate_load_options: animation and animation_name exclude each other");
  out.choice.time = o.time;
  if (o.max_memory > 0) out.limits.memory = o.max_memory;
  if (o.max_seconds > 0) out.limits.seconds = o.max_seconds;
  return out;
}

Material material_of(const zoneplate_material* given, const Scene& scene) {
  const auto m = completed(&required(given, "material"), "zoneplate_material");
  constexpr ShadingModel models[] = {ShadingModel::MetallicRoughness, ShadingModel::BlinnPhong, ShadingModel::Phong,
                                     ShadingModel::Unlit};
  constexpr AlphaMode modes[] = {AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend};
  Material out;
  out.name = text_of(m.name);
  out.model = at(models, m.model, "model");
  out.alpha_mode = at(modes, m.alpha_mode, "alpha_mode");
  out.alpha_cutoff = number_of(m.alpha_cutoff, out.alpha_cutoff);
  out.double_sided = m.is_double_sided != 0;
  if (const float* c = m.base_color) out.base_color = {c[0], c[1], c[2], c[3]};
  out.ambient = xyz(out.base_color);
  out.emissive = vector_of(m.emissive, {});
  const bool has_texture = m.metallic_roughness_texture != nullptr;
  out.metallic = number_of(m.metallic, has_texture ? 1.0f : 0);
  out.roughness = number_of(m.roughness, has_texture ? 1.0f : 0.5f);
  out.specular = vector_of(m.specular, {});
  out.exponent = number_of(m.exponent, out.exponent);
  const auto set = [&](const std::int32_t* image, TextureUse& use) {
    if (image == nullptr) return;
    if (*image < 0 || static_cast<std::size_t>(*image) >= scene.images.size())
      refuse(fmt::format("material: image {} does not exist, there are {}", *image, scene.images.size()));
    use.image = *image;
  };
  set(m.base_color_texture, out.base_color_texture);
  set(m.metallic_roughness_texture, out.metallic_roughness_texture);
  set(m.normal_texture, out.normal_texture);
  set(m.occlusion_texture, out.occlusion_texture);
  set(m.emissive_texture, out.emissive_texture);
  return out;
}

/// The rows of an array of n × `columns` as vectors.
template <class Vector>
std::vector<Vector> vectors_of(const zoneplate_array& array, const char* name, std::size_t count) {
  const std::vector<float> floats = floats_of(array, name, sizeof(Vector) / sizeof(float));
  std::vector<Vector> out(floats.size() * sizeof(float) / sizeof(Vector));
  if (count > 0 && out.size() != count) refuse(fmt::format("{}: has {} rows, expected {}", name, out.size(), count));
  std::memcpy(static_cast<void*>(out.data()), floats.data(), floats.size() * sizeof(float));
  return out;
}

/// Linear colours with alpha; integers are sRGB codes.
std::vector<float4> colors_of(const zoneplate_array& array, std::size_t count) {
  const bool has_alpha = array.dimensions == 2 && array.shape[1] == 4;
  if (array.type != ZONEPLATE_UINT8) {
    if (has_alpha) return vectors_of<float4>(array, "colors", count);
    std::vector<float4> out;
    for (const float3 c : vectors_of<float3>(array, "colors", count)) out.push_back({c.x, c.y, c.z, 1});
    return out;
  }
  const std::vector<float> codes = floats_of(array, "colors", has_alpha ? 4 : 3);
  const std::size_t channels = has_alpha ? 4 : 3;
  if (codes.size() != count * channels)
    refuse(fmt::format("colors: has {} rows, expected {}", codes.size() / channels, count));
  std::vector<float4> out(count);
  const auto linear = [](float code) { return decode_srgb8(static_cast<std::uint8_t>(code)); };
  for (std::size_t i = 0; i < count; ++i) {
    const float* const c = &codes[i * channels];
    out[i] = {linear(c[0]), linear(c[1]), linear(c[2]), has_alpha ? c[3] / 255 : 1};
  }
  return out;
}

/// Makes the positions of a mesh relative to the centre that is returned, which is not 0 if those that it uses lie far
/// from their own origin. `given` are the positions in the caller's type.
double3 center_positions(const zoneplate_array& given, Mesh& mesh) {
  OriginChoice choice;
  choice.add_used(mesh.index, [&](std::uint32_t vertex) { return mesh.position[vertex]; });
  const double3 centre = choice.origin();
  if (centre == double3{}) return centre;
  const std::vector<double> places = doubles_of(given, "positions", 3);
  for (std::size_t i = 0; i < mesh.position.size(); ++i)
    mesh.position[i] = narrowed(double3{places[3 * i], places[3 * i + 1], places[3 * i + 2]} - centre);
  return centre;
}

/// The mesh, with positions relative to `centre`.
Mesh mesh_of(const zoneplate_mesh& m, const Scene& scene, double3& centre) {
  constexpr Topology topologies[] = {Topology::Triangles, Topology::Lines, Topology::Points};
  Mesh out;
  out.name = text_of(m.name);
  out.topology = at(topologies, m.topology, "topology");
  out.position = vectors_of<float3>(m.positions, "positions", 0);
  const std::size_t count = out.position.size();
  if (count == 0) refuse("positions: is empty");
  if (is_given(m.normals)) out.normal = vectors_of<float3>(m.normals, "normals", count);
  if (is_given(m.uvs)) out.uv0 = vectors_of<float2>(m.uvs, "uvs", count);
  if (is_given(m.colors)) out.color = colors_of(m.colors, count);
  if (is_given(m.indices)) {
    const int corners = out.vertices_per_primitive();
    if (m.indices.dimensions == 2 && m.indices.shape[1] != corners)
      refuse(fmt::format("indices: has {} columns, expected {}", m.indices.shape[1], corners));
    out.index = indices_of(m.indices, "indices", count);
    if (out.index.size() % static_cast<std::size_t>(corners) != 0)
      refuse(fmt::format("indices: has {} elements, expected a multiple of {}", out.index.size(), corners));
  } else {
    out.index.resize(count / static_cast<std::size_t>(out.vertices_per_primitive()) *
                     static_cast<std::size_t>(out.vertices_per_primitive()));
    std::iota(out.index.begin(), out.index.end(), 0u);
  }
  centre = center_positions(m.positions, out);
  if (m.material != 0 && (m.material < 0 || static_cast<std::size_t>(m.material) >= scene.materials.size()))
    refuse(fmt::format("mesh: material {} does not exist, there are {}", m.material, scene.materials.size()));
  out.material = m.material;
  for (float3& n : out.normal) n = normalize(n, {0, 1, 0});
  if (out.topology == Topology::Triangles && out.normal.empty() && m.has_flat_normals != 0) make_flat_normals(out);
  return out;
}

/// Chooses the scene's origin by its first instance. Lights that were added before move with it.
void choose_origin(zoneplate_scene& building, Scene& scene, const Mesh& mesh, const Affine& placed) {
  OriginChoice choice;
  choice.add_used(mesh.index,
                  [&](std::uint32_t vertex) { return transform_point(placed, widened(mesh.position[vertex])); });
  scene.origin = choice.origin();
  for (const auto& [light, place] : building.light_places)
    if (!scene.lights[light].is_in_camera_space) scene.lights[light].position = scene.in_world(place);
}

/// The transform of a further instance of a mesh.
float4x4 place_instance(zoneplate_scene& building, Scene& scene, std::int32_t mesh, const Affine& world_from_object) {
  const auto centre = building.mesh_centres.find(mesh);
  const Affine placed =
      centre == building.mesh_centres.end() ? world_from_object : world_from_object * Affine{.move = centre->second};
  if (scene.instances.empty()) choose_origin(building, scene, scene.meshes[static_cast<std::size_t>(mesh)], placed);
  return narrowed(placed, scene.origin);
}

Affine affine_of(const double* m) {
  if (m == nullptr) return {};
  const Affine out{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, {m[3], m[7], m[11]}};
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    refuse("world_from_object: its last row is not 0, 0, 0, 1: it is not affine, or stored by columns");
  return out;
}

double3 place_of(const zoneplate_light& light) {
  const double* const p = light.position;
  return p == nullptr ? double3{} : double3{p[0], p[1], p[2]};
}

Light light_of(const zoneplate_light& l) {
  constexpr LightKind kinds[] = {LightKind::Directional, LightKind::Point, LightKind::Spot};
  Light out;
  out.kind = at(kinds, l.kind, "kind");
  out.color = vector_of(l.color, out.color);
  out.intensity = number_of(l.intensity, out.intensity);
  out.position = narrowed(place_of(l));
  out.direction = normalize(vector_of(l.direction, out.direction), out.direction);
  out.range = number_of(l.range, out.range);
  out.inner_cone = l.inner_cone;
  out.outer_cone = number_of(l.outer_cone, out.outer_cone);
  out.radius = l.radius;
  out.is_in_camera_space = l.is_in_camera_space != 0;
  return out;
}

/// The material of scenes without any: that of an STL file, or of a PLY file where vertices have colours.
Material default_material(const std::vector<Mesh>& meshes) {
  Material material = plain_material("default");
  const auto has_colors = [](const Mesh& m) { return !m.color.empty(); };
  const auto is_clear = [](const Mesh& m) { return std::ranges::any_of(m.color, [](float4 c) { return c.w < 1; }); };
  if (std::ranges::any_of(meshes, has_colors)) material.base_color = {1, 1, 1, 1};
  if (std::ranges::any_of(meshes, is_clear)) material.alpha_mode = AlphaMode::Blend;
  return material;
}

/// Completes the scene by what rendering requires: a material, normals, and tangents for normal maps.
void complete(Scene& scene) {
  if (scene.materials.empty() && !scene.meshes.empty()) scene.materials.push_back(default_material(scene.meshes));
  for (Mesh& mesh : scene.meshes) {
    if (mesh.topology != Topology::Triangles) continue;
    if (mesh.normal.empty()) make_smooth_normals(mesh);
    const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
    if (material.normal_texture.image >= 0 && mesh.tangent.empty() && !mesh.uv0.empty()) make_tangents(mesh, 0);
  }
  if (const std::optional<std::string> flaw = find_invalid(scene)) refuse(*flaw);
}

/// The number of parts of a kind, and the name of one of them.
std::size_t count_of(const Scene& scene, zoneplate_part part) {
  const std::size_t counts[] = {scene.objects.size(),    scene.materials.size(), scene.meshes.size(),
                                scene.instances.size(),  scene.lights.size(),    scene.cameras.size(),
                                scene.animations.size(), scene.variants.size(),  scene.warnings.size()};
  return at(counts, part, "part");
}
const std::string& name_of(const Scene& scene, zoneplate_part part, std::size_t i) {
  switch (part) {
    case ZONEPLATE_OBJECTS:
      return scene.objects[i];
    case ZONEPLATE_MATERIALS:
      return scene.materials[i].name;
    case ZONEPLATE_MESHES:
      return scene.meshes[i].name;
    case ZONEPLATE_INSTANCES:
      return scene.objects[static_cast<std::size_t>(scene.instances[i].object)];
    case ZONEPLATE_LIGHTS:
      return scene.lights[i].name;
    case ZONEPLATE_CAMERAS:
      return scene.cameras[i].name;
    case ZONEPLATE_ANIMATIONS:
      return scene.animations[i].name;
    case ZONEPLATE_VARIANTS:
      return scene.variants[i];
    case ZONEPLATE_WARNINGS:
      break;
  }
  return scene.warnings[i];
}

}  // namespace
}  // namespace zoneplate::capi

using namespace zoneplate;
using namespace zoneplate::capi;

PreparedScene zoneplate_scene::prepared() {
  const std::scoped_lock lock(mutex_);
  if (scene_) {
    complete(*scene_);
    Scene scene = std::move(*scene_);
    scene_.reset();
    prepared_.emplace(std::move(scene));
  }
  if (!prepared_) throw Error(ErrorKind::Failed, "the scene could not be prepared");
  return *prepared_;
}

PreparedScene zoneplate_scene::prepared(const Job& job) {
  if (!name.empty()) {
    if (model_key(job) == model_key(this->job())) return prepared();
    Scene model = load_scene(job.input, job.load);
    convert_materials(job, model);
    return PreparedScene(std::move(model), job.mips);
  }
  Job plain = this->job();
  plain.load = job.load;
  if (model_key(job) == model_key(plain)) return prepared();
  Scene model = read([](const Scene& s) { return s; });
  const bool has_lost_texels =
      std::ranges::any_of(model.images, [](const TextureImage& image) { return image.pixels.width() == 0; });
  if (has_lost_texels) refuse("the scene has been rendered: its textures cannot be prepared for options of materials");
  complete(model);
  convert_materials(job, model);
  return PreparedScene(std::move(model), job.mips);
}

std::unique_ptr<zoneplate_scene> zoneplate::capi::loaded(const std::string& name, const LoadOptions& load) {
  auto out = std::make_unique<zoneplate_scene>(load_scene(name, load));
  out->name = name, out->load = load;
  return out;
}

zoneplate_status zoneplate_scene_load(const char* name, const zoneplate_load_options* options,
                                      zoneplate_scene** scene) {
  return guarded([&] {
    const LoadOptions load = load_options_of(options);
    const std::string file = &required(name, "name");
    required(scene, "scene") = loaded(file, load).release();
  });
}

zoneplate_status zoneplate_scene_new(zoneplate_scene** scene) {
  return guarded([&] { required(scene, "scene") = new zoneplate_scene; });
}

void zoneplate_scene_free(zoneplate_scene* scene) { delete scene; }

zoneplate_status zoneplate_scene_add_image(zoneplate_scene* scene, const zoneplate_array* pixels, int32_t* index) {
  return guarded([&] {
    TexelImage image = texels_of(required(pixels, "pixels"), "pixels");
    required(scene, "scene").change([&](Scene& s) {
      s.images.push_back({.name = fmt::format("image {}", s.images.size()), .pixels = std::move(image)});
      give(index, s.images.size() - 1);
    });
  });
}

zoneplate_status zoneplate_scene_add_material(zoneplate_scene* scene, const zoneplate_material* material,
                                              int32_t* index) {
  return guarded([&] {
    required(scene, "scene").change([&](Scene& s) {
      s.materials.push_back(material_of(material, s));
      give(index, s.materials.size() - 1);
    });
  });
}

zoneplate_status zoneplate_scene_add_mesh(zoneplate_scene* scene, const zoneplate_mesh* mesh, int32_t* index) {
  return guarded([&] {
    required(scene, "scene").change([&](Scene& s) {
      const auto given = completed(&required(mesh, "mesh"), "zoneplate_mesh");
      double3 centre;
      Mesh added = mesh_of(given, s, centre);
      if (centre != double3{}) scene->mesh_centres.emplace(static_cast<std::int32_t>(s.meshes.size()), centre);
      const NotFinite lost = drop_not_finite(added);
      if (lost.dropped > 0)
        s.warnings.push_back(fmt::format("mesh {}: {} primitives have a vertex that is not finite and are dropped",
                                         s.meshes.size(), lost.dropped));
      if (lost.replaced > 0)
        s.warnings.push_back(fmt::format("mesh {}: attributes of {} vertices are not finite and are replaced",
                                         s.meshes.size(), lost.replaced));
      s.meshes.push_back(std::move(added));
      give(index, s.meshes.size() - 1);
    });
  });
}

zoneplate_status zoneplate_scene_add_instance(zoneplate_scene* scene, int32_t mesh, const double* world_from_object,
                                              const char* name, int32_t* index) {
  return guarded([&] {
    required(scene, "scene").change([&](Scene& s) {
      if (mesh < 0 || static_cast<std::size_t>(mesh) >= s.meshes.size())
        refuse(fmt::format("mesh {} does not exist, there are {}", mesh, s.meshes.size()));
      const float4x4 matrix = place_instance(*scene, s, mesh, affine_of(world_from_object));
      const std::size_t object = s.objects.size();
      s.objects.push_back(name != nullptr ? name : s.meshes[static_cast<std::size_t>(mesh)].name);
      s.instances.push_back({mesh, static_cast<int>(object), matrix});
      give(index, object);
    });
  });
}

zoneplate_status zoneplate_scene_add_light(zoneplate_scene* scene, const zoneplate_light* light) {
  return guarded([&] {
    const auto given = completed(&required(light, "light"), "zoneplate_light");
    Light added = light_of(given);
    required(scene, "scene").change([&](Scene& s) {
      const double3 place = place_of(given);
      if (!added.is_in_camera_space) added.position = s.in_world(place);
      scene->light_places.emplace(s.lights.size(), place);
      s.lights.push_back(added);
    });
  });
}

zoneplate_status zoneplate_scene_set_environment(zoneplate_scene* scene, const float* color, int32_t image,
                                                 float rotation) {
  return guarded([&] {
    const float3 factor = vector_of(&required(color, "color"), {});
    required(scene, "scene").change([&](Scene& s) {
      if (image < -1 || image >= static_cast<int32_t>(s.images.size()))
        refuse(fmt::format("image {} does not exist, there are {}", image, s.images.size()));
      s.environment = {.color = factor, .image = image, .rotation = rotation};
    });
  });
}

zoneplate_status zoneplate_scene_set_up(zoneplate_scene* scene, const float* up) {
  return guarded([&] {
    const float3 axis = normalize(vector_of(&required(up, "up"), {}));
    if (axis == float3{} || !std::isfinite(axis.x + axis.y + axis.z)) refuse("up: is not a direction");
    required(scene, "scene").change([&](Scene& s) { s.up = axis; });
  });
}

zoneplate_status zoneplate_scene_count(const zoneplate_scene* scene, zoneplate_part part, int64_t* count) {
  return guarded([&] {
    const std::size_t found = required(scene, "scene").read([&](const Scene& s) { return count_of(s, part); });
    required(count, "count") = static_cast<int64_t>(found);
  });
}

zoneplate_status zoneplate_scene_name(const zoneplate_scene* scene, zoneplate_part part, int64_t index,
                                      const char** name) {
  return guarded([&] {
    required(scene, "scene").read([&](const Scene& s) {
      const std::size_t count = count_of(s, part);
      if (index < 0 || static_cast<std::size_t>(index) >= count)
        refuse(fmt::format("index: is {}, expected 0 to {}", index, static_cast<std::int64_t>(count) - 1));
      required(name, "name") = name_of(s, part, static_cast<std::size_t>(index)).c_str();
    });
  });
}

zoneplate_status zoneplate_scene_bounds(const zoneplate_scene* scene, double minimum[3], double maximum[3]) {
  return guarded([&] {
    Box box;
    double3 least, greatest;
    required(scene, "scene").read([&](const Scene& s) {
      box = s.bounds();
      least = s.in_file(box.low), greatest = s.in_file(box.high);
    });
    if (box.empty()) refuse("the scene is empty: it has no bounds");
    double *const low = &required(minimum, "minimum"), *const high = &required(maximum, "maximum");
    low[0] = least.x, low[1] = least.y, low[2] = least.z;
    high[0] = greatest.x, high[1] = greatest.y, high[2] = greatest.z;
  });
}
