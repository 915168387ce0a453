// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/batch_shading.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/reflection/layers.h"
#include "zoneplate/shade/shadow/receivers.h"
#include "zoneplate/shade/surface/geometry_lanes.h"
#include "zoneplate/shade/surface/layered_plan.h"
#include "zoneplate/shade/texture/area_filters.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {

/// From vertices to fragments: positions and tangents in world space, normals in the mesh's space.
void BatchShading::interpolate(const SurfaceConstants::Needs& needs) {
  const Attributes& attributes = needs.attributes;
  fetch_vertex_records(d.records, batch, vertices);
  if (needs.interpolation.quads > 0) kernels.interpolate(batch, vertices, needs.interpolation, p);
  if (attributes.object_position)
    for (int c = 0; c < 3; ++c) std::copy_n(p.position[c], p.count, p.object_position[c]);
  if (attributes.position) kernels.transform_positions(batch, vertices, d.transforms.data(), p);
  if (!attributes.tangent) return;
  if (plan.has_meshes_without_tangents) make_missing_tangents(d.scene, batch, attributes.tangent_uv_set, p);
  kernels.transform_tangents(batch, vertices, d.transforms.data(), p);
}

/// The coordinates at which a slot's texture is looked up.
Footprint BatchShading::footprint(const TextureSlot& slot) {
  const auto s = slot.uv_set;
  if (!slot.is_mapped) {
    return {p.uv[s][0],
            p.uv[s][1],
            p.uv_dx[s][0],
            p.uv_dx[s][1],
            p.uv_dy[s][0],
            p.uv_dy[s][1],
            batch.has_uniform_derivatives};
  }
  kernels.map_coordinates(slot.map, batch, p, s, coordinates);
  const Coordinates& c = coordinates;
  return {c.uv[0], c.uv[1], c.dx[0], c.dx[1], c.dy[0], c.dy[1], batch.has_uniform_derivatives};
}

/// The random numbers of a fragment depend on its position, in 1/256 pixel: all textures of a fragment share them, and
/// the samples of a pixel, or frames whose samples move, have others.
void BatchShading::evaluate_random() {
  random = std::make_unique<float[]>(3 * FragmentBatch::padded_capacity);
  for (int i = 0; i < p.count; ++i) {
    const std::uint32_t key = hash(static_cast<std::uint32_t>(batch.x[i]), static_cast<std::uint32_t>(batch.y[i]));
    for (std::uint32_t n = 0; n < 3; ++n)
      random[n * FragmentBatch::padded_capacity + static_cast<std::size_t>(i)] = unit_float(hash(key, n));
  }
}

/// Samples the slot's texture at the fragments. Slots with the same size and sampler share their taps.
void BatchShading::sample(const TextureSlot& slot, float* const out[4]) {
  const bool has_taps = slot.filtering.kind == TextureFilter::Kind::BySampler && slot.filtering.anisotropy == 1;
  if (!has_taps || taps_of == nullptr || !share_taps(*taps_of, slot)) return sample(slot, footprint(slot), out);
  d.filtering.mix_taps(slot.texture->view(), taps, out, p.count);
}

/// Samples the slot's texture at these coordinates.
void BatchShading::sample(const TextureSlot& slot, Footprint at, float* const out[4]) {
  if (slot.filtering.kind != TextureFilter::Kind::BySampler) {
    if (slot.filtering.kind == TextureFilter::Kind::Stochastic) {
      if (random == nullptr) evaluate_random();
      for (int n = 0; n < 3; ++n) at.random[n] = random.get() + n * FragmentBatch::padded_capacity;
    }
    return sample_area(*slot.texture, slot.filtering, at, out, p.count);
  }
  if (slot.filtering.anisotropy > 1)
    return d.filtering.sample_anisotropic(slot.texture->view(), slot.filtering, at, out, p.count);
  d.filtering.compute_taps(slot.texture->view(), slot.filtering, at, taps, p.count);
  taps_of = &slot;
  d.filtering.mix_taps(slot.texture->view(), taps, out, p.count);
}

