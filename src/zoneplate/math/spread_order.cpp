// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/spread_order.h"

#include <algorithm>
#include <bit>

namespace zoneplate {

// The positions k / cells, k with its bits reversed, are those of van der Corput's sequence. With at least as many
// cells as indices, every index has one; with fewer, no index has two.
std::vector<std::size_t> spread_order(std::size_t n, std::size_t most) {
  std::vector<std::size_t> out;
  if (n == 0 || most == 0) return out;
  const std::size_t cells = std::bit_ceil(std::min(n, most));
  const int bits = std::countr_zero(cells);
  std::vector<bool> is_taken(cells);
  for (std::size_t k = 0; k < cells && out.size() < most; ++k) {
    std::size_t reversed = 0;
    for (int b = 0; b < bits; ++b) reversed |= (k >> b & 1) << (bits - 1 - b);
    const std::size_t i = reversed * n / cells, place = n > cells ? reversed : i;
    if (!is_taken[place]) out.push_back(i);
    is_taken[place] = true;
  }
  return out;
}

}  // namespace zoneplate
