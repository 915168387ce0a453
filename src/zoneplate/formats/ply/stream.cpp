// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/ply/stream.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/ply/mesh.h"
#include "zoneplate/formats/ply/text_rows.h"
#include "zoneplate/scene/geometry/smooth_normals.h"
#include "zoneplate/scene/geometry/winding.h"
#include "zoneplate/scene/sanitize.h"

namespace zoneplate {
namespace {

constexpr std::size_t grain = 1 << 14;  ///< faces or vertices that a thread processes at a time

/// A set of numbers below a limit, which knows how many smaller ones each has.
class RankedSet {
 public:
  explicit RankedSet(std::size_t limit) : bits_((limit + 63) / 64) {}

  /// Several threads may insert.
  void insert(std::size_t i) {
    std::atomic_ref(bits_[i / 64]).fetch_or(std::uint64_t{1} << i % 64, std::memory_order_relaxed);
  }
  bool has(std::size_t i) const { return bits_[i / 64] >> i % 64 & 1; }
  /// The numbers in ascending order; `rank` and `has_any` are valid from here on.
  std::vector<std::uint32_t> ascending() {
    std::vector<std::uint32_t> all;
    before_.clear();
    for (std::size_t word = 0; word < bits_.size(); ++word) {
      before_.push_back(static_cast<std::uint32_t>(all.size()));
      for (std::uint64_t left = bits_[word]; left; left &= left - 1)
        all.push_back(static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(left)));
    }
    return all;
  }
  /// Whether it has a number from `low` to `high`.
  bool has_any(std::size_t low, std::size_t high) const { return rank(high) + (has(high) ? 1 : 0) > rank(low); }
  /// How many smaller numbers it has.
  std::uint32_t rank(std::size_t i) const {
    return before_[i / 64] +
           static_cast<std::uint32_t>(std::popcount(bits_[i / 64] & ((std::uint64_t{1} << i % 64) - 1)));
  }

 private:
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint32_t> before_;  ///< by word
};

/// The least and the greatest vertex of some faces.
struct VertexReach {
  std::atomic<std::uint32_t> low = 0xffffffffu, high = 0;

  /// Several threads may call it.
  void add(std::uint32_t least, std::uint32_t greatest) {
    for (std::uint32_t l = low; least < l && !low.compare_exchange_weak(l, least);) continue;
    for (std::uint32_t h = high; greatest > h && !high.compare_exchange_weak(h, greatest);) continue;
  }
};

/// The elements of a file that holds vertices of one size and faces that are triangles, as its header and the first
/// face say. Rows of ASCII have no data; a row has a double for each value.
struct PlainElements {
  PlyRows vertices, faces;
  std::size_t index_at = 0;  ///< of the first index, in a face's row
  std::size_t count_at = 0;  ///< of the number of indices
  PlyType count_type = PlyType::Uint8;
};

std::uint64_t row_size(const PlyElement& element, std::uint64_t items) {
  std::uint64_t size = 0;
  for (const PlyProperty& p : element.properties)
    size += p.is_list ? size_of(p.count_type) + items * size_of(p.type) : size_of(p.type);
  return size;
}

std::size_t lists_of(const PlyElement& element) {
  return static_cast<std::size_t>(std::ranges::count(element.properties, true, &PlyProperty::is_list));
}

/// Takes rows of one size from the front of the body; nothing if they are not within it.
std::optional<PlyRows> take_rows(const PlyElement& element, PlyOrder order, std::uint64_t stride,
                                 std::span<const std::uint8_t>& body) {
  if (element.count == 0 || stride == 0 || stride > body.size() / element.count) return std::nullopt;
  const PlyRows rows{.element = &element,
                     .order = order,
                     .data = body.data(),
                     .size = element.count * stride,
                     .stride = stride,
                     .starts = {}};
  body = body.subspan(static_cast<std::size_t>(rows.size));
  return rows;
}

bool are_vertices_and_faces(const PlyHeader& header) {
  if (header.elements.size() < 2) return false;
  const PlyElement &vertex = header.elements[0], &face = header.elements[1];
  return vertex.name == "vertex" && face.name == "face" && lists_of(vertex) == 0 && lists_of(face) == 1 &&
         vertex.count < 0xffffffffu && face.count <= 0x7ffffffeu && find_columns(vertex).position && find_indices(face);
}

std::optional<PlainElements> find_plain(const PlyHeader& header, std::span<const std::uint8_t> body) {
  if (!are_vertices_and_faces(header)) return std::nullopt;
  const PlyElement &vertex = header.elements[0], &face = header.elements[1];
  const auto vertices = take_rows(vertex, header.order, row_size(vertex, 0), body);
  if (!vertices) return std::nullopt;
  const auto faces = take_rows(face, header.order, row_size(face, 3), body);
  if (!faces || !are_plain_triangles(*faces)) return std::nullopt;
  const std::size_t list = *find_indices(face);
  const auto index_at = static_cast<std::size_t>(first_ply_row(*faces)[list].at - faces->data);
  const PlyType count_type = face.properties[list].count_type;
  return PlainElements{*vertices, *faces, index_at, index_at - size_of(count_type), count_type};
}

/// The same of ASCII, whose types are those of parse_ply_text.
std::optional<PlainElements> find_plain_text(const PlyHeader& header) {
  if (!are_vertices_and_faces(header) || header.elements.size() > 2 || header.textures.size() > 1) return std::nullopt;
  const PlyElement &vertex = header.elements[0], &face = header.elements[1];
  for (const PlyProperty& p : face.properties)
    if (p.name == "red") return std::nullopt;
  const auto rows_of = [](const PlyElement& element, std::uint64_t items) {
    PlyRows rows{.element = &element, .order = PlyOrder::Ascii};
    rows.stride = row_size(element, items), rows.size = element.count * rows.stride;
    return rows;
  };
  const std::size_t count_at = *find_indices(face) * sizeof(double);
  return PlainElements{rows_of(vertex, 0), rows_of(face, 3), count_at + sizeof(double), count_at, PlyType::Double};
}

/// Reads single rows of plain elements, for one thread.
class RowReader {
 public:
  RowReader(const PlainElements& rows, const PlyTextRows* text) : rows_(rows) {
    if (text) text_.emplace(*text);
  }
  const std::uint8_t* vertex(std::size_t v) {
    return text_ ? reinterpret_cast<const std::uint8_t*>(text_->row(0, v))
                 : rows_.vertices.data + v * rows_.vertices.stride;
  }
  const std::uint8_t* face(std::size_t f) {
    return text_ ? reinterpret_cast<const std::uint8_t*>(text_->row(1, f)) : rows_.faces.data + f * rows_.faces.stride;
  }

