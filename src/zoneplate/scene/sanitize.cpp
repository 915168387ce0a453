// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/sanitize.h"

#include <algorithm>

#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {

// Sums x - x, which is 0 for finite x and NaN otherwise, with four independent accumulators.
bool are_finite(std::span<const float> values) {
  float sums[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (; i + 4 <= values.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k) sums[k] += values[i + k] - values[i + k];
  for (; i < values.size(); ++i) sums[0] += values[i] - values[i];
  return sums[0] + sums[1] + sums[2] + sums[3] == 0;
}

namespace {

constexpr std::size_t range_size = 1 << 15;

/// The floats of the vectors of vertices [begin, end).
template <class V>
std::span<const float> floats_of(const std::vector<V>& values, std::size_t begin, std::size_t end) {
  if (values.empty()) return {};
  constexpr std::size_t each = sizeof(V) / sizeof(float);
  return {reinterpret_cast<const float*>(values.data()) + begin * each, (end - begin) * each};
}

bool all_finite(const Mesh& m, std::size_t begin, std::size_t end) {
  return are_finite(floats_of(m.position, begin, end)) && are_finite(floats_of(m.normal, begin, end)) &&
         are_finite(floats_of(m.tangent, begin, end)) && are_finite(floats_of(m.uv0, begin, end)) &&
         are_finite(floats_of(m.uv1, begin, end)) && are_finite(floats_of(m.color, begin, end));
}

/// Replaces the attributes of a vertex that are not finite; returns whether there are any.
bool make_finite(Mesh& m, std::size_t i) {
  bool is_replaced = false;
  const auto replace = [&](auto& values, auto value) {
    if (are_finite(floats_of(values, i, i + 1))) return;
    values[i] = value;
    is_replaced = true;
  };
  replace(m.normal, float3{});
  replace(m.tangent, float4{});
  replace(m.uv0, float2{});
  replace(m.uv1, float2{});
  replace(m.color, float4{1, 1, 1, 1});
  return is_replaced;
}

}  // namespace

NotFinite drop_not_finite(Mesh& m) {
  std::vector<char> is_clean((m.position.size() + range_size - 1) / range_size);
  parallel_ranges(m.position.size(), range_size, [&](std::size_t begin, std::size_t end) {
    is_clean[begin / range_size] = all_finite(m, begin, end);
  });
  if (std::find(is_clean.begin(), is_clean.end(), 0) == is_clean.end()) return {};

  NotFinite out;
  std::vector<bool> is_bad(m.position.size());
  serial_ranges(m.position.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (!is_clean[i / range_size]) {
        if (make_finite(m, i)) ++out.replaced;
        is_bad[i] = !are_finite(floats_of(m.position, i, i + 1));
        if (is_bad[i]) m.position[i] = {};
      }
  });
  const auto corners = static_cast<std::size_t>(m.vertices_per_primitive());
  std::size_t kept = 0;
  for (std::size_t k = 0; k + corners <= m.index.size(); k += corners) {
    if (std::any_of(&m.index[k], &m.index[k] + corners, [&](std::uint32_t i) { return is_bad[i]; })) continue;
    for (std::size_t c = 0; c < corners; ++c) m.index[kept + c] = m.index[k + c];
    kept += corners;
  }
  out.dropped = (m.index.size() - kept) / corners;
  m.index.resize(kept);
  return out;
}

}  // namespace zoneplate
