// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/stl/stl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <string_view>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/stl/text.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/geometry/flat_normals.h"
#include "zoneplate/scene/geometry/origin.h"
#include "zoneplate/scene/geometry/triangulate.h"
#include "zoneplate/scene/sanitize.h"

namespace zoneplate {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::size_t header_bytes = 84, facet_bytes = 50, corners_at = 12, attribute_at = 48;
constexpr std::size_t block = 1024;  // facets whose data stay in the cache between loops

std::uint32_t read_u32(const std::uint8_t* at) {
  return at[0] | std::uint32_t{at[1]} << 8 | std::uint32_t{at[2]} << 16 | std::uint32_t{at[3]} << 24;
}
std::uint32_t read_u16(const std::uint8_t* at) { return at[0] | std::uint32_t{at[1]} << 8; }
/// Whether a file is ASCII. It is binary if its size agrees with the count of triangles, because many binary files
/// begin with "solid" too.
bool is_text(Bytes bytes) {
  if (bytes.size() >= header_bytes && bytes.size() == header_bytes + facet_bytes * read_u32(&bytes[80])) return false;
  constexpr std::size_t looked_at = 512;
  const Bytes front = bytes.first(std::min(bytes.size(), looked_at));
  return std::find(front.begin(), front.end(), 0) == front.end() &&
         find_stl_solid({reinterpret_cast<const char*>(front.data()), front.size()}) != std::string_view::npos;
}

/// Decodes the colours of facets: 5 bits per channel, and one bit that marks the colour as valid.
class FacetColor {
 public:
  explicit FacetColor(Bytes header) {
    static constexpr std::string_view word = "COLOR=";
    const auto found = std::search(header.begin(), header.begin() + 80, word.begin(), word.end());
    is_magics_ = found != header.begin() + 80 && header.begin() + 80 - found >= 10;
    for (std::size_t i = 0; i < 32; ++i) linear_[i] = decode_srgb(static_cast<float>(i) / 31);
    if (!is_magics_) return;
    const auto c = found + 6;
    whole_ = {decode_srgb8(c[0]), decode_srgb8(c[1]), decode_srgb8(c[2]), static_cast<float>(c[3]) / 255};
    if (whole_.w == 0) whole_.w = 1;  // programs without transparency write alpha 0
  }

  bool is_own(std::uint32_t attribute) const { return (attribute >> 15 != 0) != is_magics_; }
  bool colors_all() const { return is_magics_; }
  float4 of_all() const { return whole_; }  ///< that of the header, if `colors_all`
  float4 operator()(std::uint32_t attribute) const {
    if (!is_own(attribute)) return whole_;
    const float low = linear_[attribute & 31], middle = linear_[attribute >> 5 & 31],
                high = linear_[attribute >> 10 & 31];
    return is_magics_ ? float4{low, middle, high, 1} : float4{high, middle, low, 1};
  }