 private:
  const PlainElements& rows_;
  std::optional<PlyTextRows::Reader> text_;
};

class PlyStream : public FileStream {
 public:
  PlyStream(const std::string& path, const LoadLimits& limits)
      : FileStream(path, limits), header_(parse_ply_header(file().bytes(), path)) {
    const std::optional<PlainElements> found = header_.order == PlyOrder::Ascii ? find_text(limits) : find_binary();
    if (!found) return;
    is_plain_ = true, rows_ = *found;
    has_ = find_columns(*rows_.vertices.element);
    reach_ = std::vector<VertexReach>((rows_.faces.count() + grain - 1) / grain);
    for (const std::string& warning : header_.warnings) budget().warn_of_flaw(head_.warnings, warning);
    head_.objects.push_back(std::filesystem::path(path).stem().string());
    head_.instances.push_back({});
    head_.meshes.emplace_back();
    head_.materials = {plain_material("default")};
    if (has_.color) head_.materials[0].base_color = {1, 1, 1, 1};
  }

  bool is_plain() const { return is_plain_; }
  std::size_t count() const override { return rows_.faces.count(); }

  std::uint64_t bytes_in_memory() const override {
    // The attributes of vertices and the indices, and what load_ply reserves for smooth normals; then the interleaved
    // vertices and the screen vertices of the renderer.
    const std::uint64_t vertex = 12 + (has_.normal ? 12 : 0) + (has_.color ? 16 : 0) + (has_.uv ? 8 : 0);
    const std::uint64_t smooth = has_.normal ? 0 : rows_.vertices.count() * 28 + rows_.faces.count() * 3 * 68;
    const std::uint64_t drawn = rows_.vertices.count() * (12 + 32 + 16);
    // parse_ply_text keeps the numbers, and takes as much for its parts.
    const std::uint64_t numbers = text_ ? 2 * (rows_.vertices.size + rows_.faces.size) : 0;
    return numbers + rows_.vertices.count() * vertex + rows_.faces.count() * 12 + std::max(smooth, drawn);
  }

