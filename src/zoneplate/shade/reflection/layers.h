// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/math/lanes_vector.h"
#include "zoneplate/shade/reflection/brdf.h"
#include "zoneplate/shade/reflection/sheen_table.h"

/// Reflection models of a surface's layers, as templates over the lane types of math/lanes.h.
///
/// n is the normal, l points to the light, v to the viewer, h halfway between; all unit length or zero.
/// Source    glTF 2.0's KHR_materials_* extensions, each named at its function.
namespace zoneplate {

/// a + (b - a) t.
template <class F>
[[gnu::always_inline]] inline F mix(F a, F b, F t) {
  return a + (b - a) * t;
}
template <class F>
[[gnu::always_inline]] inline Vector<F> mix(Vector<F> a, Vector<F> b, F t) {
  return a + (b - a) * t;
}

template <class F>
[[gnu::always_inline]] inline F max_channel(Vector<F> v) {
  return max(max(v.x, v.y), v.z);
}

/// The reflectance of an interface under Schlick's approximation, f0 + (f90 - f0) (1 - v·h)^5, mixed with that of a
/// thin film.
template <class F>
struct Interface {
  Vector<F> f0;
  F f90;
  Vector<F> film;       ///< reflectance with the film
  F film_weight{0.0f};  ///< 0: no film

  /// `weight` is schlick_weight(v·h).
  [[gnu::always_inline]] Vector<F> fresnel(F weight, bool has_film) const {
    const Vector<F> white{f90, f90, f90}, bare = f0 + (white - f0) * weight;
    return has_film ? mix(bare, film, film_weight) : bare;
  }
};

/// The reflectance of a dielectric interface at normal incidence by its index of refraction and specular colour, times
/// its strength.
///
/// Source    KHR_materials_specular, KHR_materials_ior: min(((ior - 1) / (ior + 1))² color, 1) strength.
template <class F>
[[gnu::always_inline]] inline Vector<F> dielectric_f0(F f0_of_ior, Vector<F> color, F strength) {
  const F one(1.0f);
  return {min(color.x * f0_of_ior, one) * strength, min(color.y * f0_of_ior, one) * strength,
          min(color.z * f0_of_ior, one) * strength};
}

/// The light of an environment that an interface reflects: of light from about the mirror direction, and of light that
/// its microfacets scatter several times.
template <class F>
struct InterfaceShares {
  Vector<F> mirrored, scattered;
  Vector<F> gain;  ///< multiplies the lobe under lights, so that it reflects the light of several reflections too
};

/// The same bits with `has_film` where there is none; `is_grey` is allowed if f0 is.
///
/// Source    as specular_albedo; a film replaces the reflectance of single scattering (KHR_materials_iridescence).
template <class F>
[[gnu::always_inline]] inline InterfaceShares<F> interface_shares(const Interface<F>& s, SpecularWeights<F> weights,
                                                                  bool has_film, bool is_grey) {
  const F one(1.0f), lost = one - (weights.scale + weights.bias);
  InterfaceShares<F> out;
  const auto channel = [&](F f0, F film, F & mirrored, F & scattered, F & gain) __attribute__((always_inline)) {
    const F once = f0 * weights.scale + s.f90 * weights.bias, mean = f0 + (s.f90 - f0) * F(1.0f / 21.0f);
    gain = one / (one - mean * lost), mirrored = once;
    if (has_film) gain = mix(gain, one, s.film_weight), mirrored = mix(once, film, s.film_weight);
    scattered = once * (gain - one);
  };
  channel(s.f0.x, s.film.x, out.mirrored.x, out.scattered.x, out.gain.x);
  if (is_grey && !has_film) {
    const auto grey = [](F x) { return Vector<F>{x, x, x}; };
    return {grey(out.mirrored.x), grey(out.scattered.x), grey(out.gain.x)};
  }
  channel(s.f0.y, s.film.y, out.mirrored.y, out.scattered.y, out.gain.y);
  channel(s.f0.z, s.film.z, out.mirrored.z, out.scattered.z, out.gain.z);
  return out;
}

/// The axes of anisotropic microfacets: the highlight is stretched along t; b is perpendicular to t and n.
template <class F>
struct MicrofacetFrame {
  Vector<F> t, b, n;
  F alpha_t, alpha_b;
};

/// Density of anisotropic microfacet normals.
///
/// Source    KHR_materials_anisotropy; Burley, Physically-Based Shading at Disney, SIGGRAPH 2012.
template <class F>
[[gnu::always_inline]] inline F ggx(const MicrofacetFrame<F>& m, Vector<F> h) {
  const F alpha2 = m.alpha_t * m.alpha_b;
  const F x = dot(m.t, h) * m.alpha_b, y = dot(m.b, h) * m.alpha_t, z = dot(m.n, h) * alpha2;
  const F ratio = alpha2 / max(x * x + y * y + z * z, F(1e-30f));
  return alpha2 * ratio * ratio * F(inverse_pi);
}

/// Masking and shadowing of anisotropic microfacets over 4 (n·l)(n·v), height-correlated.
///
/// Requires  nl >= 0, nv > 0.
/// Source    KHR_materials_anisotropy; Heitz 2014.
template <class F>
[[gnu::always_inline]] inline F smith(const MicrofacetFrame<F>& m, Vector<F> l, Vector<F> v, F nl, F nv) {
  const auto stretched = [&](Vector<F> d, F nd) {
    const F x = dot(m.t, d) * m.alpha_t, y = dot(m.b, d) * m.alpha_b;
    return sqrt(x * x + y * y + nd * nd);
  };
  return F(0.5f) / max(nl * stretched(v, nv) + nv * stretched(l, nl), F(1e-30f));
}

/// The sheen of fibres.
///
/// Source    KHR_materials_sheen; Estevez and Kulla, Production Friendly Microfacet Sheen BRDF, SIGGRAPH 2017.
template <class F>
struct Sheen {
  F inverse_alpha, a, b, c, d, e, at_half;

