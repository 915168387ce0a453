#include "zoneplate/scene/gltf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/gltf_accessor.h"
#include "zoneplate/scene/gltf_animation.h"
#include "zoneplate/scene/gltf_file.h"
#include "zoneplate/scene/gltf_material.h"
#include "zoneplate/scene/gltf_mesh.h"
#include "zoneplate/scene/gltf_nodes.h"

namespace zoneplate {
namespace {

constexpr const char* supported_extensions[] = {
    "KHR_texture_transform",           "KHR_materials_unlit",       "KHR_lights_punctual",    "KHR_mesh_quantization",
    "KHR_materials_emissive_strength", "EXT_mesh_gpu_instancing",   "KHR_materials_variants", "EXT_texture_webp",
    "EXT_meshopt_compression",         "KHR_draco_mesh_compression"};

/// Extensions that only refine a look which the core material has too: a file that requires one is drawn without it.
constexpr const char* refining_extensions[] = {
    "KHR_materials_clearcoat",   "KHR_materials_sheen",      "KHR_materials_transmission",
    "KHR_materials_volume",      "KHR_materials_ior",        "KHR_materials_specular",
    "KHR_materials_iridescence", "KHR_materials_anisotropy", "KHR_materials_dispersion"};

void check_extensions(GltfFile& file) {
  const auto is_supported = [](const std::string& name) {
    return std::any_of(std::begin(supported_extensions), std::end(supported_extensions),
                       [&](const char* s) { return name == s; });
  };
  const auto is_refining = [](const std::string& name) {
    return std::any_of(std::begin(refining_extensions), std::end(refining_extensions),
                       [&](const char* r) { return name == r; });
  };
  for (const std::string& name : file.root().texts("extensionsRequired"))
    if (!is_supported(name) && !is_refining(name))
      file.root().fail("requires the extension " + quoted(name) + ", which is not supported");
  for (const std::string& name : file.root().texts("extensionsUsed"))
    if (!is_supported(name))
      file.warn(file.root().place() + " extension " + quoted(name) + " is not supported, passed over");
}

/// The rotation and translation of a transform; scale and mirroring are taken out, the axis -Z keeps its direction.
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
    json.fail("type is " + quoted(type) + ", wants perspective or orthographic");
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
    json.fail("type is " + quoted(type) + ", wants directional, point or spot");
  light.kind = type == "directional" ? LightKind::Directional : type == "point" ? LightKind::Point : LightKind::Spot;
  if (const std::vector<float> c = json.numbers("color", 3); !c.empty())
    light.color = {std::max(c[0], 0.0f), std::max(c[1], 0.0f), std::max(c[2], 0.0f)};
  light.intensity = std::max(json.number("intensity", 1.0f), 0.0f);
  light.range = json.number("range", std::numeric_limits<float>::infinity());
  if (!(light.range > 0)) json.fail("range must be greater than 0");
  light.position = xyz(world_from_node.column[3]);
  light.direction = normalize(-xyz(world_from_node.column[2]), {0, 0, -1});
  const JsonView spot = json.object("spot");
  light.inner_cone = spot.number("innerConeAngle", 0.0f);
  light.outer_cone = spot.number("outerConeAngle", 0.7853982f);
  if (!(light.inner_cone >= 0 && light.outer_cone > 0 && light.outer_cone <= 1.5707964f))
    spot.fail("wants 0 <= innerConeAngle < outerConeAngle <= pi / 2");
  light.inner_cone = std::min(light.inner_cone, 0.999f * light.outer_cone);  // common exporters write equal angles
  return light;
}

std::vector<std::string> list_variants(const GltfFile& file) {
  std::vector<std::string> names;
  const auto all = file.root().extension("KHR_materials_variants");
  for (std::size_t i = 0; all && i < all->count("variants"); ++i)
    names.push_back(all->element("variants", i, "variant").text("name"));
  return names;
}

std::optional<std::size_t> find_variant(const GltfFile& file, const std::string& name) {
  if (name.empty()) return std::nullopt;
  std::string known;
  const std::vector<std::string> names = list_variants(file);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return i;
    known += (known.empty() ? "" : ", ") + names[i];
  }
  throw Error(Trouble::Usage, "--variant: the file has no variant " + quoted(name) +
                                  (known.empty() ? ", nor any other" : ", but " + known));
}

