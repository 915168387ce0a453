// SPDX-License-Identifier: Apache-2.0
// Light from all directions: reflections filtered by roughness, irradiance, and the split sum.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/lit_ball.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/environment/lookup.h"
#include "zoneplate/shade/environment/lookup_lanes.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/reflection/brdf.h"

namespace zoneplate::lessons {
namespace environment_lesson {
namespace {

using F = scalar::Float;
constexpr float pi = 3.14159265f;
constexpr Param params[] = {{.name = "roughness",
                             .meaning = "of the third ball and of the split sum",
                             .value = 0.4,
                             .low = 0.1,
                             .high = 1,
                             .decimals = 2}};
// Of the integral: directions a pixel, and the roughness of their look-ups, which are filtered so that the sun is not
// seen as dots.
constexpr int samples = 1024;
constexpr float sample_roughness = 0.15f;

/// A terrace in the evening: sky with a low sun, a tiled floor, and a wall of coloured panels.
float4 terrace(float3 d) {
  const auto mix = [](float3 a, float3 b, float t) { return a + (b - a) * std::clamp(t, 0.0f, 1.0f); };
  const auto as_texel = [](float3 c) { return float4{c.x, c.y, c.z, 1}; };
  const float3 sun = normalize({-0.62f, 0.42f, 0.66f});
  const float towards = dot(d, sun);
  if (towards > 0.988f) return {20, 15, 9.5f, 1};
  if (d.y < -0.12f) {
    const float x = d.x / d.y, z = d.z / d.y;
    const bool is_dark = (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(z))) % 2 != 0;
    return as_texel(mix(is_dark ? float3{0.10f, 0.09f, 0.08f} : float3{0.42f, 0.37f, 0.30f}, {0.3f, 0.27f, 0.23f},
                        (std::abs(x) + std::abs(z)) / 14));
  }
  if (d.y < 0.22f) {
    constexpr float3 panels[] = {{0.65f, 0.10f, 0.05f}, {0.80f, 0.62f, 0.12f}, {0.10f, 0.36f, 0.14f},
                                 {0.75f, 0.72f, 0.66f}, {0.06f, 0.16f, 0.50f}, {0.20f, 0.19f, 0.18f}};
    const float turn = (atan2(d.z, d.x) / (2 * pi) + 0.5f) * 18;
    const int panel = std::min(static_cast<int>(turn), 17);
    const float inside = turn - static_cast<float>(panel);
    if (inside < 0.12f || inside > 0.88f) return {0.05f, 0.05f, 0.05f, 1};
    return as_texel(panels[panel % 6]);
  }
  const float3 sky = mix({0.95f, 0.62f, 0.42f}, {0.12f, 0.24f, 0.55f}, (d.y - 0.2f) * 1.6f);
  return as_texel(sky + float3{1.6f, 1.0f, 0.5f} * std::max(towards - 0.85f, 0.0f) * 6);
}

std::shared_ptr<const PreparedEnvironment> make_terrace() {
  constexpr int width = 256, height = width / 2, parts = 4;
  Plane<float4> image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float4 sum{0, 0, 0, 0};
      for (int k = 0; k < parts * parts; ++k) {
        const float u = (static_cast<float>(x * parts + k % parts) + 0.5f) / (width * parts);
        const float v = (static_cast<float>(y * parts + k / parts) + 0.5f) / (height * parts);
        const float across = sin(pi * v);
        sum = sum + terrace({-cos(2 * pi * u) * across, cos(pi * v), -sin(2 * pi * u) * across});
      }
      image(x, y) = sum * (1.0f / (parts * parts));
    }
  return std::make_shared<const PreparedEnvironment>(prepare_equirectangular(TexelImage(std::move(image))));
}

/// Directions of the lobe of GGX about a direction n that is also the viewer's, as LookupKernels reads them.
struct Directions {
  std::vector<float> x, y, z;
  std::vector<float> r, g, b;  ///< the light from there

