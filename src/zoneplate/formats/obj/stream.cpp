// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/stream.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/text_scan.h"
#include "zoneplate/formats/obj/libraries.h"
#include "zoneplate/formats/obj/mesh.h"
#include "zoneplate/formats/obj/normals.h"
#include "zoneplate/formats/obj/part_cache.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/geometry/triangulate.h"
#include "zoneplate/scene/geometry/winding.h"
#include "zoneplate/scene/material_layers.h"

namespace zoneplate {
namespace {

/// In memory: the position of the file and of a mesh, a normal, the interleaved vertex and the screen vertex of the
/// renderer; a triangle's corners in the file, and indices.
constexpr std::uint64_t vertex_bytes = 12 + 12 + 12 + 32 + 16, triangle_bytes = 12 + 12;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float3 nowhere{nan, nan, nan};

/// What a part of the file has before one of its elements.
struct Mark {
  std::uint32_t element = 0, triangles = 0, uvs = 0;
};

/// What is kept of a part.
struct Summary {
  std::vector<Mark> marks;  ///< at the states of the part, and at its end
  bool has_others = false;  ///< lines or points
  bool lacks_normals = false;
  bool has_colors = false, has_odd_normal = false;

  Mark at(std::uint32_t element) const { return *std::ranges::lower_bound(marks, element, {}, &Mark::element); }
};

/// Replaces what the layout of a file does not need.
Summary reduce(ObjPart& part) {
  Summary out;
  ObjChunk& chunk = part.chunk;
  Mark mark;
  std::size_t state = 0;
  for (std::uint32_t e = 0; e < chunk.elements.size(); ++e) {
    mark.element = e;
    for (; state < chunk.states.size() && chunk.states[state].before == e; ++state)
      if (out.marks.empty() || out.marks.back().element < e) out.marks.push_back(mark);
    const ObjElement element = chunk.elements[e];
    if (element.kind != ObjKind::Face) {
      out.has_others = true;
      continue;
    }
    mark.triangles += element.count - 2;
    for (std::uint32_t i = 0; i < element.count; ++i) {
      const ObjCorner corner = chunk.corners[element.first + i];
      out.lacks_normals = out.lacks_normals || corner.normal < 0;
      if (corner.uv >= 0) ++mark.uvs;
    }
  }
  mark.element = static_cast<std::uint32_t>(chunk.elements.size());
  out.marks.push_back(mark);
  if (out.marks.front().element != 0) out.marks.insert(out.marks.begin(), Mark{});
  out.has_colors = !part.vertices.colors.empty(), out.has_odd_normal = part.vertices.has_odd_normal;
  chunk.corners = {}, chunk.elements = ObjElements(chunk.elements.size());  // of which the number alone counts
  part.vertices = {};
  return out;
}

/// Faces of one object and material that follow each other in the file.
struct Run {
  std::size_t first = 0;                        ///< the number of its first triangle
  std::uint32_t chunk = 0, begin = 0, end = 0;  ///< elements of a part
  std::size_t instance = 0;
};

/// A face with some of the triangles that are read.
struct Face {
  std::size_t first;  ///< the number of its first triangle
  std::uint32_t chunk, element, first_corner;
};

/// The different positions of some corners, by number.
class Places {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  explicit Places(std::span<const float3> positions)
      : bits_(std::bit_ceil(std::max<std::size_t>(positions.size(), 64)) / 4), places_(positions.size()) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      places_[i] = key_of(positions[i]);
      bounds_.add(positions[i]);
      const std::size_t at = bit_of(places_[i]);
      bits_[at / 64] |= std::uint64_t{1} << at % 64;
    }
    std::ranges::sort(places_);
    places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
  }
  const Box& bounds() const { return bounds_; }
  /// False for most other points.
  bool may_have(float3 p) const {
    const std::size_t at = bit_of(key_of(p));
    return bits_[at / 64] >> at % 64 & 1;
  }
  std::uint32_t find(float3 p) const {
    const auto found = std::lower_bound(places_.begin(), places_.end(), key_of(p));
    return found != places_.end() && *found == key_of(p) ? static_cast<std::uint32_t>(found - places_.begin()) : none;
  }

