// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/area_filters.h"

#include <cmath>

#include "zoneplate/math/lanes.h"
#include "zoneplate/shade/texture/area_filters_lanes.h"

namespace zoneplate {

template <>
const AreaFilterKernels PerIsa<AreaFilterKernels>::scalar = area::all<scalar::Float>();

namespace {

/// Edges of a box lie at multiples of 1 / edge_steps texel.
constexpr std::int64_t edge_steps = 256;

/// The sums up to any place along an axis: places beyond the ends are reduced to a place inside, a sign and a number of
/// whole images.
struct Place {
  std::int64_t at, sign, wholes;  ///< at in [0, size]
};

/// The integral of the wrapped image up to `x` is wholes × the whole + sign × the integral up to `at`.
Place place_of(std::int64_t x, std::int64_t size, bool mirrors, bool clamps) {
  if (clamps) return {std::clamp<std::int64_t>(x, 0, size), 1, 0};
  const std::int64_t turn = x >= 0 ? x / size : -((size - 1 - x) / size), rest = x - turn * size;
  if (mirrors && (turn & 1) != 0) return {size - rest, -1, turn + 1};
  return {rest, 1, turn};
}

/// The extent of the footprint along an axis, in steps of an edge: at least a texel, at most the image.
struct Span {
  std::int64_t begin, end;
};
Span span_of(float coordinate, float dx, float dy, std::int32_t size, bool mirrors, bool clamps) {
  const double texels = size, least = 1 / texels;
  const double extent = std::abs(static_cast<double>(dx)) + std::abs(static_cast<double>(dy));
  const double length = extent > least ? std::min(extent, 1.0) : least;
  const double u = area::reduced(scalar::Float(coordinate), mirrors, clamps).v;
  const double to_steps = texels * static_cast<double>(edge_steps);
  const auto steps = std::max(static_cast<std::int64_t>(length * to_steps + 0.5), std::int64_t{1});
  auto begin = static_cast<std::int64_t>(std::floor((u - length / 2) * to_steps + 0.5));
  // Beyond a border that is clamped there must remain something to average.
  if (clamps) begin = std::clamp(begin, -steps / 2, size * edge_steps - (steps + 1) / 2);
  return {begin, begin + steps};
}

/// The integral of channel c over a box: Sum is that of the table's entries, unsigned for codes, whose overflows
/// cancel.
template <class Sum>
struct BoxIntegral {
  const Sum* table;
  std::int32_t width, height;
  bool mirror_u, clamp_u, mirror_v, clamp_v;
  int c;

  Sum entry(std::int64_t x, std::int64_t y) const { return table[4 * (y * (width + 1) + x) + c]; }
  /// The integral over [0, x) × [0, y), in steps, of the image itself.
  Sum inside(std::int64_t x, std::int64_t y) const {
    const std::int64_t i = x / edge_steps, j = y / edge_steps;
    const Sum right = static_cast<Sum>(x % edge_steps), down = static_cast<Sum>(y % edge_steps);
    const Sum left = static_cast<Sum>(edge_steps) - right, up = static_cast<Sum>(edge_steps) - down;
    const std::int64_t i1 = std::min<std::int64_t>(i + 1, width), j1 = std::min<std::int64_t>(j + 1, height);
    return (entry(i, j) * left + entry(i1, j) * right) * up + (entry(i, j1) * left + entry(i1, j1) * right) * down;
  }
  Sum up_to(std::int64_t x, std::int64_t y) const {
    const std::int64_t w = width * edge_steps, h = height * edge_steps;
    const Place px = place_of(x, w, mirror_u, clamp_u), py = place_of(y, h, mirror_v, clamp_v);
    const auto times = [](std::int64_t n) { return static_cast<Sum>(n); };
    return times(px.wholes * py.wholes) * inside(w, h) + times(px.wholes * py.sign) * inside(w, py.at) +
           times(px.sign * py.wholes) * inside(px.at, h) + times(px.sign * py.sign) * inside(px.at, py.at);
  }
  Sum over(const Span& x, const Span& y) const {
    return up_to(x.end, y.end) - up_to(x.begin, y.end) - up_to(x.end, y.begin) + up_to(x.begin, y.begin);
  }
};

std::int64_t length_inside(const Span& s, std::int32_t size, bool clamps) {
  if (!clamps) return s.end - s.begin;
  return std::min(s.end, size * edge_steps) - std::max(s.begin, std::int64_t{0});
}

}  // namespace

void sample_sums(const SumsView& s, const SamplerState& f, const Footprint& from, float* const out[4], int count) {
  const area::Derivatives derivatives(from, count);
  const Footprint at = derivatives.footprint(from);
  for (int i = 0; i < count; ++i) {
    const Span x = span_of(at.u[i], at.dudx[i], at.dudy[i], s.width, f.mirror_u, f.clamp_u);
    const Span y = span_of(at.v[i], at.dvdx[i], at.dvdy[i], s.height, f.mirror_v, f.clamp_v);
    const std::int64_t area = length_inside(x, s.width, f.clamp_u) * length_inside(y, s.height, f.clamp_v);
    for (int c = 0; c < 4; ++c) {
      if (s.codes != nullptr) {
        const BoxIntegral<std::uint64_t> integral{s.codes,   s.width,    s.height,  f.mirror_u,
                                                  f.clamp_u, f.mirror_v, f.clamp_v, c};
        const std::uint64_t sum = integral.over(x, y);
        out[c][i] = static_cast<float>(static_cast<double>(sum) / static_cast<double>(area)) * s.unit;
      } else {
        const BoxIntegral<double> integral{s.values,  s.width,    s.height,  f.mirror_u,
                                           f.clamp_u, f.mirror_v, f.clamp_v, c};
        out[c][i] = std::max(static_cast<float>(integral.over(x, y) / static_cast<double>(area)), 0.0f);
      }
    }
  }
}

void measure_footprints(const TextureView& t, const Footprint& from, float* mip_level, float* anisotropy, int count) {
  using F = scalar::Float;
  constexpr float most = 1024;
  const area::Derivatives derivatives(from, count);
  const Footprint at = derivatives.footprint(from);
  const float w = static_cast<float>(t.width[0]), h = static_cast<float>(t.height[0]);
  for (int i = 0; i < count; ++i) {
    mip_level[i] = footprint_level<F>(w, h, at, i).v;
    const area::Ellipse<F> e({at.dudx[i] * w, at.dvdx[i] * h, at.dudy[i] * w, at.dvdy[i] * h});
    const float square = e.longer.v / std::max(e.shorter.v, e.longer.v / (most * most));
    anisotropy[i] = square > 1 ? std::sqrt(square) : 1.0f;
  }
}

}  // namespace zoneplate
