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

std::size_t need_indices(const PlyElement& element, const ImportBudget& budget) {
  if (const auto found = find_indices(element)) return *found;
  throw Error(ErrorKind::Input, fmt::format("{}: element {}: has no list vertex_indices", budget.file(), element.name));
}

std::size_t blocks(std::size_t count) { return (count + PlyRows::block - 1) / PlyRows::block; }

/// A face of more corners than this is dropped: it is not a real polygon, and triangulating it would take too long.
constexpr std::uint32_t max_corners = 1 << 20;
/// Triangulating a face of more corners than this may take long: the time limit is checked before it.
constexpr std::uint32_t many_corners = 64;

/// The properties of faces besides their vertices.
struct Extras {
  std::optional<std::size_t> texcoord, texture;     ///< coordinates of the corners; the number of the texture
  std::optional<std::array<std::size_t, 3>> color;  ///< red, green and blue, unless vertices have colours
  std::array<double, 3> one{};                      ///< the value of each that represents 1
  std::size_t textures = 0;                         ///< the number of the file's textures
};

Extras find_extras(const PlyRows& rows, const Mesh& vertices, std::size_t textures) {
  Extras out{.texcoord = find(*rows.element, "texcoord", true), .textures = textures};
  if (textures > 1) out.texture = find(*rows.element, "texnumber", false);
  const auto red = find(*rows.element, "red", false), green = find(*rows.element, "green", false),
             blue = find(*rows.element, "blue", false);
  if (!vertices.color.empty() || !red || !green || !blue) return out;
  out.color = {*red, *green, *blue};
  float greatest = 0;
  std::vector<float> values(PlyRows::block);
  for (std::size_t begin = 0; begin < rows.count(); begin += PlyRows::block) {
    const std::size_t end = std::min(rows.count(), begin + PlyRows::block);
    for (const std::size_t p : *out.color) {
      read_ply_column(rows, begin, end, p, values.data(), 1);
      for (std::size_t i = 0; i < end - begin; ++i) greatest = std::max(greatest, values[i]);
    }
  }
  for (std::size_t i = 0; i < 3; ++i)
    out.one[i] = one_of(rows.element->properties[(*out.color)[i]].stated, double{greatest});
  return out;
}

/// Reads the faces of one block.
class BlockReader {
 public:
  BlockReader(const PlyRows& rows, const Mesh& vertices, std::size_t indices, const Extras& extras,
              const ImportBudget& budget)
      : rows_(rows), vertices_(vertices), indices_(indices), budget_(budget), extras_(extras) {}

  PlyFaces out;

  void read(std::size_t begin, std::size_t end) {
    for_ply_rows(rows_, begin, end, [&](std::size_t i, std::span<const PlyPlace> places) { read_face(i, places); });
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
    if (list.count > max_corners) {
      ++out.too_concave;
      return;
    }
    if (list.count > many_corners && !budget_.has_time()) return;
    corners_.clear();
    for (std::size_t k = 0; k < list.count; ++k) {
      const double v = value(indices_, list, k);
      if (!(v >= 0 && v < static_cast<double>(vertices_.position.size()))) return out.strays.add({1, row, v});
      corners_.push_back(static_cast<std::uint32_t>(v));
    }
    cut();
    for (const auto& t : triangles_)
      for (const std::uint32_t k : t) out.index.push_back(corners_[k]);
    if (extras_.texcoord) add_uvs(places[*extras_.texcoord]);
    if (extras_.color) add_color(places);
    if (extras_.texture) add_texture(places);
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
          uv = {static_cast<float>(value(*extras_.texcoord, list, 2 * k)),
                1 - static_cast<float>(value(*extras_.texcoord, list, 2 * k + 1))};
        out.corner_uv.push_back(uv);
      }
  }

  void add_color(std::span<const PlyPlace> places) {
    std::array<float, 3> c{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t p = (*extras_.color)[i];
      c[i] = decode_srgb(static_cast<float>(value(p, places[p], 0) / extras_.one[i]));
    }
    out.corner_color.insert(out.corner_color.end(), 3 * triangles_.size(), {c[0], c[1], c[2], 1});
  }

  /// A face without a valid number has the first texture.
  void add_texture(std::span<const PlyPlace> places) {
    const double number = value(*extras_.texture, places[*extras_.texture], 0);
    const bool is_there = number >= 0 && number < static_cast<double>(extras_.textures);
    out.texture.insert(out.texture.end(), triangles_.size(), static_cast<std::uint16_t>(is_there ? number : 0));
  }

  const PlyRows& rows_;
  const Mesh& vertices_;
  std::size_t indices_;
  const ImportBudget& budget_;
  const Extras& extras_;
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