 private:
  using Key = std::array<std::uint32_t, 3>;
  static Key key_of(float3 p) {
    const auto word = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.0f); };  // -0 becomes 0
    return {word(p.x), word(p.y), word(p.z)};
  }
  std::size_t bit_of(const Key& key) const { return hash(key[0], key[1], key[2]) & (64 * bits_.size() - 1); }

  std::vector<std::uint64_t> bits_;
  std::vector<Key> places_;
  Box bounds_;
};

/// The share of a corner of the file.
struct PlacedShare {
  std::uint32_t place, chunk, corner;
  ObjNormalShare share;

  struct Key {
    std::uint32_t place, chunk, corner;
    auto operator<=>(const Key&) const = default;
  };
  Key key() const { return {place, chunk, corner}; }
};

bool overlap(const Box& a, const Box& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

/// Copies faces into a file of their own, each corner with its own vertex data.
class FaceCopies {
 public:
  ObjFile file;

  explicit FaceCopies(const ObjPartCache& parts) : vertices_(parts) { file.chunks.resize(1); }

  void add(const ObjPart& part, const ObjElement& element, bool has_colors) {
    ObjChunk& chunk = file.chunks.front();
    const auto first = static_cast<std::uint32_t>(chunk.corners.size());
    for (std::uint32_t i = 0; i < element.count; ++i) {
      const ObjCorner corner = part.chunk.corners[element.first + i];
      ObjCorner own{static_cast<std::int32_t>(file.positions.size()), -1, -1};
      file.positions.push_back(vertices_.position(corner.position));
      if (has_colors) file.colors.push_back(vertices_.color(corner.position));
      if (corner.uv >= 0) own.uv = push(vertices_.uv(corner.uv), file.uvs);
      if (corner.normal >= 0) own.normal = push(vertices_.normal(corner.normal), file.normals);
      chunk.corners.push_back(own);
    }
    chunk.elements.push_back({first, element.count, ObjKind::Face});
  }

 private:
  template <class V>
  static std::int32_t push(V value, std::vector<V>& values) {
    values.push_back(value);
    return static_cast<std::int32_t>(values.size() - 1);
  }
  ObjVertexReader vertices_;
};

class ObjStream : public FileStream {
 public:
  ObjStream(const std::string& path, const LoadLimits& limits) : FileStream(path, limits) {
    const auto done = [&](std::string_view part) { file().forget(part.data(), part.size()); };
    ObjText text = cut_obj(file().bytes(), path, done);
    ImportBudget import = budget();
    ObjFile skeleton;
    std::vector<ObjCounts> before = read_layout(text, import, skeleton);
    add_meshes(skeleton, import);
    bytes_in_memory_ = bytes_of(before.back());
    parts_.emplace(std::move(text), std::move(before), limits.memory / 8);
    note_flaws();
  }

  std::size_t count() const override { return instances_.empty() ? 0 : instances_.back().end; }
  std::vector<StreamInstance> instances() const override { return instances_; }
  std::uint64_t bytes_in_memory() const override { return bytes_in_memory_; }
  std::uint64_t visible_bytes() const override {
    // Copies of the faces, and twice the shares of the faces around.
    return has_normals_ ? 800 : 2000;
  }
  void check() const override {
    if (!refusal_.empty()) refuse(refusal_);
  }

  void read(std::size_t first, std::size_t count, float3* corners) const override {
    guarded([&] {
      ObjVertexReader vertices(*parts_);
      for_triangles(first, first + count, vertices, [&](const ObjPart& part, const Run&, const std::uint32_t* corner) {
        for (int k = 0; k < 3; ++k)
          *corners++ = corner ? vertices.position(part.chunk.corners[corner[k]].position) : nowhere;
      });
    });
  }

  void examine(std::size_t first, std::size_t count, const float3* corners) override {
    if (parts_->parts().is_scattered()) refuse("has vertices in an order too scattered");
    guarded([&] {
      ObjVertexReader vertices(*parts_);
      std::map<std::size_t, std::int64_t> against;  // by instance
      std::map<std::uint32_t, Box> bounds;          // by part
      const float3* c = corners;
      for_triangles(
          first, first + count, vertices, [&](const ObjPart& part, const Run& run, const std::uint32_t* corner) {
            if (has_normals_ && corner) {
              const auto normal = [&](int k) { return vertices.normal(part.chunk.corners[corner[k]].normal); };
              against[run.instance] += turn_of({c[0], c[1], c[2]}, {normal(0), normal(1), normal(2)});
            }
            for (int k = 0; k < 3 && !has_normals_; ++k) bounds[run.chunk].add(c[k]);
            c += 3;
          });
      const std::lock_guard lock(mutex_);
      for (const auto& own : against) against_[own.first] += own.second;
      for (const auto& own : bounds) bounds_[own.first].add(own.second);
    });
  }

  void read_ahead(std::size_t, std::size_t) const override {}

  Scene head() const override { return head_; }

  Mesh mesh(std::span<const std::uint32_t> triangles) const override {
    Mesh out;
    guarded([&] { out = mesh_of(triangles); });
    forget();
    return out;
  }

 private:
  /// The parts without what can be read again, and the numbers before each.
  std::vector<ObjCounts> read_layout(const ObjText& text, ImportBudget& import, ObjFile& skeleton) {
    summaries_.resize(text.parts.size());
    std::vector<ObjPart> parts;
    const std::vector<ObjCounts> before = read_obj_parts(
        text, import, [&](std::string_view part) { file().forget(part.data(), part.size()); },
        [&](std::size_t i, ObjPart& part) { summaries_[i] = reduce(part); }, parts);
    for (ObjPart& part : parts) skeleton.chunks.push_back(std::move(part.chunk));
    report_obj_notes(skeleton, import, head_.warnings);
    return before;
  }

  void add_meshes(const ObjFile& skeleton, ImportBudget& import) {
    const std::filesystem::path place(path());
    layout_ = lay_out(skeleton, place.stem().string(), import);
    import.take(layout_.runs.size() * (sizeof(Run) + sizeof(ObjRun)));
    std::map<std::pair<int, int>, std::size_t> numbers;  // by object and material
    std::vector<std::vector<Run>> runs;
    for (const ObjRun& run : layout_.runs) {
      const auto [found, is_new] = numbers.try_emplace({run.object, run.material}, runs.size());
      if (is_new) {
        runs.emplace_back(), has_uvs_.push_back(false);
        Mesh& mesh = head_.meshes.emplace_back();
        mesh.name = layout_.objects[static_cast<std::size_t>(run.object)], mesh.material = run.material;
        head_.instances.push_back({static_cast<int>(numbers.size()) - 1, run.object, float4x4{}});
        import.take(2 * (sizeof(Mesh) + sizeof(Instance) + sizeof(StreamInstance)) + mesh.name.size());
      }
      runs[found->second].push_back({0, run.chunk, run.begin, run.end, found->second});
    }
    std::uint64_t end = 0;
    for (const std::vector<Run>& own : runs) {
      for (Run run : own) {
        const Mark from = summaries_[run.chunk].at(run.begin), to = summaries_[run.chunk].at(run.end);
        if (to.uvs > from.uvs) has_uvs_[run.instance] = true;
        run.first = static_cast<std::size_t>(end);
        end += to.triangles - from.triangles;
        runs_.push_back(run);
      }
      instances_.push_back({static_cast<std::size_t>(end), {}});
    }
    head_.objects = layout_.objects;
    against_.resize(runs.size()), bounds_.resize(summaries_.size());
    ModelFolder folder(place.parent_path().string(), import, head_);
    add_obj_materials(layout_, folder);
  }

  std::uint64_t bytes_of(const ObjCounts& all) const {
    return all.positions * (vertex_bytes + (has_colors() ? 16 : 0)) + all.uvs * 8 + all.normals * 12 +
           count() * triangle_bytes;
  }
  bool has_colors() const { return std::ranges::any_of(summaries_, &Summary::has_colors); }

  void note_flaws() {
    const auto note = [&](const char* what) {
      if (refusal_.empty()) refusal_ = what;
    };
    const bool lacks = std::ranges::any_of(summaries_, &Summary::lacks_normals);
    has_normals_ = parts_->before().back().normals > 0, has_colors_ = has_colors();
    if (std::ranges::any_of(summaries_, &Summary::has_others)) note("has lines or points");
    if (has_normals_ && (lacks || std::ranges::any_of(summaries_, &Summary::has_odd_normal)))
      note("has faces without normals beside normals");
    for (const Material& material : head_.materials) {
      if (material.height_texture.image >= 0) note("has materials with heights");
      if (needs_tangents(material)) note("has materials that need tangents");
    }
    constexpr std::size_t most = 0x7ffffffe;  // of the rasterizer
    if (count() > most) note("has more than 2^31 - 2 triangles");
    summaries_ = {};
  }

  /// Calls `body`, in which a text that is not what it was is an error about the file.
  template <class Body>
  void guarded(const Body& body) const {
    try {
      body();
    } catch (const ObjLineError&) {
      throw_changed();
    }
  }

  std::shared_ptr<const ObjPart> part_of(const Run& run) const {
    std::shared_ptr<const ObjPart> part = parts_->part(run.chunk);
    if (part->chunk.elements.size() < run.end) throw_changed();
    return part;
  }
  const Run* run_of(std::size_t triangle) const {
    const auto begins_after = [](std::size_t t, const Run& run) { return t < run.first; };
    return &*(std::upper_bound(runs_.begin(), runs_.end(), triangle, begins_after) - 1);
  }
  std::size_t end_of(const Run& run) const {
    return &run == &runs_.back() ? count() : runs_[static_cast<std::size_t>(&run - runs_.data()) + 1].first;
  }

  /// Calls visit(part, run, corners) for the triangles [first, last); no corners: they are not finite.
  template <class Visit>
  void for_triangles(std::size_t first, std::size_t last, ObjVertexReader& vertices, const Visit& visit) const {
    std::vector<float3> polygon;
    std::vector<std::array<std::uint32_t, 3>> cut;
    for_faces(first, last, [&](const ObjPart& part, const Run& run, const ObjElement& face, std::size_t t) {
      polygon.clear(), cut.clear();
      if (face.count == 3) {
        cut.push_back({0, 1, 2});
      } else {
        for (std::uint32_t i = 0; i < face.count; ++i)
          polygon.push_back(vertices.position(part.chunk.corners[face.first + i].position));
        if (std::ranges::all_of(polygon, [](float3 p) { return is_finite(p); })) triangulate(polygon, cut);
      }
      for (std::size_t k = 0; k < face.count - 2; ++k) {
        if (t + k < first || t + k >= last) continue;
        if (k >= cut.size()) {
          visit(part, run, nullptr);
          continue;
        }
        const std::uint32_t corner[] = {face.first + cut[k][0], face.first + cut[k][1], face.first + cut[k][2]};
        visit(part, run, corner);
      }
    });
  }

  /// Calls visit(part, run, face, first triangle) for the faces that have the triangles [first, last).
  template <class Visit>
  void for_faces(std::size_t first, std::size_t last, const Visit& visit) const {
    for (const Run* run = run_of(first); run != runs_.data() + runs_.size() && run->first < last; ++run) {
      const auto part = part_of(*run);
      const ObjElements& elements = part->chunk.elements;
      std::size_t t = run->first;
      std::uint32_t e = run->begin;
      if (elements.are_triangles() && first > t) e += static_cast<std::uint32_t>(first - t), t = first;
      for (; e < run->end && t < last; ++e) {
        const ObjElement face = elements[e];
        if (face.count < 3) throw_changed();
        if (t + face.count - 2 > first) visit(*part, *run, face, t);
        t += face.count - 2;
      }
      if (t != end_of(*run) && t < last) throw_changed();
    }
  }

  /// The faces that have some triangles of one instance, which are in the order of the file.
  std::vector<Face> faces_of(std::span<const std::uint32_t> triangles) const {
    std::vector<Face> out;
    for (std::size_t i = 0; i < triangles.size();) {
      const Run& run = *run_of(triangles[i]);
      const auto part = part_of(run);
      const std::size_t end = end_of(run);
      std::size_t t = run.first;
      for (std::uint32_t e = run.begin; e < run.end && i < triangles.size() && triangles[i] < end; ++e) {
        if (part->chunk.elements.are_triangles()) e += static_cast<std::uint32_t>(triangles[i] - t), t = triangles[i];
        if (e >= run.end) throw_changed();
        const ObjElement face = part->chunk.elements[e];
        if (face.count < 3) throw_changed();
        if (triangles[i] < t + face.count - 2) out.push_back({t, run.chunk, e, face.first});
        t += face.count - 2;
        while (i < triangles.size() && triangles[i] < t) ++i;
      }
      if (i < triangles.size() && triangles[i] < end) throw_changed();
    }
    return out;
  }

  Mesh mesh_of(std::span<const std::uint32_t> triangles) const {
    const std::size_t instance = run_of(triangles.front())->instance;
    const std::vector<Face> faces = faces_of(triangles);
    FaceCopies copies(*parts_);
    for (const Face& face : faces) {
      const auto part = parts_->part(face.chunk);
      copies.add(*part, part->chunk.elements[face.element], has_colors_);
    }
    const ObjFile& some = copies.file;
    if (!std::ranges::all_of(some.positions, [](float3 p) { return is_finite(p); })) throw_changed();
    ObjLayout layout;
    layout.objects.emplace_back(), layout.materials.emplace_back();
    layout.runs = {{0, 0, static_cast<std::uint32_t>(faces.size()), 0, 0, 0}};
    ImportBudget limits = budget();
    std::vector<std::vector<float3>> normals(1);
    if (!has_normals_) normals.front() = made_normals(faces, some);
    ObjMeshes made = make_meshes(some, layout, normals, limits);
    if (made.meshes.empty()) throw_changed();
    Mesh& whole = made.meshes.front().mesh;

    // Of each polygon the triangles that are wanted.
    std::vector<std::uint32_t> index;
    std::size_t i = 0, of_face = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const std::size_t count = some.chunks.front().elements[f].count - 2;
      for (; i < triangles.size() && triangles[i] < faces[f].first + count; ++i)
        for (std::size_t k = 0; k < 3; ++k)
          index.push_back(whole.index.at(3 * (of_face + triangles[i] - faces[f].first) + k));
      of_face += count;
    }
    if (index.size() != 3 * triangles.size()) throw_changed();
    whole.index = std::move(index);
    if (has_uvs_[instance] && whole.uv0.empty()) whole.uv0.resize(whole.position.size());
    if (against_[instance] > 0) reverse(whole);
    return std::move(whole);
  }

  /// The normals of the corners of faces, in a file that has no normals: they depend on all faces at the same places.
  std::vector<float3> made_normals(const std::vector<Face>& faces, const ObjFile& some) const {
    const Places places(some.positions);
    std::vector<std::vector<ObjRun>> runs(parts_->size());
    for (const ObjRun& run : layout_.runs) runs[run.chunk].push_back(run);
    std::vector<std::vector<PlacedShare>> found(parts_->size());
    parallel_for(parts_->size(), [&](std::size_t c) {
      if (runs[c].empty() || !overlap(bounds_[c], places.bounds())) return;
      guarded([&] { found[c] = shares_at(places, c, runs[c]); });
      file().forget(parts_->text(c).data(), parts_->text(c).size());
    });
    std::size_t count = 0;
    for (const std::vector<PlacedShare>& own : found) count += own.size();
    std::vector<PlacedShare> all;
    all.reserve(count);
    for (std::vector<PlacedShare>& own : found) {
      all.insert(all.end(), own.begin(), own.end());
      own = {};
    }
    std::ranges::sort(all, {}, &PlacedShare::key);

    // In the order of the places, so that a crowd is summed once.
    struct Corner {
      PlacedShare::Key key;
      std::size_t number;
    };
    std::vector<Corner> corners;
    for (std::size_t f = 0, i = 0; f < faces.size(); ++f)
      for (std::uint32_t k = 0; k < some.chunks.front().elements[f].count; ++k, ++i)
        corners.push_back({{places.find(some.positions[i]), faces[f].chunk, faces[f].first_corner + k}, i});
    std::ranges::sort(corners, {}, &Corner::key);
    std::vector<float3> out(corners.size());
    std::vector<ObjNormalShare> at_place;
    ObjCrowd crowd;
    auto begin = all.begin(), end = begin;
    for (const Corner& corner : corners) {
      if (begin == end || begin->key().place != corner.key.place) {
        begin = std::find_if(end, all.end(), [&](const PlacedShare& s) { return s.place == corner.key.place; });
        end = std::find_if(begin, all.end(), [&](const PlacedShare& s) { return s.place != corner.key.place; });
        at_place.clear();
        for (auto share = begin; share != end; ++share) at_place.push_back(share->share);
        crowd = sum_crowd(at_place);
      }
      const auto own = std::ranges::lower_bound(begin, end, corner.key, {}, &PlacedShare::key);
      if (own == end || own->key() != corner.key) throw_changed();
      out[corner.number] = smooth_normal(at_place, static_cast<std::size_t>(own - begin), crowd);
    }
    return out;
  }

  /// The shares of a part's faces at some places.
  std::vector<PlacedShare> shares_at(const Places& places, std::size_t c, const std::vector<ObjRun>& runs) const {
    std::vector<PlacedShare> out;
    const auto part = parts_->part(c);
    ObjVertexReader vertices(*parts_);
    if (part->chunk.elements.size() < runs.back().end) throw_changed();
    std::vector<float3> polygon;
    std::vector<ObjNormalShare> shares;
    for (const ObjRun& run : runs)
      for (std::uint32_t e = run.begin; e < run.end; ++e) {
        const ObjElement face = part->chunk.elements[e];
        polygon.clear(), shares.clear();
        for (std::uint32_t k = 0; k < face.count; ++k)
          polygon.push_back(vertices.position(part->chunk.corners[face.first + k].position));
        for (std::uint32_t k = 0; k < face.count; ++k) {
          if (!places.may_have(polygon[k])) continue;
          const std::uint32_t place = places.find(polygon[k]);
          if (place == Places::none) continue;
          if (shares.empty()) shares.resize(face.count), make_shares(polygon, run.smoothing, shares);
          out.push_back({place, static_cast<std::uint32_t>(c), face.first + k, shares[k]});
        }
      }
    return out;
  }

  Scene head_;
  ObjLayout layout_;
  std::vector<Summary> summaries_;  ///< by part, until the file is open
  std::vector<Run> runs_;           ///< by instance, then in the order of the file
  std::vector<StreamInstance> instances_;
  std::vector<bool> has_uvs_;  ///< by instance
  bool has_normals_ = false, has_colors_ = false;
  std::uint64_t bytes_in_memory_ = 0;
  std::optional<ObjPartCache> parts_;
  std::string refusal_;

  std::mutex mutex_;                   ///< of those that follow
  std::vector<std::int64_t> against_;  ///< by instance: how many more triangles face away from their normals than not
  std::vector<Box> bounds_;            ///< by part: of its faces
};

}  // namespace

