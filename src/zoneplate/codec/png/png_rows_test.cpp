// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/png/png_rows.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

std::vector<std::uint8_t> noise(std::size_t n, std::uint32_t seed) {
  std::vector<std::uint8_t> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<std::uint8_t>(hash(seed, static_cast<std::uint32_t>(i)));
  return out;
}

TEST(PngRows, EveryInstructionSetGivesTheSameBytes) {
  for (std::size_t n = 0; n <= 200; ++n) {
    const auto row = noise(4 * n, 1), above = noise(4 * n, 2);
    std::vector<std::uint8_t> expected(4 * n), expected_rgb(3 * n), out(4 * n), out_rgb(3 * n);
    PngRowKernels::scalar.up(row.data(), above.data(), 4 * n, expected.data());
    PngRowKernels::scalar.up_rgb(row.data(), above.data(), n, expected_rgb.data());
    for (const Isa isa : supported_isas()) {
      PngRowKernels::of(isa).up(row.data(), above.data(), 4 * n, out.data());
      PngRowKernels::of(isa).up_rgb(row.data(), above.data(), n, out_rgb.data());
      EXPECT_EQ(out, expected) << n;
      EXPECT_EQ(out_rgb, expected_rgb) << n;
    }
  }
}

TEST(PngRows, AdlerIsZlibs) {
  std::vector<std::vector<std::uint8_t>> inputs;
  for (std::size_t n = 0; n <= 200; ++n) inputs.push_back(noise(n, 3));
  inputs.push_back(noise(300000, 4));
  inputs.emplace_back(500000, std::uint8_t{255});  // the greatest possible sums
  for (const auto& bytes : inputs)
    for (const Isa isa : supported_isas())
      EXPECT_EQ(PngRowKernels::of(isa).adler(bytes.data(), bytes.size()),
                adler32(1, bytes.data(), static_cast<uInt>(bytes.size())))
          << bytes.size() << ' ' << name_of(isa);
}

}  // namespace
}  // namespace zoneplate
