// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/reflection/brdf.h"
#include "zoneplate/shade/surface/brightness.h"
#include "zoneplate/shade/surface/geometry_lanes.h"
#include "zoneplate/shade/surface/normals_lanes.h"
#include "zoneplate/shade/surface/shading.h"

/// The stages of shade/surface/shading.h from the lights to the colour, over the lane types of
/// math/lanes.h.
namespace zoneplate::stages {

template <class F>
[[gnu::always_inline]] inline Vector<F> zeros() {
  return {F(0.0f), F(0.0f), F(0.0f)};
}

/// The most frequent case, fixed at compile time: one directional light, opaque surfaces without emission.
struct PlainUniforms {
  static constexpr int lights = 1;
  static constexpr bool has_sun_only = true;
  static constexpr bool has_occlusion = false, has_emissive = false, has_emissive_texture = false;
  static constexpr bool has_bare_meshes = false, is_blended = false;
  static constexpr bool has_specular_texture = false, has_exponent_texture = false;
  static constexpr bool has_map = false;
};

/// The general case, read at run time.
struct AnyUniforms {
  int lights;
  static constexpr bool has_sun_only = false;
  bool has_occlusion, has_emissive, has_emissive_texture, has_bare_meshes, is_blended;
  bool has_specular_texture, has_exponent_texture;
  bool has_map;
  explicit AnyUniforms(const ShadingUniforms& s)
      : lights(s.lights),
        has_occlusion(s.has_occlusion),
        has_emissive(s.has_emissive),
        has_emissive_texture(s.has_emissive_texture),
        has_bare_meshes(s.has_bare_meshes),
        is_blended(s.is_blended),
        has_specular_texture(s.has_specular_texture),
        has_exponent_texture(s.has_exponent_texture),
        has_map(s.map != nullptr && s.has_environment) {}
};

inline bool is_plain(const ShadingUniforms& s, const ShadingState& p) {
  return p.light_visibility == nullptr && s.lights == 1 && s.light[0].is_directional && !s.has_occlusion &&
         !s.has_emissive && !s.has_emissive_texture && !s.has_bare_meshes && !s.is_blended && !s.has_specular_texture &&
         !s.has_exponent_texture && s.map == nullptr;
}

/// The irradiance of a light at fragments, perpendicular to its direction.
template <class F>
struct Arriving {
  Vector<F> from;  ///< unit direction to the light
  Vector<F> radiance;
  F spread;  ///< what the size of the light adds to α² of highlights
};

/// α of a highlight: the lobe of the surface, widened by the disc of the light.
///
/// Source    Karis, Real Shading in Unreal Engine 4, SIGGRAPH 2013, "Area Lights", with the variances added.
template <class F>
[[gnu::always_inline]] inline F highlight_alpha(F alpha, const PreparedLight& light, const Arriving<F>& arriving) {
  return light.spread > 0 ? min(sqrt(alpha * alpha + arriving.spread), F(1.0f)) : alpha;
}

template <class F>
[[gnu::always_inline]] inline Arriving<F> arriving(const PreparedLight& light, bool is_sun, const ShadingState& p,
                                                   int i) {
  const auto radiance = Vector<F>::all(light.radiance);
  if (is_sun || light.is_directional) return {Vector<F>::all(light.towards), radiance, F(light.spread)};
  const Vector<F> path = Vector<F>::all(light.position) - Vector<F>::load(p.position, i);
  const Vector<F> l = normalize(path);
  const F square = dot(path, path);
  F strength = fading(light, square);
  if (light.is_spot) strength = strength * cone(light, -dot(l, Vector<F>::all(light.axis)));
  const F spread = light.spread > 0 ? F(light.spread) / max(square, F(min_distance_squared)) : F(0.0f);
  return {l, radiance * strength, spread};
}

/// The radiance of light k times its visibility at the fragments.
template <class F>
[[gnu::always_inline]] inline Vector<F> visible(Vector<F> radiance, const ShadingState& p, int k, int i) {
  if (p.light_visibility == nullptr) return radiance;
  return radiance * F::load(p.light_visibility + k * FragmentBatch::padded_capacity + i);
}

/// Colour × alpha, colour clamped to [0, brightest_color].
template <class F>
[[gnu::always_inline]] inline void store_color(Vector<F> color, bool is_blended, const ShadingState& p,
                                               FragmentOutputs& out, int i) {
  const F low(0.0f), high(brightest_color);
  Vector<F> color_out{min(max(color.x, low), high), min(max(color.y, low), high), min(max(color.z, low), high)};
  const F alpha = is_blended ? F::load(p.base[3] + i) : F(1.0f);
  if (is_blended) color_out = color_out * alpha;
  color_out.x.store(out.r + i), color_out.y.store(out.g + i), color_out.z.store(out.b + i);
  alpha.store(out.a + i);
}

/// Adds what does not depend on lights: emission, the colour of fragments without normals, alpha.
template <class F, class Kind>
[[gnu::always_inline]] inline void finish(const ShadingUniforms& s, const Kind& kind, const ShadingState& p,
                                          Vector<F> sum, Vector<F> base, FragmentOutputs& out, int i) {
  if (kind.has_emissive_texture) {
    sum = sum + Vector<F>::load(p.emissive, i);
  } else if (kind.has_emissive) {
    sum = sum + Vector<F>::all(s.emissive);
  }
  if (kind.has_bare_meshes) sum = select(F::load(p.is_lit + i) > F(0.5f), sum, base);
  store_color(sum, kind.is_blended, p, out, i);
}

/// Ambient light, attenuated by occlusion.
template <class F, class Kind>
[[gnu::always_inline]] inline Vector<F> unoccluded(const Kind& kind, const ShadingState& p, Vector<F> light, int i) {
  return kind.has_occlusion ? light * F::load(p.occlusion + i) : light;
}

enum class Highlight { None, BlinnPhong, Phong };

/// The square of max(n · h, 0) with h halfway between l and the vector `way` to the viewer, of any length; 0 where h
/// does not exist.
template <class F>
[[gnu::always_inline]] inline F halfway_cosine_square(Vector<F> n, Vector<F> l, Vector<F> way) {
  const Vector<F> h = l * sqrt(dot(way, way)) + way;
  const F square = dot(h, h), nh = max(dot(n, h), F(0.0f));
  return select(square > F(1e-36f), nh * nh / square, F(0.0f));
}

/// The cosines of one light at a batch's fragments.
struct Cosines {
  alignas(64) float diffuse[FragmentBatch::padded_capacity];
  alignas(64) float highlight[FragmentBatch::padded_capacity];  ///< the cosine's power
};

/// Computes the cosine whose power is the highlight, or for Blinn-Phong its square. Source: as in
/// shade/reflection/brdf.h.
template <class F, Highlight highlight>
[[gnu::always_inline]] inline void compute_cosines(const ShadingUniforms& s, const PreparedLight& of, bool is_sun,
                                                   const FragmentBatch& batch, const ShadingState& p, Cosines& out) {
  const Viewer<F> viewer(s.viewpoint);
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i), l = arriving<F>(of, is_sun, p, i).from;
    lambert(dot(n, l)).store(out.diffuse + i);
    if constexpr (highlight == Highlight::Phong)
      max(phong_cosine(n, l, viewer.direction(batch, p, i)), F(0.0f)).store(out.highlight + i);
    if constexpr (highlight == Highlight::BlinnPhong)
      halfway_cosine_square(n, l, viewer.way(batch, p, i)).store(out.highlight + i);
  }
}

