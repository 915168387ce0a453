// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/png/png_rows.h"

namespace zoneplate::scalar {
namespace {

std::uint8_t difference(std::uint8_t p, std::uint8_t q) { return static_cast<std::uint8_t>(p - q); }

void up(const std::uint8_t* row, const std::uint8_t* above, std::size_t n, std::uint8_t* out) {
  for (std::size_t i = 0; i < n; ++i) out[i] = difference(row[i], above[i]);
}

void up_rgb(const std::uint8_t* row, const std::uint8_t* above, std::size_t n, std::uint8_t* out) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < 3; ++c) out[3 * i + c] = difference(row[4 * i + c], above[4 * i + c]);
}

std::uint32_t adler(const std::uint8_t* p, std::size_t n) {
  std::uint32_t sum = 1, sums = 0;
  for (std::size_t i = 0; i < n; ++i) {
    sum = (sum + p[i]) % 65521;
    sums = (sums + sum) % 65521;
  }
  return sums << 16 | sum;
}

}  // namespace

}  // namespace zoneplate::scalar

namespace zoneplate {

template <>
const PngRowKernels PerIsa<PngRowKernels>::scalar = {
    .up = scalar::up, .up_rgb = scalar::up_rgb, .adler = scalar::adler};

}  // namespace zoneplate
