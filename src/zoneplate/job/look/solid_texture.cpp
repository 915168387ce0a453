// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/look/solid_texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "zoneplate/base/spec.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {
namespace {

/// A pattern of --solid-texture, with its colours.
struct SolidRow {
  std::string_view name;
  SolidPattern pattern;
  float3 low, high;  ///< linear
  std::span<const Param> params;
};

constexpr Param filter_param{"filter", "1: by the footprint of the pixel; 0: point samples, which alias", 1, 0, 1};
constexpr Param fractal_params[] = {
    real_param("scale", "cells along the longest side of the largest mesh", 6, 1e-3, 1e6),
    {"octaves", "of the fractal sum", 5, 1, 12},
    real_param("gain", "amplitude of an octave over the octave before", 0.5, 0, 1),
    filter_param};
constexpr Param marble_params[] = {
    real_param("scale", "veins along the longest side of the largest mesh", 4, 1e-3, 1e6),
    {"octaves", "of the turbulence", 5, 1, 12},
    real_param("gain", "amplitude of an octave over the octave before", 0.5, 0, 1),
    real_param("distortion", "of the veins by turbulence, in vein distances", 2, 0, 100),
    filter_param};
constexpr Param wood_params[] = {real_param("scale", "rings along the longest side of the largest mesh", 10, 1e-3, 1e6),
                                 real_param("distortion", "of the rings by noise, in ring distances", 1, 0, 100),
                                 filter_param};

constexpr std::array<SolidRow, 5> rows = {
    {{"noise", SolidPattern::Noise, {0.02f, 0.02f, 0.02f}, {0.9f, 0.9f, 0.9f}, fractal_params},
     {"turbulence", SolidPattern::Turbulence, {0.05f, 0.12f, 0.35f}, {0.95f, 0.95f, 0.95f}, fractal_params},
     {"marble", SolidPattern::Marble, {0.84f, 0.82f, 0.79f}, {0.09f, 0.10f, 0.12f}, marble_params},
     {"wood", SolidPattern::Wood, {0.52f, 0.28f, 0.10f}, {0.17f, 0.06f, 0.016f}, wood_params},
     {"rock", SolidPattern::Rock, {0.06f, 0.052f, 0.045f}, {0.52f, 0.47f, 0.41f}, fractal_params}}};

Spec<SolidRow> parse(std::string_view text) {
  return parse_spec("solid texture", std::span<const SolidRow>(rows), text);
}

/// The longest side of the bounds of any mesh, in object space; 1 for a scene without extent.
float longest_side(const Scene& scene) {
  float longest = 0;
  for (const Mesh& mesh : scene.meshes) {
    Box box;
    for (const float3 p : mesh.position) box.add(p);
    if (!box.empty()) longest = std::max({longest, box.size().x, box.size().y, box.size().z});
  }
  return longest > 0 ? longest : 1;
}

}  // namespace

std::string solid_texture_names() {
  std::string names;
  for (const SolidRow& row : rows) {
    names += fmt::format("{}{}", names.empty() ? "" : "; ", row.name);
    for (const Param& param : row.params)
      names += fmt::format("{}{}={:g}", &param == row.params.data() ? ":" : ",", param.name, param.value);
  }
  return names;
}

const std::string& check_solid_texture(const std::string& text) {
  parse(text);
  return text;
}

void set_solid_texture(const std::string& text, Scene& scene) {
  const auto [row, settings] = parse(text);
  SolidTexture texture{.pattern = row.pattern, .low = row.low, .high = row.high};
  texture.scale = static_cast<float>(settings.number("scale")) / longest_side(scene);
  texture.is_filtered = settings.integer("filter") == 1;
  const bool is_fractal = row.pattern != SolidPattern::Wood;
  if (is_fractal) texture.octaves = settings.integer("octaves");
  if (is_fractal) texture.gain = static_cast<float>(settings.number("gain"));
  if (row.pattern == SolidPattern::Marble || !is_fractal)
    texture.distortion = static_cast<float>(settings.number("distortion"));
  for (Material& material : scene.materials) {
    material.base_color = {1, 1, 1, material.base_color.w};
    if (material.alpha_mode == AlphaMode::Opaque) material.base_color_texture = {};
    material.solid_texture = texture;
  }
}

}  // namespace zoneplate
