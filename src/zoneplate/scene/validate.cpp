// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>

#include "zoneplate/scene/material_layers.h"
#include "zoneplate/scene/sanitize.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

bool all_finite(std::initializer_list<float> floats) { return are_finite(std::span(floats.begin(), floats.size())); }

bool is_finite(const float4x4& m) {
  return std::all_of(std::begin(m.column), std::end(m.column), [](float4 c) {
    return all_finite({c.x, c.y, c.z, c.w});
  });
}

template <class V>
bool all_finite(const std::vector<V>& values) {
  bool is_finite = true;
  serial_ranges(values.size(), [&](std::size_t begin, std::size_t end) {
    const auto* const floats = reinterpret_cast<const float*>(values.data() + begin);
    is_finite = is_finite && are_finite(std::span(floats, (end - begin) * sizeof(V) / sizeof(float)));
  });
  return is_finite;
}

template <class V>
bool fits(const std::vector<V>& values, const Mesh& m) {
  return (values.empty() || values.size() == m.position.size()) && all_finite(values);
}

bool is_number_of(int i, std::size_t count) { return i >= 0 && static_cast<std::size_t>(i) < count; }

bool has_unit_length(float3 n) { return std::abs(dot(n, n) - 1) <= 2e-5f; }

/// Finite and not negative; false for NaN.
bool is_amount(float x) { return x >= 0 && x <= std::numeric_limits<float>::max(); }
bool are_amounts(float3 v) { return is_amount(v.x) && is_amount(v.y) && is_amount(v.z); }
bool is_share(float x) { return x >= 0 && x <= 1; }

const char* flaw_of(const Mesh& m, const Scene& s) {
  const auto corners = static_cast<std::size_t>(m.vertices_per_primitive());
  if (!fits(m.position, m) || !fits(m.normal, m) || !fits(m.tangent, m) || !fits(m.uv0, m) || !fits(m.uv1, m) ||
      !fits(m.color, m))
    return "an attribute of another length, or not finite";
  if (m.index.size() % corners != 0) return "half a primitive";
  const std::size_t count = m.position.size();
  if (std::any_of(m.index.begin(), m.index.end(), [&](std::uint32_t i) { return i >= count; }))
    return "an index out of range";
  if (!is_number_of(m.material, s.materials.size())) return "no material of that number";
  if (m.topology != Topology::Triangles) return nullptr;
  if (m.normal.size() != count) return "triangles without normals";
  const auto is_bad = [&](std::uint32_t i) { return !has_unit_length(m.normal[i]); };
  return std::any_of(m.index.begin(), m.index.end(), is_bad) ? "a normal that is not of unit length" : nullptr;
}

const char* flaw_of(const TextureUse& use, const Scene& s) {
  if (!all_finite({use.offset.x, use.offset.y, use.scale.x, use.scale.y, use.rotation}))
    return "a texture transform that is not finite";
  if (use.sampler.anisotropy < 1 || use.sampler.anisotropy > 16) return "an anisotropy out of range";
  if (use.uv_set != 0 && use.uv_set != 1) return "no texture coordinates of that number";
  if (use.image < 0) return nullptr;
  if (!is_number_of(use.image, s.images.size())) return "no image of that number";
  return s.images[static_cast<std::size_t>(use.image)].pixels.empty() ? "an image of nothing" : nullptr;
}

bool is_refractive_index(float x) { return x >= 1 && is_amount(x); }

