// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/stream/stream.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/gltf/accessor.h"
#include "zoneplate/formats/gltf/gltf.h"
#include "zoneplate/formats/gltf/nodes.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

/// What the vertices of a scene take in memory at least, and how many triangles it draws.
struct Needs {
  std::uint64_t bytes = 0, triangles = 0;
};

/// The needs of the meshes that the nodes of a scene use.
class NeedsFinder {
 public:
  explicit NeedsFinder(GltfFile& file) : file_(file) {}

  Needs find(const SceneChoice& choice) {
    std::map<std::size_t, std::uint64_t> triangles;  // by mesh
    const GltfNodes nodes(file_, choice);
    for (const GltfNode& node : nodes.in_scene()) {
      const auto mesh = node.json.find_index("mesh", file_.count("meshes"));
      if (!mesh || !node.is_visible) continue;
      const auto [found, is_new] = triangles.try_emplace(*mesh, 0);
      if (is_new) found->second = add_mesh(*mesh);
      needs_.triangles += found->second;
    }
    for (const auto& [accessor, use] : vertices_) needs_.bytes += std::min(use.count, use.corners) * use.bytes;
    return needs_;
  }

 private:
  /// The primitives that have the same positions.
  struct VertexUse {
    std::uint64_t count = 0, corners = 0, bytes = 0;
  };

  /// Returns the number of the mesh's triangles.
  std::uint64_t add_mesh(std::size_t number) {
    const JsonView mesh = file_.root().element("meshes", number, "mesh");
    std::uint64_t corners = 0;
    for (std::size_t i = 0; i < mesh.count("primitives"); ++i)
      file_.read_optional([&] { corners += add_primitive(mesh.element("primitives", i, "primitive")); });
    return corners / 3;
  }

  std::uint64_t add_primitive(const JsonView& primitive) {
    // The interleaved vertices and the screen vertices of the renderer, besides the attributes.
    constexpr std::uint64_t drawn = 32 + 16, index = 4, vector = 12;
    const JsonView attributes = primitive.object("attributes");
    const auto positions = attributes.find_index("POSITION", file_.count("accessors"));
    if (!positions) return 0;
    const std::uint64_t count = read_shape(file_, attributes, "POSITION").count;
    const std::uint64_t corners = primitive.has("indices") ? read_shape(file_, primitive, "indices").count : count;
    needs_.bytes += corners * index;
    if (!attributes.has("NORMAL")) {  // flat: each corner has its own vertex
      needs_.bytes += corners * (2 * vector + drawn);
    } else {
      VertexUse& use = vertices_[*positions];
      use.count = count, use.corners += corners, use.bytes = 2 * vector + drawn;
    }
    return corners;
  }

  GltfFile& file_;
  Needs needs_;
  std::map<std::size_t, VertexUse> vertices_;  ///< by the accessor of positions
};

/// A primitive of which triangles are read.
struct Part {
  JsonView json;
  ElementLayout position;
  std::optional<ElementLayout> index, normal;

  std::uint64_t corners() const { return index ? index->count : position.count; }
  std::uint64_t vertex(std::uint64_t corner) const { return index ? index_at(*index, corner) : corner; }
};

class GltfStream : public FileStream {
 public:
  GltfStream(const std::string& path, const LoadLimits& limits, const SceneChoice& choice)
      : FileStream(path, limits), model_(std::make_unique<GltfModel>(path, limits, file().bytes())) {
    bytes_in_memory_ = NeedsFinder(model_->restarted_file()).find(choice).bytes;
    head_ = model_->scene(choice, GltfModel::Images::With,
                          [&](GltfFile& gltf, std::size_t mesh, const GltfPose& pose,
                              std::span<const Material> materials) { return read_mesh(gltf, mesh, pose, materials); });
    if (head_.origin != double3{}) note("lies far from the origin of its coordinates");
    std::uint64_t end = 0;
    for (const Instance& instance : head_.instances) {
      end += parts_[static_cast<std::size_t>(instance.mesh)].corners() / 3;
      instances_.push_back({static_cast<std::size_t>(end), instance.world_from_object});
    }
    constexpr std::uint64_t most = 0x7ffffffe;  // of the rasterizer
    if (end > most) note("has more than 2^31 - 2 triangles");
  }

