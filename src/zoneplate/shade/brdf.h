#pragma once

#include "zoneplate/shade/vector.h"

/// Reflection models, as templates over the lane types of shade/lanes.h.
///
/// n is the normal, l points to the light, v to the viewer, h halfway between; all unit length or zero.
namespace zoneplate {

/// max(n · l, 0). Source: Lambert, Photometria, 1760.
template <class F>
[[gnu::always_inline]] inline F lambert(F nl) {
  return max(nl, F(0.0f));
}

/// max(n · h, 0)^exponent; not cut where the light is below the horizon.
/// Source: Blinn, Models of Light Reflection for Computer Synthesized Pictures, SIGGRAPH 1977.
template <class F>
[[gnu::always_inline]] inline F blinn_phong(F nh, F exponent) {
  return pow(max(nh, F(0.0f)), exponent);
}

/// max(r · v, 0)^exponent with r the mirror image of l in n; not cut where the light is below the horizon.
/// Source: Phong, Illumination for Computer Generated Pictures, CACM 18(6), 1975.
template <class F>
[[gnu::always_inline]] inline F phong(Vector<F> n, Vector<F> l, Vector<F> v, F exponent) {
  const Vector<F> r = n * (F(2.0f) * dot(n, l)) - l;
  return pow(max(dot(r, v), F(0.0f)), exponent);
}

inline constexpr float inverse_pi = 0.318309886f;

/// Roughness is not taken smaller: a punctual light's highlight would be a point that no pixel finds, and D, at
/// most 1 / (π α²), stays below 1e5.
inline constexpr float least_roughness = 0.045f;

/// Density of microfacet normals: D = α² / (π (α² (n·h)² + |n × h|²)²), the same as with ((n·h)² (α² - 1) + 1) in the
/// parenthesis but without its cancellation near n = h.
///
/// Source    Walter et al., Microfacet Models for Refraction through Rough Surfaces, EGSR 2007 (GGX); Trowbridge and
///           Reitz 1975.
template <class F>
[[gnu::always_inline]] inline F ggx(F nh, Vector<F> n_cross_h, F alpha) {
  const F alpha2 = alpha * alpha;
  const F d = alpha2 * (nh * nh) + dot(n_cross_h, n_cross_h);
  return (alpha2 * F(inverse_pi)) / max(d * d, F(1e-30f));
}

/// Masking and shadowing over 4 (n·l)(n·v), height-correlated.
///
/// Requires  nl >= 0, nv > 0, alpha > 0.
/// Source    Heitz, Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs, JCGT 3(2), 2014.
template <class F>
[[gnu::always_inline]] inline F smith(F nl, F nv, F alpha) {
  const F alpha2 = alpha * alpha;
  const F rest = F(1.0f) - alpha2;
  const F towards_viewer = nl * sqrt(nv * nv * rest + alpha2);
  const F towards_light = nv * sqrt(nl * nl * rest + alpha2);
  return F(0.5f) / (towards_viewer + towards_light);
}

/// (1 - v·h)^5, the weight of white in f0 + (1 - f0) weight.
/// Source: Schlick, An Inexpensive BRDF Model for Physically-based Rendering, Eurographics 1994.
template <class F>
[[gnu::always_inline]] inline F schlick_weight(F vh) {
  const F x = max(F(1.0f) - max(vh, F(0.0f)), F(0.0f));
  const F x2 = x * x;
  return x2 * x2 * x;
}

/// A metallic-roughness surface, prepared for its lights.
template <class F>
struct Metallic {
  Vector<F> diffuse;  ///< base colour of the dielectric part
  Vector<F> f0;       ///< reflectance at normal incidence
  F alpha;            ///< roughness squared
};

/// Source: glTF 2.0, appendix B: c_diff = mix(base, 0, metallic), f0 = mix(0.04, base, metallic).
template <class F>
[[gnu::always_inline]] inline Metallic<F> make_metallic(Vector<F> base, F metallic, F roughness) {
  const F dielectric = F(1.0f) - metallic;
  const F r = max(roughness, F(least_roughness));
  const F one(1.0f), f0 = F(0.04f) * dielectric;
  const Vector<F> reflectance{min(f0 + base.x * metallic, one), min(f0 + base.y * metallic, one),
                              min(f0 + base.z * metallic, one)};
  return {base * dielectric, reflectance, r * r};
}

/// Reflected radiance for one unit of irradiance perpendicular to l: BRDF × n·l; zero for lights below the horizon.
///
/// Source    glTF 2.0, appendix B.3: (1 - F) c_diff / π + F V D.
template <class F>
[[gnu::always_inline]] inline Vector<F> metallic_light(const Metallic<F>& m, Vector<F> n, Vector<F> l, Vector<F> v) {
  const Vector<F> h = normalize(l + v);
  const F nl = max(dot(n, l), F(0.0f));
  const F nv = max(dot(n, v), F(1e-4f));
  const F peak = ggx(dot(n, h), cross(n, h), m.alpha) * smith(nl, nv, m.alpha);
  const F white = schlick_weight(dot(v, h));
  const Vector<F> one{F(1.0f), F(1.0f), F(1.0f)};
  const Vector<F> fresnel = m.f0 + (one - m.f0) * white;
  return ((one - fresnel) * (m.diffuse * F(inverse_pi)) + fresnel * peak) * nl;
}

/// Share of a constant environment that a metallic-roughness surface reflects: specular plus diffuse.
///
/// The directional albedo of the specular lobe is f0 A + B. Light that bounces between microfacets more than once is
/// added (Fdez-Agüera 2019), and the diffuse layer gets what the specular one leaves, so a white surface, metal or
/// not, reflects 1 (to rounding).
///
/// Exact     f0 A + B within 0.03 of its integral for roughness in [0.1, 1], n·v in [0.1, 1] (brdf_test.cpp).
/// Source    A, B: Karis, Physically Based Shading on Mobile, 2014 (after Lazarov 2013). Fdez-Agüera, A Multiple-
///           Scattering Microfacet Model for Real-Time Image-based Lighting, JCGT 8(1), 2019.
template <class F>
[[gnu::always_inline]] inline Vector<F> metallic_environment(const Metallic<F>& m, F nv) {
  const F roughness = sqrt(m.alpha);
  const F x = F(1.0f) - roughness;
  const F y = F(0.0425f) - F(0.0275f) * roughness;
  const F z = F(1.04f) - F(0.572f) * roughness;
  const F w = F(0.022f) * roughness - F(0.04f);
  const F t = min(x * x, exp2(F(-9.28f) * nv)) * x + y;
  const F a = z - F(1.04f) * t;
  const F b = w + F(1.04f) * t;

  // One bounce; then the share that is left inside bounces on with the mean reflectance.
  const Vector<F> one{F(1.0f), F(1.0f), F(1.0f)};
  const F lost = F(1.0f) - (a + b);
  const Vector<F> once{m.f0.x * a + b, m.f0.y * a + b, m.f0.z * a + b};
  const Vector<F> mean = m.f0 + (one - m.f0) * F(1.0f / 21.0f);
  const Vector<F> stays = one - mean * lost;
  const Vector<F> more{F(1.0f) / stays.x, F(1.0f) / stays.y, F(1.0f) / stays.z};
  const Vector<F> specular = once + once * mean * lost * more;
  return specular + m.diffuse * (one - specular);
}

}  // namespace zoneplate
