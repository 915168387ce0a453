// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

double tpsnr_of(float r0, float r1, float t0, float t1) {
  const auto grey = [](float code) { return make_picture(DisplayImage(4, 2, {code, code, code, 1})); };
  const Choice choice = choose_metric(metrics(), "tpsnr");
  const Picture reference[] = {grey(r0), grey(r1)}, test[] = {grey(t0), grey(t1)};
  return choice.metric->measure(reference, test, choice.settings)->value;
}

TEST(Tpsnr, IsThatOfTheChange) {
  // The changes differ by an eighth.
  EXPECT_NEAR(tpsnr_of(0.25f, 0.5f, 0.5f, 0.875f), 20 * std::log10(8), 1e-9);
  // An error that does not change is not seen.
  EXPECT_EQ(tpsnr_of(0.25f, 0.5f, 0.5f, 0.75f), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace zoneplate::metrics
