// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "zoneplate/math/lanes_vector.h"
#include "zoneplate/shade/reflection/exponent.h"
#include "zoneplate/shade/reflection/specular_table.h"

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
inline constexpr float min_roughness = 0.045f;

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

/// The direction about which the lobe of a roughness gathers the light of an environment that is filtered for a view
/// along the normal: from the mirror image of v at roughness 0 to n at 1. A rough surface that is seen at an angle
/// reflects light from nearer the normal than the mirror direction, and none from below its horizon.
///
/// Shape     not of unit length.
/// Exact     over four captured environments and all views, the root mean square difference of the filtered light to the
///           integral of the lobe with masking and shadowing is 0.97 times that about the mirror direction at roughness
///           0.3, 0.78 times at 0.6, 0.62 times at 0.75 and 0.27 times at 1 (geometric means over the environments).
/// Source    the mixture by α² of Filament and three.js, a form of Lagarde and de Rousiers, Moving Frostbite to
///           Physically Based Rendering 3.0, SIGGRAPH 2014, "Specular lobe dominant direction".
template <class F>
[[gnu::always_inline]] inline Vector<F> lobe_direction(Vector<F> n, Vector<F> v, F roughness) {
  const F along = dot(n, v), alpha = roughness * roughness;
  const Vector<F> mirror = n * (along + along) - v;
  return mirror + (n - mirror) * (alpha * alpha);
}

/// What the highlight of (Blinn-)Phong reflects of light of radiance 1 from all sides, where its colour is 1: the
/// integral of the highlight over the directions of light above the surface, over π as for the diffuse term, which
/// reflects 1.
///
/// Requires  exponent >= 0, nv in [0, 1].
/// Error     of Blinn-Phong, at most 0.065; of Phong, at most 3 % from exponent 4 on where nv >= 0.7, too high at more
///           grazing views, by half at exponent 1 and nv = 0.3, because the part of the lobe below the surface is
///           counted.
/// Exact     for a view along the normal.
template <class F>
[[gnu::always_inline]] inline F blinn_phong_albedo(F exponent, F nv) {
  const F tail = pow(F(0.5f), (exponent + F(1.0f)) * F(0.5f));
  return F(8.0f) / (exponent + F(2.0f)) * (F(1.0f) - tail * F(0.707106781f)) * (nv + (F(1.0f) - nv) * tail);
}
template <class F>
[[gnu::always_inline]] inline F phong_albedo(F exponent) {
  return F(2.0f) / (exponent + F(1.0f));
}

/// The roughness of the GGX lobe that is as wide as the highlight of an exponent. A highlight of Phong is as wide as
/// one of Blinn-Phong with four times its exponent.
///
/// Source    Karis, Specular BRDF Reference, 2013: α = roughness², exponent = 2 / α² - 2.
template <class F>
[[gnu::always_inline]] inline F roughness_of_exponent(F exponent) {
  return sqrt(sqrt(F(2.0f) / (exponent + F(2.0f))));
}

/// The specular reflectance of a uniform environment is f0 scale + bias, for any f0.
template <class F>
struct SpecularWeights {
  F scale, bias;
};

template <class F>
[[gnu::always_inline]] inline F table_value(const float* table, typename F::Int i) {
  if constexpr (requires { F::gather(table, i); })
    return F::gather(table, i);
  else
    return F(static_cast<double>(table[i.v]));  // the references of the tests
}

/// The weights for n·v between the columns of a table: value(table, column) is a row's, for its whole and its grazing
/// part.
template <class F, class Value>
[[gnu::always_inline]] inline SpecularWeights<F> specular_weights_at(F nv, const Value& value) {
  using Int = typename F::Int;
  const F columns = sqrt(nv) * F(specular_table_side - 1.0f);
  const Int column = truncate(min(columns, F(specular_table_side - 2.0f)));
  const F right = columns - F::from(column);
  const auto between = [&](const auto& table) __attribute__((always_inline)) {
    const F left = value(table, column);
    return left + (value(table, column + Int(1)) - left) * right;
  };
  const F whole = between(specular_table_whole), bias = between(specular_table_grazing);
  return {whole - bias, bias};
}

