// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <numeric>
#include <optional>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/ply/mesh.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/scene/geometry/triangulate.h"

namespace zoneplate {
namespace {

std::optional<std::size_t> find(const PlyElement& element, std::string_view name, bool is_list) {
  for (std::size_t i = 0; i < element.properties.size(); ++i)
    if (element.properties[i].name == name && element.properties[i].is_list == is_list) return i;
  return std::nullopt;
}

std::optional<std::size_t> find_indices(const PlyElement& element) {
  const auto found = find(element, "vertex_indices", true);
  return found ? found : find(element, "vertex_index", true);
}

std::size_t need_indices(const PlyElement& element, const ImportBudget& budget) {
  if (const auto found = find_indices(element)) return *found;
  throw Error(ErrorKind::Input, fmt::format("{}: element {}: has no list vertex_indices", budget.file(), element.name));
}

/// A row with the index of a vertex that does not exist.
struct BadIndex {
  std::size_t row = 0;
  double value = 0;
};

/// Throws the error of the first block that has one.
void report(const std::vector<std::optional<BadIndex>>& found, const PlyRows& rows, const Mesh& vertices,
            const ImportBudget& budget) {
  budget.check_time();
  for (const std::optional<BadIndex>& bad : found)
    if (bad)
      throw Error(ErrorKind::Input, fmt::format("{}: {} {}: uses vertex {}, there are {}", budget.file(),
                                                rows.element->name, bad->row, bad->value, vertices.position.size()));
}

std::size_t blocks(std::size_t count) { return (count + PlyRows::block - 1) / PlyRows::block; }

/// A face of more corners than this is dropped: it is not a real polygon, and triangulating it would take too long.
constexpr std::uint32_t most_corners = 1 << 20;
/// Triangulating a face of more corners than this may take long: the time limit is checked before it.
constexpr std::uint32_t many_corners = 64;

/// Reads the faces of one block.
class BlockReader {
 public:
  BlockReader(const PlyRows& rows, const Mesh& vertices, std::size_t indices, const ImportBudget& budget)
      : rows_(rows),
        vertices_(vertices),
        indices_(indices),
        budget_(budget),
        texcoord_(find(*rows.element, "texcoord", true)) {
    if (!vertices.color.empty()) return;
    const auto red = find(*rows.element, "red", false), green = find(*rows.element, "green", false),
               blue = find(*rows.element, "blue", false);
    if (red && green && blue) color_ = {*red, *green, *blue};
  }

  PlyFaces out;
  std::optional<BadIndex> bad;

  void read(std::size_t begin, std::size_t end) {
    for_ply_rows(rows_, begin, end, [&](std::size_t i, std::span<const PlyPlace> places) {
      if (!bad) read_face(i, places);
    });
  }

 private:
  double value(std::size_t property, const PlyPlace& place, std::size_t item) const {
    const PlyType type = rows_.element->properties[property].type;
    return read_ply_value(place.at + item * size_of(type), type, rows_.order);
  }

  void read_face(std::size_t row, std::span<const PlyPlace> places) {
    const PlyPlace& list = places[indices_];
    if (list.count < 3) {
      ++out.too_short;
      return;
    }
    if (list.count > most_corners) {
      ++out.too_concave;
      return;
    }
    if (list.count > many_corners && !budget_.has_time()) return;
    corners_.clear();
    for (std::size_t k = 0; k < list.count; ++k) {
      const double v = value(indices_, list, k);
      if (!(v >= 0 && v < static_cast<double>(vertices_.position.size()))) {
        bad = {row, v};
        return;
      }
      corners_.push_back(static_cast<std::uint32_t>(v));
    }
    cut();
    for (const auto& t : triangles_)
      for (const std::uint32_t k : t) out.index.push_back(corners_[k]);
    if (texcoord_) add_uvs(places[*texcoord_]);
    if (color_) add_color(places);
  }

