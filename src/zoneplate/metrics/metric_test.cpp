// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/metric.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

std::string message_of(std::string_view text) {
  try {
    choose_metric(metrics(), text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    return error.what();
  }
  return {};
}

TEST(ChooseMetric, ReadsParameters) {
  EXPECT_EQ(choose_metric(metrics(), "flip:ppd=30").settings.number("ppd"), 30);
  EXPECT_EQ(choose_metric(metrics(), "flip:ppd=22.5").settings.number("ppd"), 22.5);
  EXPECT_NEAR(choose_metric(metrics(), "flip").settings.number("ppd"), 67.02, 0.01);
  EXPECT_EQ(choose_metric(metrics(), "mse").metric->name, "mse");
}

TEST(ChooseMetric, SaysWhatThereIs) {
  const std::pair<const char*, const char*> refused[] = {
      {"mse:n=3", "metric mse: unknown parameter 'n'; it has none"},
      {"flip:pd=3", "metric flip: unknown parameter 'pd'; did you mean 'ppd'?"},
      {"flip:ppd=0", "metric flip: ppd is '0', expected a number from 1 to 1000"},
      {"flip:ppd=x", "metric flip: ppd is 'x', expected a number from 1 to 1000"},
      {"flip:ppd", "metric flip: ppd requires a value: 1 to 1000"},
      {"flop", "unknown metric 'flop'; did you mean 'flip'?"},
  };
  for (const auto& [text, message] : refused) EXPECT_EQ(message_of(text), message);
  EXPECT_EQ(message_of("butteraugli").find("unknown metric 'butteraugli'; there are mse, mae,"), 0u);
}

TEST(Pooling, MeanAndRootMeanSquare) {
  const double values[] = {3, 4};
  EXPECT_EQ(mean_of(values), 3.5);
  EXPECT_EQ(root_mean_square_of(values), std::sqrt(12.5));
}

TEST(Catalogue, EveryRowIsComplete) {
  for (const Metric& metric : metrics()) {
    EXPECT_FALSE(metric.name.empty());
    EXPECT_FALSE(metric.summary.empty()) << metric.name;
    EXPECT_FALSE(metric.source.empty()) << metric.name;
    EXPECT_TRUE(metric.measure) << metric.name;
    EXPECT_GE(metric.frames, 1) << metric.name;
  }
}

}  // namespace
}  // namespace zoneplate::metrics