const char* flaw_of(const MaterialLayers& l) {
  for (const float share : {l.specular, l.clearcoat, l.clearcoat_roughness, l.sheen_roughness, l.anisotropy,
                            l.iridescence, l.transmission, l.diffuse_transmission, l.glossiness.value_or(0)})
    if (!is_share(share)) return "a layer's factor out of range";
  if (!are_amounts(l.specular_color) || !are_amounts(l.sheen_color) || !are_amounts(l.attenuation_color) ||
      !are_amounts(l.diffuse_transmission_color))
    return "a layer's colour out of range";
  if ((l.ior != 0 && !is_refractive_index(l.ior)) || !is_refractive_index(l.iridescence_ior))
    return "an index of refraction below 1";
  if (!is_amount(l.iridescence_thickness_minimum) || !is_amount(l.iridescence_thickness_maximum) ||
      !is_amount(l.thickness) || !(l.attenuation_distance > 0) || !is_amount(l.dispersion))
    return "a thickness, distance or dispersion out of range";
  return all_finite({l.clearcoat_normal_scale, l.anisotropy_rotation}) ? nullptr : "a layer's factor is not finite";
}

const char* flaw_of(const SolidTexture& t) {
  if (t.pattern == SolidPattern::None) return nullptr;
  if (!is_amount(t.scale) || !is_amount(t.distortion) || !is_share(t.gain) || t.octaves < 1 || t.octaves > 12)
    return "a solid texture with a factor out of range";
  const auto is_color = [](float3 c) { return is_share(c.x) && is_share(c.y) && is_share(c.z); };
  return is_color(t.low) && is_color(t.high) ? nullptr : "a solid texture with a colour out of range";
}

const char* flaw_of(const Material& m, const Scene& s) {
  if (!are_amounts(xyz(m.base_color)) || !is_share(m.base_color.w)) return "a base colour out of range";
  if (!are_amounts(m.emissive) || !are_amounts(m.ambient) || !are_amounts(m.specular)) return "a colour out of range";
  if (!is_amount(m.alpha_cutoff) || !is_amount(m.exponent) || !std::isfinite(m.normal_scale) ||
      !is_share(m.occlusion_strength) || !is_share(m.metallic) || !is_share(m.roughness))
    return "a factor out of range";
  if (const char* flaw = flaw_of(m.solid_texture)) return flaw;
  if (!std::isfinite(m.height_scale) || m.parallax_layers < 0 || m.parallax_layers > 256) return "heights out of range";
  if (m.layers != nullptr)
    if (const char* flaw = flaw_of(*m.layers)) return flaw;
  const char* flaw = nullptr;
  for_texture_uses(m, [&](const TextureUse& use) { flaw = flaw != nullptr ? flaw : flaw_of(use, s); });
  return flaw;
}

const char* flaw_of(const Light& l, const Scene&) {
  if (!are_amounts(l.color) || !is_amount(l.intensity)) return "a colour or intensity out of range";
  const bool is_direction = l.is_in_camera_space ? length(l.direction) > 0 : has_unit_length(l.direction);
  if (!is_finite(l.position) || !is_finite(l.direction) || !is_direction) return "a place or direction that is none";
  if (!(l.range > 0) || !are_amounts(l.attenuation)) return "a falloff out of range";
  constexpr float right_angle = 1.5707964f;
  if (!(l.inner_cone >= 0 && l.inner_cone < l.outer_cone && l.outer_cone <= right_angle)) return "a cone out of range";
  if (!is_amount(l.radius)) return "a radius out of range";
  return nullptr;
}

const char* flaw_of(const Camera& c, const Scene&) {
  constexpr float half_turn = 3.1415925f;
  if (!is_finite(c.world_from_camera)) return "a place that is not finite";
  if (!is_amount(c.aspect)) return "an aspect out of range";
  if (c.is_orthographic ? !(is_amount(c.half_height) && c.half_height > 0)
                        : !(c.vertical_fov > 0 && c.vertical_fov < half_turn))
    return "a field of view out of range";
  if (!is_amount(c.near) || !(c.far > c.near) || (c.is_orthographic ? !is_amount(c.far) : c.near == 0))
    return "a near or far distance out of range";
  return nullptr;
}