  void cut() {
    triangles_.clear();
    polygon_.clear();
    for (const std::uint32_t v : corners_) polygon_.push_back(vertices_.position[v]);
    if (corners_.size() == 3 || !std::all_of(polygon_.begin(), polygon_.end(), is_finite)) {
      for (std::uint32_t i = 1; i + 1 < corners_.size(); ++i) triangles_.push_back({0, i, i + 1});
    } else if (!triangulate(polygon_, triangles_)) {
      ++out.too_concave;
    }
  }

  void add_uvs(const PlyPlace& list) {
    for (const auto& t : triangles_)
      for (const std::uint32_t k : t) {
        float2 uv{0, 1};
        if (2 * k + 1 < list.count)
          uv = {static_cast<float>(value(*texcoord_, list, 2 * k)),
                1 - static_cast<float>(value(*texcoord_, list, 2 * k + 1))};
        out.corner_uv.push_back(uv);
      }
  }

  void add_color(std::span<const PlyPlace> places) {
    std::array<float, 3> c{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t p = (*color_)[i];
      c[i] = decode_srgb(static_cast<float>(value(p, places[p], 0) / one_of(rows_.element->properties[p].stated)));
    }
    out.corner_color.insert(out.corner_color.end(), 3 * triangles_.size(), {c[0], c[1], c[2], 1});
  }