 private:
  bool is_magics_ = false;
  float4 whole_{1, 1, 1, 1};
  std::array<float, 32> linear_{};
};

/// Allocates arrays for `count` separate triangles. It does so in parallel, because page faults dominate the time.
Mesh make_triangles(std::uint64_t count) {
  Mesh mesh;
  const std::size_t corners = 3 * static_cast<std::size_t>(count);
  parallel_for(3, [&](std::size_t i) {
    if (i == 0) make_large(mesh.position, corners);
    if (i == 1) make_large(mesh.normal, corners);
    if (i == 2) make_large(mesh.index, corners);
  });
  return mesh;
}

/// Reads `count` facets, with colours if any facet has one.
Mesh read_facets(Bytes bytes, std::uint64_t count, ImportBudget& budget) {
  const std::uint8_t* const facets = bytes.data() + header_bytes;
  budget.take(count * 3 * (2 * sizeof(float3) + sizeof(std::uint32_t)));
  Mesh mesh = make_triangles(count);
  const FacetColor color(bytes.first(header_bytes));
  std::atomic<bool> is_colored = color.colors_all(), has_attributes = false;
  parallel_ranges(count, block, [&](std::size_t begin, std::size_t end) {
    if (!budget.has_time()) return;
    std::uint32_t any = 0;
    for (std::size_t f = begin; f < end; ++f) {
      const std::uint8_t* const facet = facets + f * facet_bytes;
      std::memcpy(&mesh.position[3 * f], facet + corners_at, 3 * sizeof(float3));
      any |= read_u16(facet + attribute_at);
    }
    std::iota(&mesh.index[3 * begin], &mesh.index[3 * begin] + 3 * (end - begin),
              static_cast<std::uint32_t>(3 * begin));
    FlatNormalKernels::of().make(facets + begin * facet_bytes + corners_at, facet_bytes, end - begin,
                                 &mesh.normal[3 * begin].x);
    if (color.is_own(any)) is_colored = true;
    if (any != 0) has_attributes = true;
  });
  budget.check_time();
  if (!is_colored) return mesh;
  budget.take(count * 3 * sizeof(float4));
  make_large(mesh.color, mesh.position.size());
  // Attributes that are all 0 are left out, not black.
  parallel_ranges(count, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const std::uint32_t attribute = read_u16(facets + f * facet_bytes + attribute_at);
      std::fill_n(&mesh.color[3 * f], 3, has_attributes ? color(attribute) : color.of_all());
    }
  });
  return mesh;
}

void add_mesh(Scene& scene, Mesh mesh, std::string name, ImportBudget& budget) {
  if (const std::uint64_t dropped = drop_not_finite(mesh).dropped)
    scene.warnings.push_back(fmt::format("{}: {} triangles that are not finite are dropped", budget.file(), dropped));
  if (mesh.index.empty()) return;
  mesh.name = name;
  if (!mesh.color.empty()) scene.materials[0].base_color = {1, 1, 1, 1};
  scene.instances.push_back({static_cast<int>(scene.meshes.size()), static_cast<int>(scene.objects.size()), {}});
  scene.objects.push_back(std::move(name));
  scene.meshes.push_back(std::move(mesh));
}

void read_binary(Bytes bytes, const std::string& name, Scene& scene, ImportBudget& budget) {
  if (bytes.size() < header_bytes)
    throw Error(ErrorKind::Input, fmt::format("{}: neither ASCII STL nor binary STL: {} bytes, expected {} at least",
                                              budget.file(), bytes.size(), header_bytes));
  const std::uint64_t said = read_u32(&bytes[80]), held = (bytes.size() - header_bytes) / facet_bytes;
  const bool is_whole = bytes.size() == header_bytes + held * facet_bytes;
  // Where the file is whole facets, its size is more credible than a count that programs left at 0 or at -1.
  const bool is_wrong = said != held && is_whole && held > 0 && (said > held || said == 0);
  const std::uint64_t count = is_wrong ? held : said;
  if (count > held)
    throw Error(ErrorKind::Input,
                fmt::format("{}: not an STL file, or cut off: its header states {} triangles, the file has {}",
                            budget.file(), said, held));
  if (is_wrong)
    budget.warn_of_flaw(
        scene.warnings,
        fmt::format("{}: its header states {} triangles, the file has {}, which are drawn", budget.file(), said, held));
  else if (bytes.size() > header_bytes + said * facet_bytes)
    scene.warnings.push_back(fmt::format("{}: {} bytes after the last triangle are ignored", budget.file(),
                                         bytes.size() - header_bytes - said * facet_bytes));
  if (count > 0xffffffffu / 3) throw Error(ErrorKind::Input, budget.file() + ": more than 2^32 corners");
  add_mesh(scene, read_facets(bytes, count, budget), name, budget);
  center_far_scene(scene);
}