/// base = factor × texture × vertex colour.
void BatchShading::evaluate_base() {
  const bool is_textured = !is_corner && plan.slot(TextureSlotIndex::BaseColor).texture != nullptr;
  float* const base[4] = {p.base[0], p.base[1], p.base[2], p.base[3]};
  if (is_textured) sample(plan.slot(TextureSlotIndex::BaseColor), base);
  for (int c = 0; c < 4; ++c) {
    if (!is_textured) {
      kernels.fill(p.base[c], plan.factor[c], p.count);
    } else if (plan.factor[c] != 1) {
      kernels.scale(p.base[c], p.base[c], plan.factor[c], 0, p.count);
    }
    if (plan.attributes.color) kernels.multiply(p.base[c], p.color[c], p.count);
  }
  // The alpha of a texture lies in [0, 1] already.
  const bool may_leave = plan.attributes.color || !(plan.factor[3] >= 0 && plan.factor[3] <= 1);
  if (plan.alpha_mode != AlphaMode::Opaque && may_leave) kernels.saturate(p.base[3], p.count);
}

/// Multiplies the base colour by the solid texture at the fragments' positions in object space.
void BatchShading::apply_solid_texture() {
  SolidPoints positions;
  for (int c = 0; c < 3; ++c) {
    stages::fill_repeated(batch, p.count, p.object_dx[c]);
    stages::fill_repeated(batch, p.count, p.object_dy[c]);
    positions.position[c] = p.object_position[c];
    positions.dx[c] = p.object_dx[c], positions.dy[c] = p.object_dy[c];
  }
  d.solid.evaluate(plan.solid_texture, positions, texel, p.count);
  for (int c = 0; c < 3; ++c) kernels.multiply(p.base[c], texel[c], p.count);
}

void BatchShading::evaluate_normals(const TextureSlot& normal_map, float scale) {
  if (normal_map.texture == nullptr) return kernels.compute_normals(batch, vertices, d.transforms.data(), p);
  kernels.transform_normals(batch, vertices, d.transforms.data(), p);
  sample(normal_map, texel);
  kernels.bend_normals(batch, texel, scale, p);
}

/// The clear coat has its own normal map, or none. The interpolated normals stay in `p` for the surface's own.
void BatchShading::evaluate_coat_normals() {
  alignas(64) ShadingState::Array interpolated[3];
  const auto copy = [&](const float* from, float* to) { std::copy_n(from, p.count, to); };
  for (int c = 0; c < 3; ++c) copy(p.normal[c], interpolated[c]);
  evaluate_normals(plan.layers->slot(LayerSlotIndex::ClearcoatNormal), plan.layers->layers.clearcoat_normal_scale);
  for (int c = 0; c < 3; ++c) copy(p.normal[c], q.clearcoat_normal[c]), copy(interpolated[c], p.normal[c]);
}

/// The normals of the triangles' planes, in the mesh's space; those of lines and points stay.
void BatchShading::flatten_normals() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(p.count); ++i) {
    float3 corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const float* const record =
          vertices.first != nullptr ? vertices.first + vertices.stride * batch.vertex[k][i] : vertices.record[k][i];
      corner[k] = {record[3], record[4], record[5]};
    }
    const float3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    // Of any scale: the normals of tiny and huge triangles stay in range.
    const float greatest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    if (!(greatest > 0 && greatest <= std::numeric_limits<float>::max())) continue;
    p.normal[0][i] = normal.x / greatest, p.normal[1][i] = normal.y / greatest, p.normal[2][i] = normal.z / greatest;
  }
}

void BatchShading::evaluate_normals() {
  if (is_corner && d.view.shading_frequency == ShadingFrequency::Triangle) flatten_normals();
  if (plan.widens_by_curvature && !is_corner) kernels.compute_normal_variance(batch, vertices, d.transforms.data(), p);
  if (plan.layers != nullptr && plan.layers->uniforms.has_clearcoat) evaluate_coat_normals();
  evaluate_normals(plan.slot(TextureSlotIndex::Normal), plan.normal_scale);
  if (plan.has_bumps) tilt_normals();
}

