// SPDX-License-Identifier: Apache-2.0
// The layers of a surface against the formulas of their specifications, transcribed in double precision, and against
// the conservation of energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/surface/layered_lanes.h"
#include "zoneplate/shade/surface/layered_plan.h"
#include "zoneplate/shade/surface/surface_for_test.h"

namespace zoneplate {
namespace {

using F = scalar::Float;
using V = Vector<F>;

constexpr double pi = 3.14159265358979323846;

struct Direction {
  double x, y, z;
};
Direction operator+(Direction a, Direction b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
double dot_of(Direction a, Direction b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Direction unit(Direction a) {
  const double length = std::sqrt(dot_of(a, a));
  return {a.x / length, a.y / length, a.z / length};
}
Direction direction(double cosine, double azimuth) {
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}
V lanes(Direction d) { return {static_cast<float>(d.x), static_cast<float>(d.y), static_cast<float>(d.z)}; }

/// A surface with the normal +Z and the tangent +X.
struct Sample {
  Material material;
  MaterialLayers layers;
  Direction view{0, 0, 1};

  Sample() { material.base_color = {0.8f, 0.5f, 0.2f, 1}, material.metallic = 0, material.roughness = 0.5f; }

  /// The reflected radiance, without the clear coat, for one unit of irradiance perpendicular to each direction.
  std::vector<std::array<double, 3>> light(const std::vector<Direction>& from) const {
    const auto p = std::make_unique<ShadingState>();
    const auto q = std::make_unique<LayerState>();
    const LayeredUniforms u = make_layered_uniforms(layers);
    fill(u, *p, *q);
    const stages::LayeredSurface<F> surface =
        stages::make_surface(u, stages::LobeRows<F>(ShadingUniforms()), *p, *q, lanes(view), 0);
    std::vector<std::array<double, 3>> out;
    for (const Direction& l : from) {
      const V color = stages::layered_light(u, surface, {}, {lanes(l), {}, {}});
      out.push_back({color.x.v, color.y.v, color.z.v});
    }
    return out;
  }
  std::array<double, 3> light(Direction from) const { return light(std::vector{from})[0]; }

  /// The light of a uniform environment of radiance 1 that the clear coat reflects, over its reflectance.
  double coat_albedo(int steps) const {
    const auto p = std::make_unique<ShadingState>();
    const auto q = std::make_unique<LayerState>();
    const LayeredUniforms u = make_layered_uniforms(layers);
    fill(u, *p, *q);
    const stages::LayeredSurface<F> surface =
        stages::make_surface(u, stages::LobeRows<F>(ShadingUniforms()), *p, *q, lanes(view), 0);
    const std::vector<Direction> from = directions(steps);
    double sum = 0;
    for (std::size_t k = 0; k < from.size(); ++k)
      sum += double{stages::coat_light(surface, lanes(from[k]), surface.coat_alpha).v} * solid_angle(k, steps);
    return sum;
  }

  /// The reflected light of a uniform environment of radiance 1, by quadrature over all directions.
  std::array<double, 3> albedo(int steps) const {
    const std::vector<std::array<double, 3>> colors = light(directions(steps));
    std::array<double, 3> sum{};
    for (std::size_t k = 0; k < colors.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) sum[c] += colors[k][c] * solid_angle(k, steps);
    return sum;
  }

 private:
  /// Directions above and below the horizon, whose cosines are denser near the horizon and near the normal.
  static std::vector<Direction> directions(int steps) {
    std::vector<Direction> from;
    for (int i = 0; i < steps; ++i)
      for (int j = 0; j < steps; ++j) {
        const double t = (i + 0.5) / steps, cosine = t * t * (3 - 2 * t);
        from.push_back(direction(cosine, 2 * pi * (j + 0.5) / steps));
        from.push_back({from.back().x, from.back().y, -from.back().z});
      }
    return from;
  }
  static double solid_angle(std::size_t k, int steps) {
    const double t = (static_cast<double>(k / 2 / static_cast<std::size_t>(steps)) + 0.5) / steps;
    return 6 * t * (1 - t) / steps * (2 * pi / steps);
  }

  void fill(const LayeredUniforms& u, ShadingState& p, LayerState& q) const {
    p.normal[0][0] = p.normal[1][0] = 0, p.normal[2][0] = 1;
    p.tangent[0][0] = p.tangent[3][0] = 1, p.tangent[1][0] = p.tangent[2][0] = 0;
    p.base[0][0] = material.base_color.x, p.base[1][0] = material.base_color.y, p.base[2][0] = material.base_color.z;
    p.metallic[0] = material.metallic, p.roughness[0] = material.roughness;
    const auto color = [](float3 v, LayerState::Array(&to)[3]) { to[0][0] = v.x, to[1][0] = v.y, to[2][0] = v.z; };
    q.specular[0] = layers.specular;
    color(layers.specular_color, q.specular_color);
    color({0, 0, 1}, q.clearcoat_normal);
    q.clearcoat[0] = layers.clearcoat, q.clearcoat_roughness[0] = layers.clearcoat_roughness;
    color(layers.sheen_color, q.sheen_color);
    q.sheen_roughness[0] = layers.sheen_roughness;
    q.anisotropy[0] = layers.anisotropy, q.stretch[0][0] = u.turn[0], q.stretch[1][0] = u.turn[1];
    q.iridescence[0] = layers.iridescence, q.film_thickness[0] = layers.iridescence_thickness_maximum;
    q.transmission[0] = layers.transmission, q.thickness[0] = layers.thickness;
    q.diffuse_transmission[0] = layers.diffuse_transmission;
    color(layers.diffuse_transmission_color, q.diffuse_transmission_color);
  }
};

// --- The specifications, in double precision
// --------------------------------------------------------------------------

double square(double x) { return x * x; }
double schlick(double f0, double f90, double cosine) { return f0 + (f90 - f0) * std::pow(1 - cosine, 5); }

double specular_brdf(Direction l, Direction v, double at, double ab) {
  const Direction h = unit(l + v);
  const double d = 1 / (pi * at * ab * square(square(h.x / at) + square(h.y / ab) + square(h.z)));
  const auto stretched = [&](Direction w) { return std::sqrt(square(at * w.x) + square(ab * w.y) + square(w.z)); };
  return d * 0.5 / (l.z * stretched(v) + v.z * stretched(l));
}

double sheen_l(double x, double alpha) {
  const double t = square(1 - alpha);
  const auto between = [&](double a, double b) { return a * (1 - t) + b * t; };
  const double a = between(21.5473, 25.3245), b = between(3.82987, 3.32435), c = between(0.19823, 0.16801);
  const double d = between(-1.97760, -1.27393), e = between(-4.32054, -4.85967);
  return a / (1 + b * std::pow(x, c)) + d * x + e;
}
double sheen_lambda(double cosine, double alpha) {
  return cosine < 0.5 ? std::exp(sheen_l(cosine, alpha))
                      : std::exp(2 * sheen_l(0.5, alpha) - sheen_l(1 - cosine, alpha));
}
double sheen_brdf(Direction l, Direction v, double roughness) {
  const double alpha = square(roughness);
  const Direction h = unit(l + v);
  const double d = (2 + 1 / alpha) * std::pow(std::max(0.0, 1 - h.z * h.z), 0.5 / alpha) / (2 * pi);
  return d / ((1 + sheen_lambda(v.z, alpha) + sheen_lambda(l.z, alpha)) * 4 * l.z * v.z);
}
double sheen_integral(double nv, double roughness) {
  constexpr int steps = 200;
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double t = (i + 0.5) / steps, cosine = t * t;
      sum += sheen_brdf(direction(cosine, pi * (j + 0.5) / steps), direction(nv, 0), roughness) * cosine * (2 * t);
    }
  return sum * 2 * pi / (steps * steps);
}

std::array<double, 3> sensitivity(double path, std::array<double, 3> shift) {
  const double phase = 2 * pi * path * 1e-9;
  const double val[3] = {5.4856e-13, 4.4201e-13, 5.2481e-13}, pos[3] = {1.6810e+06, 1.7953e+06, 2.2084e+06};
  const double var[3] = {4.3278e+09, 9.3046e+09, 6.6121e+09};
  double xyz[3];
  for (std::size_t c = 0; c < 3; ++c)
    xyz[c] =
        val[c] * std::sqrt(2 * pi * var[c]) * std::cos(pos[c] * phase + shift[c]) * std::exp(-square(phase) * var[c]);
  xyz[0] += 9.7470e-14 * std::sqrt(2 * pi * 4.5282e+09) * std::cos(2.2399e+06 * phase + shift[0]) *
            std::exp(-4.5282e+09 * square(phase));
  for (double& x : xyz) x /= 1.0685e-7;
  return {3.2404542 * xyz[0] - 1.5371385 * xyz[1] - 0.4985314 * xyz[2],
          -0.9692660 * xyz[0] + 1.8760108 * xyz[1] + 0.0415560 * xyz[2],
          0.0556434 * xyz[0] - 0.2040259 * xyz[1] + 1.0572252 * xyz[2]};
}

std::array<double, 3> iridescent_fresnel(double film_ior, std::array<double, 3> base_f0, double thickness,
                                         double cosine) {
  const double inside = std::sqrt(1 - square(1 / film_ior) * (1 - square(cosine)));
  const double r12 = schlick(square((film_ior - 1) / (film_ior + 1)), 1, cosine), t121 = 1 - r12;
  const double path = 2 * film_ior * thickness * inside;
  std::array<double, 3> phi{}, sum{}, r123{}, cm{};
  for (std::size_t c = 0; c < 3; ++c) {
    const double root = std::sqrt(base_f0[c] + 0.0001), base_ior = (1 + root) / (1 - root);
    const double r23 = schlick(square((base_ior - film_ior) / (base_ior + film_ior)), 1, inside);
    phi[c] = pi + (base_ior < film_ior ? pi : 0);
    const double both = std::clamp(r12 * r23, 1e-5, 0.9999), rs = square(t121) * r23 / (1 - both);
    r123[c] = std::sqrt(both), sum[c] = r12 + rs, cm[c] = rs - t121;
  }
  for (int m = 1; m <= 2; ++m) {
    const std::array<double, 3> s = sensitivity(m * path, {m * phi[0], m * phi[1], m * phi[2]});
    for (std::size_t c = 0; c < 3; ++c) cm[c] *= r123[c], sum[c] += cm[c] * 2 * s[c];
  }
  for (double& x : sum) x = std::clamp(x, 0.0, 1.0);
  return sum;
}

/// The light of a uniform environment that the lobe of a roughness reflects, for f0 and f90: `once`, and after any
/// number of reflections between microfacets (Fdez-Agüera 2019).
struct Reflected {
  double once, all;
};
Reflected reflected(double f0, double f90, double roughness, double nv) {
  const double alpha = square(roughness);
  const Direction v = direction(nv, 0);
  constexpr int steps = 60;
  double weighted = 0, whole = 0;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      // Half vectors as D (n·h) is distributed.
      const double x = (i + 0.5) / steps, nh = std::sqrt((1 - x) / (1 + (square(alpha) - 1) * x));
      const Direction h = direction(nh, 2 * pi * (j + 0.5) / steps);
      const double vh = dot_of(v, h);
      const Direction l = {2 * vh * h.x - v.x, 2 * vh * h.y - v.y, 2 * vh * h.z - v.z};
      if (vh <= 0 || l.z <= 0) continue;
      const auto side = [&](double c) { return std::sqrt(square(alpha) + (1 - square(alpha)) * square(c)); };
      const double visible = 0.5 / (l.z * side(nv) + nv * side(l.z)) * 4 * l.z * vh / nh;
      weighted += visible * schlick(f0, f90, vh), whole += visible;
    }
  const double once = weighted / square(steps), lost = 1 - whole / square(steps), mean = f0 + (f90 - f0) / 21;
  return {once, once + once * mean * lost / (1 - mean * lost)};
}

/// The material of the specifications under one directional light of irradiance 1, without the clear coat.
std::array<double, 3> expected(const Sample& s, Direction l) {
  const MaterialLayers& m = s.layers;
  const Direction v = s.view, mirrored = {l.x, l.y, std::abs(l.z)};
  const double alpha = square(s.material.roughness), weight = std::pow(1 - dot_of(v, unit(mirrored + v)), 5);
  const double base[3] = {s.material.base_color.x, s.material.base_color.y, s.material.base_color.z};
  const double colors[3] = {m.specular_color.x, m.specular_color.y, m.specular_color.z};
  const double ior_f0 = m.ior == 0 ? 1 : square((m.ior - 1.0) / (m.ior + 1.0));
  std::array<double, 3> below{}, gain{}, metal_gain{}, f0{}, metal_f0{base[0], base[1], base[2]}, dielectric{}, metal{};
  for (std::size_t c = 0; c < 3; ++c) {
    f0[c] = std::min(ior_f0 * colors[c], 1.0) * m.specular;
    dielectric[c] = f0[c] + (m.specular - f0[c]) * weight;
    metal[c] = base[c] + (1 - base[c]) * weight;
    // Light of several reflections widens no lobe: it is added in proportion.
    const Reflected inner = reflected(f0[c], m.specular, s.material.roughness, v.z);
    const Reflected outer = reflected(base[c], 1, s.material.roughness, v.z);
    const bool has_film = m.iridescence > 0 && m.iridescence_thickness_maximum > 0;
    const double film_weight = has_film ? m.iridescence : 0;
    below[c] = inner.all;
    gain[c] = inner.all / inner.once + (1 - inner.all / inner.once) * film_weight;
    metal_gain[c] = outer.all / outer.once + (1 - outer.all / outer.once) * film_weight;
  }
  if (m.iridescence > 0 && m.iridescence_thickness_maximum > 0) {
    const auto film = iridescent_fresnel(m.iridescence_ior, f0, m.iridescence_thickness_maximum, v.z);
    const auto metal_film = iridescent_fresnel(m.iridescence_ior, metal_f0, m.iridescence_thickness_maximum, v.z);
    for (std::size_t c = 0; c < 3; ++c) {
      dielectric[c] += (film[c] - dielectric[c]) * m.iridescence;
      below[c] += (film[c] - below[c]) * m.iridescence;
      metal[c] += (metal_film[c] - metal[c]) * m.iridescence;
    }
  }
  const double most = std::min(1.0, std::max({below[0], below[1], below[2]}));
  const double at = alpha + (1 - alpha) * square(m.anisotropy);
  const double peak = l.z > 0 ? specular_brdf(l, v, at, alpha) * l.z : 0, behind = std::max(0.0, -l.z);

  // Vis_T D_T of KHR_materials_transmission, with the roughness that a wall of this index of refraction has.
  const double rough = std::max(s.material.roughness * std::clamp(2.0 * m.ior - 2, 0.0, 1.0), 0.045);
  const double wall = square(rough), hz = unit(mirrored + v).z;
  const auto side = [&](double cosine) {
    return cosine + std::sqrt(square(wall) + (1 - square(wall)) * square(cosine));
  };
  const double lobe = square(wall) / (pi * square(square(hz) * (square(wall) - 1) + 1)) / (side(behind) * side(v.z));

  std::array<double, 3> out{};
  const double sheen_color[3] = {m.sheen_color.x, m.sheen_color.y, m.sheen_color.z};
  const double back[3] = {m.diffuse_transmission_color.x, m.diffuse_transmission_color.y,
                          m.diffuse_transmission_color.z};
  const double absorbing[3] = {m.attenuation_color.x, m.attenuation_color.y, m.attenuation_color.z};
  const double max_sheen = std::max({sheen_color[0], sheen_color[1], sheen_color[2]});
  for (std::size_t c = 0; c < 3; ++c) {
    const double passed = m.thickness > 0 ? std::pow(absorbing[c], m.thickness / m.attenuation_distance) : 1;
    double inner = base[c] * std::max(0.0, l.z) / pi;
    inner += (back[c] * passed * behind / pi - inner) * m.diffuse_transmission;
    inner += (base[c] * passed * lobe * behind - inner) * m.transmission;
    const double mixture = (gain[c] * dielectric[c] * peak + (1 - most) * inner) * (1 - s.material.metallic) +
                           metal_gain[c] * metal[c] * peak * s.material.metallic;
    out[c] = mixture;
    if (max_sheen > 0) {
      out[c] *= 1 - max_sheen * sheen_integral(v.z, m.sheen_roughness);
      if (l.z > 0) out[c] += sheen_color[c] * sheen_brdf(l, v, m.sheen_roughness) * l.z;
    }
  }
  return out;
}

struct Variant {
  const char* name;
  std::function<void(Sample&)> set;
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> all = {
      {"plain", [](Sample&) {}},
      {"ior", [](Sample& s) { s.layers.ior = 2.4f; }},
      {"specular",
       [](Sample& s) {
         s.layers.specular = 0.4f, s.layers.specular_color = {1, 0.3f, 30};
       }},
      {"glossiness",
       [](Sample& s) {
         s.layers.ior = 0, s.layers.specular_color = {0.9f, 0.6f, 0.2f};
       }},
      {"metal", [](Sample& s) { s.material.metallic = 1; }},
      {"mixture", [](Sample& s) { s.material.metallic = 0.4f; }},
      {"anisotropy", [](Sample& s) { s.layers.anisotropy = 0.7f, s.material.metallic = 0.5f; }},
      {"sheen",
       [](Sample& s) {
         s.layers.sheen_color = {0.9f, 0.1f, 0.4f}, s.layers.sheen_roughness = 0.6f;
       }},
      {"film", [](Sample& s) { s.layers.iridescence = 1, s.layers.iridescence_thickness_maximum = 450; }},
      {"film on metal",
       [](Sample& s) { s.layers.iridescence = 0.7f, s.layers.iridescence_ior = 1.8f, s.material.metallic = 1; }},
      {"transmission", [](Sample& s) { s.layers.transmission = 0.75f; }},
      {"volume",
       [](Sample& s) {
         s.layers.transmission = 1, s.layers.thickness = 0.5f, s.layers.attenuation_distance = 0.25f;
         s.layers.attenuation_color = {0.5f, 0.9f, 0.7f};
       }},
      {"diffuse transmission",
       [](Sample& s) {
         s.layers.diffuse_transmission = 0.6f, s.layers.diffuse_transmission_color = {0.3f, 0.8f, 0.5f};
       }},
  };
  return all;
}

TEST(Layered, FollowsTheSpecificationsFormulas) {
  for (const Variant& variant : variants())
    for (std::uint32_t k = 0; k < 24; ++k) {
      Sample s;
      s.material.roughness = 0.3f + 0.7f * unit_float(hash(k, 1));
      variant.set(s);
      s.view = direction(0.1 + 0.9 * unit_float(hash(k, 2)), 6 * unit_float(hash(k, 3)));
      const Direction l = direction(2 * unit_float(hash(k, 4)) - 1, 6 * unit_float(hash(k, 5)));
      if (std::abs(l.z) < 0.02) continue;
      const std::array<double, 3> actual = s.light(l), wanted = expected(s, l);
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(actual[c], wanted[c], 2e-4 + 0.01 * wanted[c]) << variant.name << " " << k << " " << c;
    }
}

TEST(Layered, MetalsAreReciprocal) {
  // Films and sheen are not, and neither is light below an interface: they depend on the viewer's direction alone.
  for (const float anisotropy : {0.0f, 0.7f})
    for (std::uint32_t k = 0; k < 40; ++k) {
      Sample s;
      s.material.metallic = 1, s.layers.anisotropy = anisotropy;
      // The light of several reflections is added by the viewer's direction; a black metal has little of it.
      s.material.base_color = {0, 0, 0, 1}, s.material.roughness = 0.2f;
      const Direction a = direction(0.05 + 0.95 * unit_float(hash(k, 6)), 6 * unit_float(hash(k, 7)));
      const Direction b = direction(0.05 + 0.95 * unit_float(hash(k, 8)), 6 * unit_float(hash(k, 9)));
      s.view = a;
      const double there = s.light(b)[1] / b.z;
      s.view = b;
      const double back = s.light(a)[1] / a.z;
      EXPECT_NEAR(there, back, 5e-3 * (0.1 + std::abs(there))) << anisotropy << " " << k;
    }
}

TEST(Layered, NeverReflectsMoreThanArrives) {
  for (const Variant& variant : variants())
    for (const float roughness : {0.4f, 1.0f})
      for (const double nv : {0.15, 1.0}) {
        Sample s;
        s.material.base_color = {1, 1, 1, 1}, s.material.roughness = roughness;
        variant.set(s);
        if (s.layers.sheen_roughness > 0) s.layers.sheen_roughness = roughness, s.layers.sheen_color = {1, 1, 1};
        s.view = direction(nv, 0.4);
        for (const double albedo : s.albedo(80))
          EXPECT_LE(albedo, 1.015) << variant.name << " " << roughness << " " << nv;
      }
}

TEST(Layered, AWhiteSurfaceReflectsTheLightOfLights) {
  for (const char* name : {"plain", "ior", "metal", "mixture", "diffuse transmission"})
    for (const float roughness : {0.4f, 1.0f})
      for (const double nv : {0.3, 1.0}) {
        Sample s;
        s.material.base_color = {1, 1, 1, 1}, s.material.roughness = roughness;
        std::find_if(variants().begin(), variants().end(), [&](const Variant& v) {
          return v.name == std::string(name);
        })->set(s);
        s.layers.diffuse_transmission_color = {1, 1, 1};
        s.view = direction(nv, 0.4);
        EXPECT_NEAR(s.albedo(80)[1], 1, 0.015) << name << " " << roughness << " " << nv;
      }
}

TEST(Layered, ACoatThatReflectsAllReflectsTheLightOfLights) {
  for (const float roughness : {0.3f, 0.6f, 1.0f})
    for (const double nv : {0.3, 1.0}) {
      Sample s;
      s.layers.clearcoat = 1, s.layers.clearcoat_roughness = roughness;
      s.view = direction(nv, 0.4);
      EXPECT_NEAR(s.coat_albedo(120), 1, 0.015) << roughness << " " << nv;
    }
}

TEST(Layered, WithoutAnisotropyTheFrameDoesNotMatter) {
  Sample round;
  round.material.metallic = 1;
  for (const double azimuth : {0.0, 1.0, 2.0}) {
    round.view = direction(0.6, azimuth);
    Sample stretched = round;
    stretched.layers.anisotropy = 1e-4f;  // selects the anisotropic kernel, its square is below a float's precision
    for (const double cosine : {0.1, 0.5, 0.9})
      EXPECT_NEAR(stretched.light(direction(cosine, 2.5))[0], round.light(direction(cosine, 2.5))[0], 2e-5);
  }
}

TEST(Layered, LobesOfTurningNormalsAreAnisotropic) {
  // Turns along the tangent and across it, by two vectors that are not the frame's axes.
  const V n{0, 0, 1}, t{0.6f, 0.8f, 0}, b{-0.8f, 0.6f, 0};
  const float roughness = 0.4f, alpha = roughness * roughness, along = 0.3f, across = 0.1f, turn = 0.7f;
  const V u = t * F(along) * F(std::cos(turn)) + b * F(across) * F(std::sin(turn));
  const V w = t * F(-along) * F(std::sin(turn)) + b * F(across) * F(std::cos(turn));
  const double a2 = 0.16 * 0.16, along2 = a2 + 0.09, across2 = a2 + 0.01;
  const double tails = std::pow(a2 * a2 / (along2 * across2), 0.25);
  const MicrofacetFrame<F> frame{t, b, n, F(std::hypot(alpha, along)), F(std::hypot(alpha, across))};
  for (std::uint32_t k = 0; k < 50; ++k) {
    const auto random = [&](std::uint32_t j) { return double{unit_float(hash(k, j))}; };
    const V v = lanes(direction(0.1 + 0.9 * random(1), 6 * random(2)));
    const V l = lanes(direction(0.1 + 0.9 * random(3), 6 * random(4)));
    const V h = normalize(l + v);
    const TurningLobe<F> lobe(n, v, u, w, F(roughness));
    const double x = dot(t, h).v, y = dot(b, h).v, z = h.z.v;
    const double beckmann = std::exp(-(x * x / along2 + y * y / across2) / (z * z)) /
                            (pi * std::sqrt(along2 * across2) * z * z * z * 4 * dot(h, v).v * l.z.v);
    const double mixed = tails * (ggx(frame, h) * smith(frame, l, v, l.z, v.z)).v + (1 - tails) * beckmann;
    const auto expected = static_cast<float>(mixed);
    EXPECT_NEAR(lobe.peak(l, h, l.z).v, expected, 1e-4f * expected) << k;
    const TurningLobe<F> still(n, v, V{0, 0, 0}, V{0, 0, 0}, F(roughness));
    const float round = (ggx(dot(n, h), cross(n, h), F(alpha)) * smith(l.z, v.z, F(alpha))).v;
    EXPECT_NEAR(still.peak(l, h, l.z).v, round, 1e-4f * round) << k;
  }
}

TEST(Layered, AFilmWithoutThicknessChangesNothing) {
  Sample bare, film;
  film.layers.iridescence = 1, film.layers.iridescence_thickness_maximum = 0;
  bare.view = film.view = direction(0.4, 1);
  EXPECT_EQ(film.light(direction(0.7, 3)), bare.light(direction(0.7, 3)));
}

TEST(Layered, SheenLeansAsItsLobeDoes) {
  for (const double roughness : {0.2, 0.35, 0.5, 0.8, 1.0})
    for (const double nv : {0.1, 0.4, 0.7, 0.9}) {
      const Direction view = direction(nv, 0);
      Direction mean{0, 0, 0};
      constexpr int steps = 200;
      for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
          const Direction l = direction((i + 0.5) / steps, 2 * pi * (j + 0.5) / steps);
          const double weight = sheen_brdf(l, view, roughness) * l.z;
          mean = mean + Direction{l.x * weight, l.y * weight, l.z * weight};
        }
      const V found =
          sheen_direction(V{0, 0, 1}, lanes(view), F(static_cast<float>(nv)), F(static_cast<float>(roughness)));
      const double expected = std::atan2(mean.x, mean.z), actual = std::atan2(double{found.x.v}, double{found.z.v});
      EXPECT_NEAR(actual, expected, 3.5 * pi / 180) << roughness << " " << nv;
    }
}

TEST(Layered, TheSheenTableHoldsTheIntegrals) {
  for (int row = 1; row < sheen_table_side; row += 4)
    for (int column = 0; column < sheen_table_side; column += 3) {
      const double step = 1.0 / (sheen_table_side - 1);
      const double roughness = min_sheen_roughness + (1.0 - min_sheen_roughness) * row * step;
      const double root = 0.1 + 0.9 * column * step;
      EXPECT_NEAR(sheen_albedo_table[row][column], sheen_integral(root * root, roughness), 3e-4)
          << row << " " << column;
    }
}

// --- Whole fragments
// ---------------------------------------------------------------------------------------------------

/// The colour of the triangle in a uniform environment of radiance 1, seen at an angle of this cosine.
float4 in_furnace(const Material& material, const MaterialLayers& layers, double nv) {
  Scene scene = flat_triangle();
  scene.materials[0] = material;
  scene.materials[0].layers = std::make_shared<const MaterialLayers>(layers);
  ViewUniforms view;
  view.environment = {1, 1, 1};
  view.is_orthographic = true;
  const Direction d = direction(nv, 0.3);
  view.view_direction = {static_cast<float>(-d.x), static_cast<float>(-d.y), static_cast<float>(-d.z)};
  return color_of(scene, view);
}

TEST(Layered, AWhiteSurfaceKeepsTheLightOfAFurnace) {
  for (const float metallic : {0.0f, 0.5f, 1.0f})
    for (const float roughness : {0.0f, 0.3f, 1.0f})
      for (const double nv : {0.05, 0.5, 1.0}) {
        Material white;
        white.metallic = metallic, white.roughness = roughness;
        MaterialLayers layers;
        layers.ior = 1.8f;
        layers.clearcoat = 0.8f, layers.clearcoat_roughness = 0.4f;
        layers.transmission = 0.5f, layers.diffuse_transmission = 0.5f, layers.anisotropy = 0.6f;
        EXPECT_NEAR(in_furnace(white, layers, nv).y, 1, 0.01) << metallic << " " << roughness << " " << nv;
        layers.sheen_color = {1, 1, 1}, layers.sheen_roughness = roughness;
        EXPECT_NEAR(in_furnace(white, layers, nv).y, 1, 0.01) << metallic << " " << roughness << " " << nv;
        layers.iridescence = 1, layers.specular = 0.5f, layers.specular_color = {2, 0.5f, 1};
        const float4 color = in_furnace(white, layers, nv);
        EXPECT_LE(std::max({color.x, color.y, color.z}), 1.001f) << metallic << " " << roughness << " " << nv;
      }
}

TEST(Layered, LayersWithoutEffectGiveTheMetallicRoughnessColour) {
  Scene scene = flat_triangle(ShadingModel::MetallicRoughness, {0.7f, 0.4f, 0.1f, 1});
  Material& m = scene.materials[0];
  m.metallic = 0.3f, m.roughness = 0.4f, m.emissive = {0, 0, 0.1f};
  ViewUniforms view;
  view.eye = {1, 2, 3}, view.environment = {0.3f, 0.2f, 0.1f};
  MaterialLayers layers;
  layers.ior = 1.5000001f;
  ASSERT_NE(layers.ior, 1.5f);
  const auto expect_same = [&](float tolerance) {
    m.layers = nullptr;
    const float4 plain = color_of(scene, view);
    m.layers = std::make_shared<const MaterialLayers>(layers);
    expect_near(color_of(scene, view), plain, tolerance);
  };
  expect_same(2e-6f);
  // Under lights, the light below the interface of a dielectric differs, and only the plain lobe has its specular_gain.
  scene.lights = {sun({0.3f, -0.2f, -1}), sun({-1, 0.5f, -0.2f}, {0.5f, 2, 1})};
  m.metallic = 1;
  expect_same(0.005f);
}

TEST(Layered, TheCoatHasItsOwnNormalMap) {
  // The base's map tilts its normals away from the light's mirror direction; the coat stays flat and still mirrors it.
  Scene scene = flat_triangle(ShadingModel::MetallicRoughness, {0, 0, 0, 1});
  scene.meshes[0].tangent = {{1, 0, 0, 1}, {1, 0, 0, 1}, {1, 0, 0, 1}};
  scene.images = {{"tilted", one_texel({218, 128, 218, 255})}};
  Material& m = scene.materials[0];
  m.metallic = 0, m.roughness = 0.2f;
  scene.lights = {sun({0, 0, -1})};
  ViewUniforms view;
  view.is_orthographic = true;
  const auto shaded = [&](MaterialLayers layers) {
    m.layers = std::make_shared<const MaterialLayers>(layers);
    return color_of(scene, view).y;
  };
  MaterialLayers layers{.clearcoat = 1, .clearcoat_roughness = 0.2f};
  const float flat = shaded(layers);
  m.normal_texture.image = 0;
  EXPECT_NEAR(shaded(layers), flat * 0.5f, 0.15f * flat);  // without the base's highlight
  m.normal_texture.image = -1, layers.clearcoat_normal_texture.image = 0;
  EXPECT_LT(shaded(layers), 0.6f * flat);
  m.normal_texture.image = 0;
  EXPECT_LT(shaded(layers), 0.1f * flat);
}

}  // namespace
}  // namespace zoneplate
