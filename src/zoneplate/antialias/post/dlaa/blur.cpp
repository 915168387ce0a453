// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/dlaa/blur.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "zoneplate/antialias/post/dlaa/blur_lanes.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {
namespace scalar {
namespace {

int bend(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c) {
  return std::abs(a[0] + b[0] - 2 * c[0]) + std::abs(a[1] + b[1] - 2 * c[1]) + std::abs(a[2] + b[2] - 2 * c[2]);
}

void edge_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, std::uint8_t* edges,
              std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    int sum = 0;
    for (std::size_t at = 4 * i; at < 4 * i + 3; ++at)
      sum += std::abs(*(here + at - 4) + here[at + 4] + above[at] + below[at] - 4 * here[at]);
    edges[i] = static_cast<std::uint8_t>(std::min(255, (4 * sum + 1) / 3));
  }
}

void sum_row(const std::uint8_t* edges, std::int16_t* sums, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    int sum = 0;
    for (std::ptrdiff_t k = -8; k <= 8; ++k) sum += *(edges + i + k);
    sums[i] = static_cast<std::int16_t>(sum);
  }
}

void slide_row(const std::uint8_t* added, const std::uint8_t* removed, std::int16_t* sums, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) sums[i] = static_cast<std::int16_t>(sums[i] + added[i] - removed[i]);
}

void seen_row(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below, const std::int16_t* level,
              const std::int16_t* upright, int min_bend, int min_sum, std::uint8_t* seen, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint8_t* c = here + 4 * i;
    const int most = std::max(bend(c - 4, c + 4, c), bend(above + 4 * i, below + 4 * i, c));
    seen[i] = most > min_bend || std::max(level[i], upright[i]) > min_sum ? 1 : 0;
  }
}

using Constants = DlaaConstants;

float4 values_of(const std::uint8_t* c) {
  return {static_cast<float>(c[0]) / 255, static_cast<float>(c[1]) / 255, static_cast<float>(c[2]) / 255,
          static_cast<float>(c[3]) / 255};
}
float luma(const float4& c) { return (c.x + c.y + c.z) / 3; }
float saturated(float v) { return v > 0 ? std::min(v, 1.0f) : 0.0f; }  // NaN gives 0
float4 mixed(const float4& a, const float4& b, float t) {
  return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t, a.w + (b.w - a.w) * t};
}
/// lambda times the luma of half the second difference, minus epsilon.
float edge_of(int bend) { return Constants::lambda * (static_cast<float>(bend) / (3 * 2 * 255)) - Constants::epsilon; }

/// The colour between the neighbours at the ends of a line through `c` whose luma is that of the blur along it.
float4 between(const float4& first, const float4& c, const float4& last, const float4& blur) {
  const float to_first = luma(c) - luma(first), to_last = luma(c) - luma(last);
  const float a = to_first == 0 ? 1.0f : saturated((luma(blur) - luma(first)) / to_first);
  const float b = to_last == 0 ? 1.0f : saturated(1 + (luma(blur) - luma(c)) / to_last);
  return mixed(last, mixed(first, c, a), b);
}

/// The mean of the sixteen pixels around, `step` bytes apart, without the one in the middle.
float4 long_blur(const std::uint8_t* pixel, std::ptrdiff_t step) {
  int r = 0, g = 0, b = 0, a = 0;
  for (int i = -Constants::half_blur; i <= Constants::half_blur; ++i) {
    if (i == 0) continue;
    const std::uint8_t* c = pixel + i * step;
    r += c[0], g += c[1], b += c[2], a += c[3];
  }
  constexpr float scale = Constants::whole;
  return {static_cast<float>(r) / scale, static_cast<float>(g) / scale, static_cast<float>(b) / scale,
          static_cast<float>(a) / scale};
}

void blur_pixel(const std::uint8_t* p, std::ptrdiff_t s, float level_mask, float upright_mask, std::uint8_t* to) {
  const int level_bend = bend(p - 4, p + 4, p), upright_bend = bend(p - s, p + s, p);
  const bool has_long = std::abs(level_mask - upright_mask) > Constants::min_unlike;
  if (std::max(level_bend, upright_bend) <= Constants::unseen_bend && !has_long) return;
  const float level = edge_of(level_bend), upright = edge_of(upright_bend);
  const float4 c = values_of(p), l = values_of(p - 4), r = values_of(p + 4), t = values_of(p - s), b = values_of(p + s);

  // Short edges: a blur of six pixels along the direction of smaller change.
  const auto blurred = [&](const float4& two, const float4& one, const float4& next, const float4& after) {
    return (two + one + next + after + c * 2) * (1.0f / 6);
  };
  const float4 along = blurred(values_of(p - 8), l, r, values_of(p + 8));
  const float4 down = blurred(values_of(p - 2 * s), t, b, values_of(p + 2 * s));
  float4 out = mixed(c, along, saturated(upright / luma(along)));
  out = mixed(out, down, 0.5f * saturated(level / luma(down)));

  if (has_long) {
    out = mixed(out, between(l, c, r, long_blur(p, s)), upright_mask);
    out = mixed(out, between(t, c, b, long_blur(p, 4)), level_mask);
  }
  const auto code = [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5f); };
  to[0] = code(out.x), to[1] = code(out.y), to[2] = code(out.z), to[3] = code(out.w);
}

}  // namespace

}  // namespace scalar

template <>
const DlaaKernels PerIsa<DlaaKernels>::scalar = {.edge_row = scalar::edge_row,
                                                 .sum_row = scalar::sum_row,
                                                 .slide_row = scalar::slide_row,
                                                 .seen_row = scalar::seen_row,
                                                 .blur_row = stages::dlaa_blur_row<scalar::blur_pixel>};

}  // namespace zoneplate
