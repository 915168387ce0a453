#pragma once

#include "zoneplate/shade/brdf.h"
#include "zoneplate/shade/geometry_stages.h"
#include "zoneplate/shade/surface_kernels.h"

/// The stages of shade/surface_kernels.h from the lights to the colour, over the lane types of shade/lanes.h.
namespace zoneplate::stages {

template <class F>
[[gnu::always_inline]] inline Vector<F> zeros() {
  return {F(0.0f), F(0.0f), F(0.0f)};
}

/// What of a light arrives at points, perpendicular to its direction.
template <class F>
struct Arriving {
  Vector<F> from;  ///< unit direction to the light
  Vector<F> radiance;
};

template <class F>
[[gnu::always_inline]] inline Arriving<F> arriving(const PreparedLight& light, const Points& p, int i) {
  const auto radiance = Vector<F>::all(light.radiance);
  if (light.is_directional) return {Vector<F>::all(light.towards), radiance};
  const Vector<F> path = Vector<F>::all(light.position) - Vector<F>::load(p.position, i);
  const Vector<F> l = normalize(path);
  F strength = fading(light, dot(path, path));
  if (light.is_spot) strength = strength * cone(light, -dot(l, Vector<F>::all(light.axis)));
  return {l, radiance * strength};
}

/// Colour × alpha, colour clamped to [0, 1e9].
template <class F>
[[gnu::always_inline]] inline void store_color(Vector<F> color, F alpha, Shaded& out, int i) {
  const F low(0.0f), high(1e9f);
  (min(max(color.x, low), high) * alpha).store(out.r + i);
  (min(max(color.y, low), high) * alpha).store(out.g + i);
  (min(max(color.z, low), high) * alpha).store(out.b + i);
  alpha.store(out.a + i);
}

/// What comes after the reflected light: emission, points that are not lit, alpha.
template <class F>
[[gnu::always_inline]] inline void finish(const Illumination& s, const Points& p, Vector<F> sum, Vector<F> base,
                                          Shaded& out, int i) {
  if (s.has_emissive_texture) {
    sum = sum + Vector<F>::load(p.emissive, i);
  } else if (s.has_emissive) {
    sum = sum + Vector<F>::all(s.emissive);
  }
  if (s.has_bare_meshes) sum = select(F::load(p.is_lit + i) > F(0.5f), sum, base);
  store_color(sum, s.is_blended ? F::load(p.base[3] + i) : F(1.0f), out, i);
}

template <class F>
[[gnu::always_inline]] inline F occlusion_at(const Illumination& s, const Points& p, int i) {
  return s.has_occlusion ? F::load(p.occlusion + i) : F(1.0f);
}

enum class Highlight { None, BlinnPhong, Phong };

/// n · h with h halfway between l and the way to the viewer, whose length need not be one; 0 where there is no h.
template <class F>
[[gnu::always_inline]] inline F halfway_cosine(Vector<F> n, Vector<F> l, Vector<F> way) {
  const Vector<F> h = l * sqrt(dot(way, way)) + way;
  const F square = dot(h, h);
  return select(square > F(1e-36f), dot(n, h) / sqrt(square), F(0.0f));
}

/// The cosine whose power is the highlight. Source: as in shade/brdf.h.
template <class F, Highlight highlight>
[[gnu::always_inline]] inline F highlight_cosine(const Illumination& s, const Batch& batch, const Points& p,
                                                 Vector<F> n, Vector<F> l, int i) {
  if constexpr (highlight == Highlight::Phong) return phong_cosine(n, l, towards_viewer<F>(s.viewpoint, batch, p, i));
  return halfway_cosine(n, l, way_to_viewer<F>(s.viewpoint, batch, p, i));
}

/// Room for the cosines of a batch's points. They are found apart from the powers, because both are long chains of
/// operations that wait for each other.
struct Cosines {
  alignas(64) float diffuse[Points::capacity], highlight[Points::capacity];
};

template <class F, Highlight highlight>
[[gnu::always_inline]] inline void find_cosines(const Illumination& s, const PreparedLight& of, const Batch& batch,
                                                const Points& p, Cosines& out) {
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i), l = arriving<F>(of, p, i).from;
    lambert(dot(n, l)).store(out.diffuse + i);
    if constexpr (highlight == Highlight::None) continue;
    max(highlight_cosine<F, highlight>(s, batch, p, n, l, i), F(0.0f)).store(out.highlight + i);
  }
}