  void check() const override {
    const PlyElement& e = *rows_.vertices.element;
    if (!header_.textures.empty() && has_.uv) refuse("has textures");
    if (are_splats(e)) refuse("has Gaussian splats");
    if (!has_.color) return;
    const auto is_byte = [&](std::size_t p) { return e.properties[p].stated == PlyType::Uint8; };
    if (!std::ranges::all_of(*has_.color, is_byte) || (has_.alpha && !is_byte(*has_.alpha)))
      refuse("has colours that are not bytes");
    if (!has_.alpha) return;
    std::atomic<bool> are_opaque = true;
    parallel_ranges(rows_.vertices.count(), grain, [&](std::size_t begin, std::size_t end) {
      RowReader rows = reader();
      for (std::size_t v = begin; v < end; ++v)
        if (value(rows.vertex(v), *has_.alpha) != 255) are_opaque = false;
    });
    forget();
    if (!are_opaque) refuse("has vertices that are not opaque");
  }

  void read(std::size_t first, std::size_t count, float3* corners) const override {
    if (text_ && text_->is_scattered()) refuse("has vertices in an order too scattered");
    RowReader rows = reader();
    for (std::size_t f = first; f < first + count; ++f)
      for (const std::uint32_t v : indices_of(rows, f))
        *corners++ = v < rows_.vertices.count() ? position(rows, v) : nowhere;
  }

  void examine(std::size_t first, std::size_t count, const float3* corners) override {
    for (std::size_t begin = first; begin < first + count;) {
      const std::size_t end = std::min(first + count, (begin / grain + 1) * grain);
      examine_block(begin, end, corners);
      corners += 3 * (end - begin);
      begin = end;
    }
  }

  void read_ahead(std::size_t first, std::size_t count) const override {
    if (!text_) file().read_ahead(rows_.faces.data + first * rows_.faces.stride, count * rows_.faces.stride);
  }

  Scene head() const override {
    if (lacks_normals_) refuse("has vertices whose normals are missing");
    return head_;
  }

  Mesh mesh(std::span<const std::uint32_t> triangles) const override {
    std::vector<std::uint32_t> vertex(3 * triangles.size());
    with_rows(triangles.size(), [&](RowReader& rows, std::size_t i) {
      std::ranges::copy(vertices_of(rows, triangles[i]), &vertex[3 * i]);
    });
    Mesh out = attributes_of(vertex);
    drop_not_finite(out);
    out.index.resize(vertex.size());
    std::iota(out.index.begin(), out.index.end(), 0u);
    if (!has_.normal) add_smooth_normals(triangles, out);
    if (has_.normal && against_ > 0) reverse(out);
    return out;
  }

 private:
  static constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  static constexpr float3 nowhere{nan, nan, nan};

  /// The faces [begin, end) of one block.
  void examine_block(std::size_t begin, std::size_t end, const float3* corners) {
    VertexReach& reach = reach_[begin / grain];
    RowReader rows = reader();
    std::uint32_t low = 0xffffffffu, high = 0;
    std::int64_t against = 0;
    for (std::size_t f = begin; f < end; ++f, corners += 3) {
      const std::array<std::uint32_t, 3> vertex = indices_of(rows, f);
      if (std::ranges::any_of(vertex, [&](std::uint32_t v) { return v >= rows_.vertices.count(); })) continue;
      for (const std::uint32_t v : vertex) low = std::min(low, v), high = std::max(high, v);
      if (!has_.normal) continue;
      const float3 normals[3] = {normal(rows, vertex[0]), normal(rows, vertex[1]), normal(rows, vertex[2])};
      if (std::ranges::find(normals, float3{}) != std::end(normals)) lacks_normals_ = true;
      against += turn_of({corners[0], corners[1], corners[2]}, normals);
    }
    reach.add(low, high);
    against_ += against;
  }

  std::optional<PlainElements> find_binary() {
    std::optional<PlainElements> found = find_plain(header_, file().bytes().subspan(header_.size));
    if (!found) return found;
    offset_ = offsets_of(found->vertices);
    positions_ = floats_in_a_row(found->vertices, *find_columns(*found->vertices.element).position);
    return found;
  }

  std::optional<PlainElements> find_text(const LoadLimits& limits) {
    state_doubles(header_);
    const std::optional<PlainElements> found = find_plain_text(header_);
    if (!found) return found;
    const std::string_view text(reinterpret_cast<const char*>(file().bytes().data()), file().bytes().size());
    const PlyRows &vertices = found->vertices, &faces = found->faces;
    const PlyTextRows::Shape shape{{vertices.element->count, faces.element->count},
                                   {vertices.stride / sizeof(double), faces.stride / sizeof(double)}};
    std::optional<PlyTextRows::Layout> layout = PlyTextRows::lay_out(
        text, header_.size, shape, budget(), [&](std::string_view part) { file().forget(part.data(), part.size()); });
    if (!layout) return std::nullopt;
    text_.emplace(text, shape, std::move(*layout), path(), limits.memory / 8);
    for (std::size_t p = 0; p < vertices.element->properties.size(); ++p) offset_.push_back(p * sizeof(double));
    return found;
  }

