// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/ply/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/ply/mesh.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/geometry/flat_normals.h"
#include "zoneplate/scene/geometry/smooth_normals.h"
#include "zoneplate/scene/geometry/winding.h"
#include "zoneplate/scene/sanitize.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

/// The supported elements that the file has.
struct Found {
  std::optional<PlyRows> vertices, faces, strips, edges;
};

Found find_elements(const PlyHeader& header, std::span<const std::uint8_t> body, ImportBudget& budget) {
  Found found;
  std::optional<PlyRows>* const slots[] = {&found.vertices, &found.faces, &found.strips, &found.edges};
  constexpr const char* names[] = {"vertex", "face", "tristrips", "edge"};
  // Data after the last supported element may be missing.
  std::size_t last = 0;
  for (std::size_t e = 0; e < header.elements.size(); ++e)
    if (std::find(std::begin(names), std::end(names), header.elements[e].name) != std::end(names)) last = e + 1;
  for (std::size_t e = 0; e < last; ++e) {
    PlyRows rows = find_ply_rows(header.elements[e], header.order, body, budget);
    body = body.subspan(static_cast<std::size_t>(rows.size));
    for (std::size_t i = 0; i < std::size(names); ++i)
      if (header.elements[e].name == names[i] && !*slots[i]) *slots[i] = std::move(rows);
  }
  if (!found.vertices) throw Error(ErrorKind::Input, budget.file() + ": has no element vertex");
  return found;
}

template <class V>
std::vector<V> spread(const std::vector<V>& values, const std::vector<std::uint32_t>& index) {
  std::vector<V> out(values.empty() ? 0 : index.size());
  parallel_ranges(out.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = values[index[i]];
  });
  return out;
}

/// Gives each corner its own vertex, which has the attributes of its face.
void set_corners(Mesh& mesh, PlyFaces& faces, ImportBudget& budget) {
  budget.take(mesh.index.size() * (2 * sizeof(float3) + sizeof(float2) + sizeof(float4)));
  mesh.position = spread(mesh.position, mesh.index);
  mesh.normal = spread(mesh.normal, mesh.index);
  mesh.uv0 = faces.corner_uv.empty() ? spread(mesh.uv0, mesh.index) : std::move(faces.corner_uv);
  mesh.color = faces.corner_color.empty() ? spread(mesh.color, mesh.index) : std::move(faces.corner_color);
  std::iota(mesh.index.begin(), mesh.index.end(), 0u);
}

/// Computes the missing normals: all of them, or those that are zero in the file.
void complete_normals(Mesh& mesh, ImportBudget& budget) {
  if (mesh.topology != Topology::Triangles) {
    for (float3& n : mesh.normal) n = normalize(n, {0, 1, 0});
    return;
  }
  if (mesh.normal.empty()) {
    // A sum per vertex; a vertex per corner in the worst case, and a copy of those.
    budget.take(mesh.position.size() * 28 + mesh.index.size() * (sizeof(float3) + 2 * sizeof(std::uint32_t) + 48));
    make_smooth_normals(mesh);
    return;
  }
  if (std::find(mesh.normal.begin(), mesh.normal.end(), float3{}) == mesh.normal.end()) return;
  std::vector<float3> sum(mesh.normal.size());
  serial_ranges(mesh.primitives(), [&](std::size_t begin, std::size_t end) {
    for (const std::uint32_t* i = &mesh.index[3 * begin]; i != mesh.index.data() + 3 * end; i += 3) {
      const float3 n = flat_normal(mesh.position[i[0]], mesh.position[i[1]], mesh.position[i[2]]);
      for (std::size_t c = 0; c < 3; ++c) sum[i[c]] += n;
    }
  });
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (mesh.normal[i] == float3{}) mesh.normal[i] = normalize(sum[i], {0, 1, 0});
}

/// Reads the vertices and, if the triangles are plain, in parallel the indices: page faults dominate the time of both.
void read_arrays(const Found& found, PlyVertices& vertices, PlyFaces& faces, ImportBudget& budget) {
  const bool are_plain = found.faces && are_plain_triangles(*found.faces);
  const std::uint64_t bytes = are_plain ? found.faces->count() * 3 * sizeof(std::uint32_t) : 0;
  budget.take(bytes);
  parallel_for(2, [&](std::size_t i) {
    if (i == 0) vertices = read_ply_vertices(*found.vertices, budget);
    if (i == 1 && are_plain) faces.index = read_plain_triangles(*found.faces, found.vertices->count());
  });
  if (faces.index.empty()) budget.give_back(bytes);
  budget.check_time();
}

