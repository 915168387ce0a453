#pragma once

#include "zoneplate/shade/brdf.h"
#include "zoneplate/shade/surface_kernels.h"

/// The stages of shade/surface_kernels.h from the lights to the colour, over the lane types of shade/lanes.h.
namespace zoneplate::stages {

template <class F>
void reach_light(const PreparedLight& light, Points& p) {
  if (light.is_directional) {
    for (int i = 0; i < p.count; i += F::lanes) {
      Vector<F>::all(light.towards).store(p.to_light, i);
      F(1.0f).store(p.strength + i);
    }
    return;
  }
  const auto position = Vector<F>::all(light.position), axis = Vector<F>::all(light.axis);
  for (int i = 0; i < p.count; i += F::lanes) {
    const Vector<F> path = position - Vector<F>::load(p.position, i);
    const Vector<F> l = normalize(path);
    l.store(p.to_light, i);
    F strength = fading(light, dot(path, path));
    if (light.is_spot) strength = strength * cone(light, -dot(l, axis));
    strength.store(p.strength + i);
  }
}

/// to += light.
template <class F, class Array>
[[gnu::always_inline]] inline void add(Array& to, Vector<F> light, int i) {
  (Vector<F>::load(to, i) + light).store(to, i);
}

template <class F>
void add_lambert(const PreparedLight& light, Points& p) {
  const auto radiance = Vector<F>::all(light.radiance);
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i), l = Vector<F>::load(p.to_light, i);
    add(p.diffuse, radiance * F::load(p.strength + i) * lambert(dot(n, l)), i);
  }
}

template <class F>
void add_blinn_phong(const PreparedLight& light, float exponent, Points& p) {
  const auto radiance = Vector<F>::all(light.radiance);
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i), l = Vector<F>::load(p.to_light, i);
    const auto h = normalize(l + Vector<F>::load(p.to_viewer, i));
    const auto arriving = radiance * F::load(p.strength + i);
    add(p.diffuse, arriving * lambert(dot(n, l)), i);
    add(p.specular, arriving * blinn_phong(dot(n, h), F(exponent)), i);
  }
}

template <class F>
void add_phong(const PreparedLight& light, float exponent, Points& p) {
  const auto radiance = Vector<F>::all(light.radiance);
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i), l = Vector<F>::load(p.to_light, i);
    const auto arriving = radiance * F::load(p.strength + i);
    add(p.diffuse, arriving * lambert(dot(n, l)), i);
    add(p.specular, arriving * phong(n, l, Vector<F>::load(p.to_viewer, i), F(exponent)), i);
  }
}

template <class F>
[[gnu::always_inline]] inline Metallic<F> metallic_at(const Points& p, int i) {
  return make_metallic(Vector<F>::load(p.base, i), F::load(p.metallic + i), F::load(p.roughness + i));
}

template <class F>
void add_metallic(const PreparedLight& light, Points& p) {
  const auto radiance = Vector<F>::all(light.radiance);
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i), l = Vector<F>::load(p.to_light, i);
    const auto reflected = metallic_light(metallic_at<F>(p, i), n, l, Vector<F>::load(p.to_viewer, i));
    add(p.sum, radiance * F::load(p.strength + i) * reflected, i);
  }
}

template <class F>
void add_environment(const float radiance[3], Points& p) {
  const Vector<F> all{F(radiance[0]), F(radiance[1]), F(radiance[2])};
  for (int i = 0; i < p.count; i += F::lanes) {
    const F nv = dot(Vector<F>::load(p.normal, i), Vector<F>::load(p.to_viewer, i));
    const auto reflected = metallic_environment(Vector<F>::load(p.base, i), F::load(p.metallic + i),
                                                F::load(p.roughness + i), min(max(nv, F(0.0f)), F(1.0f)));
    add(p.sum, all * F::load(p.occlusion + i) * reflected, i);
  }
}

template <class F>
void combine_diffuse(const float ambient[3], Points& p) {
  const Vector<F> all{F(ambient[0]), F(ambient[1]), F(ambient[2])};
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto light = all * F::load(p.occlusion + i) + Vector<F>::load(p.diffuse, i);
    (Vector<F>::load(p.base, i) * light).store(p.sum, i);
  }
}

template <class F>
void add_specular(const float color[3], Points& p) {
  const Vector<F> all{F(color[0]), F(color[1]), F(color[2])};
  for (int i = 0; i < p.count; i += F::lanes) add(p.sum, all * Vector<F>::load(p.specular, i), i);
}

template <class F>
void add_emissive(Points& p) {
  for (int i = 0; i < p.count; i += F::lanes) add(p.sum, Vector<F>::load(p.emissive, i), i);
}

template <class F>
void keep_unlit(Points& p) {
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto is_lit = F::load(p.is_lit + i) > F(0.5f);
    select(is_lit, Vector<F>::load(p.sum, i), Vector<F>::load(p.base, i)).store(p.sum, i);
  }
}

template <class F>
void finish(const float* const color[3], const float* alpha, Shaded& out, int count) {
  const F low(0.0f), high(1e9f);
  for (int i = 0; i < count; i += F::lanes) {
    const F a = alpha != nullptr ? F::load(alpha + i) : F(1.0f);
    (min(max(F::load(color[0] + i), low), high) * a).store(out.r + i);
    (min(max(F::load(color[1] + i), low), high) * a).store(out.g + i);
    (min(max(F::load(color[2] + i), low), high) * a).store(out.b + i);
    a.store(out.a + i);
  }
}

}  // namespace zoneplate::stages
