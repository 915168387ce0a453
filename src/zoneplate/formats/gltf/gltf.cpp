// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/gltf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/gltf/accessor.h"
#include "zoneplate/formats/gltf/animation.h"
#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/formats/gltf/key_times.h"
#include "zoneplate/formats/gltf/material.h"
#include "zoneplate/formats/gltf/mesh.h"
#include "zoneplate/formats/gltf/nodes.h"
#include "zoneplate/scene/geometry/origin.h"

namespace zoneplate {
namespace {

constexpr const char* supported_extensions[] = {"EXT_mesh_gpu_instancing",
                                                "EXT_meshopt_compression",
                                                "EXT_texture_webp",
                                                "KHR_animation_pointer",
                                                "KHR_draco_mesh_compression",
                                                "KHR_texture_basisu",
                                                "KHR_lights_punctual",
                                                "KHR_materials_anisotropy",
                                                "KHR_materials_clearcoat",
                                                "KHR_materials_diffuse_transmission",
                                                "KHR_materials_dispersion",
                                                "KHR_materials_emissive_strength",
                                                "KHR_materials_ior",
                                                "KHR_materials_iridescence",
                                                "KHR_materials_pbrSpecularGlossiness",
                                                "KHR_materials_sheen",
                                                "KHR_materials_specular",
                                                "KHR_materials_transmission",
                                                "KHR_materials_unlit",
                                                "KHR_materials_variants",
                                                "KHR_materials_volume",
                                                "KHR_mesh_quantization",
                                                "KHR_meshopt_compression",
                                                "KHR_node_visibility",
                                                "KHR_texture_transform"};

void check_extensions(GltfFile& file) {
  const auto is_supported = [](const std::string& name) {
    return std::any_of(std::begin(supported_extensions), std::end(supported_extensions),
                       [&](const char* s) { return name == s; });
  };
  for (const std::string& name : file.root().texts("extensionsRequired"))
    if (!is_supported(name)) file.root().fail("requires the extension " + quoted(name) + ", which is not supported");
  for (const std::string& name : file.root().texts("extensionsUsed"))
    if (!is_supported(name))
      file.warn(file.root().place() + " extension " + quoted(name) + " is not supported, ignored");
}

/// The rotation and translation of a transform; scale and mirroring are removed, and the direction of -Z is kept.
float4x4 rigid(const float4x4& m) {
  const float3 back = normalize(xyz(m.column[2]), {0, 0, 1});
  float3 right = cross(normalize(xyz(m.column[1]), {0, 1, 0}), back);
  if (!(dot(right, right) > 1e-12f)) right = cross(std::abs(back.y) < 0.9f ? float3{0, 1, 0} : float3{0, 0, 1}, back);
  right = normalize(right);
  const float3 up = cross(back, right);
  return {{float4{right.x, right.y, right.z, 0}, float4{up.x, up.y, up.z, 0}, float4{back.x, back.y, back.z, 0},
           m.column[3]}};
}

Camera read_camera(const JsonView& json, const float4x4& world_from_node) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Camera c;
  c.name = json.text("name");
  c.world_from_camera = rigid(world_from_node);
  const std::string type = json.text("type");
  if (type != "perspective" && type != "orthographic")
    json.fail("type is " + quoted(type) + ", expected perspective or orthographic");
  c.is_orthographic = type == "orthographic";
  const JsonView lens = json.object(type.c_str());
  c.near = lens.number("znear");
  if (c.is_orthographic) {
    const float half_width = std::abs(lens.number("xmag"));
    c.half_height = std::abs(lens.number("ymag"));
    c.far = lens.number("zfar");
    if (!(half_width > 0 && c.half_height > 0)) lens.fail("xmag and ymag must not be 0");
    c.aspect = half_width / c.half_height;
  } else {
    c.vertical_fov = lens.number("yfov");
    c.aspect = lens.number("aspectRatio", 0.0f);
    c.far = lens.number("zfar", infinity);
    if (!(c.vertical_fov > 0 && c.vertical_fov < 3.1415925f)) lens.fail("yfov must lie between 0 and pi");
    if (!(c.near > 0)) lens.fail("znear must be greater than 0");
    if (!(c.aspect >= 0)) lens.fail("aspectRatio must be greater than 0");
  }
  if (!(c.near >= 0 && c.far > c.near)) lens.fail("zfar must be greater than znear, and znear not less than 0");
  return c;
}

Light read_light(const JsonView& json, const float4x4& world_from_node) {
  Light light;
  light.name = json.text("name");
  const std::string type = json.text("type");
  if (type != "directional" && type != "point" && type != "spot")
    json.fail("type is " + quoted(type) + ", expected directional, point or spot");
  light.kind = type == "directional" ? LightKind::Directional : type == "point" ? LightKind::Point : LightKind::Spot;
  if (const std::vector<float> c = json.numbers("color", 3); !c.empty())
    light.color = {std::max(c[0], 0.0f), std::max(c[1], 0.0f), std::max(c[2], 0.0f)};
  light.intensity = std::max(json.number("intensity", 1.0f), 0.0f);
  light.range = json.number("range", std::numeric_limits<float>::infinity());
  if (!(light.range > 0)) json.fail("range must be greater than 0");
  light.position = xyz(world_from_node.column[3]);
  light.direction = normalize(-xyz(world_from_node.column[2]), {0, 0, -1});
  if (!(dot(light.direction, light.direction) > 0.5f)) light.direction = {0, 0, -1};  // an axis whose square overflows
  const JsonView spot = json.object("spot");
  light.inner_cone = spot.number("innerConeAngle", 0.0f);
  light.outer_cone = spot.number("outerConeAngle", 0.7853982f);
  if (!(light.inner_cone >= 0 && light.outer_cone > 0 && light.outer_cone <= 1.5707964f))
    spot.fail("expected 0 <= innerConeAngle < outerConeAngle <= pi / 2");
  light.inner_cone = std::min(light.inner_cone, 0.999f * light.outer_cone);  // common exporters write equal angles
  return light;
}

bool is_finite(const float4x4& m) {
  return std::all_of(std::begin(m.column), std::end(m.column),
                     [](float4 c) { return zoneplate::is_finite(xyz(c)) && std::isfinite(c.w); });
}

/// The memory of a text that is copied from the file.
std::uint64_t bytes_of(const std::string& text) { return text.size() + 2 * sizeof(std::string); }

std::vector<std::string> list_variants(GltfFile& file) {
  std::vector<std::string> names;
  const auto all = file.root().extension("KHR_materials_variants");
  const std::size_t count = all ? all->count("variants") : 0;
  for (std::size_t i = 0; i < count; ++i) {
    file.budget().check_time();
    names.push_back(all->element("variants", i, "variant").text("name"));
    file.budget().take(bytes_of(names.back()));
  }
  return names;
}

std::optional<std::size_t> find_variant(GltfFile& file, const std::string& name) {
  if (name.empty()) return std::nullopt;
  constexpr std::size_t max_shown = 20;
  std::string known;
  const std::vector<std::string> names = list_variants(file);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return i;
    if (i < max_shown) known += (known.empty() ? "" : ", ") + names[i].substr(0, 120);
    if (i == max_shown) known += ", ...";
  }
  throw Error(ErrorKind::Usage, "--variant: the file has no variant " + quoted(name) +
                                    (known.empty() ? ", nor any other" : ", but " + known));
}

