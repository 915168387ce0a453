// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <optional>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/ply/mesh.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/scene/geometry/origin.h"

namespace zoneplate {
namespace {

using Names = std::initializer_list<std::string_view>;

/// Finds a scalar property by any of the names.
std::optional<std::size_t> find(const PlyElement& element, Names names) {
  for (const std::string_view name : names)
    for (std::size_t i = 0; i < element.properties.size(); ++i)
      if (element.properties[i].name == name && !element.properties[i].is_list) return i;
  return std::nullopt;
}

/// Finds the properties of one attribute; nothing unless all of them are present.
template <std::size_t n>
std::optional<std::array<std::size_t, n>> find_all(const PlyElement& element, const std::array<Names, n>& names) {
  std::array<std::size_t, n> out{};
  for (std::size_t i = 0; i < n; ++i) {
    const auto found = find(element, names[i]);
    if (!found) return std::nullopt;
    out[i] = *found;
  }
  return out;
}

/// Fills an attribute in blocks, each component from one property.
template <class V, std::size_t n>
void read_columns(const PlyRows& rows, const std::array<std::size_t, n>& properties, std::vector<V>& out) {
  static_assert(sizeof(V) == n * sizeof(float));
  if (const std::uint8_t* const first = floats_in_a_row(rows, properties)) {
    parallel_ranges(rows.count(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) std::memcpy(&out[i], first + i * rows.stride, sizeof(V));
    });
    return;
  }
  parallel_ranges(rows.count(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = 0; c < n; ++c)
      read_ply_column(rows, begin, end, properties[c], reinterpret_cast<float*>(&out[begin]) + c, n);
  });
}

using Columns = std::array<std::size_t, 3>;

/// The position of a row in the coordinates of the file.
double3 place_of(const PlyRows& rows, const Columns& position, std::span<const PlyPlace> places) {
  const auto value = [&](std::size_t property) {
    return read_ply_value(places[property].at, rows.element->properties[property].type, rows.order);
  };
  return {value(position[0]), value(position[1]), value(position[2])};
}

/// Stops at the first near part of the rows; rows that are far are all looked at, by all threads.
double3 choose_origin(const PlyRows& rows, const Columns& position) {
  const auto add = [&](std::size_t begin, std::size_t end, OriginChoice& choice) {
    for_ply_rows(rows, begin, end,
                 [&](std::size_t, std::span<const PlyPlace> places) { choice.add(place_of(rows, position, places)); });
  };
  constexpr std::size_t some = 64;
  OriginChoice first;
  if (rows.count() > 0) add(0, std::min(rows.count(), some), first);
  if (first.is_near()) return {};
  std::vector<OriginChoice> parts((rows.count() + PlyRows::block - 1) / PlyRows::block);
  parallel_ranges(rows.count(), PlyRows::block,
                  [&](std::size_t begin, std::size_t end) { add(begin, end, parts[begin / PlyRows::block]); });
  for (const OriginChoice& part : parts) first.add(part);
  return first.origin();
}

/// Reads positions relative to `origin`, which is subtracted before they are rounded to floats.
void read_places(const PlyRows& rows, const Columns& position, double3 origin, std::vector<float3>& out) {
  if (origin == double3{}) return read_columns(rows, position, out);
  parallel_ranges(rows.count(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    for_ply_rows(rows, begin, end, [&](std::size_t i, std::span<const PlyPlace> places) {
      out[i] = narrowed(place_of(rows, position, places) - origin);
    });
  });
}

/// The greatest value of each component.
float4 max_of(const std::vector<float4>& colors) {
  std::vector<float4> parts((colors.size() + PlyRows::block - 1) / PlyRows::block);
  const auto larger = [](float4 a, float4 b) {
    return float4{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z), std::max(a.w, b.w)};
  };
  parallel_ranges(colors.size(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    float4 most{};
    for (std::size_t i = begin; i < end; ++i) most = larger(most, colors[i]);
    parts[begin / PlyRows::block] = most;
  });
  return std::accumulate(parts.begin(), parts.end(), float4{}, larger);
}

/// Converts the colour properties of the file to linear colours.
void decode_colors(const PlyElement& element, const std::array<std::size_t, 4>& properties, bool has_alpha,
                   std::vector<float4>& colors) {
  const float4 most = max_of(colors);
  const float of_colors = std::max({most.x, most.y, most.z}), greatest[] = {of_colors, of_colors, of_colors, most.w};
  std::array<float, 4> one{};
  for (std::size_t c = 0; c < 4; ++c)
    one[c] = static_cast<float>(one_of(element.properties[properties[c]].stated, double{greatest[c]}));
  std::array<float, 256> bytes{};
  for (std::size_t i = 0; i < 256; ++i) bytes[i] = decode_srgb8(static_cast<std::uint8_t>(i));
  const bool are_bytes = one[0] == 255 && one[1] == 255 && one[2] == 255;
  const auto linear = [&](float code, float whole) {
    if (!(code > 0)) return 0.0f;
    return are_bytes ? bytes[static_cast<std::size_t>(std::min(code, 255.0f))] : decode_srgb(code / whole);
  };
  parallel_ranges(colors.size(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float4 c = colors[i];
      const float alpha = c.w / one[3];
      colors[i] = {linear(c.x, one[0]), linear(c.y, one[1]), linear(c.z, one[2]),
                   !has_alpha  ? 1.0f
                   : alpha > 0 ? std::min(alpha, 1.0f)
                               : 0.0f};
    }
  });
}

