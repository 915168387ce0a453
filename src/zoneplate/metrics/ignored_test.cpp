// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/ignored.h"

#include <gtest/gtest.h>

#include <cmath>

#include "zoneplate/base/error.h"
#include "zoneplate/metrics/charts_for_test.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

constexpr int side = 192;  // MS-SSIM needs 176

/// Frame `frame` of a moving pattern, with a sudden change after the first frame in one corner, for events.
LinearImage pattern(int frame) {
  return make_chart(side, side, [frame](int x, int y) {
    if (x < 32 && y < 32) return grey(frame == 0 ? 0.9 : 0.1);
    return grey(0.5 + 0.4 * std::sin(0.3 * (x + 0.5 * y) + (x > 100 ? 0.2 * frame : 0)));
  });
}

/// The picture with other values at the pixels for which `is_changed(x, y)`.
template <class IsChanged>
Picture changed(const LinearImage& image, const IsChanged& is_changed) {
  return make_picture(make_chart(side, side, [&](int x, int y) {
    const Linear c = image(x, y);
    return is_changed(x, y) ? Linear{1 - c.r, 0.5f * c.g, c.b, 1} : c;
  }));
}

Comparison compared(const IgnoredRegions& regions, const auto& is_changed, int frames,
                    std::span<const Choice> choices) {
  const Comparands pictures{.count = static_cast<std::size_t>(frames),
                            .reference =
                                [&](std::size_t i) {
                                  Picture picture = make_picture(pattern(static_cast<int>(i)));
                                  mark_ignored(picture, regions);
                                  picture.is_uncovered = Plane<std::uint8_t>(side, side, std::uint8_t{1});
                                  return picture;
                                },
                            .test = [&](std::size_t i) { return changed(pattern(static_cast<int>(i)), is_changed); },
                            .are_frames = frames > 1};
  return compare(pictures, choices, Unfit::Leave);
}

std::vector<Choice> all_choices() {
  std::vector<Choice> out;
  for (const Metric& metric : metrics()) out.push_back({&metric, Settings(metric.params)});
  return out;
}

// The property of every metric: what is ignored has no influence, and what is not ignored has.
TEST(IgnoredRegions, HaveNoInfluenceOnAnyMetric) {
  const IgnoredRegions regions{.rectangles = {{80, 40, 50, 60}, {0, 180, 400, 400}}};
  const auto is_inside = [](int x, int y) { return (x >= 80 && x < 130 && y >= 40 && y < 100) || y >= 180; };
  for (const int frames : {1, 9}) {
    const Comparison same = compared(regions, is_inside, frames, all_choices());
    EXPECT_TRUE(same.are_same);
    std::size_t measured = 0;
    for (const Result& result : same.results) {
      EXPECT_FALSE(result.metric->needs_whole_image) << result.metric->name;
      if (result.metric->perfect) {
        EXPECT_EQ(result.value, *result.metric->perfect) << result.metric->name;
      }
      for (const float v : result.score.map.values()) ASSERT_EQ(v, 0) << result.metric->name;
      ++measured;
    }
    for (const Metric& metric : metrics()) {
      const int least = metric.starts_short ? std::min(2, metric.frames) : metric.frames;
      measured += metric.needs_whole_image || least > frames;
    }
    EXPECT_EQ(measured, metrics().size());
    const auto is_beside = [&](int x, int y) { return is_inside(x - 3, y); };
    for (const Result& result : compared(regions, is_beside, frames, all_choices()).results)
      if (result.metric->perfect && result.metric->name != "ghost" && result.metric->name != "lag") {
        EXPECT_NE(result.value, *result.metric->perfect) << result.metric->name;
      }
  }
}

