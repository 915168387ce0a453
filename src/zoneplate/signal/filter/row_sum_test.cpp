// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/row_sum.h"

#include <gtest/gtest.h>

#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

TEST(RowSum, EveryInstructionSetGivesTheScalarBits) {
  std::vector<float> values(900);
  for (std::uint32_t i = 0; float& v : values) v = unit_float(hash(i++)) * 3 - 1;
  for (const Isa isa : supported_isas()) {
    const RowSumKernels& kernels = RowSumKernels::of(isa);
    for (std::size_t n = 0; n <= 200; ++n)
      for (std::size_t taps : {1u, 2u, 7u, 65u}) {
        std::vector<const float*> rows;
        std::vector<float> weights;
        std::vector<double> wide_weights;
        for (std::uint32_t t = 0; t < taps; ++t) {
          rows.push_back(values.data() + (t * 37) % 700);
          wide_weights.push_back(static_cast<double>(unit_float(hash(t, 1))) / 3.0 - 0.1);
          weights.push_back(static_cast<float>(wide_weights.back()));
        }
        std::vector<float> expected(n + 1, 7), found(n + 1, 7);
        RowSumKernels::scalar.narrow(rows.data(), n % 3, weights.data(), taps, expected.data(), n);
        kernels.narrow(rows.data(), n % 3, weights.data(), taps, found.data(), n);
        ASSERT_EQ(expected, found) << name_of(isa) << " narrow " << n << " " << taps;
        RowSumKernels::scalar.wide(rows.data(), n % 3, wide_weights.data(), taps, expected.data(), n);
        kernels.wide(rows.data(), n % 3, wide_weights.data(), taps, found.data(), n);
        ASSERT_EQ(expected, found) << name_of(isa) << " wide " << n << " " << taps;
        ASSERT_EQ(found[n], 7.0f);
      }
  }
}

TEST(RowSum, ScalarTwinIsTheDefinition) {
  const float a[] = {1, 2, 3}, b[] = {10, 20, 30};
  const float* rows[] = {a, b};
  const float weights[] = {2, -1};
  const double wide_weights[] = {2, -1};
  float out[3];
  RowSumKernels::scalar.narrow(rows, 0, weights, 2, out, 3);
  EXPECT_EQ(out[2], -24.0f);
  RowSumKernels::scalar.wide(rows, 0, wide_weights, 2, out, 3);
  EXPECT_EQ(out[1], -16.0f);
}

}  // namespace
}  // namespace zoneplate