class SceneReader {
 public:
  /// `origin` is Scene::origin; nothing: it follows from this choice.
  SceneReader(GltfFile& file, const SceneChoice& choice, const std::optional<double3>& origin,
              const GltfModel::MeshReader& read_mesh)
      : file_(file), nodes_(file, choice), variant_(find_variant(file, choice.variant)), read_mesh_(read_mesh) {
    scene_.origin = origin ? *origin : find_origin(file, nodes_);
    if (scene_.origin != double3{}) nodes_.set_origin(scene_.origin);
  }
  Scene read(const GltfMaterials& look, GltfModel::Images images);

 private:
  void add_node(const GltfNode& node);
  void add_camera(const GltfNode& node);
  void add_light(const GltfNode& node, const JsonView& use);
  void add_mesh(const GltfNode& node, std::size_t mesh);
  void add_name(const GltfNode& node, std::size_t mesh);
  std::pair<std::size_t, std::size_t> find_meshes(const GltfNode& node, std::size_t mesh);
  void add_instance(const GltfNode& node, std::size_t mesh, int object, const float4x4& world_from_object);
  bool is_near(std::size_t mesh, const float4x4& world_from_object);

  GltfFile& file_;
  GltfNodes nodes_;
  std::optional<std::size_t> variant_;
  const GltfModel::MeshReader& read_mesh_;
  Scene scene_;

