// SPDX-License-Identifier: Apache-2.0
// SMAA's third pass, neighborhood blending: each pixel is blended with its neighbours on the axis of its greater
// weight.
#include <algorithm>
#include <utility>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/smaa/smaa.h"

namespace zoneplate::antialias {
namespace {

/// Blends a pixel with its neighbours on the axis of its greater weight.
Rgba8 mixed_pixel(const Rgba8Image& image, int x, int y, const TakenWeights& taken, bool mixes_light) {
  const auto at = [&](int i, int j) {
    const Rgba8 c = image(std::clamp(i, 0, image.width() - 1), std::clamp(j, 0, image.height() - 1));
    if (mixes_light) return decode_pixel(c);
    return Linear{static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), static_cast<float>(c.a)};
  };
  const bool is_horizontal = std::max(taken.right, taken.left) > std::max(taken.below, taken.above);
  const float first = unorm8_value[is_horizontal ? taken.right : taken.below];
  const float second = unorm8_value[is_horizontal ? taken.left : taken.above];
  const Linear here = at(x, y);
  const Linear a = is_horizontal ? at(x + 1, y) : at(x, y + 1), b = is_horizontal ? at(x - 1, y) : at(x, y - 1);
  const float sum = first + second, u = first / sum, v = second / sum;
  const auto mix = [&](float c, float p, float q) { return u * (c + (p - c) * first) + v * (c + (q - c) * second); };
  const Linear out{mix(here.r, a.r, b.r), mix(here.g, a.g, b.g), mix(here.b, a.b, b.b), mix(here.a, a.a, b.a)};
  if (mixes_light) return encode_pixel(out);
  return {round_unorm8(out.r), round_unorm8(out.g), round_unorm8(out.b), round_unorm8(out.a)};
}

}  // namespace

Rgba8Image smaa_neighborhood_blending(const Rgba8Image& image, const SmaaBlendingWeights& weights,
                                      const SmaaOptions& options, Rgba8Image memory) {
  Rgba8Image out = sized_like(image, std::move(memory));
  mix_by_weights(
      image, out, [&](int y, WeightRow& row) { weights.find(y, row); },
      [&](int x, int y, const TakenWeights& taken) { return mixed_pixel(image, x, y, taken, options.mixes_light); });
  return out;
}

}  // namespace zoneplate::antialias
