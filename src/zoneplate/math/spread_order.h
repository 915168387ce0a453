// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace zoneplate {

/// At most `most` of the indices 0 to n - 1, in an order whose beginnings are spread over all of them: the first, the
/// middle one, those at the quarters, and so on.
std::vector<std::size_t> spread_order(std::size_t n, std::size_t most);

}  // namespace zoneplate