  explicit Directions(int count) {
    for (auto* array : {&x, &y, &z, &r, &g, &b}) array->resize(static_cast<std::size_t>(count));
  }
  void set(int i, float3 d) {
    const auto k = static_cast<std::size_t>(i);
    x[k] = d.x, y[k] = d.y, z[k] = d.z;
  }
  float3 light(int i) const {
    const auto k = static_cast<std::size_t>(i);
    return {r[k], g[k], b[k]};
  }
  void look_up(const EnvironmentView& view, float roughness) {
    const float* const from[3] = {x.data(), y.data(), z.data()};
    float* const to[3] = {r.data(), g.data(), b.data()};
    LookupKernels::of().specular(view, from, roughness, to, static_cast<int>(x.size()));
  }
};

/// The angle of sample i about an axis; the golden ratio spreads the angles.
float turn_of(int i) { return 2 * pi * static_cast<float>(static_cast<std::uint32_t>(i) * 0x9E3779B9u) * 0x1p-32f; }

/// Sample i of `count` microfacet normals about n, distributed as D(h) (n·h).
float3 microfacet(float3 n, float alpha, int i, int count) {
  const float3 x = normalize(cross(std::abs(n.y) < 0.9f ? float3{0, 1, 0} : float3{1, 0, 0}, n)), y = cross(n, x);
  const float share = (static_cast<float>(i) + 0.5f) / static_cast<float>(count), turn = turn_of(i);
  const float sine2 = alpha * alpha * share / (1 + (alpha * alpha - 1) * share);
  const float across = std::sqrt(sine2);
  return n * std::sqrt(1 - sine2) + x * (across * cos(turn)) + y * (across * sin(turn));
}

/// Sample i of `count` microfacet normals about n, distributed as those that the viewer sees. Their mirror images of
/// the viewer cover a lobe evenly at grazing views too, where most of microfacet() are hidden.
///
/// Source    Dupuy and Benyoub, Sampling Visible GGX Normals with Spherical Caps, HPG 2023.
float3 visible_microfacet(float3 n, float3 v, float alpha, int i, int count) {
  const float nv = dot(n, v);
  const float3 x = normalize(v - n * nv, normalize(cross(std::abs(n.y) < 0.9f ? float3{0, 1, 0} : float3{1, 0, 0}, n)));
  const float3 y = cross(n, x);
  // In a space where the surface is smooth, that is, its lobe a hemisphere, with v in the plane of x and n.
  const float3 smooth = normalize(float3{alpha * dot(v, x), 0, nv});
  const float share = (static_cast<float>(i) + 0.5f) / static_cast<float>(count), turn = turn_of(i);
  const float up = (1 - share) * (1 + smooth.z) - smooth.z, across = std::sqrt(std::max(1 - up * up, 0.0f));
  const float3 h = float3{across * cos(turn), across * sin(turn), up} + smooth;
  return normalize(x * (alpha * h.x) + y * (alpha * h.y) + n * std::max(h.z, 0.0f));
}

float3 mirrored(float3 v, float3 h) { return h * (2 * dot(v, h)) - v; }

float luminance(float3 c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

/// The root mean square, in per cent, of what look-ups miss of the integral over the lobe in 32 directions.
double look_up_error(const EnvironmentView& view, float roughness) {
  constexpr int places = 32, count = 1 << 15;
  Directions place(places), lobe(count);
  for (int k = 0; k < places; ++k) {
    const float up = 1 - (2 * static_cast<float>(k) + 1) / places, turn = 2.39996323f * static_cast<float>(k);
    const float across = std::sqrt(1 - up * up);
    place.set(k, {across * cos(turn), up, across * sin(turn)});
  }
  place.look_up(view, roughness);
  double sum = 0;
  for (int k = 0; k < places; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const float3 n{place.x[at], place.y[at], place.z[at]};
    for (int i = 0; i < count; ++i) lobe.set(i, mirrored(n, microfacet(n, roughness * roughness, i, count)));
    lobe.look_up(view, 0);
    double light = 0, weight = 0;
    for (int i = 0; i < count; ++i) {
      const auto l = static_cast<std::size_t>(i);
      const double nl = std::max(dot(n, float3{lobe.x[l], lobe.y[l], lobe.z[l]}), 0.0f);
      light += nl * static_cast<double>(luminance(lobe.light(i))), weight += nl;
    }
    const double error = static_cast<double>(luminance(place.light(k))) * weight / light - 1;
    sum += error * error;
  }
  return 100 * std::sqrt(sum / places);
}

/// The ball in orthographic view, of a white metal without light of several reflections: each pixel by `reflected` from
/// the normal.
template <class Reflected>
LinearImage ball_of(int side, const Reflected& reflected) {
  LinearImage image(side, side);
  const float scale = 2 * 1.06f / static_cast<float>(side);
  parallel_for(static_cast<std::size_t>(side), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < side; ++x) {
      const float nx = (static_cast<float>(x) + 0.5f) * scale - 1.06f,
                  ny = 1.06f - (static_cast<float>(y) + 0.5f) * scale;
      const float away = std::sqrt(nx * nx + ny * ny), inside = std::clamp((1 - away) / scale + 0.5f, 0.0f, 1.0f);
      const float paper = 0.033f * (1 - inside);
      image(x, y) = {paper, paper, paper, 1};
      if (inside == 0) continue;
      const float at = std::min(away, 0.9999f), shrunk = at / std::max(away, 1e-6f);
      const float3 light = reflected(float3{nx * shrunk, ny * shrunk, std::sqrt(1 - at * at)}) * inside;
      image(x, y) = {light.x + paper, light.y + paper, light.z + paper, 1};
    }
  });
  return image;
}