  [[gnu::always_inline]] explicit Sheen(F roughness) {
    const F r = max(roughness, F(min_sheen_roughness)), alpha = r * r, rest = F(1.0f) - alpha, t = rest * rest;
    inverse_alpha = F(1.0f) / alpha;
    a = mix(F(21.5473f), F(25.3245f), t);
    b = mix(F(3.82987f), F(3.32435f), t);
    c = mix(F(0.19823f), F(0.16801f), t);
    d = mix(F(-1.97760f), F(-1.27393f), t);
    e = mix(F(-4.32054f), F(-4.85967f), t);
    at_half = curve(F(0.5f));
  }

  /// Density of the fibres' normals: (2 + 1/α) sin^(1/α) / 2π.
  [[gnu::always_inline]] F density(F sine_squared) const {
    const F sine_power = pow(min(sine_squared, F(1.0f)), inverse_alpha * F(0.5f));
    return (F(2.0f) + inverse_alpha) * sine_power * F(0.5f * inverse_pi);
  }
  /// Smith's Λ, by a fit.
  [[gnu::always_inline]] F lambda(F cosine) const {
    const auto is_low = cosine < F(0.5f);
    const F at = curve(select(is_low, cosine, max(F(1.0f) - cosine, F(0.0f))));
    return exp(select(is_low, at, at_half + at_half - at));
  }
  /// Masking and shadowing over 4 (n·l)(n·v). Requires: cosines above 0.
  [[gnu::always_inline]] F visibility(F lambda_v, F nl, F nv) const {
    return F(0.25f) / ((F(1.0f) + lambda_v + lambda(nl)) * nv * nl);
  }