  bool is_empty() const { return instances_.empty() && refusal_.empty(); }
  std::size_t count() const override { return instances_.empty() ? 0 : instances_.back().end; }
  std::vector<StreamInstance> instances() const override { return instances_; }
  std::uint64_t bytes_in_memory() const override { return bytes_in_memory_; }
  void check() const override {
    if (!refusal_.empty()) refuse(refusal_);
  }

  void read(std::size_t first, std::size_t count, float3* corners) const override {
    for_each_instance(instances_, first, first + count, [&](std::size_t i, std::size_t begin, std::size_t end) {
      const Part& part = part_of(i);
      for (std::uint64_t c = 3 * (begin - begin_of(i)); c < 3 * (end - begin_of(i)); ++c) {
        const std::uint64_t v = part.vertex(c);
        *corners++ = v < part.position.count ? float3_at(part.position, v) : nowhere;
      }
    });
  }

  void examine(std::size_t first, std::size_t count, const float3*) override {
    for_each_instance(instances_, first, first + count, [&](std::size_t i, std::size_t begin, std::size_t end) {
      const Part& part = part_of(i);
      if (!part.normal) return;
      bool lacks = false;
      for (std::uint64_t c = 3 * (begin - begin_of(i)); c < 3 * (end - begin_of(i)); ++c)
        if (const std::uint64_t v = part.vertex(c); v < part.normal->count)
          lacks = lacks || gltf_direction(float3_at(*part.normal, v)) == float3{};
      if (lacks) lacks_normals_ = true;
    });
  }

  void read_ahead(std::size_t first, std::size_t count) const override {
    for_each_instance(instances_, first, first + count, [&](std::size_t i, std::size_t begin, std::size_t end) {
      const ElementLayout& list = part_of(i).index ? *part_of(i).index : part_of(i).position;
      if (list.bytes.empty()) return;
      file().read_ahead(list.bytes.data() + 3 * (begin - begin_of(i)) * list.stride, 3 * (end - begin) * list.stride);
    });
  }
  void forget() const override {
    FileStream::forget();
    model_->forget();
  }

  Scene head() const override {
    if (lacks_normals_) refuse("has vertices whose normals are missing");
    return head_;
  }

  Mesh mesh(std::span<const std::uint32_t> triangles) const override {
    const auto ends_after = [](std::size_t t, const StreamInstance& instance) { return t < instance.end; };
    const auto i = static_cast<std::size_t>(
        std::upper_bound(instances_.begin(), instances_.end(), triangles.front(), ends_after) - instances_.begin());
    std::vector<std::uint32_t> own(triangles.begin(), triangles.end());
    for (std::uint32_t& t : own) t -= static_cast<std::uint32_t>(begin_of(i));
    Mesh out = load_gltf_triangles(model_->restarted_file(), part_of(i).json, {.variant = variant_}, materials(), own);
    forget();
    if (out.primitives() != triangles.size()) throw_changed();
    return out;
  }

 private:
  static constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  static constexpr float3 nowhere{nan, nan, nan};

  const Part& part_of(std::size_t instance) const {
    return parts_[static_cast<std::size_t>(head_.instances[instance].mesh)];
  }
  std::size_t begin_of(std::size_t instance) const { return instance == 0 ? 0 : instances_[instance - 1].end; }
  /// Those of the file, without the default one.
  std::span<const Material> materials() const { return std::span(head_.materials).first(file_materials_); }
  /// Keeps the first thing that cannot be read in parts.
  void note(const char* what) {
    if (refusal_.empty()) refusal_ = what;
  }