constexpr float3 viewer{0, 0, 1};

/// ∫ L f (n·l) dl by samples of the visible microfacets: each weighs what its shadows leave of it, G₂ / G₁.
float3 integral(const EnvironmentView& view, float rough, float3 n) {
  const float alpha = rough * rough, nv = std::max(n.z, 1e-4f);
  const float all = 2 * (nv + std::sqrt(nv * nv * (1 - alpha * alpha) + alpha * alpha));
  Directions lobe(samples);
  float weight[samples];
  for (int i = 0; i < samples; ++i) {
    const float3 l = mirrored(viewer, visible_microfacet(n, viewer, alpha, i, samples));
    const float nl = std::max(dot(n, l), 0.0f);
    lobe.set(i, l);
    weight[i] = smith(F(nl), F(nv), F(alpha)).v * nl * all;
  }
  lobe.look_up(view, sample_roughness);
  float3 sum{0, 0, 0};
  for (int i = 0; i < samples; ++i) sum = sum + lobe.light(i) * weight[i];
  return sum * (1.0f / samples);
}

/// The mean light of the lobe times the lobe's reflectance.
float3 split_sum(const EnvironmentView& view, float rough, float3 n) {
  const float3 l = mirrored(viewer, n);
  const auto light = specular_light(view, Vector<F>{l.x, l.y, l.z}, F(rough));
  const SpecularWeights<F> weights = SpecularFit<F>(F(rough)).at(F(n.z));
  return float3{light.x.v, light.y.v, light.z.v} * (weights.scale.v + weights.bias.v);
}

