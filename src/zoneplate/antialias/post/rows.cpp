// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/rows.h"

#include <cstring>

namespace zoneplate {
namespace scalar {
namespace {

void copy(const std::uint8_t* from, std::uint8_t* to, std::size_t n) { std::memcpy(to, from, n); }

void luma(const std::uint8_t* rgba, float* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    const float r = rgba[4 * i], g = rgba[4 * i + 1], b = rgba[4 * i + 2];
    out[i] = 2126 * r + 7152 * g + 722 * b;
  }
}

}  // namespace

}  // namespace scalar

template <>
const RowKernels PerIsa<RowKernels>::scalar = {.copy = scalar::copy, .stream = scalar::copy, .luma = scalar::luma};

}  // namespace zoneplate
