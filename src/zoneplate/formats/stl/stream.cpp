// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/stl/stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <optional>
#include <utility>

#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/import/part_cache.h"
#include "zoneplate/formats/stl/facets.h"
#include "zoneplate/formats/stl/text.h"
#include "zoneplate/scene/geometry/flat_normals.h"

namespace zoneplate {
namespace {

/// In memory: positions, normals and indices of a triangle, then the interleaved vertices and the screen vertices of
/// the renderer.
constexpr std::uint64_t mesh_bytes = 3 * (12 + 12 + 4), drawn_bytes = 3 * (32 + 16);

class StlStream : public FileStream {
 public:
  StlStream(const std::string& path, const LoadLimits& limits) : FileStream(path, limits) {
    head_.up = {0, 0, 1};
    head_.materials = {plain_material("default")};
    head_.objects.push_back(std::filesystem::path(path).stem().string());
    head_.instances.push_back({});
    head_.meshes.emplace_back();
    facets_ = find_stl_facets(file().bytes(), head_, budget());
  }

  std::size_t count() const override { return facets_.count; }

  std::uint64_t bytes_in_memory() const override { return facets_.count * (mesh_bytes + drawn_bytes); }

  void read(std::size_t first, std::size_t count, float3* corners) const override {
    for (std::size_t f = first; f < first + count; ++f, corners += 3)
      std::memcpy(corners, facets_.facet(f) + StlFacets::corners_at, 3 * sizeof(float3));
  }

  void examine(std::size_t first, std::size_t count, const float3*) override {
    attributes_ |= facets_.attributes(first, first + count);
  }

  void read_ahead(std::size_t first, std::size_t count) const override {
    file().read_ahead(facets_.facet(first), count * StlFacets::facet_bytes);
  }

  Scene head() const override {
    Scene scene = head_;
    if (facets_.are_colored(attributes_)) scene.materials[0].base_color = {1, 1, 1, 1};
    return scene;
  }

  Mesh mesh(std::span<const std::uint32_t> triangles) const override {
    std::vector<std::uint8_t> some(triangles.size() * StlFacets::facet_bytes);
    in_steps(triangles.size(), [&](std::size_t i) {
      std::memcpy(&some[i * StlFacets::facet_bytes], facets_.facet(triangles[i]), StlFacets::facet_bytes);
    });
    ImportBudget limits = budget();
    return read_stl_facets({facets_.header, some.data(), triangles.size()}, limits, attributes_.load());
  }

 private:
  Scene head_;
  StlFacets facets_;
  std::atomic<std::uint32_t> attributes_ = 0;  ///< the bits that any facet has
};

/// The triangles of one part of a text.
struct StlCorners {
  std::vector<float3> corners;  ///< three for each triangle

  std::uint64_t bytes() const { return corners.size() * sizeof(float3); }
};

/// An ASCII file, whose parts are parsed again whenever they are read.
class StlTextStream : public FileStream {
 public:
  StlTextStream(const std::string& path, const LoadLimits& limits)
      : FileStream(path, limits),
        text_(reinterpret_cast<const char*>(file().bytes().data()), file().bytes().size()),
        cuts_(cut_stl_text(text_, [this](std::string_view part) { file().forget(part.data(), part.size()); })),
        parts_(cuts_.size(), limits.memory / 8, [this](std::size_t i) { return corners_of(i); }) {
    head_.up = {0, 0, 1};
    head_.materials = {plain_material("default")};
    lay_out(std::filesystem::path(path).stem().string());
  }

  std::size_t count() const override { return first_.back(); }
  std::vector<StreamInstance> instances() const override { return instances_; }
  std::uint64_t bytes_in_memory() const override {
    // What parse_stl_text takes for the text, its vertices and its loops, and load_stl for the mesh.
    const std::uint64_t loaded = text_.size() / 9 * sizeof(float3) + vertices_ * (12 + mesh_bytes) + 8 * loops_;
    return std::max<std::uint64_t>(loaded, count() * (mesh_bytes + drawn_bytes));
  }

  void read(std::size_t first, std::size_t count, float3* corners) const override {
    for_parts(first, first + count, [&](const StlCorners& part, std::size_t begin, std::size_t end) {
      corners = std::copy(&part.corners[3 * begin], &part.corners[3 * begin] + 3 * (end - begin), corners);
    });
  }
  void examine(std::size_t, std::size_t, const float3*) override {}
  void read_ahead(std::size_t, std::size_t) const override {}
  Scene head() const override { return head_; }

  Mesh mesh(std::span<const std::uint32_t> triangles) const override {
    Mesh out;
    out.position.resize(3 * triangles.size()), out.normal.resize(3 * triangles.size());
    out.index.resize(3 * triangles.size());
    std::iota(out.index.begin(), out.index.end(), 0u);
    in_steps(triangles.size(), [&](std::size_t i) {
      float3* const p = &out.position[3 * i];
      read(triangles[i], 1, p);
      std::fill_n(&out.normal[3 * i], 3, flat_normal(p[0], p[1], p[2]));
    });
    return out;
  }

 private:
  /// What is known of a part.
  struct Summary {
    struct Solid : StlText::Solid {
      std::size_t triangles = 0;  ///< of the part before it
    };
    std::uint64_t loops = 0, vertices = 0, too_short = 0;
    std::size_t triangles = 0;
    std::vector<Solid> solids;
  };

