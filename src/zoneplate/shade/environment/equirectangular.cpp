// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/equirectangular.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/elementary_constants.h"
#include "zoneplate/shade/environment/radiance.h"

namespace zoneplate {
namespace {

struct Angle {
  float sine, cosine;
};

/// Positions between the pixels of a row or column, `per_pixel` to each pixel, with the weight of the second of the two
/// nearest pixels.
struct Step {
  int first, second;
  float weight;
  Angle angle;
};

/// The steps along an axis of `size` pixels that spans the angle `range`.
std::vector<Step> make_steps(int size, int per_pixel, float range, bool wraps) {
  std::vector<Step> steps;
  steps.reserve(static_cast<std::size_t>(size) * static_cast<std::size_t>(per_pixel));
  for (int i = 0; i < size * per_pixel; ++i) {
    const int pixel = i / per_pixel;
    const float at = (static_cast<float>(i % per_pixel) + 0.5f) / static_cast<float>(per_pixel);
    const int first = at < 0.5f ? pixel - 1 : pixel;
    const auto inside = [&](int p) { return wraps ? (p + size) % size : std::clamp(p, 0, size - 1); };
    const float angle = range * ((static_cast<float>(pixel) + at) / static_cast<float>(size));
    steps.push_back({inside(first), inside(first + 1), at < 0.5f ? at + 0.5f : at - 0.5f, {sin(angle), cos(angle)}});
  }
  return steps;
}

float3 direction_of(const Step& column, const Step& row) {
  return {-column.angle.cosine * row.angle.sine, row.angle.cosine, -column.angle.sine * row.angle.sine};
}

float3 mix(float3 a, float3 b, float weight) { return a + (b - a) * weight; }

float3 between(const Plane<float3>& light, const Step& column, const Step& row) {
  const auto above = light.row(row.first), below = light.row(row.second);
  const auto x0 = static_cast<std::size_t>(column.first), x1 = static_cast<std::size_t>(column.second);
  return mix(mix(above[x0], above[x1], column.weight), mix(below[x0], below[x1], column.weight), row.weight);
}

/// The radiance in one direction, for texels that no step meets.
float3 look_up(const Plane<float3>& light, float3 direction) {
  const float3 d = normalize(direction);
  const auto step = [](float at, int size, bool wraps) {
    const float p = at * static_cast<float>(size) - 0.5f;
    const int first = p < 0 ? -1 : static_cast<int>(p);
    const auto inside = [&](int i) { return wraps ? (i + size) % size : std::clamp(i, 0, size - 1); };
    return Step{inside(first), inside(first + 1), p - static_cast<float>(first), {}};
  };
  return between(light, step((atan2(d.z, d.x) + elementary::pi) / (2 * elementary::pi), light.width(), true),
                 step(acos(d.y) / elementary::pi, light.height(), false));
}

/// One face: the mean over the steps in each texel, weighted by their solid angles, in the order of the image.
void make_face(const Plane<float3>& light, const std::vector<Step>& columns, const std::vector<Step>& rows,
               int per_pixel, int face, CubeImage& cube) {
  const float3 axis = cube::point(face, 0, 0);
  // A face lies within the cone of cosine 1 / √3 about its axis; the diagonal of a pixel is a margin.
  const float pixel = std::max(2 * elementary::pi / static_cast<float>(light.width()),
                               elementary::pi / static_cast<float>(light.height())) *
                      1.5f;
  const float least = 0.57f - pixel;
  const auto side = static_cast<float>(cube.side);
  const auto texels = static_cast<std::size_t>(cube.side) * static_cast<std::size_t>(cube.side);
  std::vector<float4> sums(texels, float4{0, 0, 0, 0});
  for (const Step& row : rows) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const float3 d = direction_of(columns[c], row);
      if (dot(d, axis) < least) {
        // The rest of the pixel is outside as well.
        c += static_cast<std::size_t>(per_pixel) - 1 - c % static_cast<std::size_t>(per_pixel);
        continue;
      }
      const cube::Place place = cube::place(d);
      if (place.face != face) continue;
      const int x = std::min(static_cast<int>((place.s + 1) * 0.5f * side), cube.side - 1);
      const int y = std::min(static_cast<int>((place.t + 1) * 0.5f * side), cube.side - 1);
      const float3 radiance = between(light, columns[c], row) * row.angle.sine;
      float4& sum = sums[static_cast<std::size_t>(y * cube.side + x)];
      sum = {sum.x + radiance.x, sum.y + radiance.y, sum.z + radiance.z, sum.w + row.angle.sine};
    }
  }
  for (int y = 0; y < cube.side; ++y)
    for (int x = 0; x < cube.side; ++x) {
      const float4 sum = sums[static_cast<std::size_t>(y * cube.side + x)];
      cube.texels[cube.index(face, x, y)] =
          sum.w > 0 ? xyz(sum) * (1 / sum.w)
                    : look_up(light, cube::point(face, cube::centre(x, cube.side), cube::centre(y, cube.side)));
    }
}

}  // namespace

Plane<float3> light_of(const TexelImage& image) {
  Plane<float3> light(image.width(), image.height());
  image.visit([&](const auto& plane) {
    parallel_for(static_cast<std::size_t>(plane.height()), [&](std::size_t row) {
      const int y = static_cast<int>(row);
      std::transform(plane.row(y).begin(), plane.row(y).end(), light.row(y).begin(),
                     [](const auto& texel) { return radiance_of(texel); });
    });
  });
  return light;
}

int cube_side(int equirectangular_width) {
  int side = 32;
  while (side < 512 && (side < 256 ? 4 : 8) * side <= equirectangular_width) side *= 2;
  return side;
}

CubeImage cube_of_equirectangular(const TexelImage& image, int side) {
  const Plane<float3> light = light_of(image);
  // Four steps along the width of a texel in the middle of a face, where texels are largest.
  const float pixel = std::max(2 * elementary::pi / static_cast<float>(light.width()),
                               elementary::pi / static_cast<float>(light.height()));
  const int per_pixel = std::max(1, static_cast<int>(pixel * 2 * static_cast<float>(side)) + 1);
  const std::vector<Step> columns = make_steps(light.width(), per_pixel, 2 * elementary::pi, true);
  const std::vector<Step> rows = make_steps(light.height(), per_pixel, elementary::pi, false);
  CubeImage cube{side, std::vector<float3>(static_cast<std::size_t>(cube::faces * side * side))};
  parallel_for(cube::faces,
               [&](std::size_t face) { make_face(light, columns, rows, per_pixel, static_cast<int>(face), cube); });
  return cube;
}

}  // namespace zoneplate