  /// A mesh in the scene: the number of its primitive, what was subtracted from its positions, and the bounds of all of
  /// its vertices, and of those that are used, if that was needed.
  struct Part {
    int number = 0;
    double3 centre;
    Box all;
    std::optional<Box> used = std::nullopt;
  };
  using MeshRange = std::pair<std::size_t, std::size_t>;  ///< [first, end) of the scene's meshes
  std::map<std::pair<std::size_t, std::optional<std::size_t>>, MeshRange> ready_;  ///< by the file's mesh and skin
  std::map<std::size_t, std::size_t> named_;  ///< by the file's mesh: an object that has its name
  std::vector<Part> parts_;                   ///< for each mesh in the scene
};

/// EXT_mesh_gpu_instancing: the transforms of copies relative to the node; without the extension, one identity.
class Placements {
 public:
  Placements(GltfFile& file, const GltfNode& node) : budget_(file.budget()) {
    const auto extension = node.json.extension("EXT_mesh_gpu_instancing");
    if (!extension) return;
    const JsonView list = extension->object("attributes");
    if (list.has("TRANSLATION")) moves_ = read_float3(file, list, "TRANSLATION");
    if (list.has("SCALE")) scales_ = read_float3(file, list, "SCALE");
    if (list.has("ROTATION")) turns_ = read_float4(file, list, "ROTATION");
    count_ = std::max({moves_.size(), scales_.size(), turns_.size()});
    for (const std::size_t n : {moves_.size(), scales_.size(), turns_.size()})
      if (n != 0 && n != count_) list.fail("TRANSLATION, ROTATION and SCALE differ in their number of elements");
  }
  ~Placements() {
    budget_.give_back((moves_.size() + scales_.size()) * sizeof(float3) + turns_.size() * sizeof(float4));
  }
  Placements(const Placements&) = delete;
  Placements& operator=(const Placements&) = delete;

  std::size_t size() const { return count_; }
  float4x4 operator[](std::size_t i) const {
    if (moves_.empty() && scales_.empty() && turns_.empty()) return {};
    const float4 q = turns_.empty() ? float4{0, 0, 0, 1} : turns_[i];
    return translation(moves_.empty() ? float3{} : moves_[i]) * rotation(Quaternion{q.x, q.y, q.z, q.w}) *
           scaling(scales_.empty() ? float3{1, 1, 1} : scales_[i]);
  }

 private:
  ImportBudget& budget_;
  std::size_t count_ = 1;
  std::vector<float3> moves_, scales_;
  std::vector<float4> turns_;
};

Box bounds_of(const std::vector<float3>& positions) {
  constexpr std::size_t block = 1 << 15;
  std::vector<Box> parts((positions.size() + block - 1) / block);
  parallel_ranges(positions.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) parts[begin / block].add(positions[i]);
  });
  Box all;
  for (const Box& part : parts) all.add(part);
  return all;
}

/// Whether a box is close enough to the origin that squares of distances do not overflow a float.
bool is_near(const Box& box, const float4x4& world_from_object) {
  constexpr float farthest = 1e18f;
  for (int i = 0; i < 8; ++i) {
    const float3 p = transform_point(world_from_object, box.corner(i));
    if (!(std::abs(p.x) <= farthest && std::abs(p.y) <= farthest && std::abs(p.z) <= farthest)) return false;
  }
  return true;
}

/// The range [first, end) of the scene's meshes for a mesh of the file, which is read at its first use, or for each
/// pose that is not shared.
std::pair<std::size_t, std::size_t> SceneReader::find_meshes(const GltfNode& node, std::size_t mesh) {
  GltfPose pose{.weights = nodes_.weights(node), .joints = {}, .variant = variant_};
  // Nodes with the same mesh and skin share the result, unless the morph targets have their own weights.
  const std::pair key(mesh, node.json.find_index("skin", file_.count("skins")));
  const bool is_shared = pose.weights.empty();
  if (const auto found = ready_.find(key); is_shared && found != ready_.end()) return found->second;

  if (key.second) pose.joints = nodes_.joints(node);
  const std::size_t first = scene_.meshes.size();
  for (GltfPrimitive& primitive : read_mesh_(file_, mesh, pose, scene_.materials)) {
    // A skinned mesh is in world space, which is near enough to the scene's origin.
    const double3 centre = nodes_.is_far() && !key.second ? center_far_mesh(primitive.mesh) : double3{};
    parts_.push_back({primitive.number, centre, bounds_of(primitive.mesh.position)});
    scene_.meshes.push_back(std::move(primitive.mesh));
  }
  const std::pair range(first, scene_.meshes.size());
  if (is_shared) ready_[key] = range;
  return range;
}