class SceneReader {
 public:
  SceneReader(GltfFile& file, const SceneChoice& choice)
      : file_(file), nodes_(file, choice), variant_(find_variant(file, choice.variant)) {}
  Scene read(const GltfMaterials& look, GltfModel::Images images);

 private:
  void add_node(const GltfNode& node);
  void add_mesh(const GltfNode& node, std::size_t mesh);
  std::pair<std::size_t, std::size_t> find_meshes(const GltfNode& node, std::size_t mesh, bool is_skinned);
  void add_instance(const GltfNode& node, std::size_t mesh, int object, const float4x4& world_from_object);
  std::vector<float4x4> read_placements(const GltfNode& node);

  GltfFile& file_;
  GltfNodes nodes_;
  std::optional<std::size_t> variant_;
  Scene scene_;
  std::map<std::size_t, std::pair<std::size_t, std::size_t>> ready_;  ///< file's mesh: its meshes in the scene
  std::vector<Box> boxes_;                                            ///< of each mesh in the scene
};

/// EXT_mesh_gpu_instancing: transforms of copies, relative to the node; one identity without the extension.
std::vector<float4x4> SceneReader::read_placements(const GltfNode& node) {
  const auto extension = node.json.extension("EXT_mesh_gpu_instancing");
  if (!extension) return {float4x4{}};
  const JsonView list = extension->object("attributes");
  const auto read = [&](const char* key, auto reader) -> decltype(reader(file_, list, key, ElementRange{})) {
    if (!list.has(key)) return {};
    return reader(file_, list, key, ElementRange{});
  };
  const std::vector<float3> moves = read("TRANSLATION", read_float3), scales = read("SCALE", read_float3);
  const std::vector<float4> turns = read("ROTATION", read_float4);
  const std::size_t count = std::max({moves.size(), scales.size(), turns.size()});
  for (const std::size_t n : {moves.size(), scales.size(), turns.size()})
    if (n != 0 && n != count) list.fail("TRANSLATION, ROTATION and SCALE differ in their number of elements");
  file_.budget().take(count * (sizeof(float4x4) + sizeof(Instance)));
  std::vector<float4x4> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float4 q = turns.empty() ? float4{0, 0, 0, 1} : turns[i];
    out[i] = translation(moves.empty() ? float3{} : moves[i]) * rotation(Quaternion{q.x, q.y, q.z, q.w}) *
             scaling(scales.empty() ? float3{1, 1, 1} : scales[i]);
  }
  return out;
}

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

/// Whether all of a box is so near to the origin that squares of distances fit into a float.
bool is_near(const Box& box, const float4x4& world_from_object) {
  constexpr float farthest = 1e18f;
  for (int i = 0; i < 8; ++i) {
    const float3 p = transform_point(world_from_object, box.corner(i));
    if (!(std::abs(p.x) <= farthest && std::abs(p.y) <= farthest && std::abs(p.z) <= farthest)) return false;
  }
  return true;
}

/// The scene's meshes for a mesh of the file, [first, end); read at their first use, or for a pose of their own.
std::pair<std::size_t, std::size_t> SceneReader::find_meshes(const GltfNode& node, std::size_t mesh, bool is_skinned) {
  GltfPose pose{.weights = nodes_.weights(node), .joints = {}, .variant = variant_};
  if (is_skinned) pose.joints = nodes_.joints(node);
  const bool is_plain = pose.weights.empty() && pose.joints.empty();
  if (const auto found = ready_.find(mesh); is_plain && found != ready_.end()) return found->second;

  const std::size_t first = scene_.meshes.size();
  for (Mesh& m : load_gltf_mesh(file_, mesh, pose, scene_.materials)) {
    boxes_.push_back(bounds_of(m.position));
    scene_.meshes.push_back(std::move(m));
  }
  const std::pair range(first, scene_.meshes.size());
  if (is_plain) ready_[mesh] = range;
  return range;
}

