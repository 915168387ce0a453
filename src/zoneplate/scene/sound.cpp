#include "zoneplate/scene/sound.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace zoneplate {
namespace {

template <class V>
bool all_finite(const std::vector<V>& values) {
  const std::span<const float> floats(reinterpret_cast<const float*>(values.data()),
                                      values.size() * sizeof(V) / sizeof(float));
  return std::all_of(floats.begin(), floats.end(), [](float f) { return std::isfinite(f); });
}

template <class V>
bool fits(const std::vector<V>& values, const Mesh& m) {
  return (values.empty() || values.size() == m.position.size()) && all_finite(values);
}

bool is_number_of(int i, std::size_t count) { return i >= 0 && static_cast<std::size_t>(i) < count; }

bool has_unit_length(float3 n) { return std::abs(dot(n, n) - 1) <= 2e-5f; }

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

const char* flaw_of(const Material& m, const Scene& s) {
  for (const TextureUse* use : {&m.base_color_texture, &m.emissive_texture, &m.normal_texture, &m.occlusion_texture,
                                &m.metallic_roughness_texture}) {
    if (use->image < 0) continue;
    if (!is_number_of(use->image, s.images.size())) return "no image of that number";
    if (use->uv_set != 0 && use->uv_set != 1) return "no texture coordinates of that number";
    if (s.images[static_cast<std::size_t>(use->image)].pixels.empty()) return "an image of nothing";
  }
  return nullptr;
}

bool is_one_line(const std::string& text) { return text.find('\n') == text.npos; }

}  // namespace

std::optional<std::string> find_flaw(const Scene& s) {
  const auto named = [](const char* what, std::size_t i, const std::string& flaw) {
    return std::string(what) + " " + std::to_string(i) + ": " + flaw;
  };
  for (std::size_t i = 0; i < s.meshes.size(); ++i)
    if (const char* flaw = flaw_of(s.meshes[i], s)) return named("mesh", i, flaw);
  for (std::size_t i = 0; i < s.materials.size(); ++i)
    if (const char* flaw = flaw_of(s.materials[i], s)) return named("material", i, flaw);
  for (std::size_t i = 0; i < s.instances.size(); ++i) {
    const Instance& instance = s.instances[i];
    if (!is_number_of(instance.mesh, s.meshes.size())) return named("instance", i, "no mesh of that number");
    if (!is_number_of(instance.object, s.objects.size())) return named("instance", i, "no object of that number");
  }
  if (!std::all_of(s.warnings.begin(), s.warnings.end(), is_one_line)) return "a warning of several lines";
  if (s.instances.empty()) return std::nullopt;
  const Box box = s.bounds();
  if (!box.empty() && !(is_finite(box.low) && is_finite(box.high))) return "its bounds are not finite";
  return std::nullopt;
}

}  // namespace zoneplate
