// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/shade/backdrop/backdrop_lanes.h"
#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/reflection/layers.h"
#include "zoneplate/shade/surface/layered.h"
#include "zoneplate/shade/surface/lighting_lanes.h"

/// The stage of shade/surface/shading.h that lights surfaces with layers, over the lane types of math/lanes.h.
///
/// From the bottom up, a surface has a base, which is a mixture of a metal and a dielectric, sheen and a clear coat.
/// The dielectric is an interface over diffuse reflection, diffuse transmission and transmission. A layer receives the
/// light that the layers above do not reflect.
namespace zoneplate::stages {

/// The layers of a material that has none but a clear coat: all that the others need is left out when the stage is
/// compiled.
struct PlainLayers : LayeredUniforms {
  static constexpr bool has_sheen = false, has_anisotropy = false, has_iridescence = false;
  static constexpr bool has_transmission = false, has_diffuse_transmission = false, has_volume = false;
  explicit PlainLayers(const LayeredUniforms& layers) : LayeredUniforms(layers) {}
};
inline bool is_plain(const LayeredUniforms& u) {
  return !(u.has_sheen || u.has_anisotropy || u.has_iridescence || u.has_transmission || u.has_diffuse_transmission);
}

/// The radiance of an environment of one colour.
template <class F>
struct ConstantRadiance {
  Vector<F> radiance;
  ConstantRadiance(const ShadingUniforms& s, const ShadingState& /*p*/) : radiance(Vector<F>::all(s.environment)) {}
  [[gnu::always_inline]] Vector<F> specular(Vector<F> /*direction*/, F /*roughness*/) const { return radiance; }
  [[gnu::always_inline]] Vector<F> of_base(Vector<F> /*direction*/, F /*roughness*/) const { return radiance; }
  [[gnu::always_inline]] Vector<F> of_coat(Vector<F> /*direction*/, F /*roughness*/) const { return radiance; }
  [[gnu::always_inline]] Vector<F> diffuse(Vector<F> /*normal*/) const { return radiance; }
};

/// The radiance of an environment map, filtered by the lobe of a roughness, and the irradiance over π. That of the base
/// and of the coat is from mixed levels, where there are some.
template <class F>
struct MappedRadiance {
  const EnvironmentView& map;
  const MixedLevel base, coat;
  MappedRadiance(const ShadingUniforms& s, const ShadingState& p) : map(*s.map), base(p.mixed), coat(p.coat_mixed) {}
  [[gnu::noinline]] static Vector<F> of_roughness(const EnvironmentView& map, const Vector<F>& direction,
                                                  const F& roughness) {
    return specular_light(map, direction, roughness);
  }
  [[gnu::always_inline]] Vector<F> specular(Vector<F> direction, F roughness) const {
    return of_roughness(map, direction, roughness);
  }
  [[gnu::always_inline]] Vector<F> of_base(Vector<F> direction, F roughness) const {
    return base.texels != nullptr ? specular_light(map, base, direction) : specular(direction, roughness);
  }
  [[gnu::always_inline]] Vector<F> of_coat(Vector<F> direction, F roughness) const {
    return coat.texels != nullptr ? specular_light(map, coat, direction) : specular(direction, roughness);
  }
  [[gnu::always_inline]] Vector<F> diffuse(Vector<F> normal) const { return diffuse_light(map, normal); }
};

/// The weights of the specular lobes: of one roughness, or of one that differs between fragments.
template <class F>
struct LobeRows {
  bool has_base, has_coat;
  SpecularRow<F> base, coat;
  explicit LobeRows(const ShadingUniforms& s)
      : has_base(s.layered_roughness >= 0),
        has_coat(s.coat_roughness >= 0),
        base(s.layered_roughness),
        coat(s.coat_roughness) {}
};

/// The surface at fragments i and on, prepared for its lights.
template <class F>
struct LayeredSurface {
  Vector<F> n, v, base;
  F nv, metallic, roughness, alpha;
  F through_roughness;  ///< of light that passes through the surface
  bool has_metal;       ///< in some lane; else nothing of the metal is set but its interface
  Interface<F> dielectric, metal;
  InterfaceShares<F> dielectric_shares, metal_shares;  ///< of the light of an environment
  F below_interface;         ///< the part of light that the dielectric interface does not reflect
  MicrofacetFrame<F> frame;  ///< where anisotropic

