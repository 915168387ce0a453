// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/shadow_map.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate {

/// A receiver in a map: its position in texels, its depth, and the depth that its plane has elsewhere.
struct MappedVisibility::Texels {
  float u, v, depth;
  float3 normal;      ///< in the axes of the map: right, up, forward
  float plane;        ///< dot(normal, position)
  float texel_width;  ///< world units

  /// The depth of the receiver's plane at texel coordinates, within a band around the receiver's own.
  float depth_at(const ShadowMap& map, float tu, float tv) const {
    const float half = static_cast<float>(map.depth.width()) / 2;
    float found;
    if (map.is_perspective) {
      const float x = (tu - half) / map.scale, y = (half - tv) / map.scale;
      found = plane / (normal.x * x + normal.y * y + normal.z);
    } else {
      found = depth - (normal.x * (tu - u) - normal.y * (tv - v)) / (map.scale * normal.z);
    }
    // Beyond this band the plane is seen from its edge.
    const float band = 16 * texel_width * (1 + std::abs(tu - u) + std::abs(tv - v));
    return found > depth - band && found < depth + band ? found : depth;
  }
};

namespace {

/// The positive and negative exponents, as large as the squares of the warped depths fit into a float, and the part of
/// the upper bound that counts as light bleeding.
/// Source    Lauritzen and McCool 2008; the exponents: Pettineo, A Sampling of Shadow Techniques, 2013; bleeding:
///           Lauritzen, Summed-Area Variance Shadow Maps, GPU Gems 3, 2007.
constexpr float positive_exponent = 40, negative_exponent = 5, bleeding = 0.2f;
/// Texels in which PCSS looks for blockers.
constexpr int search_points = 32;
/// The least standard deviation of a depth, as a part of the depth range: the depth of a map changes within a texel.
constexpr float min_deviation = 1e-4f;

WarpedMoments warped(float part) {
  const float p = exp(positive_exponent * part), n = -exp(-negative_exponent * part);
  return {p, p * p, n, n * n};
}

/// Chebyshev's upper bound of the part of a distribution of this mean and mean square that is beyond `t`.
float upper_bound(float mean, float mean_square, float t, float min_variance) {
  if (t <= mean) return 1;
  const float variance = std::max(mean_square - mean * mean, min_variance), d = t - mean;
  const float p = variance / (variance + d * d);
  return std::max(0.0f, (p - bleeding) / (1 - bleeding));
}

/// The warped moments of a map, filtered by a square of `radius` texels.
Plane<WarpedMoments> make_moments(const ShadowMap& map, float radius) {
  const int size = map.depth.width(), reach = static_cast<int>(std::ceil(radius - 0.5f));
  Plane<WarpedMoments> rows(size, size), out(size, size);
  // The outermost texels of the square count by the part that lies inside.
  const float edge = radius + 0.5f - static_cast<float>(reach), whole = 2 * radius;
  const auto filtered = [&](auto& from, int x, int y, int dx, int dy) {
    WarpedMoments sum{};
    for (int k = -reach; k <= reach; ++k) {
      const float weight = (std::abs(k) == reach ? std::min(1.0f, edge) : 1.0f) / whole;
      const WarpedMoments m = from(std::clamp(x + k * dx, 0, size - 1), std::clamp(y + k * dy, 0, size - 1));
      for (std::size_t c = 0; c < 4; ++c) sum[c] += weight * m[c];
    }
    return sum;
  };
  const auto warped_at = [&](int x, int y) { return warped(std::min(map.depth(x, y) / map.farthest, 1.0f)); };
  parallel_for(static_cast<std::size_t>(size), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size; ++x) rows(x, y) = filtered(warped_at, x, y, 1, 0);
  });
  parallel_for(static_cast<std::size_t>(size), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < size; ++x) out(x, y) = filtered(rows, x, y, 0, 1);
  });
  return out;
}