/// The weights for a roughness, by the tables of shade/reflection/specular_table.h.
///
/// Requires  roughness in [0, 1], nv in [0, 1].
/// Edges     roughness below min_roughness counts as min_roughness.
/// Exact     scale + bias and bias within 0.01 of their integrals for nv above 0.02, 0.002 in the root mean square.
template <class F>
struct SpecularFit {
  typename F::Int row;
  F part;  ///< of the row below

  [[gnu::always_inline]] explicit SpecularFit(F roughness) {
    const F rows =
        (max(roughness, F(min_roughness)) - F(min_roughness)) * F((specular_table_side - 1) / (1 - min_roughness));
    row = truncate(min(rows, F(specular_table_side - 2.0f)));
    part = rows - F::from(row);
  }
  [[gnu::always_inline]] SpecularWeights<F> at(F nv) const {
    using Int = typename F::Int;
    const Int first = row * Int(specular_table_side);
    return specular_weights_at(
        nv, [&](const auto& table, Int column) __attribute__((always_inline)) {
          const F above = table_value<F>(table[0], first + column);
          return above + (table_value<F>(table[1], first + column) - above) * part;
        });
  }
};

/// SpecularFit of one roughness for all lanes, with the same bits: a row between the tables' rows.
template <class F>
class SpecularRow {
 public:
  [[gnu::always_inline]] explicit SpecularRow(float roughness) {
    const SpecularFit<F> fit{F(roughness)};
    const std::int32_t row = fit.row.first();
    for (int c = 0; c < specular_table_side; c += F::lanes) {
      const auto mixed = [&](const auto& table) __attribute__((always_inline)) {
        const F above = F::load(table[row] + c);
        return above + (F::load(table[row + 1] + c) - above) * fit.part;
      };
      mixed(specular_table_whole).store(whole_ + c), mixed(specular_table_grazing).store(grazing_ + c);
    }
  }
  [[gnu::always_inline]] SpecularWeights<F> at(F nv) const {
    return specular_weights_at(
        nv, [&](const auto& table, typename F::Int column) __attribute__((always_inline)) {
          return F::look_up(&table == &specular_table_whole ? whole_ : grazing_, column);
        });
  }