/// Several independent vectors with one operation on all of them, so that their latencies overlap.
template <class F, int size>
struct Several {
  F v[size];
  explicit Several(float x) { std::fill_n(v, size, F(x)); }
  template <class Make>
  [[gnu::always_inline]] explicit Several(Make make) {
    for (int k = 0; k < size; ++k) v[k] = make(k);
  }
  [[gnu::always_inline]] friend Several operator*(const Several& a, const Several& b) {
    return Several([&](int k) { return a.v[k] * b.v[k]; });
  }
  [[gnu::always_inline]] friend Several sqrt(const Several& a) {
    return Several([&](int k) { return sqrt(a.v[k]); });
  }
  [[gnu::always_inline]] friend Several pow(const Several& a, const Several& b) {
    return Several([&](int k) { return pow(a.v[k], b.v[k]); });
  }
};

/// Raises the cosines to the exponent. This is a loop of its own because both computations are long dependency chains.
template <class F, Highlight highlight>
[[gnu::always_inline]] inline void raise_cosines(const Exponent& exponent, Cosines& cosines, int count) {
  constexpr int vectors = 8 / F::lanes < 2 ? 2 : 8 / F::lanes;
  constexpr int step = vectors * F::lanes;
  static_assert(ShadingState::capacity % step == 0);
  if (count % step != 0) std::fill_n(cosines.highlight + count, step - count % step, 0.0f);
  for (int i = 0; i < count; i += step) {
    const Several<F, vectors> x([&](int k) { return F::load(cosines.highlight + i + k * F::lanes); });
    const auto raised = highlight == Highlight::Phong ? power(x, exponent) : power_of_square(x, exponent);
    for (int k = 0; k < vectors; ++k) raised.v[k].store(cosines.highlight + i + k * F::lanes);
  }
}