/// Adds the variance of the normals that the pixel covers: to the roughness, or to the lobes of lights.
void BatchShading::widen_roughness() {
  if (plan.layers == nullptr && plan.slot(TextureSlotIndex::MetallicRoughness).texture == nullptr) {
    kernels.fill(p.roughness, plan.roughness, p.count);
    kernels.fill(p.metallic, plan.metallic, p.count);
  }
  const bool has_lobes = plan.has_turning_lobes();
  if (!plan.widens_by_curvature || is_corner) {
    kernels.fill(p.normal_variance, 0, p.count);
    for (int c = 0; c < 3 && has_lobes; ++c)
      kernels.fill(p.normal_dx[c], 0, p.count), kernels.fill(p.normal_dy[c], 0, p.count);
  }
  if (plan.normal_spread != nullptr) {
    const TextureSlot& slot = plan.slot(TextureSlotIndex::Normal);
    SamplerState sampler = slot.filtering;
    if (sampler.kind != TextureFilter::Kind::BySampler)
      sampler.kind = TextureFilter::Kind::BySampler, sampler.anisotropy = 1;
    if (sampler.anisotropy > 1) {
      d.filtering.sample_anisotropic(*plan.normal_spread, sampler, footprint(slot), texel, p.count);
    } else {
      d.filtering.compute_taps(*plan.normal_spread, sampler, footprint(slot), taps, p.count);
      d.filtering.mix_taps(*plan.normal_spread, taps, texel, p.count);
      taps_of = nullptr;
    }
    const float scale2 = plan.normal_scale * plan.normal_scale;
    for (int i = 0; i < p.count; ++i) {
      const float toksvig = 2 * (1 - texel_values[0][i]) / std::max(texel_values[0][i], 0x1p-10f);
      p.normal_variance[i] += scale2 * (plan.has_slope_variance ? texel_values[1][i] + texel_values[2][i] : toksvig);
    }
    if (has_lobes) turn_lobes(2 * scale2);
  }
  if (!has_lobes) kernels.widen_roughness(p);
}

/// Adds the covariance of the normal map's slopes, times `scale`, to the matrix a aᵀ + b bᵀ of the lobes. The vectors a
/// and b become its Cholesky factor in the tangent space.
void BatchShading::turn_lobes(float scale) {
  const auto at = [](const ShadingState::Array* of, int i) { return float3{of[0][i], of[1][i], of[2][i]}; };
  const auto store = [](float3 v, ShadingState::Array* to, int i) { to[0][i] = v.x, to[1][i] = v.y, to[2][i] = v.z; };
  for (int i = 0; i < p.count; ++i) {
    const float3 n = at(p.normal, i), along = at(p.tangent, i);
    const float3 t = normalize(along - n * dot(n, along), {0, 0, 0});
    const float side =
        (p.tangent[3][i] < 0) == (batch.is_front[batch.leader(static_cast<std::size_t>(i))] > 0) ? -1.0f : 1.0f;
    const float3 b = cross(n, t) * side;
    float tt = scale * texel_values[1][i], bb = scale * texel_values[2][i], tb = scale * texel_values[3][i];
    for (const float3 turn : {at(p.normal_dx, i), at(p.normal_dy, i)}) {
      const float x = dot(turn, t), y = dot(turn, b);
      tt += x * x, bb += y * y, tb += x * y;
    }
    const float first = std::sqrt(tt), mixed = first > 0 ? tb / first : 0;
    store(t * first + b * mixed, p.normal_dx, i);
    store(b * std::sqrt(std::max(bb - mixed * mixed, 0.0f)), p.normal_dy, i);
  }
}

void BatchShading::evaluate_emissive() {
  if (plan.slot(TextureSlotIndex::Emissive).texture == nullptr) return;
  sample(plan.slot(TextureSlotIndex::Emissive), texel);
  for (int c = 0; c < 3; ++c) kernels.scale(p.emissive[c], texel[c], plan.emissive_factor[c], 0, p.count);
}

/// Adds the ambient term of channels whose base colour factor is too small to divide by: it counts as emission.
void BatchShading::add_own_ambient() {
  if (!plan.has_own_ambient) return;
  const bool is_textured = !is_corner && plan.slot(TextureSlotIndex::BaseColor).texture != nullptr,
             is_occluded = d.shading_uniforms[static_cast<std::size_t>(batch.material)].has_occlusion;
  if (is_textured) sample(plan.slot(TextureSlotIndex::BaseColor), texel);
  for (int c = 0; c < 3; ++c) {
    if (plan.slot(TextureSlotIndex::Emissive).texture == nullptr)
      kernels.fill(p.emissive[c], plan.emissive_factor[c], p.count);
    if (is_textured)
      kernels.scale(texel[c], texel[c], plan.own_ambient[c], 0, p.count);
    else
      kernels.fill(texel[c], plan.own_ambient[c], p.count);
    if (plan.attributes.color) kernels.multiply(texel[c], p.color[c], p.count);
    if (is_occluded) kernels.multiply(texel[c], p.occlusion, p.count);
    for (int i = 0; i < p.count; ++i) p.emissive[c][i] += texel[c][i];
  }
}

