// SPDX-License-Identifier: Apache-2.0
#if __has_include(<assimp/scene.h>)
#include "zoneplate/formats/assimp/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/scene/geometry/smooth_normals.h"
#include "zoneplate/scene/geometry/triangulate.h"
#include "zoneplate/scene/geometry/winding.h"
#include "zoneplate/scene/sanitize.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

std::string text_of(const aiString& text) {
  return {text.data, std::min<std::size_t>(text.length, sizeof text.data - 1)};
}

const aiMaterialProperty* find_property(const aiMaterial& m, std::string_view key, unsigned semantic = 0) {
  for (unsigned i = 0; i < m.mNumProperties; ++i) {
    const aiMaterialProperty& p = *m.mProperties[i];
    if (text_of(p.mKey) == key && p.mSemantic == semantic && p.mIndex == 0) return &p;
  }
  return nullptr;
}

/// Up to three floats of a property, padded with zeros; nothing if it has fewer than `least`.
std::optional<float3> find_floats(const aiMaterial& m, std::string_view key, std::size_t least) {
  const aiMaterialProperty* p = find_property(m, key);
  if (p == nullptr || p->mType != aiPTI_Float || p->mDataLength < least * sizeof(float)) return std::nullopt;
  float values[3] = {0, 0, 0};
  std::memcpy(values, p->mData, std::min<std::size_t>(sizeof values, p->mDataLength));
  const float3 out{values[0], values[1], values[2]};
  return is_finite(out) ? std::optional(out) : std::nullopt;
}
std::optional<float3> find_color(const aiMaterial& m, std::string_view key) { return find_floats(m, key, 3); }
std::optional<float> find_float(const aiMaterial& m, std::string_view key) {
  const auto floats = find_floats(m, key, 1);
  return floats ? std::optional(floats->x) : std::nullopt;
}

/// Decodes a string property: a 32-bit length followed by the characters.
std::string find_text(const aiMaterial& m, std::string_view key, unsigned semantic = 0) {
  const aiMaterialProperty* p = find_property(m, key, semantic);
  if (p == nullptr || p->mType != aiPTI_String || p->mDataLength < 5) return "";
  std::uint32_t length = 0;
  std::memcpy(&length, p->mData, sizeof length);
  return {p->mData + 4, std::min<std::size_t>(length, p->mDataLength - 5)};
}

std::optional<int> find_whole(const aiMaterial& m, std::string_view key, unsigned semantic = 0) {
  const aiMaterialProperty* p = find_property(m, key, semantic);
  if (p == nullptr || p->mType != aiPTI_Integer || p->mDataLength < sizeof(std::int32_t)) return std::nullopt;
  std::int32_t value = 0;
  std::memcpy(&value, p->mData, sizeof value);
  return value;
}

/// The coordinates of a mesh that the textures of a material use: two of the eight that assimp has.
struct UsedChannels {
  std::vector<unsigned> channel = {};  ///< of Mesh::uv0 and uv1

  /// The number of a channel, which it gets here; nothing if there are two others.
  std::optional<int> use(unsigned wanted) {
    const auto found = std::find(channel.begin(), channel.end(), wanted);
    if (found == channel.end() && channel.size() == 2) return std::nullopt;
    const auto number = static_cast<int>(found - channel.begin());
    if (found == channel.end()) channel.push_back(wanted);
    return number;
  }
};

/// The transform of coordinates of an FBX texture: scaled, rotated (in degrees) and moved, about the origin. That of
/// other formats is applied by assimp.
void read_transform(const aiMaterial& m, unsigned kind, MtlTexture& out) {
  constexpr float radians = 0.017453292f;
  const aiMaterialProperty* p = find_property(m, "$tex.uvtrafo", kind);
  float v[5] = {};
  if (p == nullptr || p->mType != aiPTI_Float || p->mDataLength < sizeof v) return;
  std::memcpy(v, p->mData, sizeof v);
  if (!std::all_of(std::begin(v), std::end(v), [](float f) { return std::isfinite(f); })) return;
  out.offset = {v[0], v[1]}, out.scale = {v[2], v[3]}, out.rotation = v[4] * radians;
}

/// The first texture of these kinds; without a file if there is none, or if it would use a third set of coordinates.
MtlTexture find_texture(const aiMaterial& m, std::initializer_list<aiTextureType> kinds, UsedChannels& channels,
                        std::vector<std::string>& unsupported) {
  MtlTexture out;
  for (const aiTextureType kind : kinds) {
    out.file = find_text(m, "$tex.file", kind);
    if (out.file.empty()) continue;
    read_transform(m, kind, out);
    const int wanted = find_whole(m, "$tex.uvwsrc", kind).value_or(0);
    const bool exists = wanted >= 0 && wanted < AI_MAX_NUMBER_OF_TEXTURECOORDS;
    const std::optional<int> set = channels.use(exists ? static_cast<unsigned>(wanted) : 0);
    if (!set) unsupported.push_back(out.file + " (a third set of texture coordinates)");
    if (!set) return {};
    out.uv_set = *set;
    return out;
  }
  return out;
}