/// Whether the used vertices of a mesh are near the origin. Unused vertices may have any position, so that the bounds
/// of the used ones are computed if needed, once per mesh.
bool SceneReader::is_near(std::size_t mesh, const float4x4& world_from_object) {
  Part& part = parts_[mesh];
  if (part.all.empty() || zoneplate::is_near(part.all, world_from_object)) return true;
  if (!part.used) {
    const Mesh& m = scene_.meshes[mesh];
    part.used.emplace();
    for (const std::uint32_t i : m.index) part.used->add(m.position[i]);
  }
  return zoneplate::is_near(*part.used, world_from_object);
}

void SceneReader::add_instance(const GltfNode& node, std::size_t mesh, int object, const float4x4& world_from_object) {
  if (is_hidden(world_from_object)) return;
  if (!is_near(mesh, world_from_object)) {
    file_.warn(node.json.place() + ": lies farther than 1e18 from the origin or nowhere, dropped");
    return;
  }
  scene_.instances.push_back({static_cast<int>(mesh), object, world_from_object, parts_[mesh].number});
}

/// Adds an object with the name of the node or else of its mesh; objects named after one mesh share the text.
void SceneReader::add_name(const GltfNode& node, std::size_t mesh) {
  std::string name = node.json.text("name");
  if (!node.json.has("name")) {
    if (const auto found = named_.find(mesh); found != named_.end()) return scene_.objects.share(found->second);
    name = file_.root().element("meshes", mesh, "mesh").text("name");
    if (name.empty())
      name = "node " + std::to_string(node.number);
    else
      named_[mesh] = scene_.objects.size();
  }
  file_.budget().take(bytes_of(name));
  scene_.objects.push_back(std::move(name));
}

/// Adds the objects of a node, and unless it is hidden their instances. A node that an animation hides keeps its
/// objects, so that the others have the same numbers at all times.
void SceneReader::add_mesh(const GltfNode& node, std::size_t mesh) {
  const bool is_skinned = node.json.has("skin");
  const auto range = node.is_visible ? find_meshes(node, mesh) : MeshRange{};
  const Placements placements(file_, node);
  const std::size_t parts = range.second - range.first, first_object = scene_.objects.size();
  const std::uint64_t all = std::uint64_t{placements.size()} * parts;
  file_.budget().take(all * sizeof(Instance) + placements.size() * sizeof(std::uint32_t));
  // The exact capacity is reserved for many copies; for few, the vector grows as usual.
  if (scene_.instances.size() + all > 2 * scene_.instances.capacity())
    scene_.instances.reserve(scene_.instances.size() + all);
  for (std::size_t i = 0; i < placements.size(); ++i) {
    constexpr std::size_t copies_per_check = 1024;
    if (i % copies_per_check == 0) file_.budget().check_time();
    const int object = static_cast<int>(scene_.objects.size());
    if (i == 0)
      add_name(node, mesh);
    else
      scene_.objects.share(first_object);
    // A skinned mesh is in world space already: the transform of its node is ignored.
    const float4x4 world_from_object = is_skinned ? float4x4{} : node.world_from_node * placements[i];
    for (std::size_t m = range.first; m < range.second; ++m) {
      const bool is_far = nodes_.is_far() && !is_skinned;
      add_instance(node, m, object, is_far ? nodes_.place(node, placements[i], parts_[m].centre) : world_from_object);
    }
  }
}

void SceneReader::add_light(const GltfNode& node, const JsonView& use) {
  const auto all = file_.root().extension("KHR_lights_punctual");
  const std::size_t count = all ? all->count("lights") : 0;
  const std::size_t light = use.index("light", count);
  scene_.lights.push_back(read_light(all->element("lights", light, "light"), node.world_from_node));
  if (!is_finite(scene_.lights.back().position)) {
    file_.warn(node.json.place() + ": its light's place is not finite, dropped");
    scene_.lights.pop_back();
  } else {
    file_.budget().take(2 * sizeof(Light) + scene_.lights.back().name.size());
    scene_.needs_fill_light = true;
  }
}

void SceneReader::add_node(const GltfNode& node) {
  file_.budget().check_time();
  file_.read_optional([&] { add_camera(node); });
  file_.read_optional([&] {
    if (const auto use = node.json.extension("KHR_lights_punctual"); use && node.is_visible) add_light(node, *use);
  });
  if (const auto mesh = node.json.find_index("mesh", file_.count("meshes"))) add_mesh(node, *mesh);
}