/// The same with the exponents of a texture.
template <class F, Highlight highlight>
[[gnu::always_inline]] inline void raise_cosines(const ShadingState& p, Cosines& cosines) {
  const F factor(highlight == Highlight::Phong ? 1.0f : 0.5f);
  for (int i = 0; i < p.count; i += F::lanes)
    pow(F::load(cosines.highlight + i), F::load(p.exponent + i) * factor).store(cosines.highlight + i);
}

/// The light accumulated at fragments, for base colour and highlight.
template <class F>
struct Gathered {
  Vector<F> diffuse, specular;
};

template <class F, Highlight highlight>
[[gnu::always_inline]] inline Gathered<F> gather(const PreparedLight& of, int k, bool is_sun, const ShadingState& p,
                                                 const Cosines& cosines, int i) {
  Vector<F> radiance = arriving<F>(of, is_sun, p, i).radiance;
  if (!is_sun) radiance = visible(radiance, p, k, i);
  if constexpr (highlight == Highlight::None) return {radiance * F::load(cosines.diffuse + i), zeros<F>()};
  return {radiance * F::load(cosines.diffuse + i), radiance * F::load(cosines.highlight + i)};
}

/// The light of an environment map at a batch's fragments.
struct MapLight {
  alignas(64) ShadingState::Array diffuse[3];  ///< its irradiance over π
  alignas(64)
      ShadingState::Array specular[3];  ///< about the highlight's lobe, times what the highlight reflects of all
};

/// Computes the light of the environment map; the specular one where the surface has a highlight.
template <class F>
[[gnu::noinline]] void gather_map(const ShadingUniforms& s, const FragmentBatch& batch, const ShadingState& p,
                                  MapLight& out) {
  const AnyUniforms kind(s);
  const Viewer<F> viewer(s.viewpoint);
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i);
    unoccluded(kind, p, diffuse_light(*s.map, n), i).store(out.diffuse, i);
    if (!s.has_specular) continue;
    const Vector<F> v = viewer.direction(batch, p, i);
    const F exponent = s.has_exponent_texture ? F::load(p.exponent + i) : F(s.exponent.value);
    const F nv = min(max(dot(n, v), F(0.0f)), F(1.0f));
    const F share = s.is_phong ? phong_albedo(exponent) : blinn_phong_albedo(exponent, nv);
    const F roughness = roughness_of_exponent(s.is_phong ? exponent * F(4.0f) : exponent);
    const Vector<F> about = specular_light(*s.map, lobe_direction(n, v, roughness), roughness);
    unoccluded(kind, p, about * share, i).store(out.specular, i);
  }
}

/// Stores the colour that follows from the accumulated light of all lights; `around` is read where there is a map.
template <class F, Highlight highlight, class Kind>
[[gnu::always_inline]] inline void store_gathered(const ShadingUniforms& s, const Kind& kind, const ShadingState& p,
                                                  const MapLight& around, Gathered<F> light, FragmentOutputs& out,
                                                  int i) {
  const auto base = Vector<F>::load(p.base, i), ambient = Vector<F>::all(s.ambient);
  if (kind.has_map) {
    light.diffuse = light.diffuse + Vector<F>::load(around.diffuse, i);
    if constexpr (highlight != Highlight::None) light.specular = light.specular + Vector<F>::load(around.specular, i);
  }
  Vector<F> sum = base * (unoccluded(kind, p, ambient, i) + light.diffuse);
  if constexpr (highlight != Highlight::None)
    sum = sum +
          (kind.has_specular_texture ? Vector<F>::load(p.specular, i) : Vector<F>::all(s.specular)) * light.specular;
  finish(s, kind, p, sum, base, out, i);
}

