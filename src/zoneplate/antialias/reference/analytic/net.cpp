// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/net.h"

#include <algorithm>

#include "zoneplate/antialias/reference/converged/pattern.h"

namespace zoneplate::antialias {
namespace {

/// The index of a position's square on the Z-order curve of 2^16 × 2^16 squares.
std::uint32_t z_order(std::uint32_t x, std::uint32_t y) {
  std::uint32_t out = 0;
  for (int bit = 31; bit >= 16; --bit) out = out << 2 | (y >> bit & 1) << 1 | (x >> bit & 1);
  return out;
}

}  // namespace

SampleNet::SampleNet() {
  std::size_t first = 0;
  for (std::size_t r = 0; r < ends.size(); ++r) {
    std::vector<Place>& round = rounds_[r];
    for (std::size_t i = first; i < ends[r]; ++i) {
      const ScrambledPoint p = scrambled_point(static_cast<std::uint32_t>(i));
      round.push_back({p.x, p.y, static_cast<std::uint32_t>(i * groups / ends[r])});
    }
    std::sort(round.begin(), round.end(),
              [](const Place& p, const Place& q) { return z_order(p.x, p.y) < z_order(q.x, q.y); });
    first = ends[r];
  }
}

std::span<const SampleNet::Place> SampleNet::square(std::size_t round, int level, std::uint32_t column,
                                                    std::uint32_t row, Shift shift) const {
  if (level == 0) return rounds_[round];
  const auto leading = [&](std::uint32_t v) { return v >> (32 - level); };
  const std::uint32_t x = column ^ leading(shift.x), y = row ^ leading(shift.y);
  const std::size_t number = z_order(x << (32 - level), y << (32 - level)) >> (32 - 2 * level);
  const std::size_t count = size(round) >> (2 * level);
  return std::span(rounds_[round]).subspan(number * count, count);
}

}  // namespace zoneplate::antialias
