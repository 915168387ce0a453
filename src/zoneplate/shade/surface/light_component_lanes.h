// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/scene/light.h"
#include "zoneplate/shade/surface/layered_lanes.h"

/// The stage of shade/surface/shading.h that replaces the colour of fragments by one component of it, over the lane
/// types of math/lanes.h. It runs after the stage that lights them, so that the colour itself costs nothing more.
namespace zoneplate::stages {

/// The components of a colour but the specular one, which is the rest.
template <class F>
struct LightComponents {
  Vector<F> diffuse, transmitted, emitted;
};

/// Emission, before a clear coat attenuates it.
template <class F>
[[gnu::always_inline]] inline Vector<F> emission(const ShadingUniforms& s, const ShadingState& p, int i) {
  if (s.has_emissive_texture) return Vector<F>::load(p.emissive, i);
  return s.has_emissive ? Vector<F>::all(s.emissive) : zeros<F>();
}

/// The irradiance of all lights at a surface of normal n, over π where `scale` is 1 / π.
template <class F>
[[gnu::always_inline]] inline Vector<F> irradiance(const ShadingUniforms& s, const ShadingState& p, Vector<F> n,
                                                   float scale, int i) {
  Vector<F> sum = zeros<F>();
  for (int k = 0; k < s.lights; ++k) {
    const Arriving<F> light = arriving<F>(s.light[k], false, p, i);
    sum = sum + visible(light.radiance, p, k, i) * (lambert(dot(n, light.from)) * F(scale));
  }
  return sum;
}

/// The light of an environment map, or of one colour, chosen for each direction: half the code of one function for
/// each.
template <class F>
struct AnyRadiance {
  const ShadingUniforms& s;
  Vector<F> specular(Vector<F> direction, F roughness) const {
    return s.map != nullptr ? MappedRadiance<F>::of_roughness(*s.map, direction, roughness)
                            : Vector<F>::all(s.environment);
  }
  Vector<F> diffuse(Vector<F> normal) const {
    return s.map != nullptr ? diffuse_light(*s.map, normal) : Vector<F>::all(s.environment);
  }
};

template <class F>
[[gnu::always_inline]] inline LightComponents<F> phong_components(const ShadingUniforms& s, const AnyUniforms& kind,
                                                                  const ShadingState& p, int i) {
  const auto n = Vector<F>::load(p.normal, i), ambient = Vector<F>::all(s.ambient);
  Vector<F> arriving = unoccluded(kind, p, ambient, i) + irradiance(s, p, n, 1, i);
  if (kind.has_map) arriving = arriving + unoccluded(kind, p, diffuse_light(*s.map, n), i);
  return {Vector<F>::load(p.base, i) * arriving, zeros<F>(), emission<F>(s, p, i)};
}

template <class F>
[[gnu::always_inline]] inline LightComponents<F> metallic_components(const ShadingUniforms& s, const AnyUniforms& kind,
                                                                     const ShadingState& p, Vector<F> v, int i) {
  const F one(1.0f), zero(0.0f);
  const auto n = Vector<F>::load(p.normal, i), base = Vector<F>::load(p.base, i);
  const F metallic = s.has_material_texture ? F::load(p.metallic + i) : F(s.metallic);
  F roughness = s.has_material_texture ? F::load(p.roughness + i) : F(s.roughness);
  if (s.has_turning_normals) roughness = widened(roughness, F::load(p.normal_variance + i));
  const SpecularWeights<F> weights = SpecularFit<F>(roughness).at(min(max(dot(n, v), zero), one));
  const F below = (one - specular_albedo(weights, F(0.04f))) * (one - metallic);
  Vector<F> sum = base * (irradiance(s, p, n, inverse_pi, i) * below);
  if (s.has_environment) {
    const Vector<F> bounded{min(base.x, one), min(base.y, one), min(base.z, one)};
    sum = sum + unoccluded(kind, p, AnyRadiance<F>{s}.diffuse(n), i) * bounded * below;
  }
  return {sum, zeros<F>(), emission<F>(s, p, i)};
}

/// Light that passes through the surface without being scattered is transmitted; that of diffuse transmission is
/// diffuse.
template <class F>
LightComponents<F> layered_components(const ShadingUniforms& s, const LayeredUniforms& u, const LobeRows<F>& rows,
                                      const AnyUniforms& kind, const FragmentBatch& batch, const ShadingState& p,
                                      const LayerState& q, Vector<F> v, int i) {
  const F one(1.0f), zero(0.0f);
  const AnyRadiance<F> around{s};
  const LayeredSurface<F> surface = make_surface<F>(u, rows, p, q, v, i);
  const Vector<F> dark = zeros<F>();
  Vector<F> front = irradiance(s, p, surface.n, inverse_pi, i), back = dark, through = dark;
  if (u.has_diffuse_transmission) back = irradiance(s, p, dark - surface.n, inverse_pi, i);
  if (u.has_transmission) {
    const F rough = max(surface.through_roughness, F(min_roughness));
    for (int k = 0; k < s.lights; ++k) {
      const Arriving<F> light = arriving<F>(s.light[k], false, p, i);
      const Vector<F> l = light.from;
      const F along = dot(surface.n, l);
      const Vector<F> mirrored = select(along < zero, l - surface.n * (along + along), l);
      const F lobe = wall_lobe(max(-along, zero), surface.nv, highlight_alpha(rough * rough, s.light[k], light),
                               surface.n, normalize(mirrored + v));
      through = through + visible(light.radiance, p, k, i) * surface.absorbed * lobe;
    }
  }
  LightThrough<F> behind{dark, dark, zero};
  const bool has_backdrop = u.has_transmission && s.backdrop != nullptr;
  if (s.has_environment || has_backdrop) {
    const F seen = kind.has_occlusion ? F::load(p.occlusion + i) : one;
    front = front + around.diffuse(surface.n) * seen;
    if (u.has_diffuse_transmission) back = back + around.diffuse(dark - surface.n) * seen;
    if (u.has_transmission)
      behind = light_through(s, u, surface, around, batch, p, i), through = through + behind.color;
  }
  const F coat = u.has_clearcoat ? one - surface.coat_weight : one;
  const F below = surface.below_interface * (one - surface.metallic) * surface.below_sheen * coat;
  LightComponents<F> out{below_interface(u, surface, front, back, dark) * below, dark, emission<F>(s, p, i) * coat};
  if (!u.has_transmission) return out;
  out.transmitted = below_interface(u, surface, dark, dark, through) * below;
  if (!s.has_environment_behind) {
    // As light_layered leaves it out of the colour: the background is seen through the surface.
    const Vector<F> part = passing(u, surface);
    const F all_colors = min(max(min(min(part.x, part.y), part.z), zero), one);
    out.transmitted = out.transmitted - behind.beyond * all_colors;
  }
  return out;
}

/// See SurfaceKernels::keep_component.
template <class F>
void keep_component(LightComponent component, const ShadingUniforms& s, const LayeredUniforms* layers,
                    const FragmentBatch& batch, const ShadingState& p, const LayerState& q, FragmentOutputs& out) {
  const AnyUniforms kind(s);
  const Viewer<F> viewer(s.viewpoint);
  const LobeRows<F> rows(s);
  const F one(1.0f), zero(0.0f);
  const bool shows_background =
      s.has_background_color && !s.has_environment_behind && layers != nullptr && layers->has_transmission;
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto v = s.needs_viewer || layers != nullptr ? viewer.direction(batch, p, i) : zeros<F>();
    LightComponents<F> all;
    if (layers != nullptr)
      all = layered_components(s, *layers, rows, kind, batch, p, q, v, i);
    else if (s.is_metallic)
      all = metallic_components(s, kind, p, v, i);
    else
      all = phong_components<F>(s, kind, p, i);
    if (kind.has_bare_meshes) {
      const auto is_lit = F::load(p.is_lit + i) > F(0.5f);
      const Vector<F> dark = zeros<F>();
      all = {select(is_lit, all.diffuse, dark), select(is_lit, all.transmitted, dark),
             select(is_lit, all.emitted, Vector<F>::load(p.base, i))};
    }
    const F alpha = kind.is_blended ? F::load(p.base[3] + i) : one;
    const Vector<F> total{F::load(out.r + i), F::load(out.g + i), F::load(out.b + i)};
    Vector<F> kept = total - (all.diffuse + all.transmitted + all.emitted) * alpha;
    if (component == LightComponent::Diffuse) kept = all.diffuse * alpha;
    if (component == LightComponent::Transmission) {
      kept = all.transmitted * alpha;
      // What glass shows of a background of one colour, which alpha leaves to the image behind.
      if (shows_background) kept = kept + Vector<F>::all(s.background) * (alpha - F::load(out.a + i));
    }
    if (component == LightComponent::Emission) kept = all.emitted * alpha;
    const auto bounded = [&](F x) { return min(max(x, zero), F(brightest_color)); };
    bounded(kept.x).store(out.r + i), bounded(kept.y).store(out.g + i), bounded(kept.z).store(out.b + i);
  }
}

}  // namespace zoneplate::stages