/// The side of a cube of maps that looks most directly at a point; of one map, that map.
std::size_t side_of(const std::vector<ShadowMap>& maps, float3 point) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < maps.size(); ++i)
    if (dot(point - maps[i].eye, maps[i].forward) > dot(point - maps[best].eye, maps[best].forward)) best = i;
  return best;
}

/// Calls use(x, y, weight) for the texels of a square around (u, v), with the part of each texel that lies inside;
/// texels outside of the map are left out.
template <class Use>
void for_square(int size, float u, float v, float radius, Use use) {
  const auto first = [&](float at) { return std::max(0, static_cast<int>(std::floor(std::max(at - radius, 0.0f)))); };
  const auto last = [&](float at) {
    return static_cast<int>(std::floor(std::min(at + radius, static_cast<float>(size) - 0.5f)));
  };
  const auto inside = [&](int texel, float at) {
    const float low = static_cast<float>(texel);
    return std::max(0.0f, std::min(low + 1, at + radius) - std::max(low, at - radius));
  };
  for (int y = first(v); y <= last(v); ++y)
    for (int x = first(u); x <= last(u); ++x) use(x, y, inside(x, u) * inside(y, v));
}

}  // namespace

MappedVisibility::MappedVisibility(std::vector<Light> lights, std::vector<std::vector<ShadowMap>> maps,
                                   const ShadowOptions& options, const LightVisibility* environment)
    : lights_(std::move(lights)),
      maps_(std::move(maps)),
      options_(options),
      environment_(environment),
      search_(search_points) {
  if (options_.map.filter != ShadowFilter::Evsm) return;
  for (const std::vector<ShadowMap>& of_light : maps_) {
    moments_.emplace_back();
    for (const ShadowMap& map : of_light) moments_.back().push_back(make_moments(map, options_.map.radius));
  }
}

/// The visibility of a light from a receiver, by the filter.
float MappedVisibility::at(const Light& light, const ShadowMap& map, const Plane<WarpedMoments>* moments,
                           const Texels& r, std::uint32_t seed) const {
  const int size = map.depth.width();
  // What a map does not show casts no shadow.
  const auto side = static_cast<float>(size);
  if (!(r.u >= 0 && r.u < side && r.v >= 0 && r.v < side)) return 1;
  const auto is_lit = [&](int x, int y) {
    return r.depth_at(map, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f) <= map.depth(x, y);
  };
  const auto mean = [&](float radius) {
    float sum = 0, all = 0;
    for_square(size, r.u, r.v, radius, [&](int x, int y, float weight) {
      all += weight;
      if (is_lit(x, y)) sum += weight;
    });
    return all > 0 ? sum / all : 1;
  };

  switch (options_.map.filter) {
    case ShadowFilter::Nearest:
      return is_lit(static_cast<int>(r.u), static_cast<int>(r.v)) ? 1.0f : 0.0f;
    case ShadowFilter::Pcf:
      return mean(options_.map.radius);
    case ShadowFilter::Evsm: {
      // Bilinear between the filtered texels.
      const float x = std::clamp(r.u - 0.5f, 0.0f, side - 1), y = std::clamp(r.v - 0.5f, 0.0f, side - 1);
      const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
      const int x1 = std::min(x0 + 1, size - 1), y1 = std::min(y0 + 1, size - 1);
      const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
      WarpedMoments m;
      for (std::size_t c = 0; c < 4; ++c) {
        const float upper = (*moments)(x0, y0)[c] * (1 - fx) + (*moments)(x1, y0)[c] * fx;
        const float lower = (*moments)(x0, y1)[c] * (1 - fx) + (*moments)(x1, y1)[c] * fx;
        m[c] = upper * (1 - fy) + lower * fy;
      }
      const WarpedMoments t = warped(std::min(r.depth / map.farthest, 1.0f));
      // A deviation of the depth is one of its warp, times the warp's slope.
      const float dp = min_deviation * positive_exponent * t[0], dn = min_deviation * negative_exponent * t[2];
      return std::min(upper_bound(m[0], m[1], t[0], dp * dp), upper_bound(m[2], m[3], t[2], dn * dn));
    }
    case ShadowFilter::Pcss: {
      // The extent of the light as the receiver sees it, times the distance from a blocker, is the width of the
      // penumbra.
      const float sine = light.kind == LightKind::Directional ? sin(light.radius > 0 ? light.radius : options_.angle)
                         : light.radius > 0                   ? light.radius / std::max(r.depth, light.radius)
                                                              : sin(options_.angle);
      const float slope = sine / std::sqrt(std::max(1 - sine * sine, 1e-6f));
      constexpr float most = 64;  // texels
      const float search = std::clamp(slope * r.depth / r.texel_width, 1.0f, most);
      const ShiftedDisc disc(search_, seed, 0x5eed);
      float sum = 0;
      int blockers = 0;
      for (std::uint32_t i = 0; i < search_points; ++i) {
        const ShiftedDisc::Point point = disc(i);
        const float radius = search * std::sqrt(point.square);
        const int x = static_cast<int>(std::floor(r.u + radius * point.cosine));
        const int y = static_cast<int>(std::floor(r.v + radius * point.sine));
        if (x < 0 || y < 0 || x >= size || y >= size || is_lit(x, y)) continue;
        sum += map.depth(x, y), ++blockers;
      }
      if (blockers == 0) return 1;
      const float blocker = sum / static_cast<float>(blockers);
      const float spread = map.is_perspective ? r.depth / std::max(blocker, 1e-6f * r.depth) : 1.0f;
      return mean(std::clamp(slope * (r.depth - blocker) * spread / r.texel_width, 0.5f, most));
    }
  }
  return 1;
}