 private:
  [[gnu::always_inline]] F curve(F x) const { return a / (F(1.0f) + b * pow(x, c)) + d * x + e; }
};

/// The directional albedo of Sheen by sheen_albedo_table, bilinear; it exceeds 1 at grazing angles of low roughness.
template <class F>
[[gnu::always_inline]] inline F sheen_albedo(F roughness, F nv) {
  using Int = typename F::Int;
  constexpr float steps = sheen_table_side - 1, min_root = 0.1f;  // the root of min_sheen_cosine
  const F zero(0.0f);
  const auto position = [&](F x, float low) { return min(max((x - F(low)) * F(steps / (1 - low)), zero), F(steps)); };
  const F y = position(roughness, min_sheen_roughness), x = position(sqrt(nv), min_root);
  const Int row = min(truncate(y), Int(sheen_table_side - 2)), column = min(truncate(x), Int(sheen_table_side - 2));
  const F down = y - F::from(row), right = x - F::from(column);
  const Int first = row * Int(sheen_table_side) + column;
  const auto texel = [&](int offset) { return F::gather(sheen_albedo_table[0], first + Int(offset)); };
  const F above = mix(texel(0), texel(1), right);
  const F below = mix(texel(sheen_table_side), texel(sheen_table_side + 1), right);
  return mix(above, below, down);
}

/// The mean direction from which Sheen reflects light to the viewer: fibres lean towards grazing light on the viewer's
/// side. The irradiance about it stands for the light of an environment.
///
/// Requires  nv = n·v in [0, 1], roughness >= min_sheen_roughness.
/// Exact     within 3.5 degrees of the lobe's mean direction for roughness of 0.2 and more. The sheen of four captured
///           environments differs from its integral, in the root mean square over directions, by 18 to 73 % of their
///           mean radiance at roughness 0.5 and by 12 to 42 % at 1; with the irradiance about the normal by 37 to 100 %
///           and 19 to 48 %, with an environment filtered by the fibres' density about the mirror direction by 53 to
///           114 % and 49 to 91 %.
template <class F>
[[gnu::always_inline]] inline Vector<F> sheen_direction(Vector<F> n, Vector<F> v, F nv, F roughness) {
  const F one(1.0f), inverse = one / roughness;
  const F tangent = (F(0.285f) * inverse - F(0.13f)) * (one + (F(0.6f) + F(0.38f) * inverse) * nv);
  const F sine = max(sqrt(max(one - nv * nv, F(0.0f))), F(0.3f));  // near the normal all sides have equal parts
  return normalize(n + (v - n * nv) * (tangent / sine));
}

/// The reflectance at normal incidence of the interface between two media.
template <class F>
[[gnu::always_inline]] inline F interface_f0(F from, F to) {
  const F root = (to - from) / (to + from);
  return root * root;
}

/// The colour of white light after interference: the sensitivity of an observer to the optical path difference `path`
/// (metres), shifted by a phase of 0 or π, whose cosine is `sign`.
///
/// Source    KHR_materials_iridescence: Gaussian fits to the observer's Fourier transform, then Rec. 709 primaries.
template <class F>
[[gnu::always_inline]] inline Vector<F> interference(F path, Vector<F> sign) {
  const F phase = path * F(6.2831853f), square = phase * phase;
  // Each lobe: amplitude × sqrt(2π variance) / 1.0685e-7, position, variance.
  const auto lobe = [&](float amplitude, float position, float variance) {
    return F(amplitude) * cos(F(position) * phase) * exp(-(F(variance) * square));
  };
  const F x = lobe(0.84659f, 1.6810e6f, 4.3278e9f) * sign.x + lobe(0.15387f, 2.2399e6f, 4.5282e9f) * sign.x;
  const F y = lobe(1.00022f, 1.7953e6f, 9.3046e9f) * sign.y;
  const F z = lobe(1.00112f, 2.2084e6f, 6.6121e9f) * sign.z;
  return {F(3.2404542f) * x - F(1.5371385f) * y - F(0.4985314f) * z,
          F(1.8760108f) * y - F(0.9692660f) * x + F(0.0415560f) * z,
          F(0.0556434f) * x - F(0.2040259f) * y + F(1.0572252f) * z};
}

/// The reflectance of a surface below a thin film, in air.
///
/// Units     thickness in nanometres.
/// Source    KHR_materials_iridescence: Belcour and Barla, A Practical Extension to Microfacet Theory for the Modeling
///           of Varying Iridescence, SIGGRAPH 2017, without polarisation; limited to [0, 1].
template <class F>
[[gnu::always_inline]] inline Vector<F> film_fresnel(F ior, F thickness, Vector<F> f0, F cosine) {
  const F one(1.0f), zero(0.0f);
  const F sine2 = (one - cosine * cosine) / (ior * ior);
  const F inside = sqrt(max(one - sine2, zero));
  const F outer_f0 = interface_f0(one, ior);
  const F r12 = outer_f0 + (one - outer_f0) * schlick_weight(cosine);
  const F t121 = one - r12;
  const F inner_weight = schlick_weight(inside);
  const F path = F(2e-9f) * ior * thickness * inside;

  Vector<F> r23, amplitude, sum, sign;
  const auto channel = [&](F f, F& r, F& a, F& s, F& phase) {
    const F root = sqrt(min(f + F(0.0001f), F(0.9999f)));
    const F base_ior = (one + root) / (one - root);
    const F inner_f0 = interface_f0(ior, base_ior);
    r = inner_f0 + (one - inner_f0) * inner_weight;
    const F both = min(max(r12 * r, F(1e-5f)), F(0.9999f));
    const F direct = t121 * t121 * r / (one - both);
    s = r12 + direct;
    a = direct - t121;
    r = sqrt(both);
    // The light is reflected from inside at the first interface, which turns the phase by π; so does a rarer medium.
    phase = select(base_ior < ior, one, F(-1.0f));
  };
  channel(f0.x, r23.x, amplitude.x, sum.x, sign.x);
  channel(f0.y, r23.y, amplitude.y, sum.y, sign.y);
  channel(f0.z, r23.z, amplitude.z, sum.z, sign.z);

  const Vector<F> first = amplitude * r23, second = first * r23;
  const F two(2.0f);
  sum = sum + first * (interference(path, sign) * two) + second * (interference(path + path, sign * sign) * two);
  const auto bounded = [&](F f) { return min(max(f, zero), one); };
  return {bounded(sum.x), bounded(sum.y), bounded(sum.z)};
}

/// Light through a thin rough wall for one unit of irradiance: the transmitting lobe × n·l, with l on the other side.
///
/// Requires  nl = -(n·l) >= 0, nv > 0; h halfway between v and the mirror image of l.
/// Source    KHR_materials_transmission: Vis_T D_T.
template <class F>
[[gnu::always_inline]] inline F wall_lobe(F nl, F nv, F alpha, Vector<F> n, Vector<F> h) {
  const F alpha2 = alpha * alpha, rest = F(1.0f) - alpha2;
  const auto side = [&](F cosine) { return cosine + sqrt(alpha2 + rest * cosine * cosine); };
  return ggx(dot(n, h), cross(n, h), alpha) * nl / (side(nl) * side(nv));
}

/// The direction of light that enters a medium along -v: eta is the index of refraction outside over that inside.
template <class F>
[[gnu::always_inline]] inline Vector<F> refracted(Vector<F> n, Vector<F> v, F nv, F eta) {
  const F inside = sqrt(max(F(1.0f) - eta * eta * (F(1.0f) - nv * nv), F(0.0f)));
  return n * (eta * nv - inside) - v * eta;
}

}  // namespace zoneplate