/// occlusion = 1 + strength (texture - 1).
void BatchShading::evaluate_occlusion() {
  if (plan.slot(TextureSlotIndex::Occlusion).texture == nullptr) return;
  sample(plan.slot(TextureSlotIndex::Occlusion), texel);
  kernels.scale(p.occlusion, texel[0], plan.occlusion_strength, 1 - plan.occlusion_strength, p.count);
}

void BatchShading::evaluate_metallic() {
  if (plan.slot(TextureSlotIndex::MetallicRoughness).texture == nullptr) return;
  sample(plan.slot(TextureSlotIndex::MetallicRoughness), texel);
  kernels.scale(p.roughness, texel[1], plan.roughness, 0, p.count);
  kernels.scale(p.metallic, texel[2], plan.metallic, 0, p.count);
}

/// The part of each light, and of the environment, that reaches the fragments.
void BatchShading::evaluate_visibility() {
  const LightVisibility& visibility = *d.view.visibility;
  Receivers receivers;
  const auto record = [this](std::size_t k, std::size_t i) {
    return vertices.first != nullptr ? vertices.first + vertices.stride * batch.vertex[k][i] : vertices.record[k][i];
  };
  const float(&towards)[3] = d.viewpoint.towards;
  make_receivers(d.scene, batch, record, {d.view.eye, {towards[0], towards[1], towards[2]}, d.view.is_orthographic},
                 visibility.needs_footprint(), receivers);
  receivers.is_transmissive = plan.layers != nullptr && (plan.layers->uniforms.has_transmission ||
                                                         plan.layers->uniforms.has_diffuse_transmission);
  constexpr std::size_t stride = FragmentBatch::padded_capacity;
  light_visibility = std::make_unique<float[]>(d.lights.size() * stride);
  const auto pad = [&](float* visible) {
    std::fill(visible + batch.count, visible + batch.padded(), visible[batch.count - 1]);
  };
  for (std::size_t k = 0; k < d.lights.size(); ++k) {
    visibility.of_light(static_cast<int>(k), receivers, &light_visibility[k * stride]);
    pad(&light_visibility[k * stride]);
  }
  if (!d.lights.empty()) p.light_visibility = light_visibility.get();
  if (!visibility.has_occlusion()) return;
  visibility.of_environment(receivers, texel[0]);
  pad(texel[0]);
  if (plan.slot(TextureSlotIndex::Occlusion).texture == nullptr)
    std::copy_n(texel[0], p.count, p.occlusion);
  else
    kernels.multiply(p.occlusion, texel[0], p.count);
}

/// specular = factor × texture, exponent = factor × texture, at least 1.
void BatchShading::evaluate_highlight() {
  if (!plan.has_specular) return;
  if (plan.slot(TextureSlotIndex::Specular).texture != nullptr) {
    sample(plan.slot(TextureSlotIndex::Specular), texel);
    for (int c = 0; c < 3; ++c) kernels.scale(p.specular[c], texel[c], plan.specular[c], 0, p.count);
  }
  if (plan.slot(TextureSlotIndex::Exponent).texture == nullptr) return;
  sample(plan.slot(TextureSlotIndex::Exponent), texel);
  for (int i = 0; i < p.count; ++i) p.exponent[i] = std::max(texel[0][i] * plan.exponent.value, 1.0f);
}

/// The thickness of the volume in the world: scaled as its instance is along the ray that enters the volume.
void BatchShading::evaluate_thickness() {
  using F = scalar::Float;
  const stages::Viewer<F> viewer(d.viewpoint);
  const float eta = 1 / plan.layers->uniforms.ior;
  for (std::size_t i = 0; i < static_cast<std::size_t>(p.count); ++i) {
    const std::size_t group = i / FragmentBatch::group;
    const std::size_t at = vertices.one_instance[group] ? batch.leader(group * FragmentBatch::group) : i;
    const InstanceTransform& transform = d.transforms[batch.instance[at]];
    if (transform.scale_along == 0) {
      q.thickness[i] *= transform.scale;
      continue;
    }
    const auto fragment = static_cast<int>(i);
    const auto n = Vector<F>::load(p.normal, fragment), v = viewer.direction(batch, p, fragment);
    const Vector<F> ray = refracted(n, v, min(max(dot(n, v), F(0.0f)), F(1.0f)), F(eta));
    float square = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float* const m = transform.normal + 3 * c;
      const float along = m[0] * ray.x.v + m[1] * ray.y.v + m[2] * ray.z.v;
      square += along * along;
    }
    q.thickness[i] *= transform.scale_along / std::max(std::sqrt(square), 1e-30f);
  }
}

