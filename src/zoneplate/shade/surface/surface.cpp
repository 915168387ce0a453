// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/surface.h"

#include <algorithm>
#include <cstddef>
#include <memory>

#include "zoneplate/shade/shadow/receivers.h"
#include "zoneplate/shade/surface/batch_shading.h"
#include "zoneplate/shade/surface/brightness.h"
#include "zoneplate/shade/surface/corners.h"
#include "zoneplate/shade/surface/surface_constants.h"
#include "zoneplate/shade/texture/area_filters.h"

namespace zoneplate {

SurfaceShader::SurfaceShader(const Scene& scene, const ViewUniforms& view, const TextureSet& textures,
                             const InterleavedVertices& records)
    : constants_(std::make_unique<SurfaceConstants>(scene, view, textures, records)),
      brightest_(brightest_fragment(constants_->plans, constants_->lights, view.environment)) {}

SurfaceShader::~SurfaceShader() = default;

void SurfaceShader::shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const {
  if (batch.count == 0) return;
  const bool is_lit = constants_->plans[static_cast<std::size_t>(batch.material)].is_lit;
  if (constants_->view.shading_frequency == ShadingFrequency::Fragment || !is_lit || !outputs.color)
    return shade_fragments(batch, outputs, out);
  shade_triangles(batch, out);
  outputs.color = false;
  if (outputs.normal || outputs.uv || outputs.albedo || outputs.footprint) shade_fragments(batch, outputs, out);
}

/// Shades the triangles of a batch at their vertices or middles, interpolates their colours, and multiplies them by the
/// textures of the base colour.
void SurfaceShader::shade_triangles(const FragmentBatch& batch, FragmentOutputs& out) const {
  const bool is_flat = constants_->view.shading_frequency == ShadingFrequency::Triangle;
  TriangleCorners corners(is_flat ? 1 : 3);
  FragmentOutputs colors;
  for (int begin = 0, end = 0; begin < batch.count; begin = end) {
    end = corners.collect(batch, begin);
    BatchShading shading(*constants_, corners.batch());
    shading.is_corner = true;
    shading.shade_color(colors);
    for (int i = begin; i < end; ++i) {
      out.r[i] = corners.at(batch, i, colors.r), out.g[i] = corners.at(batch, i, colors.g);
      out.b[i] = corners.at(batch, i, colors.b), out.a[i] = corners.at(batch, i, colors.a);
    }
  }
  BatchShading whole(*constants_, batch);
  const MaterialPlan& plan = whole.plan;
  const TextureSlot& slot = plan.slot(TextureSlotIndex::BaseColor);
  const bool is_textured = slot.texture != nullptr, is_solid = plan.attributes.object_position;
  if (!is_textured && !is_solid) return;
  Attributes attributes;
  attributes.uv[slot.uv_set] = is_textured, attributes.object_position = is_solid;
  whole.interpolate(constants_->make_needs(batch.material, attributes, false));
  auto& color = whole.p.base;
  float* const channels[4] = {color[0], color[1], color[2], color[3]};
  if (is_textured)
    whole.sample(slot, channels);
  else
    for (float* const channel : channels) whole.kernels.fill(channel, 1, whole.p.count);
  if (is_solid) whole.apply_solid_texture();
  const bool is_blended = plan.alpha_mode == AlphaMode::Blend;
  for (int i = 0; i < batch.count; ++i) {
    const float alpha = is_blended ? color[3][i] : 1;
    out.r[i] *= color[0][i] * alpha, out.g[i] *= color[1][i] * alpha;
    out.b[i] *= color[2][i] * alpha, out.a[i] *= alpha;
  }
}

void SurfaceShader::shade_fragments(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const {
  BatchShading shading(*constants_, batch);
  const MaterialPlan& plan = shading.plan;
  ShadingState& p = shading.p;

  // Data besides the colour may need more vertex attributes.
  const SurfaceConstants::Needs* needs = &constants_->needs_of_color[static_cast<std::size_t>(batch.material)];
  SurfaceConstants::Needs more;
  const TextureSlot& base = plan.slot(TextureSlotIndex::BaseColor);
  const bool has_footprint = outputs.footprint && base.texture != nullptr;
  if (outputs.normal || outputs.uv || has_footprint) {
    Attributes attributes = plan.attributes;
    if (outputs.normal) attributes.normal = true;
    if (outputs.uv || has_footprint) attributes.uv[base.uv_set] = true;
    more = constants_->make_needs(batch.material, attributes,
                                  plan.needs_viewer || (outputs.normal && plan.has_bare_meshes));
    needs = &more;
  }

  shading.interpolate(*needs);
  if (plan.parallax_layers > 0) shading.displace_coordinates();
  if (outputs.color || outputs.albedo) {
    shading.evaluate_base();
    if (needs->attributes.object_position) shading.apply_solid_texture();
  }
  if (needs->attributes.normal) shading.evaluate_normals();
  if (outputs.color && plan.is_lit)
    shading.light(out);
  else if (outputs.color)
    shading.unlit(out);

  const auto copy = [&](const float* from, float* to) { std::copy_n(from, p.count, to); };
  if (outputs.normal) {
    if (plan.has_bare_meshes) shading.kernels.default_normals(constants_->viewpoint, batch, p);
    for (int c = 0; c < 3; ++c) copy(p.normal[c], out.normal[c]);
  }
  if (outputs.albedo)
    for (int c = 0; c < 3; ++c) copy(p.base[c], out.albedo[c]);
  if (outputs.uv) {
    const Footprint at = shading.footprint(base);
    copy(at.u, out.uv[0]), copy(at.v, out.uv[1]);
  }
  if (has_footprint) {
    measure_footprints(base.texture->view(), shading.footprint(base), out.mip_level, out.anisotropy, p.count);
  } else if (outputs.footprint) {
    std::fill_n(out.mip_level, p.count, FragmentOutputs::no_mip_level);
    std::fill_n(out.anisotropy, p.count, 0.0f);
  }
}

bool SurfaceShader::needs_derivatives(int material) const {
  const Attributes& a = constants_->plans[static_cast<std::size_t>(material)].attributes;
  const LightVisibility* const visibility = constants_->view.visibility;
  return a.uv[0] || a.uv[1] || a.normal_change || a.object_position ||
         (visibility != nullptr && visibility->needs_footprint());
}

bool SurfaceShader::needs_coverage() const {
  const LightVisibility* const visibility = constants_->view.visibility;
  return visibility != nullptr && visibility->needs_coverage();
}

std::span<const float> SurfaceShader::vertex_record(std::uint32_t instance, int material) const {
  return {constants_->records.of_instance(instance),
          static_cast<std::size_t>(constants_->records.layout(material).floats)};
}

void SurfaceShader::alpha(const FragmentBatch& batch, float* out) const {
  if (batch.count == 0) return;
  BatchShading shading(*constants_, batch);
  Attributes attributes;
  attributes.color = shading.plan.attributes.color;
  if (shading.plan.slot(TextureSlotIndex::BaseColor).texture != nullptr)
    attributes.uv[shading.plan.slot(TextureSlotIndex::BaseColor).uv_set] = true;
  const bool is_displaced = shading.plan.parallax_layers > 0;
  if (is_displaced) attributes.uv[shading.plan.slot(TextureSlotIndex::Height).uv_set] = true;
  shading.interpolate(constants_->make_needs(batch.material, attributes, is_displaced));
  if (is_displaced) shading.displace_coordinates();
  shading.evaluate_base();
  std::copy_n(shading.p.base[3], shading.p.count, out);
}

}  // namespace zoneplate