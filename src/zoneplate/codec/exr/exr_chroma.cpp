// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_chroma.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace zoneplate {
namespace {

using Row = std::vector<float>;

/// Weights of the samples at distances of 1/2, 3/2, ... from the middle between two samples.
constexpr std::array taps = {0.627123f, -0.186077f, 0.087929f, -0.043159f, 0.019597f, -0.00754f, 0.002128f};

float* row_of(float* values, int width, int y) {
  return values + static_cast<std::ptrdiff_t>(y) * static_cast<std::ptrdiff_t>(width);
}

/// The odd columns of a row between its even ones, the first and last of which continue.
void reconstruct_columns(float* row, int width) {
  const auto sample = [&](int i) { return row[2 * std::clamp(i, 0, width / 2 - 1)]; };
  for (int i = 0; i < width / 2; ++i) {
    float sum = 0;
    for (int k = 0; k < static_cast<int>(taps.size()); ++k)
      sum += (sample(i - k) + sample(i + 1 + k)) * taps[static_cast<std::size_t>(k)];
    row[2 * i + 1] = sum;
  }
}

/// Row y between the even ones, the first and last of which continue; y may be -1.
void reconstruct_row(float* values, int width, int height, int y, float* out) {
  const auto sample = [&](int i) { return row_of(values, width, 2 * std::clamp(i, 0, height / 2 - 1)); };
  std::fill_n(out, width, 0.0f);
  for (int k = 0; k < static_cast<int>(taps.size()); ++k) {
    const float *const above = sample((y - 1) / 2 - k), *const below = sample((y + 1) / 2 + k);
    for (int x = 0; x < width; ++x) out[x] += (above[x] + below[x]) * taps[static_cast<std::size_t>(k)];
  }
}

void reconstruct(const ChromaPlane& plane, int width, int height) {
  assert(plane.sampling.x == 1 || (plane.sampling.x == 2 && width % 2 == 0));
  assert(plane.sampling.y == 1 || (plane.sampling.y == 2 && height % 2 == 0));
  if (plane.sampling.x == 2)
    for (int y = 0; y < height; y += plane.sampling.y) reconstruct_columns(row_of(plane.values, width, y), width);
  if (plane.sampling.y == 2)
    for (int y = 1; y < height; y += 2) reconstruct_row(plane.values, width, height, y, row_of(plane.values, width, y));
}

/// Replaces a row of RY, Y and BY by red, green and blue; without chroma all three are the luminance's bits.
void convert_row(float* red, float* luminance, float* blue, int width, float3 weights) {
  for (int x = 0; x < width; ++x) {
    const float y = luminance[x];
    if (red[x] == 0 && blue[x] == 0) {
      red[x] = blue[x] = y;
      continue;
    }
    red[x] = (red[x] + 1) * y;
    blue[x] = (blue[x] + 1) * y;
    luminance[x] = (y - red[x] * weights.x - blue[x] * weights.z) / weights.y;
  }
}

float saturation(float r, float g, float b) {
  const float most = std::max(r, std::max(g, b)), least = std::min(r, std::min(g, b));
  return most > 0 ? 1 - least / most : 0;
}

void compute_saturation(const float* r, const float* g, const float* b, Row& out) {
  for (std::size_t x = 0; x < out.size(); ++x) out[x] = saturation(r[x], g[x], b[x]);
}

/// Scales the saturation by `part` at the same luminance.
void desaturate(float& r, float& g, float& b, float part, float3 weights) {
  const auto luminance = [&] { return r * weights.x + g * weights.y + b * weights.z; };
  const float before = luminance(), most = std::max(r, std::max(g, b));
  for (float* const c : {&r, &g, &b}) *c = std::max(most - (most - *c) * part, 0.0f);
  const float after = luminance();
  if (after > 0)
    for (float* const c : {&r, &g, &b}) *c *= before / after;
}

/// The saturation of the row above the first, which the filters of its neighbours reach.
Row saturation_above(const LuminanceChroma& image, float3 weights) {
  const auto count = static_cast<std::size_t>(image.width);
  Row luminance(image.luminance, image.luminance + image.width), red(count), blue(count), out(count);
  const auto fill = [&](const ChromaPlane& plane, Row& row) {
    if (plane.sampling.y == 2)
      reconstruct_row(plane.values, image.width, image.height, -1, row.data());
    else
      std::copy_n(plane.values, image.width, row.begin());
  };
  fill(image.red, red), fill(image.blue, blue);
  convert_row(red.data(), luminance.data(), blue.data(), image.width, weights);
  compute_saturation(red.data(), luminance.data(), blue.data(), out);
  return out;
}

/// Limits the saturation of each pixel by that of its four diagonal neighbours. The row below the last is the last but
/// one.
void limit_saturation(const LuminanceChroma& image, float3 weights, Row above) {
  const auto row = [&](float* values, int y) { return row_of(values, image.width, y); };
  const auto saturation_of = [&](int y, Row& out) {
    compute_saturation(row(image.red.values, y), row(image.luminance, y), row(image.blue.values, y), out);
  };
  Row here(above.size()), below(above.size());
  saturation_of(0, here);
  for (int y = 0; y < image.height; ++y) {
    if (y + 1 < image.height)
      saturation_of(y + 1, below);
    else if (y > 0)
      below = above;
    else
      below = here;
    float *const r = row(image.red.values, y), *const g = row(image.luminance, y), *const b = row(image.blue.values, y);
    for (int x = 0; x < image.width; ++x) {
      const auto left = static_cast<std::size_t>(std::max(x - 1, 0)),
                 right = static_cast<std::size_t>(std::min(x + 1, image.width - 1));
      const float mean = std::min(1.0f, 0.25f * (above[left] + above[right] + below[left] + below[right]));
      const float most = std::min(1.0f, 1 - (1 - mean) * 0.25f), own = here[static_cast<std::size_t>(x)];
      if (own > mean && own > most) desaturate(r[x], g[x], b[x], most / own, weights);
    }
    std::swap(above, here), std::swap(here, below);
  }
}

}  // namespace

std::optional<float3> luminance_weights(const ExrChromaticities& c) {
  // The amounts of the primaries, of luminance y each, whose sum is white.
  const auto xyz = [&](std::size_t k) { return float3{c[2 * k], c[2 * k + 1], 1 - c[2 * k] - c[2 * k + 1]}; };
  const float3 r = xyz(0), g = xyz(1), b = xyz(2), w = xyz(3);
  const float volume = dot(r, cross(g, b));
  const float3 parts{dot(w, cross(g, b)) * r.y, dot(r, cross(w, b)) * g.y, dot(r, cross(g, w)) * b.y};
  const float3 weights = parts * (1 / (volume * w.y));
  if (!std::isfinite(weights.x) || !std::isfinite(weights.y) || !std::isfinite(weights.z) || weights.y == 0)
    return std::nullopt;
  return weights;
}

void make_colors(const LuminanceChroma& image, float3 weights) {
  reconstruct(image.red, image.width, image.height);
  reconstruct(image.blue, image.width, image.height);
  Row above = saturation_above(image, weights);
  for (int y = 0; y < image.height; ++y)
    convert_row(row_of(image.red.values, image.width, y), row_of(image.luminance, image.width, y),
                row_of(image.blue.values, image.width, y), image.width, weights);
  limit_saturation(image, weights, std::move(above));
}

}  // namespace zoneplate
