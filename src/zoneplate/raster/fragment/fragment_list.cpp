// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/fragment/fragment_list.h"

#include <bit>

#include "zoneplate/raster/coverage/coverage.h"

namespace zoneplate::scalar {
namespace {

SamplePosition position_of(const OwnerRow& row, std::uint32_t samples) {
  if (samples == (1u << row.sample_count) - 1 && !row.is_per_sample) return row.whole;
  std::int32_t sum = row.first_summand[std::countr_zero(samples)];
  for (std::uint32_t left = samples & (samples - 1); left; left &= left - 1)
    sum += row.more_summands[std::countr_zero(left)];
  return mean_position(sum);
}

void add(const OwnerRow& row, std::int32_t lane, std::int32_t id, std::uint32_t samples, FragmentList& out) {
  const SamplePosition position = position_of(row, samples);
  const int i = out.count++;
  out.x[i] = row.x + lane * 256 + position.x;
  out.y[i] = row.y + position.y;
  out.id[i] = id;
  out.at[i] = row.pixel + static_cast<std::uint32_t>(lane) + (samples << 12);
}

/// Lists fragments by their first samples, those of one first sample by pixels.
void list(const OwnerRow& row, FragmentList& out) {
  for (int s = 0; s < row.sample_count; ++s)
    for (std::int32_t lane = 0; lane < FragmentBatch::group; ++lane) {
      const auto id_of = [&](int sample) { return row.id[sample * sample_stride + lane]; };
      const std::int32_t id = id_of(s);
      if ((row.drawn >> lane & 1) == 0 || id == no_primitive) continue;
      if (row.is_per_sample) {
        add(row, lane, id, 1u << s, out);
        continue;
      }
      std::uint32_t samples = 0;
      for (int t = 0; t < row.sample_count; ++t) samples |= id_of(t) == id ? 1u << t : 0;
      if (std::countr_zero(samples) == s) add(row, lane, id, samples, out);
    }
}

void add(const FragmentOutputs& color, const std::uint32_t* at, const float* weight, int count, float* sum) {
  for (int i = 0; i < count; ++i) {
    float* const to = sum + 4 * FragmentList::pixel(at[i]);
    to[0] += color.r[i] * weight[i], to[1] += color.g[i] * weight[i];
    to[2] += color.b[i] * weight[i], to[3] += color.a[i] * weight[i];
  }
}

void divide(const float* sum, float weight, Linear8& out) {
  for (std::size_t i = 0; i < Linear8::size; ++i) {
    const float* const of = sum + 4 * i;
    out.set(i, {of[0] / weight, of[1] / weight, of[2] / weight, of[3] / weight});
  }
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const FragmentListKernels PerIsa<FragmentListKernels>::scalar = {
    .list = scalar::list, .add = scalar::add, .divide = scalar::divide};

}  // namespace zoneplate
