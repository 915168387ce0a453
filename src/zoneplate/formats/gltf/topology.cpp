// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/topology.h"

#include <cassert>

namespace zoneplate {

Topology gltf_topology(int mode) {
  assert(mode >= 0 && mode <= 6);
  return mode == 0 ? Topology::Points : mode <= 3 ? Topology::Lines : Topology::Triangles;
}

std::vector<std::uint32_t> list_primitives(std::vector<std::uint32_t> order, int mode) {
  const std::size_t n = order.size();
  if (mode == 0 || mode == 1 || mode == 4) {
    order.resize(n - n % (mode == 0 ? 1 : mode == 1 ? 2 : 3));
    return order;
  }
  std::vector<std::uint32_t> out;
  const auto add = [&](std::size_t i) { out.push_back(order[i]); };
  if (mode == 2 || mode == 3)
    for (std::size_t i = 0; i + 1 < n; ++i) add(i), add(i + 1);
  if (mode == 2 && n > 1) add(n - 1), add(0);
  if (mode == 5)
    for (std::size_t i = 0; i + 2 < n; ++i) add(i), add(i + 1 + i % 2), add(i + 2 - i % 2);
  if (mode == 6)
    for (std::size_t i = 0; i + 2 < n; ++i) add(i + 1), add(i + 2), add(0);
  return out;
}

}  // namespace zoneplate