/// The address of the first row's indices, if all rows are triangles of 32-bit indices; else null.
const std::uint8_t* first_plain_triangle(const PlyRows& rows) {
  const std::optional<std::size_t> indices = find_indices(*rows.element);
  if (!indices || rows.stride == 0 || rows.count() == 0) return nullptr;
  const PlyType type = rows.element->properties[*indices].type;
  if (type != PlyType::Int32 && type != PlyType::Uint32) return nullptr;
  if (find(*rows.element, "texcoord", true) || find(*rows.element, "red", false)) return nullptr;
  const PlyPlace place = first_ply_row(rows)[*indices];
  return place.count == 3 ? place.at : nullptr;
}

}  // namespace

std::optional<std::size_t> find_indices(const PlyElement& element) {
  const auto found = find(element, "vertex_indices", true);
  return found ? found : find(element, "vertex_index", true);
}

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
      for (std::uint32_t& word : v) word = native_word(word, rows.order);
      most = std::max({most, v[0], v[1], v[2]});
      std::memcpy(&index[3 * i], v, sizeof v);
    }
    if (most >= limit) are_there = false;
  });
  if (!are_there) index.clear();
  return index;
}

PlyFaces read_ply_faces(const PlyRows& rows, const Mesh& vertices, std::size_t textures, ImportBudget& budget) {
  const std::size_t indices = need_indices(*rows.element, budget);
  PlyFaces out;
  if (rows.count() == 0) return out;

  std::atomic<std::uint64_t> made = 0;
  const std::uint64_t most = budget.memory_left();
  std::vector<PlyFaces> parts(blocks(rows.count()));
  const Extras extras = find_extras(rows, vertices, textures);
  parallel_ranges(rows.count(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    if (!budget.has_time() || made > most) return;
    BlockReader reader(rows, vertices, indices, extras, budget);
    reader.read(begin, end);
    made += reader.out.index.size() * sizeof(std::uint32_t) + reader.out.corner_uv.size() * sizeof(float2) +
            reader.out.corner_color.size() * sizeof(float4) + reader.out.texture.size() * sizeof(std::uint16_t);
    parts[begin / PlyRows::block] = std::move(reader.out);
  });
  budget.check_time();
  budget.take(made);
  budget.give_back(made);
  for (const PlyFaces& part : parts) {
    out.too_short += part.too_short, out.too_concave += part.too_concave;
    out.strays.add(part.strays);
  }
  out.index = joined(parts, &PlyFaces::index, budget);
  out.corner_uv = joined(parts, &PlyFaces::corner_uv, budget);
  out.corner_color = joined(parts, &PlyFaces::corner_color, budget);
  out.texture = joined(parts, &PlyFaces::texture, budget);
  if (out.index.size() >= 0xffffffffu) throw Error(ErrorKind::Input, budget.file() + ": more than 2^32 corners");
  return out;
}

std::vector<std::uint32_t> read_ply_strips(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget,
                                           PlyStrays& strays) {
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
                     const bool is_there = v >= 0 && v < static_cast<double>(vertices.position.size());
                     if (!is_there && !(v < 0)) strays.add({1, row, v});
                     if (!is_there) {
                       strip.clear();
                       continue;
                     }
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

std::vector<std::uint32_t> read_ply_edges(const PlyRows& rows, const Mesh& vertices, ImportBudget& budget,
                                          PlyStrays& strays) {
  const auto a = find(*rows.element, "vertex1", false), b = find(*rows.element, "vertex2", false);
  if (!a || !b) return {};
  budget.take(rows.count() * 2 * sizeof(std::uint32_t));
  std::vector<std::uint32_t> out;
  out.reserve(2 * rows.count());
  for (std::size_t begin = 0; begin < rows.count(); begin += PlyRows::block) {
    budget.check_time();
    for_ply_rows(rows, begin, std::min(rows.count(), begin + PlyRows::block),
                 [&](std::size_t row, std::span<const PlyPlace> places) {
                   const double ends[] = {read_ply_value(places[*a].at, rows.element->properties[*a].type, rows.order),
                                          read_ply_value(places[*b].at, rows.element->properties[*b].type, rows.order)};
                   for (const double v : ends)
                     if (!(v >= 0 && v < static_cast<double>(vertices.position.size()))) return strays.add({1, row, v});
                   for (const double v : ends) out.push_back(static_cast<std::uint32_t>(v));
                 });
  }
  return out;
}

}  // namespace zoneplate
