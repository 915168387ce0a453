// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/lanes_vector.h"
#include "zoneplate/shade/surface/exponent.h"

/// Reflection models, as templates over the lane types of math/lanes.h.
///
/// n is the normal, l points to the light, v to the viewer, h halfway between; all unit length or zero.
namespace zoneplate {

/// max(n · l, 0). Source: Lambert, Photometria, 1760.
template <class F>
[[gnu::always_inline]] inline F lambert(F nl) {
  return max(nl, F(0.0f));
}

/// x^exponent.
///
/// Requires  x >= 0.
template <class F>
[[gnu::always_inline]] inline F power(F x, Exponent exponent) {
  if (exponent.whole == 0) return pow(x, F(exponent.value));
  auto left = static_cast<unsigned>(exponent.whole);
  for (; left % 2 == 0; left /= 2) x = x * x;
  F result = x;
  for (left /= 2; left > 0; left /= 2) {
    x = x * x;
    if (left % 2 != 0) result = result * x;
  }
  return result;
}

/// x^(exponent / 2), with x the square of a cosine: only odd exponents need a square root.
template <class F>
[[gnu::always_inline]] inline F power_of_square(F x, Exponent exponent) {
  if (exponent.whole % 2 != 0) return power(F(sqrt(x)), exponent);
  return power(x, {exponent.value * 0.5f, exponent.whole / 2});
}

/// max(n · h, 0)^exponent; not cut where the light is below the horizon.
/// Source: Blinn, Models of Light Reflection for Computer Synthesized Images, SIGGRAPH 1977.
template <class F>
[[gnu::always_inline]] inline F blinn_phong(F nh, Exponent exponent) {
  return power(max(nh, F(0.0f)), exponent);
}

/// r · v with r the mirror image of l in n.
template <class F>
[[gnu::always_inline]] inline F phong_cosine(Vector<F> n, Vector<F> l, Vector<F> v) {
  return dot(n * (F(2.0f) * dot(n, l)) - l, v);
}

/// max(r · v, 0)^exponent; not cut where the light is below the horizon.
/// Source: Phong, Illumination for Computer Generated Images, CACM 18(6), 1975.
template <class F>
[[gnu::always_inline]] inline F phong(Vector<F> n, Vector<F> l, Vector<F> v, Exponent exponent) {
  return power(max(phong_cosine(n, l, v), F(0.0f)), exponent);
}

inline constexpr float inverse_pi = 0.318309886f;

/// The lower bound of roughness: below it, the highlight of a punctual light would fall between the pixels. D, at most
/// 1 / (π α²), so stays below 1e5.
inline constexpr float least_roughness = 0.045f;

/// Density of microfacet normals: D = α² / (π (α² (n·h)² + |n × h|²)²). The usual form with ((n·h)² (α² - 1) + 1) in
/// the parenthesis is equal but loses digits by cancellation near n = h.
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

/// (1 - v·h)^5, the weight in Schlick's Fresnel term f0 + (1 - f0) weight.
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

/// The specular reflectance of a uniform environment is f0 scale + bias, for any f0.
template <class F>
struct SpecularWeights {
  F scale, bias;
};

/// Coefficients by powers of roughness, then of 1 - n·v: least-squares fits at 28 × 36 points to the integrals of
/// V D (1 - v·h)^5 4 (n·l) and of V D 4 (n·l), computed to four digits (brdf_test.cpp repeats the fits).
inline constexpr float bias_fit[5][6] = {{0.001071967f, -0.02879978f, 0.06464715f, 0.6246422f, -2.248347f, 2.752502f},
                                         {0.06429541f, -3.563934f, 35.83931f, -131.8516f, 200.4812f, -104.5397f},
                                         {-0.3169211f, 16.97701f, -165.8701f, 593.0977f, -866.8636f, 427.0783f},
                                         {0.4722983f, -24.93838f, 240.9048f, -850.3088f, 1218.679f, -586.6104f},
                                         {-0.2222662f, 11.63321f, -111.6655f, 390.8947f, -553.3457f, 262.8498f}};
inline constexpr float scale_and_bias_fit[5][6] = {
    {1.030213f, -0.5295086f, 3.992396f, -12.97856f, 17.04678f, -7.533857f},
    {-0.5799478f, 6.826395f, -46.4232f, 149.67f, -190.8224f, 79.61082f},
    {3.218751f, -22.70056f, 133.9361f, -431.7784f, 528.2256f, -203.7823f},
    {-6.757923f, 27.54618f, -146.1094f, 473.533f, -553.8303f, 195.7494f},
    {3.39516f, -10.8005f, 53.47554f, -174.0905f, 193.1336f, -60.68471f}};

/// Both fits for one roughness, which leaves polynomials in 1 - n·v.
///
/// Requires  roughness in [0, 1], nv in [0, 1].
/// Edges     roughness below least_roughness counts as least_roughness.
/// Exact     scale + bias and bias within 0.04 of their integrals, 0.005 in the root mean square.
/// Source    the split into scale and bias: Karis, Real Shading in Unreal Engine 4, SIGGRAPH 2013 (its own fits are for
///           another geometry term, and off by 0.17 here).
template <class F>
struct SpecularFit {
  F total[6], bias[6];