  std::vector<GltfPrimitive> read_mesh(GltfFile& gltf, std::size_t number, const GltfPose& pose,
                                       std::span<const Material> materials) {
    const JsonView json = gltf.root().element("meshes", number, "mesh");
    file_materials_ = materials.size();
    variant_ = pose.variant;
    if (!pose.joints.empty()) note("has skins");
    std::vector<GltfPrimitive> out;
    for (std::size_t i = 0; i < json.count("primitives"); ++i) {
      const JsonView primitive = json.element("primitives", i, "primitive");
      if (primitive.count("targets") > 0 && (json.has("weights") || !pose.weights.empty())) note("has morph targets");
      Mesh head;
      gltf.read_optional([&] {
        if (!add_part(gltf, primitive, materials, head)) return;
        head.name = json.text("name", "mesh " + std::to_string(number));
        out.push_back({static_cast<int>(i), std::move(head)});
      });
    }
    return out;
  }

  /// Adds a primitive, and sets what its mesh has besides vertices and triangles; false if it draws nothing.
  bool add_part(GltfFile& gltf, const JsonView& primitive, std::span<const Material> materials, Mesh& head) {
    const JsonView owner = primitive.object("attributes").renamed(primitive.place());
    if (primitive.whole("mode", 4, 255) != 4) return note("has strips, fans, lines or points"), false;
    if (primitive.extension("KHR_draco_mesh_compression")) return note("has meshes that Draco compresses"), false;
    if (has_sparse(gltf, primitive, owner)) return note("has sparse accessors"), false;
    Part part{primitive, {}, {}, {}};
    if (owner.has("POSITION")) part.position = find_float3(gltf, owner, "POSITION");
    if (owner.has("POSITION") && primitive.has("indices")) part.index = find_indices(gltf, primitive, "indices");
    if (owner.has("POSITION") && part.corners() < 3) return false;

    // What one triangle lacks, all do.
    constexpr std::uint32_t first[] = {0};
    const Mesh some = load_gltf_triangles(gltf, primitive, {.variant = variant_}, materials, first);
    if (some.position.empty()) return false;
    gltf.read_optional([&] {
      if (owner.has("NORMAL")) part.normal = find_float3(gltf, owner, "NORMAL");
    });
    if (part.normal && part.normal->count != part.position.count) part.normal.reset();
    const auto m = static_cast<std::size_t>(some.material);
    if (m < materials.size() && needs_tangents(materials[m])) note("has materials that need tangents");
    head.material = some.material;
    parts_.push_back(std::move(part));
    return true;
  }

  static bool has_sparse(GltfFile& gltf, const JsonView& primitive, const JsonView& attributes) {
    const auto is_sparse = [&](const JsonView& owner, const char* key) {
      try {
        const auto number = owner.find_index(key, gltf.count("accessors"));
        return number && gltf.root().element("accessors", *number, "accessor").has("sparse");
      } catch (const Error&) {  // its reader reports it
        return false;
      }
    };
    return is_sparse(primitive, "indices") || std::ranges::any_of(attributes.keys(), [&](const std::string& key) {
             return is_sparse(attributes, key.c_str());
           });
  }

  std::unique_ptr<GltfModel> model_;
  std::uint64_t bytes_in_memory_ = 0;
  Scene head_;
  std::vector<Part> parts_;  ///< by mesh of the head
  std::vector<StreamInstance> instances_;
  std::size_t file_materials_ = 0;
  std::optional<std::size_t> variant_;
  std::string refusal_;
  std::atomic<bool> lacks_normals_ = false;
};

}  // namespace

bool gltf_may_exceed_memory(const std::string& path, const LoadLimits& limits, const SceneChoice& choice) {
  try {
    const FileBytes bytes = FileBytes::reclaimable(path);
    GltfFile file(path, limits, bytes.bytes());
    const Needs needs = NeedsFinder(file).find(choice);
    return needs.bytes + needs.triangles * FileStream::max_in_bins > limits.memory;
  } catch (const Gltf1Error&) {
    return false;
  }
}

std::unique_ptr<FileStream> open_gltf_stream(const std::string& path, const LoadLimits& limits,
                                             const SceneChoice& choice) {
  try {
    auto stream = std::make_unique<GltfStream>(path, limits, choice);
    if (stream->is_empty()) return nullptr;
    return stream;
  } catch (const Gltf1Error&) {
    return nullptr;
  }
}

}  // namespace zoneplate
