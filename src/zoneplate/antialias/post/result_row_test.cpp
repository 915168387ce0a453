// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/result_row.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/base/isa.h"

namespace zoneplate::antialias {
namespace {

TEST(ResultRow, KernelsCopyEveryByteAndNoOther) {
  std::vector<std::uint8_t> from(300);
  for (std::uint32_t i = 0; i < from.size(); ++i) from[i] = static_cast<std::uint8_t>(hash(i) | 1);
  for (const Isa isa : supported_isas()) {
    const RowKernels& kernels = RowKernels::of(isa);
    for (const auto copy : {kernels.copy, kernels.stream})
      for (std::size_t n = 0; n <= 200; ++n) {
        const std::size_t at = n % 37;
        std::vector<std::uint8_t> to(300), expected(300);
        std::copy_n(from.begin() + 3, n, expected.begin() + static_cast<std::ptrdiff_t>(at));
        copy(&from[3], &to[at], n);
        ASSERT_EQ(to, expected) << name_of(isa) << " " << n;
      }
  }
}

TEST(ResultRow, ResultsOfAnySizeGetWhatTheRowHolds) {
  // The second size is written past the caches.
  for (const auto& size : {std::pair{31, 7}, {2053, 1025}}) {
    const int width = size.first, height = size.second;
    const Rgba8Image image = make_codes(width, height, [](int x, int y) {
      return Rgba8{static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 7};
    });
    Rgba8Image expected = image;
    for (int y = 0; y < height; ++y) expected(y % width, y) = {1, 2, 3, 4};
    for (const Isa isa : supported_isas()) {
      Rgba8Image out(width, height);
      with_isa(isa, [&] {
        ResultRow row(image, out);
        for (int y = 0; y < height; ++y) row.begin(y)[static_cast<std::size_t>(y % width)] = {1, 2, 3, 4}, row.end();
      });
      ASSERT_EQ(out, expected) << name_of(isa);
    }
  }
}

}  // namespace
}  // namespace zoneplate::antialias
