// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/layout.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/elementary_constants.h"
#include "zoneplate/shade/environment/equirectangular.h"
#include "zoneplate/shade/environment/radiance.h"
#include "zoneplate/shade/environment/texel_light.h"

namespace zoneplate {
namespace {

/// A square or disc of the image: where it begins, its size in pixels, and whether it is turned by half a turn.
struct Panel {
  float x, y, width, height;
  bool is_turned = false;
};

/// Where a direction is in a panel, from 0 to 1 to the right and downwards.
struct Spot {
  Panel panel;
  float u, v;
};

/// The panels +x, -x, +y, -y, +z, -z of a cube.
struct CubePanels {
  Panel panel[6];
};

CubePanels panels_of(int width, int height, EnvironmentLayout layout) {
  const float w = static_cast<float>(width), h = static_cast<float>(height);
  const auto grid = [&](float columns, float rows) {
    return [=](float column, float row, bool is_turned = false) {
      return Panel{column * w / columns, row * h / rows, w / columns, h / rows, is_turned};
    };
  };
  if (layout == EnvironmentLayout::Strip) {
    const bool is_wide = width >= height;
    const auto at = is_wide ? grid(6, 1) : grid(1, 6);
    CubePanels out;
    for (int i = 0; i < 6; ++i) {
      const auto k = static_cast<float>(i);
      out.panel[i] = is_wide ? at(k, 0) : at(0, k);
    }
    return out;
  }
  if (width >= height) {
    const auto at = grid(4, 3);
    return {{at(2, 1), at(0, 1), at(1, 0), at(1, 2), at(1, 1), at(3, 1)}};
  }
  const auto at = grid(3, 4);
  return {{at(2, 1), at(0, 1), at(1, 0), at(1, 2), at(1, 1), at(1, 3, true)}};
}

/// Source: OpenGL 4.6, table 8.19.
Spot spot_of_cube(const CubePanels& panels, float3 world) {
  const float3 d{-world.x, world.y, world.z};
  const float ax = std::abs(d.x), ay = std::abs(d.y), az = std::abs(d.z);
  const auto spot = [&](int face, float s, float t, float longest) {
    float u = (s / longest + 1) / 2, v = (t / longest + 1) / 2;
    const Panel& panel = panels.panel[face];
    if (panel.is_turned) u = 1 - u, v = 1 - v;
    return Spot{panel, u, v};
  };
  if (ax >= ay && ax >= az) return d.x > 0 ? spot(0, -d.z, -d.y, ax) : spot(1, d.z, -d.y, ax);
  if (ay >= az) return d.y > 0 ? spot(2, d.x, d.z, ay) : spot(3, d.x, -d.z, ay);
  return d.z > 0 ? spot(4, d.x, -d.y, az) : spot(5, -d.x, -d.y, az);
}

/// The normal of the ball that mirrors d to +z lies halfway between them.
Spot spot_of_ball(const Panel& whole, float3 d) {
  const float3 n = normalize(d + float3{0, 0, 1});
  return {whole, (n.x + 1) / 2, (1 - n.y) / 2};
}

Spot spot_of_angle(const Panel& whole, float3 d) {
  const float across = std::sqrt(d.x * d.x + d.y * d.y);
  const float r = across > 0 ? acos(-d.z) / (elementary::pi * across) : 0.0f;
  return {whole, (d.x * r + 1) / 2, (1 - d.y * r) / 2};
}

/// Bilinear between the pixels of a panel.
float3 look_up(const Plane<float3>& light, const Spot& spot) {
  struct Axis {
    int first, second;
    float part;
  };
  const auto axis = [](float begin, float size, float at, int count) {
    const float p = std::clamp(begin + at * size - 0.5f, begin, std::max(begin + size - 1, begin));
    const int first = std::clamp(static_cast<int>(p), 0, count - 1);
    const int last = std::clamp(static_cast<int>(begin + size + 0.5f) - 1, first, count - 1);
    return Axis{first, std::min(first + 1, last), p - static_cast<float>(first)};
  };
  const Axis x = axis(spot.panel.x, spot.panel.width, spot.u, light.width());
  const Axis y = axis(spot.panel.y, spot.panel.height, spot.v, light.height());
  const auto mix = [](float3 a, float3 b, float part) { return a + (b - a) * part; };
  return mix(mix(light(x.first, y.first), light(x.second, y.first), x.part),
             mix(light(x.first, y.second), light(x.second, y.second), x.part), y.part);
}

/// By 4 × 4 directions in each texel.
template <class SpotOf>
CubeImage sampled(const Plane<float3>& light, int side, const SpotOf& spot_of) {
  constexpr int steps = 4;
  std::vector<TexelLight> texels(static_cast<std::size_t>(cube::faces * side * side));
  parallel_for(static_cast<std::size_t>(cube::faces * side), [&](std::size_t row) {
    const int face = static_cast<int>(row) / side, y = static_cast<int>(row) % side;
    for (int x = 0; x < side; ++x)
      for (int i = 0; i < steps * steps; ++i) {
        const float s = cube::centre(x * steps + i % steps, side * steps);
        const float t = cube::centre(y * steps + i / steps, side * steps);
        texels[row * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)].add(
            look_up(light, spot_of(normalize(cube::point(face, s, t)))), 1, cube::centre(i % steps, steps) * 0.5f,
            cube::centre(i / steps, steps) * 0.5f);
      }
  });
  return cube_of_texels(side, std::move(texels));
}

}  // namespace

EnvironmentLayout layout_of(int width, int height) {
  if (width == height) return EnvironmentLayout::MirrorBall;
  if (3 * width == 4 * height || 4 * width == 3 * height) return EnvironmentLayout::Cross;
  if (width == 6 * height || height == 6 * width) return EnvironmentLayout::Strip;
  return EnvironmentLayout::Equirectangular;
}

CubeImage cube_of(const TexelImage& image, EnvironmentLayout layout) {
  const int width = image.width(), height = image.height();
  if (layout == EnvironmentLayout::Equirectangular) return cube_of_equirectangular(image, cube_side(width));
  const Plane<float3> light = light_of(image);
  const Panel whole{0, 0, static_cast<float>(width), static_cast<float>(height)};
  // A ball shows all directions across half as many pixels as an equirectangular image of its width has columns.
  if (layout == EnvironmentLayout::MirrorBall)
    return sampled(light, cube_side(2 * width), [&](float3 d) { return spot_of_ball(whole, d); });
  if (layout == EnvironmentLayout::AngularMap)
    return sampled(light, cube_side(2 * width), [&](float3 d) { return spot_of_angle(whole, d); });
  const CubePanels panels = panels_of(width, height, layout);
  return sampled(light, cube_side(4 * static_cast<int>(panels.panel[0].width)),
                 [&](float3 d) { return spot_of_cube(panels, d); });
}

}  // namespace zoneplate
