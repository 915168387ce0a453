// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/field/distance_transform.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/sdf/field/field_image.h"

namespace zoneplate::sdf {
namespace {

constexpr std::int32_t no_row = 1 << 15;  // more than any distance along a column

/// Along each column, the distance from the nearest pixel that is set.
Plane<std::int32_t> column_distances(const Plane<std::uint8_t>& mask) {
  Plane<std::int32_t> out(mask.width(), mask.height(), no_row);
  const auto width = static_cast<std::size_t>(mask.width());
  constexpr std::size_t grain = 256;
  parallel_ranges(width, grain, [&](std::size_t begin, std::size_t end) {
    const auto relax = [&](int y, int from) {
      for (auto x = static_cast<int>(begin); x < static_cast<int>(end); ++x)
        out(x, y) = mask(x, y) != 0                     ? 0
                    : from >= 0 && from < mask.height() ? std::min(out(x, y), out(x, from) + 1)
                                                        : out(x, y);
    };
    for (int y = 0; y < mask.height(); ++y) relax(y, y - 1);
    for (int y = mask.height(); y-- > 0;) relax(y, y + 1);
  });
  return out;
}

/// The lower envelope of the parabolas (x - i)² + g(i)² along a row.
void row_distances(std::span<const std::int32_t> g, std::span<std::int32_t> out) {
  const auto width = static_cast<std::int64_t>(g.size());
  const auto height_of = [&](std::int64_t i) {
    const std::int64_t v = g[static_cast<std::size_t>(i)];
    return v * v;
  };
  std::vector<std::int64_t> vertex, first;  // of each part of the envelope: its parabola and its first pixel
  for (std::int64_t i = 0; i < width; ++i) {
    if (g[static_cast<std::size_t>(i)] >= no_row) continue;
    std::int64_t from = 0;
    while (!vertex.empty()) {
      // The first pixel at which parabola i is lower than the last one, k: x > (i² - k² + g(i)² - g(k)²) / 2(i - k).
      const std::int64_t k = vertex.back(), numerator = i * i - k * k + height_of(i) - height_of(k),
                         denominator = 2 * (i - k);
      const std::int64_t quotient =
          numerator >= 0 ? numerator / denominator : -((-numerator + denominator - 1) / denominator);
      from = quotient + 1;
      if (from > first.back()) break;
      vertex.pop_back(), first.pop_back();
      from = 0;
    }
    if (from < width) vertex.push_back(i), first.push_back(vertex.size() == 1 ? 0 : from);
  }
  std::size_t part = 0;
  for (std::int64_t x = 0; x < width; ++x) {
    if (vertex.empty()) {
      out[static_cast<std::size_t>(x)] = infinitely_far;
      continue;
    }
    while (part + 1 < first.size() && first[part + 1] <= x) ++part;
    const std::int64_t along = x - vertex[part];
    out[static_cast<std::size_t>(x)] = static_cast<std::int32_t>(along * along + height_of(vertex[part]));
  }
}

}  // namespace

Plane<std::int32_t> squared_distances(const Plane<std::uint8_t>& mask) {
  assert(mask.width() < no_row && mask.height() < no_row);
  const Plane<std::int32_t> columns = column_distances(mask);
  Plane<std::int32_t> out(mask.width(), mask.height());
  parallel_for(static_cast<std::size_t>(mask.height()),
               [&](std::size_t y) { row_distances(columns.row(static_cast<int>(y)), out.row(static_cast<int>(y))); });
  return out;
}

Plane<float> signed_distances(const Plane<std::uint8_t>& mask) {
  Plane<std::uint8_t> complement(mask.width(), mask.height());
  std::ranges::transform(mask.values(), complement.values().begin(),
                         [](std::uint8_t m) { return static_cast<std::uint8_t>(m == 0); });
  const Plane<std::int32_t> outer = squared_distances(mask), inner = squared_distances(complement);
  Plane<float> out(mask.width(), mask.height());
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    const bool is_inside = mask.values()[i] != 0;
    const auto d = static_cast<float>(std::sqrt(static_cast<double>((is_inside ? inner : outer).values()[i])) - 0.5);
    out.values()[i] = is_inside ? -d : d;
  }
  return out;
}

Plane<float> drawn_field(const Plane<float>& distances, int width, int height, double scale) {
  FieldImage field{.distances = Plane<float4>(distances.width(), distances.height())};
  for (std::size_t i = 0; i < distances.values().size(); ++i) {
    const float inside = -distances.values()[i];
    field.distances.values()[i] = {inside, inside, inside, inside};
  }
  Plane<float> out(width, height);
  field.add_coverage(out, {}, scale);
  return out;
}

}  // namespace zoneplate::sdf