/// Adds what a light does to the gathered diffuse and specular light.
template <class F, Highlight highlight>
[[gnu::always_inline]] inline void add_light(const Illumination& s, const PreparedLight& of, const Points& p,
                                             const Cosines& cosines, Vector<F>& diffuse, Vector<F>& specular, int i) {
  const Vector<F> radiance = arriving<F>(of, p, i).radiance;
  diffuse = diffuse + radiance * F::load(cosines.diffuse + i);
  if constexpr (highlight != Highlight::None)
    specular = specular + radiance * power(F::load(cosines.highlight + i), s.exponent);
}

template <class F, Highlight highlight>
void light_phong(const Illumination& s, const Batch& batch, const Points& p, Shaded& out) {
  const auto ambient = Vector<F>::all(s.ambient);
  Cosines cosines;
  alignas(64) Points::Array diffuse_sum[3], specular_sum[3];
  for (int k = 0; k == 0 || k < s.lights; ++k) {
    if (k < s.lights) find_cosines<F, highlight>(s, s.light[k], batch, p, cosines);
    for (int i = 0; i < p.count; i += F::lanes) {
      Vector<F> diffuse = zeros<F>(), specular = zeros<F>();
      if (k > 0) diffuse = Vector<F>::load(diffuse_sum, i), specular = Vector<F>::load(specular_sum, i);
      if (k < s.lights) add_light<F, highlight>(s, s.light[k], p, cosines, diffuse, specular, i);
      if (k + 1 < s.lights) {
        diffuse.store(diffuse_sum, i), specular.store(specular_sum, i);
        continue;
      }
      const auto base = Vector<F>::load(p.base, i);
      Vector<F> sum = base * (ambient * occlusion_at<F>(s, p, i) + diffuse);
      if constexpr (highlight != Highlight::None) sum = sum + Vector<F>::all(s.specular) * specular;
      finish(s, p, sum, base, out, i);
    }
  }
}

template <class F>
void light_phong(const Illumination& s, const Batch& batch, const Points& p, Shaded& out) {
  if (!s.has_specular) return light_phong<F, Highlight::None>(s, batch, p, out);
  if (s.is_phong) return light_phong<F, Highlight::Phong>(s, batch, p, out);
  light_phong<F, Highlight::BlinnPhong>(s, batch, p, out);
}

template <class F>
void light_metallic(const Illumination& s, const Batch& batch, const Points& p, Shaded& out) {
  const auto environment = Vector<F>::all(s.environment);
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i), base = Vector<F>::load(p.base, i);
    const auto v = s.needs_viewer ? towards_viewer<F>(s.viewpoint, batch, p, i) : zeros<F>();
    const F metallic = s.has_material_texture ? F::load(p.metallic + i) : F(s.metallic);
    const F roughness = s.has_material_texture ? F::load(p.roughness + i) : F(s.roughness);
    const Metallic<F> m = make_metallic(base, metallic, roughness);
    Vector<F> sum = zeros<F>();
    for (int k = 0; k < s.lights; ++k) {
      const Arriving<F> light = arriving<F>(s.light[k], p, i);
      sum = sum + light.radiance * metallic_light(m, n, light.from, v);
    }
    if (s.has_environment) {
      const F nv = min(max(dot(n, v), F(0.0f)), F(1.0f));
      sum = sum + environment * occlusion_at<F>(s, p, i) * metallic_environment(base, metallic, roughness, nv);
    }
    finish(s, p, sum, base, out, i);
  }
}

template <class F>
void unlit(bool is_blended, const Points& p, Shaded& out) {
  for (int i = 0; i < p.count; i += F::lanes)
    store_color(Vector<F>::load(p.base, i), is_blended ? F::load(p.base[3] + i) : F(1.0f), out, i);
}

}  // namespace zoneplate::stages
