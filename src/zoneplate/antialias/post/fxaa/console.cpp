// SPDX-License-Identifier: Apache-2.0
// The scalar equivalents of the console path of FXAA 3.11: two taps half a pixel along the edge, and two more distant
// ones if their luma is within the range of the surrounding lumas.
#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/post/fxaa/console.h"

namespace zoneplate::scalar {
namespace {

/// The lumas at the four corners of a pixel.
struct Corners {
  float nw, ne, sw, se, high, low;

  Corners(const std::uint8_t* p, std::ptrdiff_t stride) {
    const auto corner = [&](std::ptrdiff_t dx, std::ptrdiff_t dy) {
      return static_cast<float>(p[0] + p[dx] + p[dy] + p[dx + dy]) / 4;
    };
    nw = corner(-1, -stride), ne = corner(1, -stride) + FxaaConsoleKernels::nudge;
    sw = corner(-1, stride), se = corner(1, stride);
    high = std::max({nw, ne, sw, se}), low = std::min({nw, ne, sw, se});
  }
};

void seen_row(const FxaaConsoleRows& rows, float threshold, float least, std::uint8_t* seen, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const Corners c(rows.luma + i, rows.stride);
    const float m = rows.luma[i];
    seen[i] = !(std::max(c.high, m) - std::min(c.low, m) < std::max(least, c.high * threshold));
  }
}

/// A colour as four floats in [0, 255], and its luma.
struct Tap {
  float rgba[4], luma;
};

Tap mean(const Tap& a, const Tap& b) {
  Tap out{{}, (a.luma + b.luma) * 0.5f};
  for (int c = 0; c < 4; ++c) out.rgba[c] = (a.rgba[c] + b.rgba[c]) * 0.5f;
  return out;
}

/// The bilinear fetch at a point relative to the centre of pixel x of n.
Tap fetch(const FxaaConsoleRows& rows, std::ptrdiff_t x, std::ptrdiff_t n, float dx, float dy) {
  const float left = std::floor(dx), top = std::floor(dy);
  const float u = dx - left, v = dy - top;
  x += static_cast<std::ptrdiff_t>(left);
  const auto y = static_cast<std::ptrdiff_t>(top);
  const auto mix = [&](float a, float b, float c, float d) {
    const float upper = a + (b - a) * u, lower = c + (d - c) * u;
    return upper + (lower - upper) * v;
  };
  const auto at = [&](std::ptrdiff_t i, std::ptrdiff_t j) {
    return rows.codes[rows.radius + y + j] + 4 * std::clamp<std::ptrdiff_t>(x + i, 0, n - 1);
  };
  const std::uint8_t *a = at(0, 0), *b = at(1, 0), *c = at(0, 1), *d = at(1, 1);
  const std::uint8_t *l = rows.luma + x + y * rows.stride, *below = l + rows.stride;
  Tap out{{}, mix(l[0], l[1], below[0], below[1])};
  for (int k = 0; k < 4; ++k) out.rgba[k] = mix(a[k], b[k], c[k], d[k]);
  return out;
}

void mix_pixel(const FxaaConsoleRows& rows, float sharpness, std::ptrdiff_t x, std::ptrdiff_t n, std::uint8_t* to) {
  const Corners corner(rows.luma + x, rows.stride);
  float dx = (corner.sw - corner.ne) + (corner.se - corner.nw), dy = (corner.sw - corner.ne) - (corner.se - corner.nw);
  const float length = std::sqrt(dx * dx + dy * dy);
  if (!(length > 0)) return;
  dx /= length, dy /= length;
  const Tap near = mean(fetch(rows, x, n, -dx * 0.5f, -dy * 0.5f), fetch(rows, x, n, dx * 0.5f, dy * 0.5f));

  const float scale = std::min(std::abs(dx), std::abs(dy)) * sharpness;
  const auto stretched = [&](float v) { return v == 0 ? 0.0f : 2 * std::clamp(v / scale, -2.0f, 2.0f); };
  const float fx = stretched(dx), fy = stretched(dy);
  const Tap far = mean(near, mean(fetch(rows, x, n, -fx, -fy), fetch(rows, x, n, fx, fy)));
  const Tap& c = far.luma < corner.low || far.luma > corner.high ? near : far;
  for (int k = 0; k < 4; ++k) to[k] = static_cast<std::uint8_t>(c.rgba[k] + 0.5f);
}

void mix_row(const FxaaConsoleRows& rows, float sharpness, const std::uint8_t* seen, std::uint8_t* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    if (seen[i])
      mix_pixel(rows, sharpness, static_cast<std::ptrdiff_t>(i), static_cast<std::ptrdiff_t>(n), out + 4 * i);
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const FxaaConsoleKernels PerIsa<FxaaConsoleKernels>::scalar = {.seen_row = scalar::seen_row,
                                                               .mix_row = scalar::mix_row};

}  // namespace zoneplate