void SceneReader::add_camera(const GltfNode& node) {
  if (const auto camera = node.json.find_index("camera", file_.count("cameras"))) {
    scene_.cameras.push_back(read_camera(file_.root().element("cameras", *camera, "camera"), node.world_from_node));
    float4x4& place = scene_.cameras.back().world_from_camera;
    if (!is_finite(place)) {
      file_.warn(node.json.place() + ": its camera's place is not finite, taken at the origin");
      place = {};
    }
    file_.budget().take(2 * sizeof(Camera) + scene_.cameras.back().name.size());
  }
}

Scene SceneReader::read(const GltfMaterials& look, GltfModel::Images images) {
  scene_.materials = file_.edits().touch("/materials/") ? read_materials(file_, look) : look.materials;
  if (images == GltfModel::Images::With) scene_.images = look.images;
  for (const GltfNode& node : nodes_.in_scene()) add_node(node);

  // The default material is appended if a mesh needs it.
  const auto last = static_cast<int>(scene_.materials.size());
  const bool needs_default =
      std::any_of(scene_.meshes.begin(), scene_.meshes.end(), [&](const Mesh& m) { return m.material == last; });
  if (needs_default) {
    Material& material = scene_.materials.emplace_back();
    material.name = "default", material.is_default = true;
  }
  if (scene_.instances.empty() && file_.first_loss()) throw *file_.first_loss();
  if (scene_.instances.empty()) file_.warn(file_.root().place() + " nothing in the scene can be drawn");
  scene_.animations = list_animations(file_);
  scene_.variants = list_variants(file_);
  scene_.warnings = file_.warnings();
  return std::move(scene_);
}

}  // namespace

/// The open file, the budget that remained after opening it, and what its scenes need at all times.
struct GltfModel::Open {
  template <class... Bytes>
  Open(const std::string& path, const LoadLimits& limits, Bytes... bytes) : file(path, limits, bytes...) {
    check_extensions(file);
    look = load_materials(file);
    left = file.budget().memory_left();
  }

  /// Makes the file as it was after opening it, with the whole budget for a scene.
  void restart() {
    file.budget().restart(left);
    file.edits().undo();
    file.forget_zeros();
  }

  /// The origin of an animated scene, which is that of its first keys at all times; nothing without an animation.
  std::optional<double3> find_origin(const SceneChoice& choice) {
    std::pair key(choice.scene, chosen_animations(file, choice));
    if (key.second.empty()) return std::nullopt;
    if (const auto found = origins.find(key); found != origins.end()) return found->second;
    restart();
    SceneChoice first = choice;
    first.time = -std::numeric_limits<double>::infinity();
    const double3 origin = zoneplate::find_origin(file, GltfNodes(file, first));
    return origins.emplace(std::move(key), origin).first->second;
  }

  GltfFile file;
  GltfMaterials look;
  std::uint64_t left = 0;
  std::map<std::pair<std::optional<int>, std::vector<std::size_t>>, double3> origins;  ///< by scene and animations
};

GltfModel::GltfModel(const std::string& path, const LoadLimits& limits) : open_(std::make_unique<Open>(path, limits)) {}
GltfModel::GltfModel(const std::string& path, const LoadLimits& limits, std::span<const std::uint8_t> bytes)
    : open_(std::make_unique<Open>(path, limits, bytes)) {}
GltfModel::~GltfModel() = default;

Scene GltfModel::scene(const SceneChoice& choice, Images images) { return scene(choice, images, load_gltf_mesh); }

Scene GltfModel::scene(const SceneChoice& choice, Images images, const MeshReader& read_mesh) {
  const std::optional<double3> origin = open_->find_origin(choice);
  open_->restart();
  return SceneReader(open_->file, choice, origin, read_mesh).read(open_->look, images);
}

void GltfModel::forget() const { open_->file.forget(); }

GltfFile& GltfModel::restarted_file() {
  open_->file.budget().restart(open_->left);
  open_->file.forget_zeros();
  return open_->file;
}

std::vector<double> GltfModel::key_times(const SceneChoice& choice) {
  open_->file.budget().restart(open_->left);
  return zoneplate::key_times(open_->file, choice);
}

Scene load_gltf(const std::string& path, const LoadLimits& limits, const SceneChoice& choice) {
  return GltfModel(path, limits).scene(choice);
}

}  // namespace zoneplate