  /// Of each property in a row.
  static std::vector<std::size_t> offsets_of(const PlyRows& rows) {
    std::vector<std::size_t> out;
    for (const PlyPlace& place : first_ply_row(rows)) out.push_back(static_cast<std::size_t>(place.at - rows.data));
    return out;
  }

  RowReader reader() const { return {rows_, text_ ? &*text_ : nullptr}; }

  /// Calls body(rows, i) for every i below `count`, as in_steps does.
  template <class Body>
  void with_rows(std::size_t count, const Body& body) const {
    PerThread<RowReader> rows;
    in_steps(count, [&](std::size_t i) { body(rows.local(rows_, text_ ? &*text_ : nullptr), i); });
  }

  /// The vertices of a face; ones that do not exist if it is no triangle.
  std::array<std::uint32_t, 3> indices_of(RowReader& rows, std::size_t f) const {
    const std::uint8_t* const row = rows.face(f);
    std::array<std::uint32_t, 3> out;
    if (text_) {
      std::array<double, 4> count_and_vertices;
      std::memcpy(count_and_vertices.data(), row + rows_.count_at, sizeof count_and_vertices);
      const auto [count, a, b, c] = count_and_vertices;
      const auto is_there = [](double v) { return v >= 0 && v < 0xffffffffp0; };
      if (count != 3 || !is_there(a) || !is_there(b) || !is_there(c)) return {0xffffffffu, 0xffffffffu, 0xffffffffu};
      return {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)};
    }
    std::memcpy(out.data(), row + rows_.index_at, sizeof out);
    for (std::uint32_t& v : out) v = native_word(v, rows_.faces.order);
    const bool is_triangle = rows_.count_type == PlyType::Uint8
                                 ? row[rows_.count_at] == 3
                                 : read_ply_value(row + rows_.count_at, rows_.count_type, rows_.faces.order) == 3;
    if (!is_triangle) out.fill(0xffffffffu);
    return out;
  }

  /// The vertices of a face whose corners `read` has given, which are finite.
  ///
  /// Errors    ErrorKind::Input if another program has changed the file since.
  std::array<std::uint32_t, 3> vertices_of(RowReader& rows, std::size_t f) const {
    const std::array<std::uint32_t, 3> out = indices_of(rows, f);
    if (std::ranges::any_of(out, [&](std::uint32_t v) { return v >= rows_.vertices.count(); })) throw_changed();
    return out;
  }

  float value(const std::uint8_t* row, std::size_t property) const {
    return static_cast<float>(read_ply_value(row + offset_[property], rows_.vertices.element->properties[property].type,
                                             rows_.vertices.order));
  }
  float3 vector(const std::uint8_t* row, const std::array<std::size_t, 3>& p) const {
    return {value(row, p[0]), value(row, p[1]), value(row, p[2])};
  }
  float3 position(RowReader& rows, std::size_t v) const {
    if (positions_ == nullptr) return vector(rows.vertex(v), *has_.position);
    float3 p;
    std::memcpy(&p, positions_ + v * rows_.vertices.stride, sizeof p);
    return p;
  }
  float3 normal(RowReader& rows, std::size_t v) const { return ply_normal(vector(rows.vertex(v), *has_.normal)); }

  /// The attributes of these vertices, as those of a file that has no others.
  Mesh attributes_of(std::span<const std::uint32_t> vertex) const {
    std::vector<std::uint8_t> bytes(vertex.size() * rows_.vertices.stride);
    with_rows(vertex.size(), [&](RowReader& rows, std::size_t i) {
      std::memcpy(&bytes[i * rows_.vertices.stride], rows.vertex(vertex[i]), rows_.vertices.stride);
    });
    PlyElement element = *rows_.vertices.element;
    element.count = vertex.size();
    const PlyRows rows{.element = &element,
                       .order = rows_.vertices.order,
                       .data = bytes.data(),
                       .size = bytes.size(),
                       .stride = rows_.vertices.stride,
                       .starts = {}};
    ImportBudget limits = budget();
    return read_ply_vertices(rows, limits, double3{}).mesh;
  }