/// Converts the loops [begin, end) to triangles.
Mesh make_mesh(const StlText& text, std::uint64_t begin, std::uint64_t end, const ImportBudget& budget,
               std::uint64_t& too_short) {
  constexpr std::size_t many_corners = 64;  // triangulating a loop of more corners may take long
  constexpr std::uint64_t loops_per_check = 4096;
  Mesh mesh;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint64_t l = begin; l < end; ++l) {
    const std::span<const float3> loop(&text.vertices[text.loops[l]], text.loops[l + 1] - text.loops[l]);
    if ((loop.size() > many_corners || l % loops_per_check == 0) && !budget.has_time()) break;
    triangles.clear();
    if (loop.size() == 3 || !std::all_of(loop.begin(), loop.end(), is_finite))
      triangles.push_back({0, 1, 2});  // non-finite triangles are dropped later
    else
      triangulate(loop, triangles);
    if (loop.size() < 3) triangles.clear(), ++too_short;
    for (const auto& [a, b, c] : triangles) {
      const float3 normal = flat_normal(loop[a], loop[b], loop[c]);
      for (const std::uint32_t i : {a, b, c}) {
        mesh.index.push_back(static_cast<std::uint32_t>(mesh.position.size()));
        mesh.position.push_back(loop[i]);
        mesh.normal.push_back(normal);
      }
    }
  }
  return mesh;
}

/// Parses the text, and again where its vertices are far from the origin, so that they lose nothing as floats.
StlText parse(std::string_view text, Scene& scene, ImportBudget& budget) {
  const std::uint64_t before = budget.memory_left();
  StlText out = parse_stl_text(text, budget);
  OriginChoice choice;
  choice.add(out.vertices);
  scene.origin = choice.origin();
  if (scene.origin == double3{}) return out;
  out = {};
  budget.give_back(before - budget.memory_left());
  return parse_stl_text(text, budget, scene.origin);
}

void read_text(Bytes bytes, const std::string& name, Scene& scene, ImportBudget& budget) {
  StlText text = parse({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, scene, budget);
  if (text.vertices.size() > 0xffffffffu / 3) throw Error(ErrorKind::Input, budget.file() + ": more than 2^32 corners");
  budget.take(3 * text.vertices.size() * (2 * sizeof(float3) + sizeof(std::uint32_t)));
  if (text.solids.empty() || text.solids[0].before > 0) text.solids.insert(text.solids.begin(), {0, ""});

  std::vector<Mesh> meshes(text.solids.size());
  std::vector<std::uint64_t> too_short(meshes.size());
  parallel_for(meshes.size(), [&](std::size_t i) {
    const std::uint64_t end = i + 1 < meshes.size() ? text.solids[i + 1].before : text.loops.size() - 1;
    meshes[i] = make_mesh(text, text.solids[i].before, end, budget, too_short[i]);
  });
  budget.check_time();
  if (const std::uint64_t n = std::accumulate(too_short.begin(), too_short.end(), std::uint64_t{0}))
    scene.warnings.push_back(fmt::format("{}: {} loops have fewer than 3 vertices and are dropped", budget.file(), n));
  for (std::size_t i = 0; i < meshes.size(); ++i)
    add_mesh(scene, std::move(meshes[i]), text.solids[i].name.empty() ? name : text.solids[i].name, budget);
}

}  // namespace

Scene load_stl(const std::string& path, const LoadLimits& limits) {
  const bool is_stream = path == "-";
  const FileBytes file(path, limits.memory);
  ImportBudget budget(is_stream ? "standard input" : path, limits);
  const std::string name = is_stream ? "object" : std::filesystem::path(path).stem().string();

  Scene scene;
  scene.up = {0, 0, 1};
  scene.materials = {plain_material("default")};
  if (is_text(file.bytes()))
    read_text(file.bytes(), name, scene, budget);
  else
    read_binary(file.bytes(), name, scene, budget);
  if (scene.meshes.empty()) throw budget.nothing_to_draw(scene.warnings, "holds no triangles");
  return scene;
}

}  // namespace zoneplate
