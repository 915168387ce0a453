// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/look/shadow_args.h"

#include <span>
#include <string_view>

#include "zoneplate/base/spec.h"

namespace zoneplate {
namespace {

/// A way to compute visibility, with its parameters.
struct VisibilityRow {
  std::string_view name;
  std::span<const Param> params = {};
};

constexpr Param spacing_param = {
    "spacing", "pixels between the points of a surface whose rays the fragments between them share; 1: none share", 1,
    1, 16};
constexpr Param soft_params[] = {
    {"samples", "rays from a fragment to a light", 32, 1, 4096},
    real_param("angle", "angular radius in degrees of lights without a radius of their own", 3, 0.01, 89),
    spacing_param,
};
constexpr std::string_view filter_names[] = {"nearest", "pcf", "pcss", "evsm"};
constexpr Param map_params[] = {
    {.name = "filter", .meaning = "how depths become visibility", .value = 1, .names = filter_names},
    {"size", "texels a side", 2048, 16, 16384},
    real_param("radius", "of the filter in texels", 1.5, 0.5, 64),
    real_param("bias", "factor of the distance by which points are moved off their surface", 1, 0, 100),
    soft_params[1],
};
constexpr VisibilityRow shadow_rows[] = {{"none"}, {"map", map_params}, {"hard"}, {"soft", soft_params}};

constexpr Param ray_params[] = {
    {"samples", "rays from a fragment", 32, 1, 4096},
    real_param("distance", "world units beyond which nothing occludes; 0: a quarter of the scene's diagonal", 0, 0,
               1e9),
    spacing_param,
};
constexpr VisibilityRow occlusion_rows[] = {{"none"}, {"rays", ray_params}};

}  // namespace

ShadowOptions parse_shadows(const std::string& text) {
  const auto spec = parse_spec("shadow method", std::span<const VisibilityRow>(shadow_rows), text);
  const Settings& settings = spec.settings;
  const auto real = [&](std::string_view name) { return static_cast<float>(settings.number(name)); };
  ShadowOptions shadows;
  if (spec.row.name == "none") return shadows;
  if (spec.row.name == "hard") {
    shadows.method = ShadowMethod::Hard;
    return shadows;
  }
  shadows.angle = real("angle") * (3.14159265f / 180);
  if (spec.row.name == "soft") {
    shadows.method = ShadowMethod::Soft;
    shadows.samples = settings.integer("samples");
    shadows.spacing = settings.integer("spacing");
    return shadows;
  }
  constexpr ShadowFilter filters[] = {ShadowFilter::Nearest, ShadowFilter::Pcf, ShadowFilter::Pcss, ShadowFilter::Evsm};
  shadows.method = ShadowMethod::Map;
  shadows.map = {.filter = filters[settings.integer("filter")],
                 .size = settings.integer("size"),
                 .radius = real("radius"),
                 .bias = real("bias")};
  return shadows;
}

OcclusionOptions parse_occlusion(const std::string& text) {
  const auto spec = parse_spec("ambient occlusion", std::span<const VisibilityRow>(occlusion_rows), text);
  if (spec.row.name == "none") return {};
  return {.samples = spec.settings.integer("samples"),
          .distance = static_cast<float>(spec.settings.number("distance")),
          .spacing = spec.settings.integer("spacing")};
}

}  // namespace zoneplate
