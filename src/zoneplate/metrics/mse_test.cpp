// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/mse.h"

#include <gtest/gtest.h>

#include <limits>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/metrics/charts_for_test.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/metrics/psnr.h"

namespace zoneplate::metrics {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two images of 2 × 1 pixels; their second pixels differ by ½ in red and by ¼ in blue.
struct TwoPixels {
  DisplayImage reference{2, 1}, test{2, 1};
  TwoPixels() {
    reference(0, 0) = test(0, 0) = {0.25f, 0.5f, 1, 1};
    reference(1, 0) = {0.25f, 0.5f, 1, 1};
    test(1, 0) = {0.75f, 0.5f, 0.75f, 1};
  }
};

Score measure(std::string_view name, const DisplayImage& reference, const DisplayImage& test) {
  const Picture a = make_picture(reference), b = make_picture(test);
  const Choice choice = choose_metric(metrics(), name);
  return *choice.metric->measure({&a, 1}, {&b, 1}, choice.settings);
}

TEST(PixelMetrics, ByHand) {
  const TwoPixels p;
  constexpr double mse = (0.25 + 0.0625) / 6;
  EXPECT_EQ(mean_squared_error(p.reference, p.test), mse);
  EXPECT_NEAR(peak_signal_to_noise(make_picture(p.reference), make_picture(p.test)), 12.83301228703605, 1e-12);
  const Score mae = measure("mae", p.reference, p.test);
  EXPECT_EQ(mae.value, 0.125);
  EXPECT_EQ(mae.more[0].value, 0.5);
  EXPECT_EQ(mae.map(0, 0), 0);
  EXPECT_EQ(mae.map(1, 0), 0.5f);
  const double luma_difference = 0.2126 * 0.5 - 0.0722 * 0.25;
  EXPECT_NEAR(luma_peak_signal_to_noise(make_picture(p.reference), make_picture(p.test)),
              psnr_of_mse(luma_difference * luma_difference / 2), 1e-12);
  const double older = 0.299 * 0.5 - 0.114 * 0.25;
  EXPECT_NEAR(luma_peak_signal_to_noise(make_picture(p.reference), make_picture(p.test), rec601_luma),
              psnr_of_mse(older * older / 2), 1e-12);
  EXPECT_NEAR(measure("psnr_luma:rec=601", p.reference, p.test).value, psnr_of_mse(older * older / 2), 1e-12);
}

TEST(PixelMetrics, TransparentPicturesLieOnBlack) {
  DisplayImage half(1, 1, {1, 1, 1, 0.5f}), grey_pixel(1, 1, {0.5f, 0.5f, 0.5f, 1});
  EXPECT_EQ(mean_squared_error(half, grey_pixel), 0);
}

TEST(PixelMetrics, PublishedPeakSignalToNoise) {
  const auto psnr = [](int which) {
    const ChartPair pair = chart_pair(which);
    return peak_signal_to_noise(make_picture(as_codes(pair.reference)), make_picture(as_codes(pair.test)));
  };
  EXPECT_NEAR(psnr(0), 31.97445, 1e-5);
  EXPECT_NEAR(psnr(1), 9.02749, 1e-5);
  EXPECT_NEAR(psnr(3), 16.98970, 1e-5);
}

TEST(PixelMetrics, SequencesPoolTheirErrorsNotTheirDecibels) {
  const double frames[] = {infinity, psnr_of_mse(0.02)};
  EXPECT_NEAR(pool_psnr(frames), psnr_of_mse(0.01), 1e-12);
  const double exact[] = {infinity, infinity};
  EXPECT_EQ(pool_psnr(exact), infinity);
}

// Properties of every metric of single images: equal images and different ones.
DisplayImage noise(std::uint32_t seed, int width, int height) {
  DisplayImage image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto code = [&](std::uint32_t channel) {
        return unit_float(hash(seed, channel, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
      };
      image(x, y) = {code(0), code(1), code(2), 1};
    }
  }
  return image;
}

TEST(EveryMetric, APictureIsPerfectlyLikeItself) {
  // A sudden change, after which nothing changes.
  std::vector<Picture> film(8, make_picture(noise(1, 180, 177)));
  film[0] = make_picture(noise(2, 180, 177));
  for (Picture& picture : film) picture.is_uncovered = Plane<std::uint8_t>(180, 177, std::uint8_t{1});
  for (const Metric& metric : metrics()) {
    const auto frames = std::span(film).first(std::min(film.size(), static_cast<std::size_t>(metric.frames)));
    const auto score = metric.measure(frames, frames, Settings(metric.params));
    if (!metric.perfect) continue;
    ASSERT_TRUE(score) << metric.name;
    EXPECT_EQ(score->value, *metric.perfect) << metric.name;
    for (const float error : score->map.values()) ASSERT_EQ(error, 0) << metric.name;
  }
}

TEST(EveryMetric, IsSymmetricUnlessItSaysNot) {
  const Picture a = make_picture(noise(1, 176, 176)), b = make_picture(noise(2, 176, 176));
  for (const char* name : {"mse", "mae", "psnr", "psnr_luma", "ssim", "ms_ssim", "flip", "yiq_rms"}) {
    const Choice choice = choose_metric(metrics(), name);
    EXPECT_EQ(choice.metric->measure({&a, 1}, {&b, 1}, choice.settings)->value,
              choice.metric->measure({&b, 1}, {&a, 1}, choice.settings)->value)
        << name;
  }
}

TEST(EveryMetric, HasTheSameBitsOnAnyNumberOfThreads) {
  const std::vector<Picture> a = {make_picture(noise(1, 180, 177)), make_picture(noise(3, 180, 177))};
  const std::vector<Picture> b = {make_picture(noise(2, 180, 177)), make_picture(noise(4, 180, 177))};
  for (const Metric& metric : metrics()) {
    const auto measure_with = [&](int threads) {
      std::optional<Score> score;
      with_threads(threads, [&] {
        const auto frames = std::min<std::size_t>(2, static_cast<std::size_t>(metric.frames));
        score = metric.measure(std::span(a).first(frames), std::span(b).first(frames), Settings(metric.params));
      });
      return score;
    };
    const auto one = measure_with(1), seven = measure_with(7);
    ASSERT_EQ(one.has_value(), seven.has_value()) << metric.name;
    if (!one) continue;
    EXPECT_EQ(one->value, seven->value) << metric.name;
    EXPECT_EQ(one->map, seven->map) << metric.name;
  }
}

}  // namespace
}  // namespace zoneplate::metrics
