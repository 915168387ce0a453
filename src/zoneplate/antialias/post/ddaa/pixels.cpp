// SPDX-License-Identifier: Apache-2.0
// The scalar equivalents of DDAA's kernels.
#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/post/ddaa/pixels.h"
#include "zoneplate/math/vec.h"

namespace zoneplate::scalar {
namespace {

using Constants = DdaaConstants;

void power_row(const std::uint8_t* rgba, float* power, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    power[i] = static_cast<float>(299 * rgba[4 * i] + 587 * rgba[4 * i + 1] + 114 * rgba[4 * i + 2]) / 255000;
}

void seen_row(const float* power, std::ptrdiff_t stride, float threshold, float least, std::uint8_t* seen,
              std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    // The square root is monotonic, so that the greatest and the least luma are those of the sums.
    const float* p = power + i;
    const auto [low, high] = std::minmax({p[0], *(p - stride), p[stride], *(p - 1), p[1]});
    const float greatest = std::sqrt(high), range = greatest - std::sqrt(low);
    seen[i] = low != high && range >= std::max(least, greatest * threshold);
  }
}

/// The lumas around a pixel and the quantities derived from them.
struct Around {
  float m, n, s, w, e, nw, ne, sw, se;
  Around(const float* p, std::ptrdiff_t stride)
      : m(std::sqrt(p[0])),
        n(std::sqrt(*(p - stride))),
        s(std::sqrt(p[stride])),
        w(std::sqrt(p[-1])),
        e(std::sqrt(p[1])),
        nw(std::sqrt(*(p - stride - 1))),
        ne(std::sqrt(*(p - stride + 1))),
        sw(std::sqrt(p[stride - 1])),
        se(std::sqrt(p[stride + 1])) {}

  bool is_horizontal() const {
    const float h = std::abs((nw + sw) - 2 * w) + 2 * std::abs((n + s) - 2 * m) + std::abs((ne + se) - 2 * e);
    const float v = std::abs((nw + ne) - 2 * n) + 2 * std::abs((w + e) - 2 * m) + std::abs((sw + se) - 2 * s);
    return h >= v;
  }
  /// The direction of the edge, across the gradient.
  float2 direction() const {
    const float gx = Constants::scharr_middle * (w - e) + Constants::scharr_corner * ((sw + nw) - (se + ne));
    const float gy = Constants::scharr_middle * (n - s) + Constants::scharr_corner * ((nw + ne) - (sw + se));
    return {-gy, gx};
  }
};

/// The offset towards the pixel across the nearer edge, from the line through the edge's ends.
float search_offset(const float* pixel, std::ptrdiff_t along, std::ptrdiff_t across, float here, float there) {
  const float average = (here + there) / 2, least = 0.25f * std::abs(there - here);
  struct End {
    int distance = Constants::search + 1;
    float off = 0;
  };
  const auto find_end = [&](std::ptrdiff_t step) {
    End found;
    for (int i = 1; i <= Constants::search; ++i) {
      const float *p = pixel + i * step, *q = p + across;
      const float luma = i == 1 ? (std::sqrt(*p) + std::sqrt(*q)) / 2 : std::sqrt((*p + *q) / 2);
      found.off = luma - average;
      if (std::abs(found.off) >= least) {
        found.distance = i;
        break;
      }
    }
    return found;
  };
  const End before = find_end(-along), after = find_end(along);
  const End& nearer = before.distance < after.distance ? before : after;
  if ((nearer.off < 0) == (here < average)) return 0;
  return 0.5f - static_cast<float>(nearer.distance) / static_cast<float>(before.distance + after.distance);
}

void taps_of(const float* pixel, std::ptrdiff_t stride, float most, float* taps) {
  const Around a(pixel, stride);
  float2 direction = a.direction();
  const float length = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  float strength = std::min(1.0f, most * std::sqrt(length));
  direction = strength < 1e-6f ? float2{0, 0} : float2{direction.x / length, direction.y / length};

  const bool is_horizontal = a.is_horizontal();
  const float first = (is_horizontal ? a.n : a.w) - a.m, second = (is_horizontal ? a.s : a.e) - a.m;
  // A line of one pixel is a ridge, and is not blurred.
  if ((first > 0) == (second > 0) && (first < 0) == (second < 0))
    strength *= 1 - std::min(1.0f, 10 * std::min(std::abs(first), std::abs(second)));

  const bool is_second = std::abs(second) > std::abs(first);
  const int side = is_second ? 1 : -1;
  const std::ptrdiff_t along = is_horizontal ? 1 : stride, across = side * (is_horizontal ? stride : 1);
  const float offset = search_offset(pixel, along, across, a.m, a.m + (is_second ? second : first));
  strength *= 1 - std::min(1.0f, std::abs(2 * offset));
  const float moved = offset * static_cast<float>(side), spread = Constants::diffusion_step * strength;
  const float2 middle = is_horizontal ? float2{0, moved} : float2{moved, 0};
  taps[0] = middle.x - direction.x * spread, taps[1] = middle.y - direction.y * spread;
  taps[2] = middle.x + direction.x * spread, taps[3] = middle.y + direction.y * spread;
}

void taps_row(const float* power, std::ptrdiff_t stride, float strength, const std::uint8_t* seen, float* taps,
              std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    if (seen[i]) taps_of(power + i, stride, strength, taps + 4 * i);
}

/// The bilinear fetch at a point relative to the centre of pixel x of the middle row.
float4 fetch(const std::uint8_t* const* rows, std::ptrdiff_t x, std::ptrdiff_t n, float dx, float dy) {
  const float left = std::floor(dx), top = std::floor(dy), u = dx - left, v = dy - top;
  x += static_cast<std::ptrdiff_t>(left);
  const std::uint8_t* const* row = rows + 2 + static_cast<std::ptrdiff_t>(top);
  const auto at = [&](std::ptrdiff_t i, int j) {
    const std::uint8_t* c = row[j] + 4 * std::clamp<std::ptrdiff_t>(i, 0, n - 1);
    return float4{static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]),
                  static_cast<float>(c[3])};
  };
  const float4 upper = at(x, 0) * (1 - u) + at(x + 1, 0) * u, lower = at(x, 1) * (1 - u) + at(x + 1, 1) * u;
  return upper * (1 - v) + lower * v;
}

void fetch_row(const std::uint8_t* const* rows, const float* taps, const std::uint8_t* seen, std::uint8_t* out,
               std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    if (!seen[i]) continue;
    const auto x = static_cast<std::ptrdiff_t>(i), width = static_cast<std::ptrdiff_t>(n);
    const float* t = taps + 4 * i;
    const float4 c = (fetch(rows, x, width, t[0], t[1]) + fetch(rows, x, width, t[2], t[3])) * 0.5f;
    const auto code = [](float value) { return static_cast<std::uint8_t>(value + 0.5f); };
    out[4 * i] = code(c.x), out[4 * i + 1] = code(c.y), out[4 * i + 2] = code(c.z), out[4 * i + 3] = code(c.w);
  }
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const DdaaKernels PerIsa<DdaaKernels>::scalar = {.power_row = scalar::power_row,
                                                 .seen_row = scalar::seen_row,
                                                 .taps_row = scalar::taps_row,
                                                 .fetch_row = scalar::fetch_row};

}  // namespace zoneplate