/// `s` and each light are copies, so that their members are loaded once and not again after each store.
template <class F, Highlight highlight, class Kind>
void light_phong(const ShadingUniforms s, const Kind& kind, const FragmentBatch& batch, const ShadingState& p,
                 FragmentOutputs& out) {
  MapLight around;
  if (kind.has_map) gather_map<F>(s, batch, p, around);
  if (kind.lights == 0) {
    for (int i = 0; i < p.count; i += F::lanes)
      store_gathered<F, highlight>(s, kind, p, around, {zeros<F>(), zeros<F>()}, out, i);
    return;
  }
  Cosines cosines;
  alignas(64) ShadingState::Array diffuse[3], specular[3];
  for (int k = 0; k < kind.lights; ++k) {
    const PreparedLight light = s.light[k];
    compute_cosines<F, highlight>(s, light, kind.has_sun_only, batch, p, cosines);
    if constexpr (highlight != Highlight::None) {
      if (kind.has_exponent_texture)
        raise_cosines<F, highlight>(p, cosines);
      else
        raise_cosines<F, highlight>(s.exponent, cosines, p.count);
    }
    for (int i = 0; i < p.count; i += F::lanes) {
      Gathered<F> all = gather<F, highlight>(light, k, kind.has_sun_only, p, cosines, i);
      if (k > 0) {
        all.diffuse = Vector<F>::load(diffuse, i) + all.diffuse;
        all.specular = Vector<F>::load(specular, i) + all.specular;
      }
      if (k + 1 < kind.lights) {
        all.diffuse.store(diffuse, i), all.specular.store(specular, i);
      } else {
        store_gathered<F, highlight>(s, kind, p, around, all, out, i);
      }
    }
  }
}

template <class F, Highlight highlight>
void light_phong(const ShadingUniforms& s, const FragmentBatch& batch, const ShadingState& p, FragmentOutputs& out) {
  if (is_plain(s, p)) return light_phong<F, highlight>(s, PlainUniforms(), batch, p, out);
  light_phong<F, highlight>(s, AnyUniforms(s), batch, p, out);
}

template <class F>
void light_phong(const ShadingUniforms& s, const FragmentBatch& batch, const ShadingState& p, FragmentOutputs& out) {
  if (!s.has_specular) return light_phong<F, Highlight::None>(s, batch, p, out);
  if (s.is_phong) return light_phong<F, Highlight::Phong>(s, batch, p, out);
  light_phong<F, Highlight::BlinnPhong>(s, batch, p, out);
}

template <class F>
[[gnu::always_inline]] inline bool is_dielectric(F metallic) {
  return all(metallic == F(0.0f));
}

/// The reflection of an environment of one colour.
template <class F>
struct ConstantEnvironment {
  Vector<F> radiance;

  ConstantEnvironment(const ShadingUniforms& s, const ShadingState& /*p*/) : radiance(Vector<F>::all(s.environment)) {}

  template <class Kind>
  [[gnu::always_inline]] Vector<F> reflected(const Kind& kind, const ShadingState& p, Vector<F> /*n*/, Vector<F> /*v*/,
                                             Vector<F> base, F metallic, F /*roughness*/, SpecularWeights<F> weights,
                                             int i) const {
    return unoccluded(kind, p, radiance, i) * metallic_environment(base, metallic, weights);
  }
};

/// The reflection of an environment map; with `is_mixed`, for the roughness of ShadingState::mixed.
template <class F, bool is_mixed>
struct MappedEnvironment {
  const EnvironmentView& map;
  const MixedLevel level;

  MappedEnvironment(const ShadingUniforms& s, const ShadingState& p) : map(*s.map), level(p.mixed) {}

