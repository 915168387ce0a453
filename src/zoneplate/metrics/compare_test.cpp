// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "zoneplate/base/error.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/metrics/psnr.h"

namespace zoneplate::metrics {
namespace {

Picture flat(float code, int side = 16) { return make_picture(DisplayImage(side, side, {code, code, code, 1})); }

Comparands sequence(const std::vector<Picture>& reference, const std::vector<Picture>& test) {
  return {.count = reference.size(),
          .reference = [&reference](std::size_t i) { return reference[i]; },
          .test = [&test](std::size_t i) { return test[i]; },
          .are_frames = reference.size() > 1};
}

std::vector<Choice> choices(std::initializer_list<std::string_view> names) {
  std::vector<Choice> out;
  for (const std::string_view name : names) out.push_back(choose_metric(metrics(), name));
  return out;
}

const Result* find(const Comparison& comparison, std::string_view name) {
  for (const Result& result : comparison.results) {
    if (result.metric->name == name) return &result;
  }
  return nullptr;
}

TEST(Compare, OnePairByTheUsualMetrics) {
  const std::vector<Picture> a = {flat(0.5f)}, b = {flat(0.75f)};
  const Comparison c = compare(sequence(a, b), default_choices(metrics()), Unfit::Leave);
  EXPECT_FALSE(c.are_same);
  EXPECT_EQ(c.width, 16);
  ASSERT_TRUE(find(c, "mse"));
  EXPECT_EQ(find(c, "mse")->value, 0.0625);
  EXPECT_TRUE(find(c, "ssim"));
  EXPECT_FALSE(find(c, "ms_ssim"));   // the images are too small
  EXPECT_FALSE(find(c, "flicker"));   // there is only one frame
  EXPECT_FALSE(find(c, "flip_hdr"));  // not selected
}

TEST(Compare, SequencesArePooledAndKeepTheirWorst) {
  const std::vector<Picture> a = {flat(0.5f), flat(0.5f), flat(0.5f)}, b = {flat(0.5f), flat(0.75f), flat(0.625f)};
  const Comparison c = compare(sequence(a, b), choices({"psnr", "mae", "flicker"}), Unfit::Refuse);
  EXPECT_EQ(c.count, 3u);
  const Result& psnr = *find(c, "psnr");
  ASSERT_EQ(psnr.values.size(), 3u);
  EXPECT_EQ(psnr.values[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(psnr.worst, 1u);
  EXPECT_NEAR(psnr.value, psnr_of_mse((0.0625 + 0.015625) / 3), 1e-12);
  EXPECT_EQ(find(c, "mae")->value, 0.125);
  EXPECT_EQ(find(c, "mae")->score.map(3, 3), 0.25f);
  EXPECT_EQ(find(c, "flicker")->values.size(), 2u);
  EXPECT_NEAR(find(c, "flicker")->value, std::sqrt((0.0625 + 0.015625) / 2), 1e-12);
}

TEST(Compare, TheSamePicturesAreTheSame) {
  const std::vector<Picture> a = {flat(0.5f)};
  EXPECT_TRUE(compare(sequence(a, a), choices({"mse"}), Unfit::Refuse).are_same);
}

TEST(Compare, AlphaAloneMakesADifference) {
  const std::vector<Picture> a = {make_picture(DisplayImage(2, 2, {0, 0, 0, 1}))};
  const std::vector<Picture> b = {make_picture(DisplayImage(2, 2, {0, 0, 0, 0}))};
  const Comparison c = compare(sequence(a, b), choices({"mse"}), Unfit::Refuse);
  EXPECT_FALSE(c.are_same);
  EXPECT_EQ(c.results[0].value, 1);  // over white
}

TEST(Compare, TheWorseOfBlackAndWhiteCounts) {
  const std::vector<Picture> half = {make_picture(DisplayImage(16, 16, {0, 0, 0, 0.5f}))};
  const std::vector<Picture> clear = {make_picture(DisplayImage(16, 16, {0, 0, 0, 0}))};
  const std::vector<Picture> white = {make_picture(DisplayImage(16, 16, {1, 1, 1, 1}))};
  const Comparison dark = compare(sequence(clear, half), choices({"psnr", "mae", "ssim"}), Unfit::Refuse);
  EXPECT_NEAR(find(dark, "psnr")->value, psnr_of_mse(0.25), 1e-9);
  EXPECT_NEAR(find(dark, "mae")->score.more[0].value, 0.5, 1e-9);
  EXPECT_LT(find(dark, "ssim")->value, 0.9);
  // Over black these differ by 1, over white not at all.
  EXPECT_EQ(compare(sequence(white, clear), choices({"mae"}), Unfit::Refuse).results[0].value, 1);
  // Light without alpha adds to the background.
  const std::vector<Picture> flame = {make_picture(LinearImage(16, 16, {4, 2, 1, 0}))};
  const std::vector<Picture> none = {make_picture(LinearImage(16, 16, {0, 0, 0, 0}))};
  EXPECT_EQ(compare(sequence(none, flame), choices({"mse"}), Unfit::Refuse).results[0].value, 1);
}

TEST(Compare, AnOpaqueFrameBesideATransparentOneKeepsItsValue) {
  const Picture grey = flat(0.5f), lighter = flat(0.75f), clear = make_picture(DisplayImage(16, 16, {0, 0, 0, 0}));
  const std::vector<Picture> a = {grey, clear, grey}, b = {lighter, clear, lighter};
  const Comparison c = compare(sequence(a, b), choices({"mse", "flicker"}), Unfit::Refuse);
  EXPECT_EQ(find(c, "mse")->values, (std::vector<double>{0.0625, 0, 0.0625}));
  EXPECT_EQ(find(c, "flicker")->values.size(), 2u);
}

TEST(Compare, ValuesThatAreNotFiniteAreMeasuredAsNumbers) {
  LinearImage light(8, 8, {0.5f, 0.5f, 0.5f, 1});
  light(1, 2) = {std::nanf(""), std::numeric_limits<float>::infinity(), 0, 1};
  const std::vector<Picture> a = {make_picture(LinearImage(8, 8, {0.5f, 0.5f, 0.5f, 1}))}, b = {make_picture(light)};
  EXPECT_EQ(count_not_finite(a[0]), 0u);
  EXPECT_EQ(count_not_finite(b[0]), 1u);
  const Comparison c = compare(sequence(a, b), choices({"mse", "flip", "flip_hdr", "cvvdp"}), Unfit::Leave);
  for (const Result& result : c.results) EXPECT_TRUE(std::isfinite(result.value)) << result.metric->name;
  EXPECT_FALSE(c.are_same);
  EXPECT_TRUE(compare(sequence(b, b), choices({"mse"}), Unfit::Refuse).are_same);
}

std::string refusal(const Picture& a, const Picture& b, std::string_view name) {
  const std::vector<Picture> as = {a}, bs = {b};
  try {
    compare(sequence(as, bs), choices({name}), Unfit::Refuse);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Input);
    return error.what();
  }
  return {};
}

TEST(Compare, SaysWhyAMetricDoesNotFit) {
  EXPECT_EQ(refusal(flat(0, 8), flat(0, 8), "ssim"),
            "metric ssim: image 1 has 8 × 8 pixels, expected 11 × 11 at least");
  EXPECT_EQ(refusal(flat(0, 8), flat(0, 9), "mse"), "image 1 has 9 × 9 pixels, expected 8 × 8 as the reference");
  EXPECT_EQ(refusal(flat(0, 40), flat(0, 16), "above_nyquist"),
            "metric above_nyquist: image 1 has 16 × 16 pixels, expected 40 × 40 as the reference");
  EXPECT_EQ(refusal(flat(0), flat(0), "edge_response"),
            "metric edge_response: image 1 has nothing that it could measure");
  EXPECT_EQ(refusal(flat(0), flat(0), "flicker"),
            "metric flicker: image 1 is not one of 2 or more frames of a sequence");
}

TEST(Threshold, LooksTheRightWay) {
  const Metric& mse = *choose_metric(metrics(), "mse").metric;
  const Metric& psnr = *choose_metric(metrics(), "psnr").metric;
  EXPECT_TRUE(is_as_good(mse, 0.1, 0.1));
  EXPECT_FALSE(is_as_good(mse, 0.2, 0.1));
  EXPECT_TRUE(is_as_good(psnr, std::numeric_limits<double>::infinity(), 40));
  EXPECT_FALSE(is_as_good(psnr, 39, 40));
  EXPECT_FALSE(is_as_good(psnr, std::numeric_limits<double>::quiet_NaN(), 40));
}

TEST(Measure, GivesTheValueOfAMetricByName) {
  const Rgba8Image black(16, 16, {0, 0, 0, 255}), grey(16, 16, {51, 51, 51, 255});
  EXPECT_NEAR(measure(black, grey, "mse"), 0.04, 1e-6);
  EXPECT_NEAR(measure(black, grey, "psnr"), 10 * std::log10(1 / 0.04), 1e-4);
  EXPECT_EQ(measure(grey, grey, "flip:ppd=30"), 0);
}

TEST(Measure, RefusesWhatCannotBeMeasured) {
  const Rgba8Image image(16, 16), small(8, 16);
  const auto kind_of = [&](const Rgba8Image& test, const char* metric) {
    try {
      measure(image, test, metric);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::Failed;
  };
  EXPECT_EQ(kind_of(image, "flap"), ErrorKind::Usage);
  EXPECT_EQ(kind_of(small, "mse"), ErrorKind::Input);
  EXPECT_EQ(kind_of(image, "flicker"), ErrorKind::Input);  // needs several frames
}

}  // namespace
}  // namespace zoneplate::metrics
