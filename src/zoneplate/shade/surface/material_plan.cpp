// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/material_plan.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/shade/surface/components.h"
#include "zoneplate/shade/surface/layered_plan.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

/// True if the slot's texture affects the material's colour.
bool uses_slot(const Material& m, TextureSlotIndex slot) {
  if (slot == TextureSlotIndex::BaseColor) return true;
  if (m.model == ShadingModel::Unlit) return false;
  if (slot == TextureSlotIndex::Emissive) return true;  // an animation may change a black factor
  if (slot == TextureSlotIndex::Specular || slot == TextureSlotIndex::Exponent)
    return m.model != ShadingModel::MetallicRoughness && m.specular != float3{};
  return slot != TextureSlotIndex::MetallicRoughness || m.model == ShadingModel::MetallicRoughness;
}

TexelMeaning meaning_of(bool is_color) { return is_color ? TexelMeaning::Color : TexelMeaning::Values; }

/// Calls use(slot index, texture use, meaning) for every slot whose texture affects the material's colour.
template <class Use>
void for_used_slots(const Material& m, Use use) {
  for (std::size_t i = 0; i < texture_slot_count; ++i) {
    const MaterialTextureSlot& slot = material_texture_slots[i];
    if (uses_slot(m, static_cast<TextureSlotIndex>(i))) use(i, m.*slot.use, meaning_of(slot.is_color));
  }
}

/// The same for the slots of the material's layers. Requires: it has layers.
template <class Use>
void for_used_layer_slots(const Material& m, Use use) {
  for (std::size_t i = 0; i < layer_texture_slot_count; ++i) {
    const LayerTextureSlot& slot = layer_texture_slots[i];
    if (uses_slot(*m.layers, static_cast<LayerSlotIndex>(i))) use(i, (*m.layers).*slot.use, meaning_of(slot.is_color));
  }
}

TextureSlot make_slot(const TextureUse& use, const Texture* texture, const ViewUniforms& view) {
  TextureSlot slot{texture, make_filtering(use.sampler, view.anisotropy, view.texture_filter), coordinate_map(use),
                   false, use.uv_set == 1 ? 1 : 0};
  slot.is_mapped = !(slot.map == CoordinateMap{});
  return slot;
}

void copy_factors(const Material& m, MaterialPlan& plan) {
  plan.model = m.model;
  plan.alpha_mode = m.alpha_mode;
  plan.solid_texture = m.solid_texture;
  plan.factor[0] = m.base_color.x, plan.factor[1] = m.base_color.y;
  plan.factor[2] = m.base_color.z, plan.factor[3] = m.base_color.w;
  plan.metallic = std::clamp(m.metallic, 0.0f, 1.0f);
  plan.roughness = std::clamp(m.roughness, 0.0f, 1.0f);
  copy(m.emissive, plan.emissive_factor);
  plan.normal_scale = m.normal_scale;
  plan.height_scale = m.height_scale;
  plan.occlusion_strength = std::clamp(m.occlusion_strength, 0.0f, 1.0f);
  copy(m.specular, plan.specular);
  plan.exponent = make_exponent(std::clamp(m.exponent, 0.0f, 1e5f));
}

/// Diffuse and ambient light are added up before the multiplication with the base colour, which is cheapest. The
/// ambient term is ambient × light × the base colour that a factor of 1 would give.
void plan_ambient(const Material& m, const ViewUniforms& s, MaterialPlan& plan) {
  constexpr float min_divisor = 0x1p-32f;
  if (m.model != ShadingModel::BlinnPhong && m.model != ShadingModel::Phong) return;
  const float ambient[3] = {m.ambient.x, m.ambient.y, m.ambient.z};
  const float light[3] = {s.ambient_light.x, s.ambient_light.y, s.ambient_light.z};
  for (int c = 0; c < 3; ++c) {
    if (plan.factor[c] >= min_divisor)
      plan.ambient_factor[c] = ambient[c] / plan.factor[c] * light[c];
    else
      plan.own_ambient[c] = ambient[c] * light[c];
    if (plan.own_ambient[c] > 0) plan.has_own_ambient = true;
  }
}