  [[gnu::always_inline]] explicit SpecularFit(F roughness) {
    const F r = max(roughness, F(least_roughness));
    for (int j = 0; j < 6; ++j) total[j] = of(scale_and_bias_fit, j, r), bias[j] = of(bias_fit, j, r);
  }
  [[gnu::always_inline]] SpecularWeights<F> at(F nv) const {
    const F t = F(1.0f) - nv;
    const F both = min(max(evaluate(total, t), F(0.0f)), F(1.0f));
    const F least = min(max(evaluate(bias, t), F(0.0f)), both);
    return {both - least, least};
  }

 private:
  [[gnu::always_inline]] static F of(const float (&fit)[5][6], int j, F roughness) {
    F sum(fit[4][j]);
    for (int i = 3; i >= 0; --i) sum = sum * roughness + F(fit[i][j]);
    return sum;
  }
  [[gnu::always_inline]] static F evaluate(const F (&polynomial)[6], F t) {
    F sum = polynomial[5];
    for (int j = 4; j >= 0; --j) sum = sum * t + polynomial[j];
    return sum;
  }
};

/// The specular reflectance of a uniform environment for one f0, including multiple scattering between microfacets.
///
/// Source    Fdez-Agüera, A Multiple-Scattering Microfacet Model for Real-Time Image-based Lighting, JCGT 8(1), 2019.
template <class F>
[[gnu::always_inline]] inline F specular_albedo(SpecularWeights<F> weights, F f0) {
  const F one(1.0f);
  const F lost = one - (weights.scale + weights.bias);
  const F once = f0 * weights.scale + weights.bias;
  const F mean = f0 + (one - f0) * F(1.0f / 21.0f);
  return once + once * (mean * lost / (one - mean * lost));
}

/// The light of an environment that a metallic-roughness surface reflects: a part of the light from about the mirror
/// direction, filtered by the lobe, and a part of the irradiance over π.
template <class F>
struct EnvironmentShares {
  Vector<F> mirrored;   ///< of the light that the microfacets reflect once
  Vector<F> scattered;  ///< of diffuse light, and of light that the microfacets reflect several times
};

/// The shares of metallic_environment. Their sum is its result, to rounding.
///
/// Source    as metallic_environment; light of several reflections arrives from all sides (Fdez-Agüera 2019).
template <class F>
[[gnu::always_inline]] inline EnvironmentShares<F> metallic_shares(Vector<F> base, F metallic,
                                                                   SpecularWeights<F> weights) {
  const F one(1.0f), f0_coat(0.04f);
  const F coat_once = f0_coat * weights.scale + weights.bias, coat = specular_albedo(weights, f0_coat);
  const auto mirrored = [&](F color) {
    const F once = min(color, one) * weights.scale + weights.bias;
    return coat_once + (once - coat_once) * metallic;
  };
  const auto scattered = [&](F color) {
    const F c = min(color, one);
    const F metal = specular_albedo(weights, c) - (c * weights.scale + weights.bias);
    const F dielectric = (coat - coat_once) + c * (one - coat);
    return dielectric + (metal - dielectric) * metallic;
  };
  return {{mirrored(base.x), mirrored(base.y), mirrored(base.z)},
          {scattered(base.x), scattered(base.y), scattered(base.z)}};
}

/// The fraction of a constant environment that a metallic-roughness surface reflects, specular and diffuse.
///
/// The surface is a mixture of a metal and a dielectric, whose diffuse layer receives the light that the specular layer
/// does not reflect. A white surface therefore reflects 1 (to rounding), whatever its roughness and metalness.
///
/// Source    glTF 2.0, appendix B.2: mix(dielectric, metal, metallic).
template <class F>
[[gnu::always_inline]] inline Vector<F> metallic_environment(Vector<F> base, F metallic, const SpecularFit<F>& fit,
                                                             F nv) {
  const F one(1.0f);
  const SpecularWeights<F> weights = fit.at(nv);
  const F coat = specular_albedo(weights, F(0.04f));
  const auto channel = [&](F color) {
    const F c = min(color, one);
    const F dielectric = coat + c * (one - coat);
    return dielectric + (specular_albedo(weights, c) - dielectric) * metallic;
  };
  return {channel(base.x), channel(base.y), channel(base.z)};
}

}  // namespace zoneplate