std::optional<Columns> find_position(const PlyElement& e) { return find_all<3>(e, {Names{"x"}, {"y"}, {"z"}}); }

std::optional<Columns> find_harmonics(const PlyElement& e) {
  return find_all<3>(e, {Names{"f_dc_0"}, {"f_dc_1"}, {"f_dc_2"}});
}

/// Reads the constant coefficients of splats, and makes colours of them.
///
/// Source    Kerbl et al., 3D Gaussian Splatting for Real-Time Radiance Field Rendering, 2023: the code is 0.5 plus the
///           coefficient times the harmonic of degree 0, 1 / (2 sqrt(pi)).
void read_splat_colors(const PlyRows& rows, const Columns& harmonics, std::vector<float4>& colors) {
  const std::array<std::size_t, 4> all{harmonics[0], harmonics[1], harmonics[2], harmonics[0]};
  read_columns(rows, all, colors);
  const auto linear = [](float coefficient) {
    const float code = 0.5f + 0.28209479f * coefficient;
    return code > 0 ? decode_srgb(std::min(code, 1.0f)) : 0.0f;
  };
  parallel_ranges(colors.size(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      colors[i] = {linear(colors[i].x), linear(colors[i].y), linear(colors[i].z), 1};
  });
}

/// Normalizes normals; those without a direction become zero.
void normalize_all(std::vector<float3>& normals) {
  parallel_ranges(normals.size(), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) normals[i] = ply_normal(normals[i]);
  });
}

}  // namespace

float3 ply_normal(float3 stored) {
  const double x = stored.x, y = stored.y, z = stored.z, length = std::sqrt(x * x + y * y + z * z);
  if (!(length > 0 && std::isfinite(length))) return {0, 0, 0};
  return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

bool are_splats(const PlyElement& vertices) {
  return find_harmonics(vertices) && find(vertices, {"opacity"}) && find(vertices, {"scale_0"}) &&
         find(vertices, {"rot_0"}) && !find(vertices, {"red", "r", "diffuse_red"});
}

double3 center_far_vertices(const PlyRows& rows, Mesh& mesh) {
  OriginChoice choice;
  choice.add_used(mesh.index, [&](std::uint32_t vertex) { return mesh.position[vertex]; });
  const double3 origin = choice.origin();
  if (origin != double3{}) read_places(rows, *find_position(*rows.element), origin, mesh.position);
  return origin;
}

PlyColumns find_columns(const PlyElement& e) {
  PlyColumns out{.position = find_position(e)};
  // The normals of splats are zero.
  if (!are_splats(e)) out.normal = find_all<3>(e, {Names{"nx"}, {"ny"}, {"nz"}});
  out.uv = find_all<2>(
      e, {Names{"s", "u", "texture_u", "texture_s", "texcoord_u"}, {"t", "v", "texture_v", "texture_t", "texcoord_v"}});
  out.color = find_all<3>(
      e, {Names{"red", "r", "diffuse_red"}, {"green", "g", "diffuse_green"}, {"blue", "b", "diffuse_blue"}});
  out.alpha = find(e, {"alpha", "a", "diffuse_alpha"});
  return out;
}

PlyVertices read_ply_vertices(const PlyRows& rows, ImportBudget& budget, std::optional<double3> whole_origin) {
  const PlyElement& e = *rows.element;
  const PlyColumns has = find_columns(e);
  if (!has.position) throw Error(ErrorKind::Input, budget.file() + ": element vertex: has no x, y and z");
  if (e.count >= 0xffffffffu) throw Error(ErrorKind::Input, budget.file() + ": more than 2^32 vertices");
  const bool has_splats = are_splats(e);

  const std::size_t n = rows.count();
  budget.take(n * (sizeof(float3) + (has.normal ? sizeof(float3) : 0) + (has.uv ? sizeof(float2) : 0) +
                   (has.color || has_splats ? sizeof(float4) : 0)));
  Mesh mesh;
  parallel_for(4, [&](std::size_t i) {
    const auto make = [n](auto& values) { reserve_large(values, n), values.resize(n); };
    if (i == 0) make(mesh.position);
    if (i == 1 && has.normal) make(mesh.normal);
    if (i == 2 && (has.color || has_splats)) make(mesh.color);
    if (i == 3 && has.uv) make(mesh.uv0);
  });
  const double3 origin = whole_origin ? *whole_origin : choose_origin(rows, *has.position);
  read_places(rows, *has.position, origin, mesh.position);
  if (has.normal) read_columns(rows, *has.normal, mesh.normal), normalize_all(mesh.normal);
  if (has.uv) read_columns(rows, *has.uv, mesh.uv0);
  for (float2& t : mesh.uv0) t.y = 1 - t.y;
  if (has.color) {
    const auto& [red, green, blue] = *has.color;
    const std::array<std::size_t, 4> all{red, green, blue, has.alpha.value_or(red)};
    read_columns(rows, all, mesh.color);
    decode_colors(e, all, has.alpha.has_value(), mesh.color);
  }
  if (has_splats) read_splat_colors(rows, *find_harmonics(e), mesh.color);
  return {std::move(mesh), origin};
}

}  // namespace zoneplate