  F transmission, diffuse_transmission;
  Vector<F> back_color;  ///< of diffuse transmission, attenuated by the volume
  Vector<F> absorbed;    ///< the share of light that the volume lets pass
  F thickness;

  Vector<F> sheen_color;
  F sheen_roughness, sheen_cosine, sheen_lambda, sheen_scale, sheen_albedo, below_sheen;

  Vector<F> coat_n;
  F coat_nv, coat_alpha, coat_roughness, coat_weight;  ///< the latter: clearcoat × its reflectance
  F coat_gain;  ///< multiplies the coat's lobe under lights, so that it reflects the light of several reflections too
};

/// Light that passes a distance of the volume.
template <class F>
[[gnu::always_inline]] inline Vector<F> transmittance(const LayeredUniforms& u, F distance) {
  return {exp(-(F(u.absorption[0]) * distance)), exp(-(F(u.absorption[1]) * distance)),
          exp(-(F(u.absorption[2]) * distance))};
}

/// The frame of anisotropic microfacets: the direction of the tangent space, made perpendicular to the normal.
/// Fragments without a tangent have any frame.
template <class F>
[[gnu::always_inline]] inline MicrofacetFrame<F> make_frame(const ShadingState& p, const LayerState& q, Vector<F> n,
                                                            F alpha, int i) {
  const F one(1.0f), strength = F::load(q.anisotropy + i);
  const auto tangent = normalize(Vector<F>::load(p.tangent, i));
  const F sign = select(F::load(p.tangent[3] + i) < F(0.0f), F(-1.0f), one);
  const Vector<F> bitangent = cross(n, tangent) * sign;
  const Vector<F> along = tangent * F::load(q.stretch[0] + i) + bitangent * F::load(q.stretch[1] + i);
  const Vector<F> flat = normalize(along - n * dot(along, n));
  const Vector<F> x_axis{one, F(0.0f), F(0.0f)}, y_axis{F(0.0f), one, F(0.0f)};
  const Vector<F> any = normalize(cross(n, select(abs(n.x) < F(0.7f), x_axis, y_axis)));
  const Vector<F> t = select(dot(flat, flat) > F(0.5f), flat, any);
  return {t, cross(n, t), n, mix(alpha, one, strength * strength), alpha};
}

template <class F, class Layers>
[[gnu::always_inline]] inline LayeredSurface<F> make_surface(const Layers& u, const LobeRows<F>& rows,
                                                             const ShadingState& p, const LayerState& q, Vector<F> v,
                                                             int i) {
  const F one(1.0f), zero(0.0f);
  const auto bounded = [&](F x) { return min(max(x, zero), one); };
  LayeredSurface<F> s;
  s.n = Vector<F>::load(p.normal, i), s.v = v;
  s.base = Vector<F>::load(p.base, i);
  s.nv = min(max(dot(s.n, v), F(1e-4f)), one);
  s.metallic = F::load(p.metallic + i);
  const F roughness = F::load(p.roughness + i);
  s.roughness = max(roughness, F(min_roughness));
  s.through_roughness = roughness * F(u.wall_roughness);
  s.alpha = s.roughness * s.roughness;

  const F strength = F::load(q.specular + i);
  const Vector<F> white{one, one, one};
  s.dielectric = {dielectric_f0(F(u.f0_of_ior), Vector<F>::load(q.specular_color, i), strength), strength, white, zero};
  s.metal = {{min(s.base.x, one), min(s.base.y, one), min(s.base.z, one)}, one, white, zero};
  if (u.has_iridescence) {
    const F ior(u.iridescence_ior), thickness = F::load(q.film_thickness + i);
    s.dielectric.film_weight = s.metal.film_weight = where(thickness > zero, F::load(q.iridescence + i));
    s.dielectric.film = film_fresnel(ior, thickness, s.dielectric.f0, s.nv);
    s.metal.film = film_fresnel(ior, thickness, s.metal.f0, s.nv);
  }
  if (u.has_anisotropy) s.frame = make_frame<F>(p, q, s.n, s.alpha, i);
  const SpecularWeights<F> weights = rows.has_base ? rows.base.at(s.nv) : SpecularFit<F>(s.roughness).at(s.nv);
  s.dielectric_shares = interface_shares(s.dielectric, weights, u.has_iridescence, u.has_grey_interface);
  s.has_metal = !is_dielectric(s.metallic);
  if (s.has_metal) s.metal_shares = interface_shares(s.metal, weights, u.has_iridescence, false);
  s.below_interface = one - min(max_channel(s.dielectric_shares.mirrored + s.dielectric_shares.scattered), one);

  s.absorbed = white, s.thickness = zero;
  if (u.has_volume) {
    s.thickness = F::load(q.thickness + i);
    s.absorbed = transmittance(u, s.thickness);
  }
  if (u.has_transmission) s.transmission = F::load(q.transmission + i);
  if (u.has_diffuse_transmission) {
    s.diffuse_transmission = F::load(q.diffuse_transmission + i);
    s.back_color = Vector<F>::load(q.diffuse_transmission_color, i) * s.absorbed;
  }

  s.below_sheen = one;
  if (u.has_sheen) {
    s.sheen_color = Vector<F>::load(q.sheen_color, i);
    s.sheen_roughness = max(F::load(q.sheen_roughness + i), F(min_sheen_roughness));
    s.sheen_cosine = max(s.nv, F(min_sheen_cosine));
    const F albedo = sheen_albedo(s.sheen_roughness, s.sheen_cosine);
    s.sheen_lambda = Sheen<F>(s.sheen_roughness).lambda(s.sheen_cosine);
    // The fit of Λ lets grazing fibres reflect more light than arrives: there the lobe is scaled to reflect it all.
    s.sheen_scale = one / max(albedo, one);
    s.sheen_albedo = albedo * s.sheen_scale;
    s.below_sheen = one - bounded(max_channel(s.sheen_color)) * s.sheen_albedo;
  }
  if (u.has_clearcoat) {
    s.coat_n = Vector<F>::load(q.clearcoat_normal, i);
    s.coat_nv = min(max(abs(dot(s.coat_n, v)), F(1e-4f)), one);
    s.coat_roughness = max(F::load(q.clearcoat_roughness + i), F(min_roughness));
    s.coat_alpha = s.coat_roughness * s.coat_roughness;
    const SpecularWeights<F> all =
        rows.has_coat ? rows.coat.at(s.coat_nv) : SpecularFit<F>(s.coat_roughness).at(s.coat_nv);
    s.coat_gain = one / (all.scale + all.bias);
    s.coat_weight = F::load(q.clearcoat + i) * (F(0.04f) + F(0.96f) * schlick_weight(s.coat_nv));
  }
  return s;
}

/// What lies below the dielectric interface: light from the front, from the back and through the surface, each times
/// its own colour.
template <class F, class Layers>
[[gnu::always_inline]] inline Vector<F> below_interface(const Layers& u, const LayeredSurface<F>& s, Vector<F> front,
                                                        Vector<F> back, Vector<F> through) {
  Vector<F> sum = front * s.base;
  if (u.has_diffuse_transmission) sum = mix(sum, back * s.back_color, s.diffuse_transmission);
  if (u.has_transmission) sum = mix(sum, through * s.base, s.transmission);
  return sum;
}

/// Reflected radiance for one unit of irradiance perpendicular to l, without the clear coat: BSDF × |n·l|.
///
/// The light below the interface is that which the interface does not reflect towards any direction, not what Schlick's
/// term at v·h leaves, with which grazing views of bright surfaces would reflect more light than arrives.
template <class F, class Layers>
[[gnu::always_inline]] inline Vector<F> layered_light(const Layers& u, const LayeredSurface<F>& s,
                                                      const PreparedLight& light, const Arriving<F>& arriving) {
  const Vector<F> l = arriving.from;
  const F one(1.0f), zero(0.0f), along = dot(s.n, l), nl = max(along, zero);
  const bool has_back = u.has_transmission || u.has_diffuse_transmission;
  // Light from behind meets the interface as its mirror image does.
  const Vector<F> front_l = has_back ? select(along < zero, l - s.n * (along + along), l) : l;
  const Vector<F> h = normalize(front_l + s.v);
  const F weight = schlick_weight(dot(s.v, h));
  const auto wide = [&](F alpha) { return highlight_alpha(alpha, light, arriving); };
  const F alpha = wide(s.alpha);
  MicrofacetFrame<F> frame = s.frame;
  if (u.has_anisotropy) frame.alpha_t = wide(frame.alpha_t), frame.alpha_b = wide(frame.alpha_b);
  const F peak = u.has_anisotropy ? ggx(frame, h) * smith(frame, front_l, s.v, nl, s.nv)
                                  : ggx(dot(s.n, h), cross(s.n, h), alpha) * smith(nl, s.nv, alpha);
  const Vector<F> dielectric = s.dielectric.fresnel(weight, u.has_iridescence) * s.dielectric_shares.gain;
  Vector<F> reflected = dielectric;
  if (s.has_metal)
    reflected = mix(dielectric, s.metal.fresnel(weight, u.has_iridescence) * s.metal_shares.gain, s.metallic);

  const auto grey = [](F x) { return Vector<F>{x, x, x}; };
  const F behind = max(-along, zero);
  const Vector<F> front = grey(nl * F(inverse_pi)), back = grey(behind * F(inverse_pi));
  Vector<F> through = grey(zero);
  if (u.has_transmission) {
    const F rough = max(s.through_roughness, F(min_roughness));
    through = s.absorbed * wall_lobe(behind, s.nv, wide(rough * rough), s.n, h);
  }
  const Vector<F> below = below_interface(u, s, front, back, through);
  const Vector<F> mirrored = reflected * (peak * nl);
  Vector<F> sum = mirrored + below * (s.below_interface * (one - s.metallic));
  if (u.has_sheen) {
    const Sheen<F> sheen(s.sheen_roughness);
    const Vector<F> across = cross(s.n, h);
    const F fibres = sheen.density(dot(across, across)) *
                     sheen.visibility(s.sheen_lambda, max(nl, F(1e-4f)), s.sheen_cosine) * nl * s.sheen_scale;
    sum = sum * s.below_sheen + s.sheen_color * fibres;
  }
  return sum;
}

/// Reflected radiance of a clear coat of reflectance 1 for one unit of irradiance perpendicular to l, with the lobe
/// of `alpha`. Its microfacets lose no light, as those that reflect an environment.
template <class F>
[[gnu::always_inline]] inline F coat_light(const LayeredSurface<F>& s, Vector<F> l, F alpha) {
  const Vector<F> h = normalize(l + s.v);
  const F nl = max(dot(s.coat_n, l), F(0.0f));
  const F peak = ggx(dot(s.coat_n, h), cross(s.coat_n, h), alpha) * smith(nl, s.coat_nv, alpha);
  return peak * nl * s.coat_gain;
}

/// The direction of the light that the surface reflects; stretched highlights reflect along a normal bent towards the
/// viewer.
///
/// Source    KHR_materials_anisotropy, "Image-based lighting".
template <class F, class Layers>
[[gnu::always_inline]] inline Vector<F> reflected_direction(const Layers& u, const LayeredSurface<F>& s,
                                                            const LayerState& q, int i) {
  Vector<F> n = s.n;
  if (u.has_anisotropy) {
    const F one(1.0f);
    const Vector<F> bent = normalize(cross(cross(s.frame.b, s.v), s.frame.b));
    const F rest = one - F::load(q.anisotropy + i) * (one - s.roughness), square = rest * rest;
    n = normalize(mix(bent, s.n, square * square));
  }
  return lobe_direction(n, s.v, s.roughness);
}

/// The light of the environment that the surface sends to the viewer, without the clear coat: `seen` is the part of the
/// environment that is not occluded, `through` the light that passes through the surface.
template <class F, class Layers, class Radiance>
[[gnu::always_inline]] inline Vector<F> layered_environment(const Layers& u, const LayeredSurface<F>& s,
                                                            const Radiance& around, Vector<F> through, F seen,
                                                            const LayerState& q, int i) {
  const F one(1.0f);
  const InterfaceShares<F>&dielectric = s.dielectric_shares, &metal = s.metal_shares;
  const Vector<F> mirrored = around.of_base(reflected_direction(u, s, q, i), s.roughness) * seen;
  const Vector<F> front = around.diffuse(s.n) * seen;
  const Vector<F> back = u.has_diffuse_transmission ? around.diffuse(Vector<F>{-s.n.x, -s.n.y, -s.n.z}) * seen : front;

  const Vector<F> below = below_interface(u, s, front, back, through);
  Vector<F> share = dielectric.mirrored, scattered = dielectric.scattered;
  if (s.has_metal)
    share = mix(share, metal.mirrored, s.metallic), scattered = mix(scattered, metal.scattered, s.metallic);
  Vector<F> sum = mirrored * share + front * scattered + below * (s.below_interface * (one - s.metallic));
  if (u.has_sheen) {
    const Vector<F> leaning = around.diffuse(sheen_direction(s.n, s.v, s.nv, s.sheen_roughness)) * seen;
    sum = sum * s.below_sheen + leaning * s.sheen_color * s.sheen_albedo;
  }
  return sum;
}

/// What passes through the surface from behind.
template <class F>
struct LightThrough {
  Vector<F> color;   ///< attenuated by the volume
  Vector<F> beyond;  ///< the light of the background in it, where nothing of the scene is behind, not attenuated
  F open;            ///< the part of the image behind that is empty
};

/// Along the line of sight through a thin wall, bent into a volume. Where the image behind is empty, the background's
/// colour is seen, or the environment.
template <class F, class Layers, class Radiance>
[[gnu::always_inline]] inline LightThrough<F> light_through(const ShadingUniforms& s, const Layers& u,
                                                            const LayeredSurface<F>& surface, const Radiance& around,
                                                            const FragmentBatch& batch, const ShadingState& p, int i) {
  using Int = typename F::Int;
  const F one(1.0f), roughness = surface.through_roughness;
  const Int first = s.backdrop != nullptr ? first_texels<F>(*s.backdrop, batch, i) : Int(0);
  const auto behind = [&](Vector<F> direction, ImagePlace<F> at) {
    const Vector<F> light =
        s.has_background_color ? Vector<F>::all(s.background) : around.specular(direction, roughness);
    if (s.backdrop == nullptr) return LightThrough<F>{light, light, one};
    const BackdropColor<F> seen = backdrop_color(*s.backdrop, at, roughness);
    const F open = one - seen.alpha;
    const Vector<F> beyond = light * open;
    return LightThrough<F>{seen.color + beyond, beyond, open};
  };
  if (!u.has_volume) {
    const Vector<F> direction{-surface.v.x, -surface.v.y, -surface.v.z};
    if (s.backdrop != nullptr && !s.has_pixels)
      return behind(direction, image_place(*s.backdrop, Vector<F>::load(p.position, i), first));
    const F pixel(1.0f / 256);
    return behind(direction, {F::from(Int::load(batch.x + i)) * pixel, F::from(Int::load(batch.y + i)) * pixel, first});
  }
  const auto along = [&](float ior) {
    const Vector<F> direction = refracted(surface.n, surface.v, surface.nv, F(1 / ior));
    if (s.backdrop == nullptr) return behind(direction, {one, one, first});
    const Vector<F> exit = Vector<F>::load(p.position, i) + direction * surface.thickness;
    return behind(direction, image_place(*s.backdrop, exit, first));
  };
  const LightThrough<F> green = along(u.ior);
  if (!(u.half_spread > 0)) return {green.color * surface.absorbed, green.beyond, green.open};
  const LightThrough<F> red = along(u.ior - u.half_spread), blue = along(u.ior + u.half_spread);
  return {Vector<F>{red.color.x, green.color.y, blue.color.z} * surface.absorbed,
          {red.beyond.x, green.beyond.y, blue.beyond.z},
          green.open};
}

/// The part of light from behind that passes through all layers.
template <class F, class Layers>
[[gnu::always_inline]] inline Vector<F> passing(const Layers& u, const LayeredSurface<F>& s) {
  const F one(1.0f);
  F part = s.transmission * s.below_interface * (one - s.metallic) * s.below_sheen;
  if (u.has_clearcoat) part = part * (one - s.coat_weight);
  return s.base * s.absorbed * part;
}

template <class F, class Radiance, class Layers>
void light_layered_in(const ShadingUniforms& s, const Layers& u, const FragmentBatch& batch, const ShadingState& p,
                      const LayerState& q, FragmentOutputs& out) {
  const Radiance around(s, p);
  const LobeRows<F> rows(s);
  AnyUniforms kind(s);
  kind.has_emissive = kind.has_emissive_texture = false;  // added below the coat
  const Viewer<F> viewer(s.viewpoint);
  const F one(1.0f), zero(0.0f);
  for (int i = 0; i < p.count; i += F::lanes) {
    const LayeredSurface<F> surface = make_surface<F>(u, rows, p, q, viewer.direction(batch, p, i), i);
    Vector<F> sum = zeros<F>(), coat = zeros<F>();
    LightThrough<F> through{zeros<F>(), zeros<F>(), zero};
    for (int k = 0; k < s.lights; ++k) {
      const Arriving<F> light = arriving<F>(s.light[k], false, p, i);
      const Vector<F> radiance = visible(light.radiance, p, k, i);
      sum = sum + radiance * layered_light(u, surface, s.light[k], light);
      if (u.has_clearcoat)
        coat =
            coat + radiance * coat_light(surface, light.from, highlight_alpha(surface.coat_alpha, s.light[k], light));
    }
    if (s.has_environment || (u.has_transmission && s.backdrop != nullptr)) {
      if (u.has_transmission) through = light_through(s, u, surface, around, batch, p, i);
      const F seen = kind.has_occlusion ? F::load(p.occlusion + i) : one;
      sum = sum + layered_environment(u, surface, around, through.color, seen, q, i);
      if (u.has_clearcoat) {
        const Vector<F> towards = lobe_direction(surface.coat_n, surface.v, surface.coat_roughness);
        coat = coat + around.of_coat(towards, surface.coat_roughness) * seen;
      }
    }
    if (s.has_emissive_texture) {
      sum = sum + Vector<F>::load(p.emissive, i);
    } else if (s.has_emissive) {
      sum = sum + Vector<F>::all(s.emissive);
    }
    if (u.has_clearcoat) sum = sum * (one - surface.coat_weight) + coat * surface.coat_weight;
    F clear = zero;
    if (u.has_transmission && !s.has_environment_behind) {
      // The background is seen through the surface as far as all colours pass; the other light is added here.
      const Vector<F> part = passing(u, surface);
      const F all_colors = min(max(min(min(part.x, part.y), part.z), zero), one);
      sum = sum - through.beyond * all_colors;
      clear = min(all_colors * through.open, max(one - max_channel(sum), zero));
    }
    finish(s, kind, p, sum, surface.base, out, i);
    if (u.has_transmission) (F::load(out.a + i) * (one - clear)).store(out.a + i);
  }
}

template <class F, class Wide>
void light_layered(const ShadingUniforms& s, const LayeredUniforms& u, const FragmentBatch& batch,
                   const ShadingState& p, const LayerState& q, FragmentOutputs& out) {
  if (s.map == nullptr) return light_layered_in<F, ConstantRadiance<F>>(s, u, batch, p, q, out);
  if (is_plain(u)) return light_layered_in<Wide, MappedRadiance<Wide>>(s, PlainLayers(u), batch, p, q, out);
  light_layered_in<F, MappedRadiance<F>>(s, u, batch, p, q, out);
}

}  // namespace zoneplate::stages