/// The environment's mixed levels for the lobes of the material.
void BatchShading::evaluate_mixed_levels() {
  const auto level = [&](LevelMix* mix) { return mix != nullptr ? mix->for_lookups(p.count) : MixedLevel{}; };
  const SurfaceConstants::Lobes& lobes = d.lobes[static_cast<std::size_t>(batch.material)];
  p.mixed = level(lobes.base), p.coat_mixed = level(lobes.coat);
}

void BatchShading::light_layered(FragmentOutputs& out) {
  const LayeredPlan& layered = *plan.layers;
  const auto values = [&](const TextureSlot& slot) {
    sample(slot, texel);
    return texel;
  };
  evaluate_layers(layered, kernels, p.count, values, q);
  if (layered.uniforms.has_volume) evaluate_thickness();
  if (plan.slot(TextureSlotIndex::MetallicRoughness).texture == nullptr) {
    kernels.fill(p.metallic, plan.metallic, p.count);
    kernels.fill(p.roughness, plan.roughness, p.count);
  }
  if (const std::optional<float> glossiness = layered.layers.glossiness) {
    const bool is_textured = layered.has(LayerSlotIndex::SpecularColor);
    if (is_textured)
      kernels.scale(p.roughness, values(layered.slot(LayerSlotIndex::SpecularColor))[3], -*glossiness, 1, p.count);
    else
      kernels.fill(p.roughness, 1 - *glossiness, p.count);
  }
  if (plan.widens()) widen_roughness();
  evaluate_mixed_levels();
  kernels.light_layered(d.shading_uniforms[static_cast<std::size_t>(batch.material)], layered.uniforms, batch, p, q,
                        out);
}

/// From base colour and normal to the fragment's colour, or to the component of it that the view selects.
void BatchShading::light(FragmentOutputs& out) {
  light_whole(out);
  if (d.view.component == LightComponent::All) return;
  kernels.keep_component(d.view.component, d.shading_uniforms[static_cast<std::size_t>(batch.material)],
                         plan.layers != nullptr ? &plan.layers->uniforms : nullptr, batch, p, q, out);
}

/// The colour of surfaces without lighting counts as emission.
void BatchShading::unlit(FragmentOutputs& out) {
  kernels.unlit(plan.alpha_mode == AlphaMode::Blend, p, out);
  if (d.view.component == LightComponent::All || d.view.component == LightComponent::Emission) return;
  for (float* const channel : {out.r, out.g, out.b}) kernels.fill(channel, 0, p.count);
}

void BatchShading::light_whole(FragmentOutputs& out) {
  evaluate_occlusion();
  if (d.view.visibility != nullptr) evaluate_visibility();
  evaluate_emissive();
  add_own_ambient();
  if (plan.has_bare_meshes) mark_lit(d.scene, batch, p.is_lit);
  const bool is_metallic = plan.model == ShadingModel::MetallicRoughness;
  if (is_metallic) evaluate_metallic();
  if (plan.layers != nullptr) return light_layered(out);
  if (is_metallic && plan.widens()) widen_roughness();

  const ShadingUniforms& uniforms = d.shading_uniforms[static_cast<std::size_t>(batch.material)];
  if (is_metallic && uniforms.map != nullptr) {
    evaluate_mixed_levels();
    kernels.light_metallic_in_map(uniforms, batch, p, out);
  } else if (is_metallic) {
    kernels.light_metallic(uniforms, batch, p, out);
  } else {
    evaluate_highlight();
    kernels.light_phong(uniforms, batch, p, out);
  }
}

void BatchShading::shade_color(FragmentOutputs& out) {
  interpolate(d.needs_of_color[static_cast<std::size_t>(batch.material)]);
  evaluate_base();
  if (plan.attributes.normal) evaluate_normals();
  light(out);
}

}  // namespace zoneplate