const char* flaw_of(const Environment& e, const Scene& s) {
  if (!are_amounts(e.color) || !is_amount(e.strength) || !std::isfinite(e.rotation))
    return "a radiance or rotation out of range";
  if (e.image >= 0 && !is_number_of(e.image, s.images.size())) return "no image of that number";
  return nullptr;
}

const char* flaw_of(const AnimationSpan& a, const Scene&) {
  return all_finite({a.begin, a.end}) && a.begin <= a.end ? nullptr : "a time out of range";
}

/// The greatest absolute coordinates of the vertices that a primitive uses.
float3 reach_of(const Mesh& m) {
  float3 reach;
  serial_ranges(m.index.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const float3 p = m.position[m.index[k]];
      reach = {std::max(reach.x, std::abs(p.x)), std::max(reach.y, std::abs(p.y)), std::max(reach.z, std::abs(p.z))};
    }
  });
  return reach;
}

/// Whether every vertex within `reach` is finite in the world too, for any order of the sums.
bool stays_finite(const float4x4& m, float3 reach) {
  const auto bound = [&](float x, float y, float z, float moved) {
    return std::abs(double{x}) * reach.x + std::abs(double{y}) * reach.y + std::abs(double{z}) * reach.z +
           std::abs(double{moved});
  };
  constexpr double most = std::numeric_limits<float>::max();
  const auto& c = m.column;
  return is_finite(m) && bound(c[0].x, c[1].x, c[2].x, c[3].x) <= most &&
         bound(c[0].y, c[1].y, c[2].y, c[3].y) <= most && bound(c[0].z, c[1].z, c[2].z, c[3].z) <= most;
}

std::string named(const char* what, std::size_t i, const char* flaw) {
  return std::string(what) + " " + std::to_string(i) + ": " + flaw;
}

template <class Part>
std::optional<std::string> flaw_among(const std::vector<Part>& parts, const char* what, const Scene& s) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (const char* flaw = flaw_of(parts[i], s)) return named(what, i, flaw);
  return std::nullopt;
}

std::optional<std::string> flaw_among_instances(const Scene& s) {
  std::vector<std::optional<float3>> reaches(s.meshes.size());
  for (std::size_t i = 0; i < s.instances.size(); ++i) {
    const Instance& instance = s.instances[i];
    if (!is_number_of(instance.mesh, s.meshes.size())) return named("instance", i, "no mesh of that number");
    if (!is_number_of(instance.object, s.objects.size())) return named("instance", i, "no object of that number");
    const auto mesh = static_cast<std::size_t>(instance.mesh);
    if (!reaches[mesh]) reaches[mesh] = reach_of(s.meshes[mesh]);
    if (!stays_finite(instance.world_from_object, *reaches[mesh]))
      return named("instance", i, "its bounds are not finite");
  }
  return std::nullopt;
}

bool is_one_line(const std::string& text) { return text.find('\n') == text.npos; }

}  // namespace

std::optional<std::string> find_invalid(const Scene& s) {
  if (auto flaw = flaw_among(s.meshes, "mesh", s)) return flaw;
  if (auto flaw = flaw_among(s.materials, "material", s)) return flaw;
  if (auto flaw = flaw_among_instances(s)) return flaw;
  if (auto flaw = flaw_among(s.lights, "light", s)) return flaw;
  if (auto flaw = flaw_among(s.cameras, "camera", s)) return flaw;
  if (auto flaw = flaw_among(s.animations, "animation", s)) return flaw;
  if (const char* flaw = flaw_of(s.environment, s)) return std::string("environment: ") + flaw;
  if (!is_finite(narrowed(s.origin))) return "its origin is not finite";
  if (!is_finite(s.up) || !has_unit_length(s.up)) return "its upward axis has no unit length";
  if (!are_amounts(s.ambient_light)) return "its ambient light is out of range";
  if (!std::all_of(s.warnings.begin(), s.warnings.end(), is_one_line)) return "a warning of several lines";
  return std::nullopt;
}

}  // namespace zoneplate