/// Applies the shading models of COLLADA's common profile: <constant> is its emission alone, and <lambert>, which
/// assimp names Gouraud, has no highlights. Nor has a material that states none, to which assimp gives its own.
void set_collada_model(const aiMaterial& m, MtlMaterial& out) {
  constexpr float3 specular_of_assimp{0.4f, 0.4f, 0.4f};
  constexpr float exponent_of_assimp = 10;
  const std::optional<int> model = find_whole(m, "$mat.shadingm");
  const bool states_none = out.specular == specular_of_assimp && out.exponent == exponent_of_assimp;
  if (model == int{aiShadingMode_Gouraud} || states_none) out.illumination = 1;
  if (model != int{aiShadingMode_NoShading}) return;
  out.illumination = 0;
  out.diffuse = std::exchange(out.emissive, std::nullopt);
  out.diffuse_map = std::exchange(out.emissive_map, {});
}

/// Converts a material to the parameters of MTL, the only ones that are imported from these formats.
MtlMaterial mtl_of(const aiMaterial& m, UsedChannels& channels) {
  MtlMaterial out;
  out.name = find_text(m, "?mat.name");
  out.diffuse = find_color(m, "$clr.diffuse");
  if (!out.diffuse) out.diffuse = find_color(m, "$clr.base");
  out.specular = find_color(m, "$clr.specular");
  out.emissive = find_color(m, "$clr.emissive");
  out.exponent = find_float(m, "$mat.shininess");
  out.opacity = find_float(m, "$mat.opacity");
  out.metallic = find_float(m, "$mat.metallicFactor");
  out.roughness = find_float(m, "$mat.roughnessFactor");
  out.diffuse_map = find_texture(m, {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR}, channels, out.unsupported);
  // In FBX, COLLADA and 3DS a texture is the diffuse colour; in formats with a base colour it multiplies that.
  if (!out.diffuse_map.file.empty() && !find_color(m, "$clr.base")) out.diffuse.reset();
  out.ambient = out.diffuse;
  out.emissive_map = find_texture(m, {aiTextureType_EMISSIVE, aiTextureType_EMISSION_COLOR}, channels, out.unsupported);
  out.opacity_map = find_texture(m, {aiTextureType_OPACITY}, channels, out.unsupported);
  out.normal_map = find_texture(m, {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA}, channels, out.unsupported);
  return out;
}

/// The state of a conversion. A mesh of assimp may mix primitives, and becomes up to three meshes.
class Conversion {
 public:
  Conversion(const aiScene& from, std::string_view extension, Polygons polygons, ModelFolder& folder)
      : from_(from),
        extension_(extension),
        folder_(folder),
        scene_(folder.scene()),
        budget_(folder.budget()),
        polygons_(polygons) {}

  void run() {
    scene_.up = up();
    for (unsigned i = 0; i < from_.mNumTextures; ++i) embed(*from_.mTextures[i], i);
    for (unsigned i = 0; i < from_.mNumMaterials; ++i) add_material(*from_.mMaterials[i]);
    if (scene_.materials.empty()) scene_.materials.push_back(plain_material("default")), channels_.emplace_back();
    for (unsigned i = 0; i < from_.mNumMeshes; ++i) parts_.push_back(add_mesh(*from_.mMeshes[i]));
    if (from_.mRootNode != nullptr) add_node(*from_.mRootNode, {}, 0);
    if (dropped_ > 0)
      scene_.warnings.push_back(
          fmt::format("{}: {} primitives or meshes that are not finite are dropped", budget_.file(), dropped_));
    if (from_.mNumAnimations > 0)
      scene_.warnings.push_back(fmt::format("{}: animations of this format are ignored", budget_.file()));
  }

 private:
  // Where a file has no materials, its importer adds one of these names, in a grey of its own.
  void add_material(const aiMaterial& from) {
    MtlMaterial mtl = mtl_of(from, channels_.emplace_back());
    const bool is_default = mtl.name == AI_DEFAULT_MATERIAL_NAME || (mtl.name.empty() && is_format(".off")) ||
                            (mtl.name == "%%%DEFAULT" && is_format(".3ds"));
    if (is_default && mtl.diffuse_map.file.empty()) {
      scene_.materials.push_back(plain_material(mtl.name));
      return;
    }
    if (is_format(".dae")) set_collada_model(from, mtl);
    scene_.materials.push_back(make_material(mtl, "", folder_));
    scene_.materials.back().is_default = is_default;
  }
  bool is_format(std::string_view extension) const { return extension_ == extension; }

