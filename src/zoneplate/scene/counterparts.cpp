// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/counterparts.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace zoneplate {
namespace {

std::pair<int, int> identity_of(const Instance& instance) { return {instance.object, instance.part}; }

/// The indices of instances by identity, and of equal ones by index.
std::vector<std::uint32_t> sorted(const std::vector<Instance>& instances) {
  std::vector<std::uint32_t> out(instances.size());
  std::iota(out.begin(), out.end(), 0u);
  std::stable_sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) {
    return identity_of(instances[a]) < identity_of(instances[b]);
  });
  return out;
}

}  // namespace

std::vector<std::uint32_t> counterparts(const Scene& now, const Scene& other) {
  std::vector<std::uint32_t> out(now.instances.size(), no_instance);
  const auto have_one_identity = [](const Instance& a, const Instance& b) { return identity_of(a) == identity_of(b); };
  if (std::equal(now.instances.begin(), now.instances.end(), other.instances.begin(), other.instances.end(),
                 have_one_identity)) {
    std::iota(out.begin(), out.end(), 0u);
    return out;
  }
  const std::vector<std::uint32_t> there = sorted(other.instances);
  auto next = there.begin();
  for (const std::uint32_t i : sorted(now.instances)) {
    const auto identity = identity_of(now.instances[i]);
    while (next != there.end() && identity_of(other.instances[*next]) < identity) ++next;
    if (next != there.end() && identity_of(other.instances[*next]) == identity) out[i] = *next++;
  }
  return out;
}

}  // namespace zoneplate
