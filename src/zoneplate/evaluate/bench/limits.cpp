// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/bench/limits.h"

namespace zoneplate::scalar {
namespace {

std::uint32_t sum(const std::uint32_t* words, std::size_t n) {
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < n; ++i) all += words[i];
  return all;
}

std::uint32_t gather(const std::uint32_t* table, const std::int32_t* index, std::size_t n) {
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < n; ++i) all += table[index[i]];
  return all;
}

std::uint32_t multiply(const std::int16_t* values, std::size_t turns) {
  std::uint32_t all = 0;
  for (std::size_t turn = 0; turn < turns; ++turn)
    for (std::size_t i = 0; i < LimitKernels::factors; ++i) all += static_cast<std::uint32_t>(3 * values[i]);
  return all;
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const LimitKernels PerIsa<LimitKernels>::scalar = {
    .sum = scalar::sum, .gather = scalar::gather, .multiply = scalar::multiply};

}  // namespace zoneplate