 private:
  alignas(64) float whole_[specular_table_side];
  alignas(64) float grazing_[specular_table_side];
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

/// specular_albedo over the reflectance of single scattering: what the lobe is multiplied by so that it reflects the
/// light of several reflections too.
template <class F>
[[gnu::always_inline]] inline F specular_gain(SpecularWeights<F> weights, F f0) {
  const F one(1.0f);
  const F mean = f0 + (one - f0) * F(1.0f / 21.0f);
  return one / (one - mean * (one - (weights.scale + weights.bias)));
}

/// A metallic-roughness surface seen from one direction, prepared for its lights.
template <class F>
struct Metallic {
  Vector<F> diffuse;            ///< reflectance of the layer below the dielectric's lobe, over π
  Vector<F> mirrored, grazing;  ///< the lobe's Fresnel term: mirrored + grazing × schlick_weight
  F alpha;                      ///< roughness squared
};

/// Source    glTF 2.0, appendix B: a mixture of a dielectric with f0 0.04 and a metal with f0 of the base colour. Unlike
///           glTF's sample implementation, whose rough metals lose up to 70 % of the light and whose dielectrics gain
///           it at grazing views, light that arrives from all sides evenly is reflected as metallic_environment
///           reflects it: the lobes have their specular_gain, and the layer below gets what the lobe leaves on average.
template <class F>
[[gnu::always_inline]] inline Metallic<F> make_metallic(Vector<F> base, F metallic, F roughness,
                                                        SpecularWeights<F> weights) {
  const F one(1.0f), f0(0.04f), dielectric = one - metallic;
  const F r = max(roughness, F(min_roughness));
  const F coat_gain = specular_gain(weights, f0) * dielectric;
  const F below = (one - specular_albedo(weights, f0)) * dielectric * F(inverse_pi);
  Metallic<F> m{base * below, {}, {}, r * r};
  const auto lobe = [&](F color, F& mirrored, F& grazing) {
    const F c = min(color, one), gain = specular_gain(weights, c) * metallic;
    mirrored = f0 * coat_gain + c * gain;
    grazing = (one - f0) * coat_gain + (one - c) * gain;
  };
  lobe(base.x, m.mirrored.x, m.grazing.x);
  lobe(base.y, m.mirrored.y, m.grazing.y);
  lobe(base.z, m.mirrored.z, m.grazing.z);
  return m;
}

/// make_metallic with metallic 0, with the same bits.
template <class F>
[[gnu::always_inline]] inline Metallic<F> make_dielectric(Vector<F> base, F roughness, SpecularWeights<F> weights) {
  const F one(1.0f), f0(0.04f), gain = specular_gain(weights, f0);
  const F r = max(roughness, F(min_roughness)), mirrored = f0 * gain, grazing = (one - f0) * gain;
  return {base * ((one - specular_albedo(weights, f0)) * F(inverse_pi)),
          {mirrored, mirrored, mirrored},
          {grazing, grazing, grazing},
          r * r};
}

/// Reflected radiance for one unit of irradiance perpendicular to l: BRDF × n·l, with the lobe of `alpha`; zero for
/// lights below the horizon.
template <class F>
[[gnu::always_inline]] inline Vector<F> metallic_light(const Metallic<F>& m, Vector<F> n, Vector<F> l, Vector<F> v,
                                                       F alpha) {
  const Vector<F> h = normalize(l + v);
  const F nl = max(dot(n, l), F(0.0f));
  const F nv = max(dot(n, v), F(1e-4f));
  const F peak = ggx(dot(n, h), cross(n, h), alpha) * smith(nl, nv, alpha);
  return (m.diffuse + (m.mirrored + m.grazing * schlick_weight(dot(v, h))) * peak) * nl;
}

template <class F>
[[gnu::always_inline]] inline Vector<F> metallic_light(const Metallic<F>& m, Vector<F> n, Vector<F> l, Vector<F> v) {
  return metallic_light(m, n, l, v, m.alpha);
}

/// A GGX lobe whose normals turn within a pixel: it is convolved with a normal distribution of slopes, whose matrix is
/// half of a aᵀ + b bᵀ, in the plane across n. With a and b zero it is the isotropic lobe.
///
/// The convolution is approximated by a mixture of two lobes with the matrix A = α² I + a aᵀ + b bᵀ: GGX, which has the
/// tails, by the part (α⁴ / det A)^¼, and Beckmann. For isotropic turns of any size, the error of the mixture is at
/// most 12 % of the lobe in the root mean square over slopes; that of GGX alone is up to 22 %, and with it the light of
/// spheres of a few pixels' radius is up to 20 % too much. The Beckmann part is the distribution of the normals in the
/// pixel, which do not mask each other.
///
/// Source    non-axis-aligned NDF filtering: Tokuyoshi and Kaplanyan, Stable Geometric Specular Antialiasing with
///           Projected-Space NDF Filtering, JCGT 10(2), 2021, which has GGX alone; the shapes: Heitz 2014.
template <class F>
struct TurningLobe {
  Vector<F> n, v, a, b;
  F alpha2, determinant, tails, nv, towards_viewer;