/// Sets the mesh's primitives and topology; attributes per corner and the textures of triangles remain in `faces`.
void choose_primitives(const Found& found, std::size_t textures, Mesh& mesh, PlyFaces& faces, ImportBudget& budget) {
  if (found.faces && faces.index.empty()) faces = read_ply_faces(*found.faces, mesh, textures, budget);
  if (faces.index.empty() && found.strips) faces.index = read_ply_strips(*found.strips, mesh, budget, faces.strays);
  mesh.index = std::move(faces.index);
  if (!mesh.index.empty() || faces.too_short > 0 || faces.strays.count > 0) return;
  if (found.edges) mesh.index = read_ply_edges(*found.edges, mesh, budget, faces.strays);
  if (faces.strays.count > 0 && mesh.index.empty()) return;
  mesh.topology = mesh.index.empty() ? Topology::Points : Topology::Lines;
  if (mesh.topology == Topology::Lines) return;
  budget.take(mesh.position.size() * sizeof(std::uint32_t));
  mesh.index.resize(mesh.position.size());
  std::iota(mesh.index.begin(), mesh.index.end(), 0u);
}

/// Whether all vertices have one opaque grey. MeshLab stores its default, (192, 192, 192), in files of meshes without
/// colours.
bool is_uniform_grey(const std::vector<float4>& colors) {
  const float4 first = colors.empty() ? float4{} : colors.front();
  return first.x == first.y && first.x == first.z && first.w == 1 &&
         std::all_of(colors.begin(), colors.end(), [&](float4 c) { return c == first; });
}

/// A material with the image of a texture, or of none, for a mesh that gets it.
Material material_of(const std::string& texture, ModelFolder& files, Mesh& mesh) {
  Material material = plain_material("default");
  if (!texture.empty() && !mesh.uv0.empty()) {
    material.base_color_texture.image = files.image("", texture);
    material.is_default = false;
    // A texture is not darkened by such a grey.
    if (material.base_color_texture.image >= 0 && is_uniform_grey(mesh.color)) mesh.color.clear();
  }
  if (!mesh.color.empty() || material.base_color_texture.image >= 0) material.base_color = {1, 1, 1, 1};
  const bool is_clear = std::any_of(mesh.color.begin(), mesh.color.end(), [](float4 c) { return c.w < 1; });
  if (is_clear) material.alpha_mode = AlphaMode::Blend;
  return material;
}

/// Makes colours opaque that would all be transparent: their programs do not use alpha.
void show_transparent(Mesh& mesh, Scene& scene, const std::string& file) {
  if (mesh.color.empty() || std::any_of(mesh.color.begin(), mesh.color.end(), [](float4 c) { return c.w > 0; })) return;
  scene.warnings.push_back(file + ": the alpha of all vertices is 0, taken as 1");
  for (float4& c : mesh.color) c.w = 1;
}

/// The part of a mesh whose triangles have a texture. Each corner has its own vertex.
Mesh part_of(const Mesh& mesh, const std::vector<std::uint16_t>& textures, std::size_t texture) {
  Mesh part;
  part.name = mesh.name;
  for (std::size_t t = 0; t < textures.size(); ++t)
    if (textures[t] == texture) part.index.insert(part.index.end(), &mesh.index[3 * t], &mesh.index[3 * t] + 3);
  part.position = spread(mesh.position, part.index);
  part.normal = spread(mesh.normal, part.index);
  part.uv0 = spread(mesh.uv0, part.index);
  part.color = spread(mesh.color, part.index);
  std::iota(part.index.begin(), part.index.end(), 0u);
  return part;
}

/// Adds the mesh, or a mesh for each texture if triangles have several (`textures`, a number per triangle).
void add_meshes(Mesh mesh, const std::vector<std::uint16_t>& textures, const PlyHeader& header,
                const std::string& folder, Scene& scene, ImportBudget& budget) {
  scene.objects.push_back(mesh.name);
  ModelFolder files(folder, budget, scene);
  const auto add = [&](Mesh part, const std::string& texture) {
    part.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material_of(texture, files, part));
    scene.instances.push_back({static_cast<int>(scene.meshes.size()), 0, {}});
    scene.meshes.push_back(std::move(part));
  };
  if (textures.empty()) return add(std::move(mesh), header.textures.empty() ? "" : header.textures.front());
  budget.take(mesh.index.size() * (2 * sizeof(float3) + sizeof(float2) + sizeof(float4) + sizeof(std::uint32_t)));
  for (std::size_t i = 0; i < header.textures.size(); ++i)
    if (Mesh part = part_of(mesh, textures, i); !part.index.empty()) add(std::move(part), header.textures[i]);
}

