// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/picture.h"

#include <algorithm>
#include <array>
#include <bit>

#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/backdrop.h"
#include "zoneplate/metrics/rows.h"

namespace zoneplate::metrics {
namespace {

Linear light_of(Display c) { return {decode_srgb(c.r) * c.a, decode_srgb(c.g) * c.a, decode_srgb(c.b) * c.a, c.a}; }

float code_of(float premultiplied, float alpha) { return encode_srgb(std::clamp(premultiplied / alpha, 0.0f, 1.0f)); }

Display shown(Linear stored) {
  const Linear c = finite(stored);
  if (!(c.a > 0)) return {0, 0, 0, 0};
  return {code_of(c.r, c.a), code_of(c.g, c.a), code_of(c.b, c.a), std::min(c.a, 1.0f)};
}

}  // namespace

Picture make_picture(DisplayImage display) {
  LinearImage linear(display.width(), display.height());
  for_rows(display.height(), [&](int y) { std::ranges::transform(display.row(y), linear.row(y).begin(), light_of); });
  return {std::move(display), std::move(linear), false};
}

Picture make_picture(LinearImage linear) {
  DisplayImage display(linear.width(), linear.height());
  for_rows(linear.height(), [&](int y) { std::ranges::transform(linear.row(y), display.row(y).begin(), shown); });
  return {std::move(display), std::move(linear), true};
}

bool has_same_values(const Picture& a, const Picture& b) {
  if (a.is_scene_linear != b.is_scene_linear) return false;
  if (!a.is_scene_linear) return a.display == b.display;
  const auto has_same_bits = [](const Linear& p, const Linear& q) {
    return std::bit_cast<std::array<std::uint32_t, 4>>(p) == std::bit_cast<std::array<std::uint32_t, 4>>(q);
  };
  return a.width() == b.width() && a.height() == b.height() &&
         std::ranges::equal(a.linear.values(), b.linear.values(), has_same_bits);
}

std::size_t count_not_finite(const Picture& picture) {
  return static_cast<std::size_t>(
      std::ranges::count_if(picture.linear.values(), [](const Linear& c) { return !is_finite(c); }));
}

Plane<double> luma_plane(const DisplayImage& image, LumaWeights weights) {
  Plane<double> out(image.width(), image.height());
  for_rows(image.height(), [&](int y) {
    std::ranges::transform(image.row(y), out.row(y).begin(),
                           [&](Display c) { return luma(codes_on_black(c), weights); });
  });
  return out;
}

Plane<double> luminance_plane(const LinearImage& image) {
  Plane<double> out(image.width(), image.height());
  std::ranges::transform(image.values(), out.values().begin(),
                         [](const Linear& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; });
  return out;
}

}  // namespace zoneplate::metrics