  const PlyRows& rows_;
  const Mesh& vertices_;
  std::size_t indices_;
  const ImportBudget& budget_;
  std::optional<std::size_t> texcoord_;
  std::optional<std::array<std::size_t, 3>> color_;
  std::vector<std::uint32_t> corners_;
  std::vector<float3> polygon_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

/// Concatenates one list of all blocks.
template <class T>
std::vector<T> joined(std::vector<PlyFaces>& parts, std::vector<T> PlyFaces::*list, ImportBudget& budget) {
  std::vector<std::size_t> first(parts.size() + 1);
  for (std::size_t i = 0; i < parts.size(); ++i) first[i + 1] = first[i] + (parts[i].*list).size();
  budget.take(2 * first.back() * sizeof(T));
  std::vector<T> out(first.back());
  parallel_for(parts.size(), [&](std::size_t i) {
    std::copy((parts[i].*list).begin(), (parts[i].*list).end(), out.begin() + static_cast<std::ptrdiff_t>(first[i]));
    parts[i].*list = {};
  });
  budget.give_back(first.back() * sizeof(T));
  return out;
}

/// The address of the first row's indices, if all rows are triangles of 32-bit indices in native byte order; else null.
const std::uint8_t* first_plain_triangle(const PlyRows& rows) {
  const std::optional<std::size_t> indices = find_indices(*rows.element);
  if (!indices || rows.stride == 0 || rows.count() == 0 || rows.order != PlyOrder::Little) return nullptr;
  const PlyType type = rows.element->properties[*indices].type;
  if (type != PlyType::Int32 && type != PlyType::Uint32) return nullptr;
  if (find(*rows.element, "texcoord", true) || find(*rows.element, "red", false)) return nullptr;
  const PlyPlace place = first_ply_row(rows)[*indices];
  return place.count == 3 ? place.at : nullptr;
}

}  // namespace

bool are_plain_triangles(const PlyRows& rows) { return first_plain_triangle(rows) != nullptr; }

std::vector<std::uint32_t> read_plain_triangles(const PlyRows& rows, std::size_t vertices) {
  const std::uint8_t* const first = first_plain_triangle(rows);
  const auto limit = static_cast<std::uint32_t>(std::min<std::size_t>(vertices, 0xffffffffu));
  std::vector<std::uint32_t> index;
  reserve_large(index, 3 * rows.count());
  index.resize(3 * rows.count());
  std::atomic<bool> are_there = true;
  parallel_ranges(rows.count(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    std::uint32_t most = 0;
    for (std::size_t i = begin; i < end; ++i) {
      std::uint32_t v[3];
      std::memcpy(v, first + i * rows.stride, sizeof v);
      most = std::max({most, v[0], v[1], v[2]});
      std::memcpy(&index[3 * i], v, sizeof v);
    }
    if (most >= limit) are_there = false;
  });
  if (!are_there) index.clear();
  return index;
}

PlyFaces read_ply_faces(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget) {
  const std::size_t indices = need_indices(*rows.element, budget);
  PlyFaces out;
  if (rows.count() == 0) return out;

  std::atomic<std::uint64_t> made = 0;
  const std::uint64_t most = budget.memory_left();
  std::vector<PlyFaces> parts(blocks(rows.count()));
  std::vector<std::optional<BadIndex>> found(parts.size());
  parallel_ranges(rows.count(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    if (!budget.has_time() || made > most) return;
    BlockReader reader(rows, vertices, indices, budget);
    reader.read(begin, end);
    made += reader.out.index.size() * sizeof(std::uint32_t) + reader.out.corner_uv.size() * sizeof(float2) +
            reader.out.corner_color.size() * sizeof(float4);
    parts[begin / PlyRows::block] = std::move(reader.out);
    found[begin / PlyRows::block] = reader.bad;
  });
  report(found, rows, vertices, budget);
  budget.take(made);
  budget.give_back(made);
  for (const PlyFaces& part : parts) out.too_short += part.too_short, out.too_concave += part.too_concave;
  out.index = joined(parts, &PlyFaces::index, budget);
  out.corner_uv = joined(parts, &PlyFaces::corner_uv, budget);
  out.corner_color = joined(parts, &PlyFaces::corner_color, budget);
  if (out.index.size() >= 0xffffffffu) throw Error(ErrorKind::Input, budget.file() + ": more than 2^32 corners");
  return out;
}

std::vector<std::uint32_t> read_ply_strips(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget) {
  const std::size_t indices = need_indices(*rows.element, budget);
  const PlyType type = rows.element->properties[indices].type;
  std::vector<std::uint32_t> out, strip;
  budget.take(3 * sizeof(std::uint32_t) * (rows.size / size_of(type)));
  for (std::size_t b = 0; b < rows.count(); b += PlyRows::block) {
    budget.check_time();
    for_ply_rows(rows, b, std::min(rows.count(), b + PlyRows::block),
                 [&](std::size_t row, std::span<const PlyPlace> p) {
                   strip.clear();
                   for (std::size_t k = 0; k < p[indices].count; ++k) {
                     const double v = read_ply_value(p[indices].at + k * size_of(type), type, rows.order);
                     if (v < 0) {
                       strip.clear();
                       continue;
                     }
                     if (!(v < static_cast<double>(vertices.position.size())))
                       report({BadIndex{row, v}}, rows, vertices, budget);
                     strip.push_back(static_cast<std::uint32_t>(v));
                     const std::size_t n = strip.size();
                     if (n < 3) continue;
                     // Every other triangle of a strip has the opposite winding.
                     const bool is_odd = n % 2 == 0;
                     out.insert(out.end(), {strip[n - (is_odd ? 2 : 3)], strip[n - (is_odd ? 3 : 2)], strip[n - 1]});
                   }
                 });
  }
  return out;
}

std::vector<std::uint32_t> read_ply_edges(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget) {
  const auto a = find(*rows.element, "vertex1", false), b = find(*rows.element, "vertex2", false);
  if (!a || !b) return {};
  budget.take(rows.count() * 2 * sizeof(std::uint32_t));
  std::vector<std::uint32_t> out(2 * rows.count());
  std::vector<std::optional<BadIndex>> found(blocks(rows.count()));
  parallel_ranges(rows.count(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    for_ply_rows(rows, begin, end, [&](std::size_t i, std::span<const PlyPlace> places) {
      for (std::size_t k = 0; k < 2; ++k) {
        const std::size_t p = k == 0 ? *a : *b;
        const double v = read_ply_value(places[p].at, rows.element->properties[p].type, rows.order);
        const bool is_there = v >= 0 && v < static_cast<double>(vertices.position.size());
        if (!is_there && !found[begin / PlyRows::block]) found[begin / PlyRows::block] = {i, v};
        if (is_there) out[2 * i + k] = static_cast<std::uint32_t>(v);
      }
    });
  });
  report(found, rows, vertices, budget);
  return out;
}

}  // namespace zoneplate