  /// Requires  n and v of unit length, a and b perpendicular to the interpolated normal.
  [[gnu::always_inline]] TurningLobe(Vector<F> n_in, Vector<F> v_in, Vector<F> a_in, Vector<F> b_in, F roughness)
      : n(n_in), v(v_in), a(a_in), b(b_in) {
    const F r = max(roughness, F(min_roughness)), across = dot(n, cross(a, b));
    alpha2 = r * r * (r * r);
    determinant = alpha2 * (alpha2 + (dot(a, a) + dot(b, b))) + across * across;
    tails = min(sqrt(alpha2 / max(sqrt(determinant), F(1e-30f))), F(1.0f));
    nv = max(dot(n, v), F(1e-4f));
    towards_viewer = stretched(v, nv);
  }
  /// The square root of dᵀ A d + (n·d)², by which microfacets mask each other.
  [[gnu::always_inline]] F stretched(Vector<F> d, F nd) const {
    const F along_a = dot(a, d), along_b = dot(b, d), square = nd * nd;
    return sqrt(alpha2 * max(F(1.0f) - square, F(0.0f)) + (along_a * along_a + along_b * along_b) + square);
  }
  /// Density of normals × masking and shadowing over 4 (n·l)(n·v).
  [[gnu::always_inline]] F peak(Vector<F> l, Vector<F> h, F nl) const {
    const F zero(0.0f), least(1e-30f);
    const Vector<F> across = cross(n, h);
    const F along_a = dot(n, cross(a, h)), along_b = dot(n, cross(b, h)), nh = dot(n, h);
    const F flat = alpha2 * dot(across, across) + (along_a * along_a + along_b * along_b);
    const F slope = flat / max(determinant, least), square = nh * nh, q = slope + square;
    const F scale = F(inverse_pi) / max(sqrt(determinant), least);
    const F ggx = scale / max(q * q, least) * F(0.5f) / max(nl * towards_viewer + nv * stretched(l, nl), least);

    constexpr float log2_e = 1.44269504f;
    const F cosine = max(nh, F(1e-3f));
    const F bell = exp2(max(slope / (cosine * cosine), zero) * F(-log2_e)) * scale / (cosine * cosine * cosine);
    const F beckmann = bell * F(0.25f) / (max(dot(h, v), F(1e-4f)) * max(nl, F(1e-4f)));
    return ggx * tails + select(nh > zero, beckmann, zero) * (F(1.0f) - tails);
  }
};

/// metallic_light with a lobe whose normals turn.
template <class F>
[[gnu::always_inline]] inline Vector<F> metallic_light(const Metallic<F>& m, const TurningLobe<F>& lobe, Vector<F> l) {
  const Vector<F> h = normalize(l + lobe.v);
  const F nl = max(dot(lobe.n, l), F(0.0f));
  return (m.diffuse + (m.mirrored + m.grazing * schlick_weight(dot(lobe.v, h))) * lobe.peak(l, h, nl)) * nl;
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

/// metallic_shares with metallic 0, with the same bits.
template <class F>
[[gnu::always_inline]] inline EnvironmentShares<F> dielectric_shares(Vector<F> base, SpecularWeights<F> weights) {
  const F one(1.0f), f0(0.04f), once = f0 * weights.scale + weights.bias, all = specular_albedo(weights, f0);
  const auto scattered = [&](F color) { return (all - once) + min(color, one) * (one - all); };
  return {{once, once, once}, {scattered(base.x), scattered(base.y), scattered(base.z)}};
}

/// The fraction of a constant environment that a metallic-roughness surface reflects, specular and diffuse.
///
/// The surface is a mixture of a metal and a dielectric, whose diffuse layer receives the light that the specular layer
/// does not reflect. A white surface therefore reflects 1 (to rounding), whatever its roughness and metalness.
///
/// Source    glTF 2.0, appendix B.2: mix(dielectric, metal, metallic).
template <class F>
[[gnu::always_inline]] inline Vector<F> metallic_environment(Vector<F> base, F metallic, SpecularWeights<F> weights) {
  const F one(1.0f);
  const F coat = specular_albedo(weights, F(0.04f));
  const auto channel = [&](F color) {
    const F c = min(color, one);
    const F dielectric = coat + c * (one - coat);
    return dielectric + (specular_albedo(weights, c) - dielectric) * metallic;
  };
  return {channel(base.x), channel(base.y), channel(base.z)};
}

}  // namespace zoneplate
