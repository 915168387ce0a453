// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/coverage/alpha_coverage.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace zoneplate {
namespace {

constexpr float min_slope = 1e-4f;

/// The batch's fragments, moved by a pixel (or sample) along one direction.
FragmentBatch moved(const FragmentBatch& batch, const float (&change)[2][FragmentBatch::padded_capacity]) {
  FragmentBatch out = batch;
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < batch.padded(); ++i) out.b[k][i] += change[k][i];
  return out;
}

}  // namespace

int AlphaDigits::digits() const { return static_cast<int>(std::bit_width(static_cast<unsigned>(samples_))); }

float AlphaDigits::alpha(const FragmentBatch& batch, float* out) const {
  const float cutoff = inner_.alpha(batch, out);
  alignas(64) float right[FragmentBatch::padded_capacity], below[FragmentBatch::padded_capacity];
  if (is_sharp_) {
    inner_.alpha(moved(batch, batch.dbdx), right);
    inner_.alpha(moved(batch, batch.dbdy), below);
  }
  for (int i = 0; i < batch.padded(); ++i) {
    float a = out[i];
    if (is_sharp_)
      a = (a - cutoff) / std::max(std::abs(right[i] - out[i]) + std::abs(below[i] - out[i]), min_slope) + 0.5f;
    const int count = static_cast<int>(std::clamp(a, 0.0f, 1.0f) * static_cast<float>(samples_) + 0.5f);
    out[i] = static_cast<float>(count >> digit_ & 1);
  }
  return 1;
}

}  // namespace zoneplate
