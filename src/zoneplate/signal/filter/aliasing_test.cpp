// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/filter/aliasing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/signal/filter/resample.h"

namespace zoneplate {
namespace {

TEST(Aliasing, TheZonePlateIsItsFormula) {
  for (const int size : {64, 65}) {
    const Plane<float> plate = zone_plate(size);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const double dx = x + 0.5 - size / 2.0, dy = y + 0.5 - size / 2.0;
        EXPECT_NEAR(plate(x, y), 0.5 + 0.5 * std::cos(M_PI * (dx * dx + dy * dy) / size), 1e-6);
      }
  }
}

struct Case {
  int in, out;
};
class ReducedZonePlate : public testing::TestWithParam<Case> {};

// Minification by 2 and by 3.7, compared with the ideal band-limited result.
TEST_P(ReducedZonePlate, LanczosKeepsAliasesBelowTheirLimits) {
  const auto [in, out] = GetParam();
  const AliasFigures figures = measure_aliases(zone_plate(in), out, out, make_kernel("lanczos3"));
  EXPECT_LE(figures.all_db, -15);
  EXPECT_LE(figures.far_db, -40);
  EXPECT_LE(figures.pass_half_db, -30);
}

TEST_P(ReducedZonePlate, EveryKernelDoesWhatItsResponseSays) {
  const auto [in, out] = GetParam();
  const Plane<float> plate = zone_plate(in);
  for (const KernelEntry& entry : kernels()) {
    const Kernel kernel = make_kernel(entry.name);
    const AliasFigures found = measure_aliases(plate, out, out, kernel);
    const AliasFigures expected = predict_aliases(kernel, static_cast<double>(in) / out);
    EXPECT_NEAR(found.all_db, expected.all_db, 1) << entry.name;
    EXPECT_NEAR(found.far_db, expected.far_db, 1.5) << entry.name;
    EXPECT_NEAR(found.pass_db, expected.pass_db, 0.5) << entry.name;
    EXPECT_NEAR(found.pass_half_db, expected.pass_half_db, 1) << entry.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Factors, ReducedZonePlate, testing::Values(Case{256, 128}, Case{370, 100}),
                         [](const auto& test) { return "to" + std::to_string(test.param.out); });

}  // namespace
}  // namespace zoneplate