void warn(Scene& scene, const ImportBudget& budget, std::uint64_t count, const char* text) {
  if (count > 0) scene.warnings.push_back(fmt::format("{}: {} {}", budget.file(), count, text));
}

void warn_of_strays(Scene& scene, const ImportBudget& budget, const PlyStrays& strays, std::size_t vertices) {
  if (strays.count == 0) return;
  const std::string more = strays.count > 1 ? fmt::format(" (and {} more)", strays.count - 1) : "";
  budget.warn_of_flaw(scene.warnings, fmt::format("{}: face {} uses vertex {}, there are {}: it is dropped{}",
                                                  budget.file(), strays.row, strays.index, vertices, more));
}

}  // namespace

Scene load_ply(const std::string& path, const LoadLimits& limits) {
  const bool is_stream = path == "-";
  const FileBytes file(path, limits.memory);
  ImportBudget budget(is_stream ? "standard input" : path, limits);
  PlyHeader header = parse_ply_header(file.bytes(), budget.file());
  std::span<const std::uint8_t> body = file.bytes().subspan(header.size);
  std::vector<double> numbers;
  if (header.order == PlyOrder::Ascii) {
    const auto* const text = reinterpret_cast<const char*>(file.bytes().data());
    const auto lines = static_cast<std::size_t>(std::count(text, text + header.size, '\n'));
    numbers = parse_ply_text({text + header.size, body.size()}, lines, header, budget);
    body = {reinterpret_cast<const std::uint8_t*>(numbers.data()), numbers.size() * sizeof(double)};
  }

  Scene scene;
  for (const std::string& warning : header.warnings) budget.warn_of_flaw(scene.warnings, warning);
  const Found found = find_elements(header, body, budget);
  PlyVertices read;
  PlyFaces faces;
  read_arrays(found, read, faces, budget);
  scene.origin = read.origin;
  Mesh mesh = std::move(read.mesh);
  const std::size_t vertices = mesh.position.size();
  choose_primitives(found, header.textures.size(), mesh, faces, budget);
  if (scene.origin == double3{}) scene.origin = center_far_vertices(*found.vertices, mesh);
  warn_of_strays(scene, budget, faces.strays, vertices);
  warn(scene, budget, faces.too_short, "faces have fewer than 3 corners and are dropped");
  warn(scene, budget, faces.too_concave, "faces have too many corners to be cut rightly");
  if (mesh.topology == Topology::Points && are_splats(*found.vertices->element))
    scene.warnings.push_back(
        budget.file() + ": looks like Gaussian splats: only their centres are drawn, as points of their mean colours");
  const std::size_t primitives = mesh.primitives();
  const bool has_normals = !mesh.normal.empty();
  if (!faces.corner_uv.empty() || !faces.corner_color.empty()) {
    if (mesh.normal.empty()) drop_not_finite(mesh), complete_normals(mesh, budget);
    if (mesh.primitives() == primitives) set_corners(mesh, faces, budget);
  }
  drop_not_finite(mesh);
  warn(scene, budget, primitives - mesh.primitives(), "primitives have a vertex that is not finite and are dropped");
  if (mesh.index.empty()) throw budget.nothing_to_draw(scene.warnings, "holds no vertices");
  if (mesh.primitives() != primitives && !faces.texture.empty()) {
    faces.texture.clear();
    scene.warnings.push_back(budget.file() + ": triangles are dropped, the others have the first texture");
  }
  complete_normals(mesh, budget);
  if (has_normals) turn_to_normals(mesh);
  show_transparent(mesh, scene, budget.file());

  const std::filesystem::path place(path);
  mesh.name = is_stream ? "object" : place.stem().string();
  add_meshes(std::move(mesh), faces.texture, header, is_stream ? "." : place.parent_path().string(), scene, budget);
  return scene;
}

}  // namespace zoneplate