  Summary summarize(std::size_t part, const ImportBudget& import) const {
    StlText text = parse_stl_part(text_, cuts_[part], path());
    Summary out{.loops = text.loops.size() - 1, .vertices = text.vertices.size()};
    std::vector<float3> corners;
    std::uint64_t done = 0;
    const auto add_until = [&](std::uint64_t loop) {
      out.too_short += add_stl_triangles(text, std::exchange(done, loop), loop, import, corners);
    };
    for (StlText::Solid& solid : text.solids) {
      add_until(solid.before);
      out.solids.push_back({std::move(solid), corners.size() / 3});
    }
    add_until(out.loops);
    out.triangles = corners.size() / 3;
    return out;
  }

  /// Reads the whole text once: what is kept of it are solids, and numbers of triangles.
  void lay_out(const std::string& name) {
    ImportBudget import = budget();
    constexpr std::size_t solid_bytes =
        sizeof(Summary::Solid) + sizeof(Mesh) + sizeof(Instance) + sizeof(StreamInstance) + std::size_t{3} * 200;
    std::vector<Summary> summaries(cuts_.size());
    constexpr std::size_t step = 64;  // parts after which the system may reclaim them
    for (std::size_t first = 0; first < cuts_.size(); first += step) {
      parallel_for(std::min(step, cuts_.size() - first),
                   [&](std::size_t i) { summaries[first + i] = summarize(first + i, import); });
      import.check_time();
      for (std::size_t i = first; i < std::min(first + step, cuts_.size()); ++i)
        import.take(summaries[i].solids.size() * solid_bytes);
      forget();
    }
    add_solids(summaries, name);
    std::uint64_t too_short = 0;
    for (const Summary& part : summaries) too_short += part.too_short;
    if (too_short > 0)
      head_.warnings.push_back(
          fmt::format("{}: {} loops have fewer than 3 vertices and are dropped", path(), too_short));
  }

  void add_solids(std::span<Summary> parts, const std::string& name) {
    std::vector<StlText::Solid> solids;  // `before`: loops of the text
    std::vector<std::size_t> begins;     // of each, in triangles
    first_ = {0};
    for (Summary& part : parts) {
      for (Summary::Solid& solid : part.solids) {
        const std::size_t begin = first_.back() + solid.triangles;
        add_solid(solids, {loops_ + solid.before, std::move(solid.name)});
        begins.resize(solids.size()), begins.back() = begin;
      }
      first_.push_back(first_.back() + part.triangles);
      loops_ += part.loops, vertices_ += part.vertices;
    }
    if (solids.empty() || solids[0].before > 0) {
      solids.insert(solids.begin(), {0, ""});
      begins.insert(begins.begin(), 0);
    }
    for (std::size_t i = 0; i < solids.size(); ++i) {
      const std::size_t end = i + 1 < solids.size() ? begins[i + 1] : count();
      if (end == begins[i]) continue;
      const int number = static_cast<int>(head_.meshes.size());
      const std::string& own = head_.meshes.emplace_back().name = solids[i].name.empty() ? name : solids[i].name;
      head_.objects.push_back(own);
      head_.instances.push_back({number, number, {}});
      instances_.push_back({end, {}});
    }
  }

  StlCorners corners_of(std::size_t part) const {
    const StlText text = parse_stl_part(text_, cuts_[part], path());
    StlCorners out;
    out.corners.reserve(text.vertices.size());
    add_stl_triangles(text, 0, text.loops.size() - 1, budget(), out.corners);
    if (out.corners.size() != 3 * (first_[part + 1] - first_[part])) throw_changed();
    file().forget(cuts_[part].data(), cuts_[part].size());
    return out;
  }

  /// Calls visit(part, begin, end) for the triangles [first, last): those of a part are [begin, end) of its own.
  template <class Visit>
  void for_parts(std::size_t first, std::size_t last, const Visit& visit) const {
    auto part = static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), first) - first_.begin()) - 1;
    for (; first < last; ++part) {
      const std::size_t end = std::min(last, first_[part + 1]);
      if (first < end) visit(*parts_.part(part), first - first_[part], end - first_[part]);
      first = std::max(first, end);
    }
  }

  Scene head_;
  std::string_view text_;
  std::vector<std::string_view> cuts_;
  std::uint64_t loops_ = 0, vertices_ = 0;  ///< of the text
  std::vector<std::size_t> first_;          ///< the triangles before each part, and all
  std::vector<StreamInstance> instances_;   ///< the solids that have triangles
  PartCache<StlCorners> parts_;
};

}  // namespace

bool stl_may_exceed_memory(const std::string& path, const LoadLimits& limits) {
  constexpr std::uint64_t most = 8;  // a facet of few digits has some 100 characters
  const FileBytes file = FileBytes::reclaimable(path);
  return !is_stl_text(file.bytes()) || file.bytes().size() > limits.memory / most;
}

std::unique_ptr<FileStream> open_stl_stream(const std::string& path, const LoadLimits& limits) {
  if (!is_stl_text(FileBytes::reclaimable(path).bytes())) return std::make_unique<StlStream>(path, limits);
  auto stream = std::make_unique<StlTextStream>(path, limits);
  if (stream->count() == 0) return nullptr;
  return stream;
}

}  // namespace zoneplate