void resolve_slots(const Material& m, const TextureSet& textures, const ViewUniforms& view, MaterialPlan& plan) {
  const auto slot_of = [&](const TextureUse& use, TexelMeaning meaning) {
    return make_slot(use, textures.find(use, meaning), view);
  };
  for_used_slots(
      m, [&](std::size_t i, const TextureUse& use, TexelMeaning meaning) { plan.slots[i] = slot_of(use, meaning); });
  if (!has_layers(m)) return;
  LayeredPlan layers{.layers = *m.layers, .slots = {}, .uniforms = make_layered_uniforms(*m.layers)};
  for_used_layer_slots(
      m, [&](std::size_t i, const TextureUse& use, TexelMeaning meaning) { layers.slots[i] = slot_of(use, meaning); });
  const float3 color = m.layers->specular_color;
  layers.uniforms.has_grey_interface =
      color.x == color.y && color.y == color.z && !layers.has(LayerSlotIndex::SpecularColor);
  plan.layers = std::make_shared<const LayeredPlan>(std::move(layers));
}

void plan_specular_aa(SpecularAntialiasing kind, MaterialPlan& plan) {
  using Kind = SpecularAntialiasing;
  plan.widens_by_curvature = kind == Kind::Geometric || kind == Kind::Full;
  plan.has_slope_variance = kind == Kind::Lean || kind == Kind::Full;
  const Texture* const normals = plan.slot(TextureSlotIndex::Normal).texture;
  if (normals == nullptr) plan.has_slope_variance = false;
  if (normals != nullptr && (kind == Kind::Toksvig || plan.has_slope_variance))
    plan.normal_spread = &normals->normal_spread();
}

/// Decides which stages are needed, from the lights and textures that exist.
void decide(const ViewUniforms& s, const Material& m, MaterialPlan& plan) {
  const bool is_metallic = m.model == ShadingModel::MetallicRoughness;
  const bool has_lights = !s.lights.empty();
  const bool reflects_environment = s.environment != float3{} && (is_metallic || s.map);
  const bool has_places = std::any_of(s.lights.begin(), s.lights.end(),
                                      [](const Light& light) { return light.kind != LightKind::Directional; });
  plan.is_lit = m.model != ShadingModel::Unlit;
  const bool uses_normal = plan.is_lit && (has_lights || plan.layers != nullptr || reflects_environment);
  plan.has_specular = plan.is_lit && !is_metallic && (has_lights || reflects_environment) && m.specular != float3{};
  plan.has_emissive = plan.is_lit && m.emissive != float3{};
  plan.needs_viewer = uses_normal && (is_metallic || plan.has_specular);
  TextureSlot &normal = plan.slot(TextureSlotIndex::Normal), &height = plan.slot(TextureSlotIndex::Height);
  if (!uses_normal) normal.texture = nullptr;
  if (!plan.has_emissive) plan.slot(TextureSlotIndex::Emissive).texture = nullptr;
  if (height.texture != nullptr) plan.parallax_layers = m.parallax_layers;
  plan.has_bumps = uses_normal && height.texture != nullptr && normal.texture == nullptr;
  if (!plan.has_bumps && plan.parallax_layers == 0) height.texture = nullptr;
  if (plan.parallax_layers > 0) plan.needs_viewer = true;
  if (uses_normal && is_metallic) plan_specular_aa(s.specular_aa, plan);

  Attributes& a = plan.attributes;
  a.position = (plan.needs_viewer && !s.is_orthographic && !s.rays) || (uses_normal && has_places);
  a.normal = uses_normal;
  a.normal_change = plan.widens_by_curvature;
  a.object_position = m.solid_texture.pattern != SolidPattern::None;
  a.tangent = normal.texture != nullptr;
  a.tangent_uv_set = tangent_uv_set(m);
  const auto use_coordinates = [&](const TextureSlot& slot) {
    if (slot.texture != nullptr) a.uv[slot.uv_set] = true;
  };
  for (const TextureSlot& slot : plan.slots) use_coordinates(slot);
  if (plan.layers == nullptr) return;
  for (const TextureSlot& slot : plan.layers->slots) use_coordinates(slot);
  // Where light leaves a volume depends on where it enters.
  const bool has_pixels = s.shading_frequency == ShadingFrequency::Fragment;
  if (s.backdrop && (plan.layers->uniforms.has_volume || !has_pixels)) a.position = true;
  if (plan.layers->uniforms.has_anisotropy || plan.layers->has(LayerSlotIndex::ClearcoatNormal)) a.tangent = true;
}

}  // namespace

TextureSet::TextureSet(const Scene& scene, const MipOptions& mips) : TextureSet(mips) {
  collect_uses(scene);
  for (auto& [key, entry] : textures_)
    entry.texture =
        std::make_unique<Texture>(scene.images[static_cast<std::size_t>(key.first)].pixels, key.second, entry.options);
}