  template <class Kind>
  [[gnu::always_inline]] Vector<F> reflected(const Kind& kind, const ShadingState& p, Vector<F> n, Vector<F> v,
                                             Vector<F> base, F metallic, F roughness, SpecularWeights<F> weights,
                                             int i) const {
    const EnvironmentShares<F> shares =
        is_dielectric(metallic) ? dielectric_shares(base, weights) : metallic_shares(base, metallic, weights);
    const Vector<F> direction = lobe_direction(n, v, roughness);
    Vector<F> mirrored;
    if constexpr (is_mixed)
      mirrored = specular_light(map, level, direction);
    else
      mirrored = specular_light(map, direction, roughness);
    return unoccluded(kind, p, shares.mirrored * mirrored + shares.scattered * diffuse_light(map, n), i);
  }
};

/// With `turns`, the lobes of lights are widened by the turn of the normal along each direction, and the environment's
/// by the mean over all directions.
template <class F, bool has_texture, class Environment, bool turns = false>
void light_metallic(const ShadingUniforms& s, const FragmentBatch& batch, const ShadingState& p, FragmentOutputs& out) {
  const Environment environment(s, p);
  const SpecularRow<F> row(s.roughness);
  const AnyUniforms kind(s);
  const Viewer<F> viewer(s.viewpoint);
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i), base = Vector<F>::load(p.base, i);
    const auto v = s.needs_viewer ? viewer.direction(batch, p, i) : zeros<F>();
    const F metallic = has_texture ? F::load(p.metallic + i) : F(s.metallic);
    const F own_roughness = has_texture ? F::load(p.roughness + i) : F(s.roughness);
    F roughness = own_roughness;
    if constexpr (turns) roughness = widened(own_roughness, F::load(p.normal_variance + i));
    const F nv = min(max(dot(n, v), F(0.0f)), F(1.0f));
    const SpecularWeights<F> weights = has_texture ? SpecularFit<F>(roughness).at(nv) : row.at(nv);
    const Metallic<F> m = is_dielectric(metallic) ? make_dielectric(base, roughness, weights)
                                                  : make_metallic(base, metallic, roughness, weights);
    const auto turning_lobe = [&](const PreparedLight& light, const Arriving<F>& arriving) {
      const F r = max(own_roughness, F(min_roughness));
      return TurningLobe<F>(n, v, Vector<F>::load(p.normal_dx, i), Vector<F>::load(p.normal_dy, i),
                            light.spread > 0 ? sqrt(highlight_alpha(r * r, light, arriving)) : own_roughness);
    };
    Vector<F> sum = zeros<F>();
    for (int k = 0; k < s.lights; ++k) {
      const Arriving<F> light = arriving<F>(s.light[k], false, p, i);
      const Vector<F> radiance = visible(light.radiance, p, k, i);
      if constexpr (turns)
        sum = sum + radiance * metallic_light(m, turning_lobe(s.light[k], light), light.from);
      else
        sum = sum + radiance * metallic_light(m, n, light.from, v, highlight_alpha(m.alpha, s.light[k], light));
    }
    if (s.has_environment) sum = sum + environment.reflected(kind, p, n, v, base, metallic, roughness, weights, i);
    finish(s, kind, p, sum, base, out, i);
  }
}

template <class F>
void light_metallic(const ShadingUniforms& s, const FragmentBatch& batch, const ShadingState& p, FragmentOutputs& out) {
  if (s.has_turning_normals) return light_metallic<F, true, ConstantEnvironment<F>, true>(s, batch, p, out);
  if (s.has_material_texture) return light_metallic<F, true, ConstantEnvironment<F>>(s, batch, p, out);
  light_metallic<F, false, ConstantEnvironment<F>>(s, batch, p, out);
}

template <class F>
void light_metallic_in_map(const ShadingUniforms& s, const FragmentBatch& batch, const ShadingState& p,
                           FragmentOutputs& out) {
  using Map = MappedEnvironment<F, false>;
  if (s.has_turning_normals) return light_metallic<F, true, Map, true>(s, batch, p, out);
  if (s.has_material_texture) return light_metallic<F, true, Map>(s, batch, p, out);
  if (p.mixed.texels == nullptr) return light_metallic<F, false, Map>(s, batch, p, out);
  light_metallic<F, false, MappedEnvironment<F, true>>(s, batch, p, out);
}

template <class F>
void unlit(bool is_blended, const ShadingState& p, FragmentOutputs& out) {
  for (int i = 0; i < p.count; i += F::lanes) store_color(Vector<F>::load(p.base, i), is_blended, p, out, i);
}

}  // namespace zoneplate::stages