  /// Smooth normals depend on all triangles around a vertex, which are found for some triangles at a time.
  void add_smooth_normals(std::span<const std::uint32_t> triangles, Mesh& out) const {
    constexpr std::size_t some = 1 << 18;
    out.normal.resize(out.position.size());
    for (std::size_t first = 0; first < triangles.size(); first += some)
      add_smooth_normals(triangles.subspan(first, std::min(some, triangles.size() - first)), first, out);
  }
  void add_smooth_normals(std::span<const std::uint32_t> triangles, std::size_t first, Mesh& out) const {
    RankedSet own(rows_.vertices.count()), all(rows_.vertices.count());
    with_rows(triangles.size(), [&](RowReader& rows, std::size_t i) {
      for (const std::uint32_t v : vertices_of(rows, triangles[i])) own.insert(v);
    });
    static_cast<void>(own.ascending());
    const std::vector<std::uint32_t> around = triangles_at(own);
    Mesh mesh;
    mesh.index.resize(3 * around.size());
    with_rows(around.size(), [&](RowReader& rows, std::size_t i) {
      std::size_t k = 3 * i;
      for (const std::uint32_t v : vertices_of(rows, around[i])) all.insert(mesh.index[k++] = v);
    });
    const std::vector<std::uint32_t> vertices = all.ascending();
    for (std::uint32_t& v : mesh.index) v = all.rank(v);
    mesh.position.resize(vertices.size());
    with_rows(vertices.size(), [&](RowReader& rows, std::size_t i) { mesh.position[i] = position(rows, vertices[i]); });
    make_smooth_normals(mesh);
    for (std::size_t i = 0, at = 0; i < triangles.size(); ++i) {
      while (at < around.size() && around[at] != triangles[i]) ++at;
      if (at == around.size()) throw_changed();
      for (std::size_t k = 0; k < 3; ++k) out.normal[3 * (first + i) + k] = mesh.normal[mesh.index[3 * at + k]];
    }
  }

  /// The triangles that have one of these vertices, in ascending order.
  std::vector<std::uint32_t> triangles_at(const RankedSet& vertices) const {
    std::vector<std::size_t> blocks;
    for (std::size_t i = 0; i < reach_.size(); ++i)
      if (reach_[i].low <= reach_[i].high && vertices.has_any(reach_[i].low, reach_[i].high)) blocks.push_back(i);
    std::vector<std::vector<std::uint32_t>> found(blocks.size());
    constexpr std::size_t step = 64;  // blocks after which the system may reclaim them
    for (std::size_t first = 0; first < blocks.size(); first += step) {
      parallel_for(std::min(step, blocks.size() - first), [&](std::size_t i) {
        const std::size_t begin = blocks[first + i] * grain;
        RowReader rows = reader();
        for (std::size_t f = begin; f < std::min(begin + grain, count()); ++f) {
          const auto [a, b, c] = vertices_of(rows, f);
          if (vertices.has(a) || vertices.has(b) || vertices.has(c))
            found[first + i].push_back(static_cast<std::uint32_t>(f));
        }
      });
      forget();
    }
    std::vector<std::uint32_t> out;
    for (const std::vector<std::uint32_t>& part : found) out.insert(out.end(), part.begin(), part.end());
    return out;
  }

  PlyHeader header_;
  bool is_plain_ = false;
  PlainElements rows_;
  PlyColumns has_;
  std::optional<PlyTextRows> text_;          ///< of ASCII
  std::vector<std::size_t> offset_;          ///< of the properties of a vertex, in its row
  const std::uint8_t* positions_ = nullptr;  ///< of the first vertex, if they are adjacent floats
  Scene head_;
  std::vector<VertexReach> reach_;         ///< of the faces, by block
  std::atomic<std::int64_t> against_ = 0;  ///< how many more triangles face away from their normals than not
  std::atomic<bool> lacks_normals_ = false;
};

}  // namespace

bool ply_may_exceed_memory(const std::string& path, const LoadLimits& limits) {
  constexpr std::uint64_t most = 16;  // a number has two characters at least, and eight in most files
  const FileBytes file = FileBytes::reclaimable(path);
  return parse_ply_header(file.bytes(), path).order != PlyOrder::Ascii || file.bytes().size() > limits.memory / most;
}

std::unique_ptr<FileStream> open_ply_stream(const std::string& path, const LoadLimits& limits) {
  auto stream = std::make_unique<PlyStream>(path, limits);
  if (!stream->is_plain()) return nullptr;
  return stream;
}

}  // namespace zoneplate