TextureSet TextureSet::take(Scene& scene, const MipOptions& mips) {
  TextureSet set(mips);
  set.collect_uses(scene);
  auto next = set.textures_.begin();
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    TexelImage& pixels = scene.images[i].pixels;
    const auto is_of_this = [&] { return next != set.textures_.end() && next->first.first == static_cast<int>(i); };
    while (is_of_this()) {
      auto& [key, entry] = *next++;
      entry.texture = is_of_this() ? std::make_unique<Texture>(pixels, key.second, entry.options)
                                   : std::make_unique<Texture>(std::move(pixels), key.second, entry.options);
    }
    pixels = TexelImage();
  }
  return set;
}

void TextureSet::collect_uses(const Scene& scene) {
  for (const TextureImage& image : scene.images) is_light_.push_back(image.pixels.kind() == TexelKind::Light);
  for (const Material& material : scene.materials) {
    const auto add = [&](std::size_t, const TextureUse& use, TexelMeaning meaning) {
      if (use.image < 0) return;
      const TextureImage& image = scene.images.at(static_cast<std::size_t>(use.image));
      if (image.pixels.empty()) throw Error(ErrorKind::Input, "texture " + image.name + ": has no texels");
      LevelOptions options{mips_.filter, use.sampler.wrap_u, use.sampler.wrap_v, {}};
      // A cutoff of 0 leaves every texel visible.
      const bool has_alpha = (material.alpha_mode == AlphaMode::Blend ||
                              (material.alpha_mode == AlphaMode::Mask && material.alpha_cutoff > 0)) &&
                             &use == &material.base_color_texture;
      if (mips_.keeps_coverage && has_alpha && material.alpha_mode == AlphaMode::Mask)
        options.kept_cutoff = material.alpha_cutoff;
      options.weights_by_alpha = mips_.weights_by_alpha && has_alpha;
      const auto [entry, is_new] = textures_.try_emplace(key_of(use.image, meaning), Entry{options, nullptr});
      // Where a use ignores alpha, no texel hides its colour.
      if (!is_new) entry->second.options.weights_by_alpha &= options.weights_by_alpha;
    };
    for_used_slots(material, add);
    if (material.layers == nullptr || material.model != ShadingModel::MetallicRoughness) continue;
    // Also those of layers whose factor is 0, which an animation may change.
    for (const LayerTextureSlot& slot : layer_texture_slots)
      add(0, (*material.layers).*slot.use, meaning_of(slot.is_color));
  }
}

TextureSet::Key TextureSet::key_of(int image, TexelMeaning meaning) const {
  const bool is_raw = mips_.raw_colors && !is_light_[static_cast<std::size_t>(image)];
  return {image, is_raw ? TexelMeaning::Values : meaning};
}

const Texture* TextureSet::find(const TextureUse& use, TexelMeaning meaning) const {
  if (use.image < 0) return nullptr;
  const auto found = textures_.find(key_of(use.image, meaning));
  return found == textures_.end() ? nullptr : found->second.texture.get();
}

CoordinateMap coordinate_map(const TextureUse& use) {
  const float c = cos(use.rotation), s = sin(use.rotation);
  return {{use.scale.x * c, use.scale.y * s, use.offset.x, -(use.scale.x * s), use.scale.y * c, use.offset.y}};
}

bool share_taps(const TextureSlot& a, const TextureSlot& b) {
  const TextureView &s = a.texture->view(), &t = b.texture->view();
  return s.width[0] == t.width[0] && s.height[0] == t.height[0] && a.uv_set == b.uv_set && a.filtering == b.filtering &&
         a.map == b.map;
}

std::vector<MaterialPlan> make_plans(const Scene& scene, const ViewUniforms& view, const TextureSet& textures) {
  std::vector<MaterialPlan> plans(scene.materials.size());
  for (std::size_t i = 0; i < plans.size(); ++i) {
    copy_factors(scene.materials[i], plans[i]);
    plan_ambient(scene.materials[i], view, plans[i]);
    resolve_slots(scene.materials[i], textures, view, plans[i]);
    decide(view, scene.materials[i], plans[i]);
  }

  // All batches of a material have the stages that any of its meshes needs.
  for (const Mesh& mesh : scene.meshes) {
    MaterialPlan& plan = plans[static_cast<std::size_t>(mesh.material)];
    if (!mesh.color.empty()) plan.attributes.color = true;
    if (mesh.normal.empty()) plan.has_bare_meshes = true;
    if (mesh.tangent.empty()) plan.has_meshes_without_tangents = true;
  }
  return plans;
}

}  // namespace zoneplate
