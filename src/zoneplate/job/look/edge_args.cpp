// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/look/edge_args.h"

#include <span>
#include <string_view>

#include "zoneplate/base/spec.h"

namespace zoneplate {
namespace {

/// A set of edges, with the parameters of its lines.
struct EdgeRow {
  std::string_view name;
  std::span<const Param> params = {};
};

constexpr std::string_view hidden_names[] = {"removed", "shown"};
constexpr std::string_view surface_names[] = {"shaded", "none"};

constexpr Param width_param = real_param("width", "of lines, in pixels", 1, 0.05, 64);
constexpr Param removing_param = {
    .name = "hidden", .meaning = "lines behind surfaces", .value = 0, .names = hidden_names};
constexpr Param showing_param = {
    .name = "hidden", .meaning = "lines behind surfaces", .value = 1, .names = hidden_names};
constexpr Param surface_param = {
    .name = "surfaces", .meaning = "what is below the lines", .value = 0, .names = surface_names};

constexpr Param feature_params[] = {
    real_param("angle", "degrees between the normals of two triangles above which their edge is a crease", 30, 0, 180),
    width_param, removing_param, surface_param};
constexpr Param mesh_params[] = {width_param, removing_param, surface_param};
constexpr Param wireframe_params[] = {width_param, showing_param};
constexpr EdgeRow edge_rows[] = {
    {"none"}, {"features", feature_params}, {"mesh", mesh_params}, {"wireframe", wireframe_params}};

}  // namespace

void set_edges(const std::string& text, EdgeOptions& options) {
  const auto [row, settings] = parse_spec("edges", std::span<const EdgeRow>(edge_rows), text);
  EdgeOptions edges;
  edges.color = options.color;
  if (row.name != "none") {
    const bool is_wireframe = row.name == "wireframe";
    edges.kind = row.name == "features" ? EdgeKind::Features : EdgeKind::Mesh;
    if (edges.kind == EdgeKind::Features)
      edges.crease_angle = static_cast<float>(settings.number("angle")) * (3.14159265f / 180);
    edges.width = static_cast<float>(settings.number("width"));
    edges.hides = settings.integer("hidden") == 0;
    edges.has_surfaces = !is_wireframe && settings.integer("surfaces") == 0;
  }
  options = edges;
}

}  // namespace zoneplate