// Metrics of single pixels have the value of the image that was cropped to the rest.
TEST(IgnoredRegions, LeaveTheValueOfTheRest) {
  const ChartPair charts = chart_pair(2);
  const auto left_half = [](const LinearImage& image) {
    return make_picture(make_chart(128, 128, [&](int x, int y) { return image(x, y); }));
  };
  for (const char* name : {"mse", "mae", "pixels", "psnr", "psnr_luma", "yiq_rms"}) {
    const std::vector<Choice> choice = {choose_metric(metrics(), name)};
    const auto value = [&](const auto& reference, const auto& test) {
      const Comparands pictures{.count = 1, .reference = reference, .test = test};
      return compare(pictures, choice, Unfit::Refuse).results.at(0);
    };
    const Result cropped = value([&](std::size_t) { return left_half(charts.reference); },
                                 [&](std::size_t) { return left_half(charts.test); });
    const Result rest = value(
        [&](std::size_t) {
          Picture picture = make_picture(LinearImage(charts.reference));
          mark_ignored(picture, {.rectangles = {{128, 0, 128, 128}}});
          return picture;
        },
        [&](std::size_t) { return make_picture(LinearImage(charts.test)); });
    EXPECT_EQ(rest.value, cropped.value) << name;
    ASSERT_EQ(rest.score.more.size(), cropped.score.more.size());
    for (std::size_t i = 0; i < rest.score.more.size(); ++i)
      if (rest.score.more[i].name != "seen") {  // a share of all pixels
        EXPECT_EQ(rest.score.more[i].value, cropped.score.more[i].value) << name << ' ' << rest.score.more[i].name;
      }
  }
}

// Windows count where their centre is measured: the mean is that of the map, over the rest.
TEST(IgnoredRegions, LeaveOutWindowsAboutIgnoredPixels) {
  const IgnoredRegions regions{.rectangles = {{60, 0, 100, side}}};
  const std::vector<Choice> choices = {choose_metric(metrics(), "flip"), choose_metric(metrics(), "ssim")};
  const auto is_changed = [](int x, int y) { return (x + y) % 7 == 0; };
  const Comparison whole = compared({}, is_changed, 1, choices), rest = compared(regions, is_changed, 1, choices);
  for (std::size_t m = 0; m < choices.size(); ++m) {
    const Plane<float>&map = rest.results[m].score.map, &whole_map = whole.results[m].score.map;
    double sum = 0, count = 0;
    const int border = m == 0 ? 0 : 5;  // SSIM counts windows inside of the image
    for (int y = border; y < side - border; ++y)
      for (int x = border; x < side - border; ++x) {
        if (x >= 60 && x < 160) continue;
        sum += static_cast<double>(map(x, y)), count += 1;
        if (x < 40 || x >= 180) {  // out of the windows' reach
          ASSERT_EQ(map(x, y), whole_map(x, y)) << m;
        }
      }
    EXPECT_NEAR(m == 0 ? rest.results[m].value : (1 - rest.results[m].value) / 2, sum / count, 1e-6);
  }
}

TEST(IgnoredRegions, AreMasksOfTheSameSize) {
  Picture picture = make_picture(LinearImage(16, 16));
  const Picture mask = make_picture(make_chart(16, 16, [](int x, int) { return grey(x < 4 ? 1 : 0); }));
  mark_ignored(picture, {.masks = {{"mask.png", mask}}});
  EXPECT_EQ(measured_pixels(picture), 12 * 16);
  EXPECT_FALSE(is_measured(picture, 3, 7));
  EXPECT_TRUE(is_measured(picture, 4, 7));
  const auto fails_with = [&](const IgnoredRegions& regions, const std::string& text) {
    try {
      mark_ignored(picture, regions);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_EQ(error.what(), text);
    }
  };
  fails_with({.masks = {{"mask.png", make_picture(LinearImage(8, 16))}}},
             "mask.png: the mask has 8 × 16 pixels, the reference 16 × 16");
  fails_with({.rectangles = {{0, 0, 16, 20}}}, "all pixels are ignored: none remains to measure");
}

}  // namespace
}  // namespace zoneplate::metrics