  /// The axis that points up: +Z in the world of Blender, FBX states it; assimp turns other formats.
  float3 up() const {
    if (is_format(".blend")) return {0, 0, 1};
    std::int32_t axis = 1, sign = 1;
    if (!is_format(".fbx") || from_.mMetaData == nullptr || !from_.mMetaData->Get("UpAxis", axis)) return scene_.up;
    from_.mMetaData->Get("UpAxisSign", sign);
    const float one = sign < 0 ? -1.0f : 1.0f;
    return axis == 0 ? float3{one, 0, 0} : axis == 2 ? float3{0, 0, one} : float3{0, one, 0};
  }

  /// Adds an image that is embedded in the file; materials refer to it by its index or its name.
  void embed(const aiTexture& t, unsigned number) {
    std::string names[] = {"*" + std::to_string(number), text_of(t.mFilename)};
    if (t.mHeight == 0) {
      folder_.embed(names, {reinterpret_cast<const std::uint8_t*>(t.pcData), t.mWidth});
      return;
    }
    const std::uint64_t count = std::uint64_t{t.mWidth} * t.mHeight;
    if (count > budget_.limits().pixels) return;
    budget_.take(count * sizeof(Rgba8));
    Rgba8Image image(static_cast<int>(t.mWidth), static_cast<int>(t.mHeight));
    std::transform(t.pcData, t.pcData + count, image.values().begin(), [](const aiTexel& p) {
      return Rgba8{p.r, p.g, p.b, p.a};
    });
    folder_.embed(names, std::move(image));
  }

  Mesh vertices_of(const aiMesh& m) {
    Mesh out;
    const std::size_t n = m.mNumVertices;
    const bool has_color = m.mColors[0] != nullptr;
    budget_.take(n * (sizeof(float3) + (m.mNormals ? sizeof(float3) : 0) + (has_color ? sizeof(float4) : 0)));
    const auto to_float3 = [](const aiVector3D& v) { return float3{v.x, v.y, v.z}; };
    out.position.resize(n), std::transform(m.mVertices, m.mVertices + n, out.position.begin(), to_float3);
    if (m.mNormals != nullptr) {
      out.normal.resize(n);
      std::transform(m.mNormals, m.mNormals + n, out.normal.begin(), [&](const aiVector3D& v) {
        return is_finite(to_float3(v)) ? normalize(to_float3(v), {0, 1, 0}) : float3{0, 1, 0};
      });
    }
    const std::vector<unsigned>& channels = channels_[material_of(m)].channel;
    out.uv0 = coordinates_of(m, channels.empty() ? 0 : channels[0]);
    if (channels.size() == 2) out.uv1 = coordinates_of(m, channels[1]);
    if (has_color) {
      out.color.resize(n);
      std::transform(m.mColors[0], m.mColors[0] + n, out.color.begin(), [](const aiColor4D& c) {
        return float4{linear(c.r), linear(c.g), linear(c.b), c.a};
      });
    }
    return out;
  }
  /// The coordinates of a channel; the first ones of a mesh that has none there.
  std::vector<float2> coordinates_of(const aiMesh& m, unsigned channel) {
    const aiVector3D* const from = m.mTextureCoords[m.mTextureCoords[channel] != nullptr ? channel : 0];
    if (from == nullptr) return {};
    budget_.take(m.mNumVertices * sizeof(float2));
    std::vector<float2> out(m.mNumVertices);
    std::transform(from, from + m.mNumVertices, out.begin(), [](const aiVector3D& v) { return float2{v.x, 1 - v.y}; });
    return out;
  }
  std::size_t material_of(const aiMesh& m) const {
    return std::min<std::size_t>(m.mMaterialIndex, scene_.materials.size() - 1);
  }
  static float linear(float code) { return decode_srgb(std::clamp(code, 0.0f, 1.0f)); }