/// The factors of the split sum by roughness, downwards, and n·v, to the right.
Rgba8Image table_picture(int side) {
  LinearImage image(side, side);
  for (int y = 0; y < side; ++y) {
    const SpecularFit<F> fit(F((static_cast<float>(y) + 0.5f) / static_cast<float>(side)));
    for (int x = 0; x < side; ++x) {
      const SpecularWeights<F> weights = fit.at(F((static_cast<float>(x) + 0.5f) / static_cast<float>(side)));
      image(x, y) = {weights.scale.v, weights.bias.v, 0, 1};
    }
  }
  return shown(image);
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel;
  static const auto map = make_terrace();
  const Environment environment{.color = {1, 1, 1}, .map = map};
  const EnvironmentView view = map->view(environment, {0, 1, 0});
  const auto draw = [&](float metallic, float roughness) {
    Material m;
    m.metallic = metallic, m.roughness = roughness;
    m.base_color = metallic > 0 ? float4{1, 1, 1, 1} : float4{0.8f, 0.8f, 0.8f, 1};
    Scene scene = lit_ball(m, 192, 96);
    scene.lights.clear();
    scene.environment = environment;
    scene.cameras.front().is_orthographic = false;
    scene.cameras.front().vertical_fov = 0.76f;
    return shown(shoot(scene, "msaa:n=8",
                       {.width = side, .height = side, .background = EnvironmentBackground{.blur = roughness}}));
  };

  Figure figure{.title = "Environment light: integrals over all directions, made into look-ups", .rows = {{}, {}}};
  const auto rough = static_cast<float>(settings.number("roughness"));
  const float roughnesses[] = {0, 0.2f, rough, 1};
  const std::string captions[] = {
      "A mirror, roughness 0\nReflection and background are the radiance itself.",
      "Roughness 0.2\nThe mean over a narrow lobe about the mirror direction, for the ball and the background alike.",
      fmt::format("Roughness {}\nThe sun alone makes this highlight: its light is spread over the lobe.", rough),
      "Roughness 1\nThe lobe is the cosine over a hemisphere: what a white diffuse surface reflects."};
  for (std::size_t k = 0; k < std::size(roughnesses); ++k) {
    std::string caption = captions[k];
    if (roughnesses[k] > 0)
      caption += fmt::format(" Error of the look-ups: {}\u00a0%.", number(look_up_error(view, roughnesses[k]), 2));
    figure.rows[0].push_back({draw(1, roughnesses[k]), caption});
  }

  const LinearImage exact = ball_of(side, [&](float3 n) { return integral(view, rough, n); });
  const LinearImage split = ball_of(side, [&](float3 n) { return split_sum(view, rough, n); });
  const Plane<float> exact_luminance = luminance_of(exact), split_luminance = luminance_of(split);
  double mean = 0;
  for (const float light : exact_luminance.values()) mean += static_cast<double>(light);
  mean /= static_cast<double>(exact_luminance.values().size());
  figure.rows[1] = {
      {draw(0, 0.5f),
       "A dielectric\n4\u00a0% is mirrored, more at grazing views; the rest reaches the layer below, which reflects "
       "the "
       "irradiance."},
      {table_picture(side),
       "The lobe's reflectance\nDown: roughness from 0 to 1. Right: n·v from 0, grazing, to 1. Red is the factor of "
       "f0, "
       "green what Fresnel adds."},
      {shown(split),
       fmt::format("Split sum, roughness {}\nThe mean light of the lobe, times the table: two look-ups.", rough)},
      {shown(exact),
       fmt::format("The integral itself\n{} directions per pixel. At grazing views the lobe is longer and dimmer than "
                   "the split sum's. Difference: {}\u00a0% of the mean.",
                   samples, number(100 * rms_difference(exact_luminance, split_luminance) / mean, 1))}};
  figure.text = fmt::format(
      "The light that a surface reflects is an integral over all directions. Two approximations turn it into look-ups. "
      "First, the lobe is that of a view along the normal, so that its mean light depends on the mirror direction and "
      "the roughness only; it is computed in advance for {} levels of roughness. The levels are cube maps, with faces "
      "of {} to {} texels a side, and their texels are the control points of one spline, quadratic in direction and "
      "roughness. Second, "
      "the mean of the product of light and reflectance is replaced by the product of their means (Karis 2013). The "
      "filter takes seconds, so that its result is kept in a file. A background blurred by the same lobe costs one "
      "look-up a pixel. (Errors of look-ups: root mean square over 32 directions, relative to 32,768 samples of the "
      "lobe "
      "each.)",
      view.levels, view.side[0], view.side[view.levels - 1]);
  return {.frames = {figure}};
}

}  // namespace
}  // namespace environment_lesson

Demo demo_environment() {
  return {"environment", "reflection by roughness, irradiance, and the split sum", environment_lesson::make,
          environment_lesson::params};
}

}  // namespace zoneplate::lessons