void MappedVisibility::of_light(int k, const Receivers& receivers, float* visible) const {
  const Light& light = lights_[static_cast<std::size_t>(k)];
  const std::vector<ShadowMap>& maps = maps_[static_cast<std::size_t>(k)];
  for (int i = 0; i < receivers.count; ++i) {
    const auto vector = [&](const float(&a)[3][Receivers::capacity]) { return float3{a[0][i], a[1][i], a[2][i]}; };
    const float3 face = vector(receivers.face), position = vector(receivers.position);
    const std::size_t side = side_of(maps, position);
    const ShadowMap& map = maps[side];
    const float3 to_light = map.is_perspective ? map.eye - position : -map.forward;
    visible[i] = 0;
    const bool is_above = dot(vector(receivers.normal), to_light) > 0;
    if (!is_above && !receivers.is_transmissive) continue;
    const float sign = is_above ? 1.0f : -1.0f;

    const float distance = dot(position - map.eye, map.forward);
    const float texel_width = (map.is_perspective ? std::max(distance, 0.0f) : 1.0f) / map.scale;
    const float3 at_map = position + face * (sign * (receivers.margin[i] + options_.map.bias * texel_width)) - map.eye;
    const float3 p{dot(at_map, map.right), dot(at_map, map.up), dot(at_map, map.forward)};
    visible[i] = 1;
    if (map.is_perspective && !(p.z > 0)) continue;
    const float projected = map.is_perspective ? map.scale / p.z : map.scale;
    const float half = static_cast<float>(map.depth.width()) / 2;
    Texels r{half + p.x * projected, half - p.y * projected, p.z, {}, 0, texel_width};
    r.normal = {dot(face, map.right), dot(face, map.up), dot(face, map.forward)};
    r.plane = dot(r.normal, p);
    const Plane<WarpedMoments>* const moments =
        moments_.empty() ? nullptr : &moments_[static_cast<std::size_t>(k)][side];
    visible[i] = at(light, map, moments, r, receivers.seed[i]);
  }
}

}  // namespace zoneplate