  void add_face(const aiFace& face, const aiMesh& m, std::array<std::vector<std::uint32_t>, 3>& index) {
    const std::span<const unsigned> corners(face.mIndices, face.mNumIndices);
    if (std::any_of(corners.begin(), corners.end(), [&](unsigned i) { return i >= m.mNumVertices; }))
      throw Error(ErrorKind::Input, budget_.file() + ": a face names a vertex that is not there");
    if (corners.empty()) return;
    constexpr std::size_t many_corners = 64;  // triangulating a polygon of more corners may take long
    if (corners.size() > many_corners) budget_.check_time();
    budget_.take(3 * corners.size() * sizeof(std::uint32_t));
    if (polygons_ == Polygons::Polylines && corners.size() > 1) {
      for (std::size_t i = 1; i < corners.size(); ++i) index[1].insert(index[1].end(), {corners[i - 1], corners[i]});
      return;
    }
    std::vector<std::uint32_t>& out = index[std::min<std::size_t>(corners.size(), 3) - 1];
    if (corners.size() <= 3) return void(out.insert(out.end(), corners.begin(), corners.end()));
    polygon_.clear(), triangles_.clear();
    for (const unsigned i : corners) polygon_.push_back({m.mVertices[i].x, m.mVertices[i].y, m.mVertices[i].z});
    if (!std::all_of(polygon_.begin(), polygon_.end(), is_finite)) return void(++dropped_);
    triangulate(polygon_, triangles_);
    for (const auto& triangle : triangles_)
      for (const std::uint32_t corner : triangle) out.push_back(corners[corner]);
  }

  /// Adds the meshes that a mesh of assimp becomes; returns their indices.
  std::vector<int> add_mesh(const aiMesh& m) {
    budget_.check_time();
    std::array<std::vector<std::uint32_t>, 3> index;
    serial_ranges(m.mNumFaces, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) add_face(m.mFaces[f], m, index);
    });
    std::vector<int> numbers;
    for (std::size_t corners = 1; corners <= 3; ++corners) {
      if (index[corners - 1].empty()) continue;
      Mesh mesh = vertices_of(m);
      mesh.name = text_of(m.mName);
      budget_.take(2 * sizeof(Mesh) + mesh.name.size());
      mesh.topology = corners == 1 ? Topology::Points : corners == 2 ? Topology::Lines : Topology::Triangles;
      mesh.index = std::move(index[corners - 1]);
      mesh.material = static_cast<int>(material_of(m));
      dropped_ += drop_not_finite(mesh).dropped;
      if (mesh.index.empty()) continue;
      if (corners == 3 && mesh.normal.empty()) {
        budget_.take(mesh.position.size() * sizeof(float3) * 2);
        make_smooth_normals(mesh);
      } else if (corners == 3) {
        turn_to_normals(mesh);
      }
      numbers.push_back(static_cast<int>(scene_.meshes.size()));
      scene_.meshes.push_back(std::move(mesh));
    }
    return numbers;
  }

  void add_node(const aiNode& node, const float4x4& world_from_parent, int depth) {
    if (depth > budget_.limits().node_depth)
      throw Error(ErrorKind::Input,
                  fmt::format("{}: nodes deeper than {}", budget_.file(), budget_.limits().node_depth));
    budget_.check_time();
    budget_.take(2 * sizeof(std::string) + node.mName.length);
    const aiMatrix4x4& t = node.mTransformation;
    const float4x4 parent_from_node{{float4{t.a1, t.b1, t.c1, t.d1}, float4{t.a2, t.b2, t.c2, t.d2},
                                     float4{t.a3, t.b3, t.c3, t.d3}, float4{t.a4, t.b4, t.c4, t.d4}}};
    const float4x4 world = world_from_parent * parent_from_node;
    const int object = static_cast<int>(scene_.objects.size());
    if (node.mNumMeshes > 0) scene_.objects.push_back(text_of(node.mName));
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
      if (node.mMeshes[i] >= parts_.size())
        throw Error(ErrorKind::Input, budget_.file() + ": a node names a mesh that is not there");
      for (const int part : parts_[node.mMeshes[i]]) add_instance({part, object, world});
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(*node.mChildren[i], world, depth + 1);
  }

  void add_instance(const Instance& instance) {
    for (const float4& c : instance.world_from_object.column)
      if (!is_finite(xyz(c)) || !std::isfinite(c.w)) return void(++dropped_);
    budget_.take(2 * sizeof(Instance));
    scene_.instances.push_back(instance);
  }

  const aiScene& from_;
  std::string_view extension_;
  ModelFolder& folder_;
  Scene& scene_;
  ImportBudget& budget_;
  Polygons polygons_;
  std::vector<UsedChannels> channels_;   ///< by material
  std::vector<std::vector<int>> parts_;  ///< for each mesh of assimp, the indices of our meshes
  std::vector<float3> polygon_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::uint64_t dropped_ = 0;
};

}  // namespace

void convert_assimp_scene(const aiScene& from, std::string_view extension, Polygons polygons, ModelFolder& folder) {
  Conversion(from, extension, polygons, folder).run();
}

}  // namespace zoneplate
#endif