void SceneReader::add_instance(const GltfNode& node, std::size_t mesh, int object, const float4x4& world_from_object) {
  // What no primitive uses may lie where it wants: that is looked at only where it matters.
  if (!is_near(boxes_[mesh], world_from_object)) {
    Box used;
    for (const std::uint32_t i : scene_.meshes[mesh].index) used.add(scene_.meshes[mesh].position[i]);
    boxes_[mesh] = used;
  }
  if (!is_near(boxes_[mesh], world_from_object)) {
    file_.warn(node.json.place() + ": lies farther than 1e18 from the origin or nowhere, dropped");
    return;
  }
  scene_.instances.push_back({static_cast<int>(mesh), object, world_from_object});
}

void SceneReader::add_mesh(const GltfNode& node, std::size_t mesh) {
  const bool is_skinned = node.json.has("skin");
  const auto range = find_meshes(node, mesh, is_skinned);
  const std::string mesh_name = file_.root().element("meshes", mesh, "mesh").text("name");
  for (const float4x4& placement : read_placements(node)) {
    file_.budget().take(sizeof(Instance) * (range.second - range.first) + sizeof(std::string));
    const int object = static_cast<int>(scene_.objects.size());
    scene_.objects.push_back(
        node.json.text("name", mesh_name.empty() ? "node " + std::to_string(node.number) : mesh_name));
    // A skinned mesh is in the world already: its node's own transform does not count.
    const float4x4 world_from_object = is_skinned ? float4x4{} : node.world_from_node * placement;
    for (std::size_t m = range.first; m < range.second; ++m) add_instance(node, m, object, world_from_object);
  }
}

void SceneReader::add_node(const GltfNode& node) {
  file_.budget().check_time();
  if (const auto camera = node.json.find_index("camera", file_.count("cameras")))
    scene_.cameras.push_back(read_camera(file_.root().element("cameras", *camera, "camera"), node.world_from_node));
  if (const auto use = node.json.extension("KHR_lights_punctual")) {
    const auto all = file_.root().extension("KHR_lights_punctual");
    const std::size_t count = all ? all->count("lights") : 0;
    const std::size_t light = use->index("light", count);
    scene_.lights.push_back(read_light(all->element("lights", light, "light"), node.world_from_node));
  }
  if (const auto mesh = node.json.find_index("mesh", file_.count("meshes"))) add_mesh(node, *mesh);
}

Scene SceneReader::read(const GltfMaterials& look, GltfModel::Images images) {
  scene_.materials = look.materials;
  if (images == GltfModel::Images::With) scene_.images = look.images;
  for (const GltfNode& node : nodes_.in_scene()) add_node(node);

  // The default material comes last, where something needs it.
  const auto last = static_cast<int>(scene_.materials.size());
  const bool needs_default =
      std::any_of(scene_.meshes.begin(), scene_.meshes.end(), [&](const Mesh& m) { return m.material == last; });
  if (needs_default) scene_.materials.emplace_back().name = "default";
  if (scene_.instances.empty()) file_.warn(file_.root().place() + " nothing in the scene can be drawn");
  scene_.animations = list_animations(file_);
  scene_.variants = list_variants(file_);
  scene_.warnings = file_.warnings();
  return std::move(scene_);
}

}  // namespace

/// What is open, and what was left of the budget when it had been opened.
struct GltfModel::Open {
  Open(const std::string& path, const LoadLimits& limits) : file(path, limits) {
    check_extensions(file);
    look = load_materials(file);
    left = file.budget().memory_left();
  }
  GltfFile file;
  GltfMaterials look;
  std::uint64_t left = 0;
};

GltfModel::GltfModel(const std::string& path, const LoadLimits& limits) : open_(std::make_unique<Open>(path, limits)) {}
GltfModel::~GltfModel() = default;

Scene GltfModel::scene(const SceneChoice& choice, Images images) {
  open_->file.budget().restart(open_->left);
  return SceneReader(open_->file, choice).read(open_->look, images);
}

Scene load_gltf(const std::string& path, const LoadLimits& limits, const SceneChoice& choice) {
  return GltfModel(path, limits).scene(choice);
}

}  // namespace zoneplate