bool obj_may_exceed_memory(const std::string& path, const LoadLimits& limits) {
  constexpr std::size_t samples = 16, sample_bytes = 1 << 16;
  const FileBytes file = FileBytes::reclaimable(path);
  const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
  std::uint64_t read = 0, vertices = 0, triangles = 0;
  for (std::size_t i = 0; i < samples; ++i) {
    const std::string_view some = text.substr(text.size() / samples * i, sample_bytes);
    read += some.size();
    for (TextLines lines(some, 0); lines.next();) {
      LineWords words(lines.line());
      const std::string_view word = words.next();
      if (word == "v") ++vertices;
      int corners = 0;
      while (word == "f" && !words.next().empty()) ++corners;
      triangles += corners > 2 ? static_cast<std::uint64_t>(corners - 2) : 0;
    }
  }
  const std::uint64_t of_samples = vertices * vertex_bytes + triangles * (triangle_bytes + FileStream::max_in_bins);
  return 2 * static_cast<double>(of_samples) * static_cast<double>(text.size()) >
         static_cast<double>(limits.memory) * static_cast<double>(std::max<std::uint64_t>(read, 1));
}

std::unique_ptr<FileStream> open_obj_stream(const std::string& path, const LoadLimits& limits) {
  auto stream = std::make_unique<ObjStream>(path, limits);
  if (stream->count() == 0) return nullptr;
  return stream;
}

}  // namespace zoneplate
