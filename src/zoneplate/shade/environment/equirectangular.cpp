// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/environment/equirectangular.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/math/elementary_constants.h"
#include "zoneplate/shade/environment/radiance.h"
#include "zoneplate/shade/environment/texel_light.h"

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

float3 derivative_by_row(const Step& column, const Step& row) {
  return {-column.angle.cosine * row.angle.cosine, -row.angle.sine, -column.angle.sine * row.angle.cosine};
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

/// The pieces into which a whole number divides an interval of a width below 1: where none lies in it, one.
struct Pieces {
  int first, count;
  float part[2], centre[2];

  Pieces(float at, float width) {
    const float begin = at - width * 0.5f, end = at + width * 0.5f;
    first = static_cast<int>(std::floor(begin));
    const auto cut = static_cast<float>(first + 1);
    count = cut < end ? 2 : 1;
    part[0] = count == 1 ? 1.0f : (cut - begin) / width, part[1] = 1 - part[0];
    centre[0] = count == 1 ? at : (begin + cut) * 0.5f, centre[1] = (cut + end) * 0.5f;
  }
};

/// The light of the texels of one face, in the order of the image. The texels that a step overlaps share it, so that
/// every texel has nearly its solid angle of steps.
void make_face(const Plane<float3>& light, const std::vector<Step>& columns, const std::vector<Step>& rows,
               int per_pixel, int face, int side, TexelLight* texels) {
  const float3 axis = cube::point(face, 0, 0);
  // A face lies within the cone of cosine 1 / √3 about its axis; the diagonal of a pixel is a margin.
  const float pixel = std::max(2 * elementary::pi / static_cast<float>(light.width()),
                               elementary::pi / static_cast<float>(light.height())) *
                      1.5f;
  const float least = 0.57f - pixel;
  const float half_side = static_cast<float>(side) * 0.5f;
  const float column_angle = 2 * elementary::pi / static_cast<float>(columns.size()),
              row_angle = elementary::pi / static_cast<float>(rows.size());
  for (const Step& row : rows) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const float3 d = direction_of(columns[c], row);
      const float ahead = dot(d, axis);
      if (ahead < least) {
        // The rest of the pixel is outside as well.
        c += static_cast<std::size_t>(per_pixel) - 1 - c % static_cast<std::size_t>(per_pixel);
        continue;
      }
      // On the plane of the face, where steps from beyond its edges may overlap it.
      if (ahead < 0.5f) continue;
      const float distance = 1 / ahead;
      const float2 at = cube::across(face, d) * distance;
      // A step covers a rectangle of the sum of its extents by row and by column. These rectangles cover the face
      // evenly where the steps lie along its axes, or at 45 degrees to them.
      const auto step = [&](float3 derivative, float angle) {
        const float2 move = cube::across(face, derivative);
        const float away = dot(derivative, axis), scale = distance * angle * half_side;
        return float2{std::abs(move.x - at.x * away) * scale, std::abs(move.y - at.y * away) * scale};
      };
      const float2 by_column = step({-d.z, 0, d.x}, column_angle),
                   by_row = step(derivative_by_row(columns[c], row), row_angle);
      const Pieces across((at.x + 1) * half_side, by_column.x + by_row.x),
          down((at.y + 1) * half_side, by_column.y + by_row.y);
      if (across.first + across.count <= 0 || down.first + down.count <= 0 || across.first >= side ||
          down.first >= side)
        continue;
      const float3 radiance = between(light, columns[c], row);
      for (int j = 0; j < down.count; ++j)
        for (int i = 0; i < across.count; ++i) {
          const int x = across.first + i, y = down.first + j;
          if (x < 0 || y < 0 || x >= side || y >= side) continue;
          texels[y * side + x].add(radiance, row.angle.sine * across.part[i] * down.part[j],
                                   across.centre[i] - (static_cast<float>(x) + 0.5f),
                                   down.centre[j] - (static_cast<float>(y) + 0.5f));
        }
    }
  }
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      if (TexelLight& texel = texels[y * side + x]; !(texel.weights.one > 0))
        texel.add(look_up(light, cube::point(face, cube::centre(x, side), cube::centre(y, side))), 1, 0, 0);
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
  int side = 64, columns = 2 * side;
  while (side < 512 && columns <= equirectangular_width) side *= 2, columns *= 4;
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
  std::vector<TexelLight> texels(static_cast<std::size_t>(cube::faces * side * side));
  parallel_for(cube::faces, [&](std::size_t face) {
    make_face(light, columns, rows, per_pixel, static_cast<int>(face), side,
              texels.data() + face * static_cast<std::size_t>(side * side));
  });
  return cube_of_texels(side, std::move(texels));
}

}  // namespace zoneplate
