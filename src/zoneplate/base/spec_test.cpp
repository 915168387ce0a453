// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/spec.h"

#include <gtest/gtest.h>

#include <functional>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

constexpr int counts[] = {2, 4, 8};
constexpr std::string_view patterns[] = {"grid", "halton", "sobol"};
constexpr Param blur_params[] = {
    real_param("sigma", "width", 1, 0.1, 100),
    {.name = "radius", .meaning = "reach", .value = 4, .low = 1, .high = 8},
    {.name = "n", .meaning = "samples", .value = 4, .choices = counts},
    {.name = "pattern", .meaning = "their places", .value = 1, .names = patterns},
    {.name = "turn", .meaning = "of a circle", .value = 0.25, .low = -2, .high = 2, .decimals = 3},
};

struct Filter {
  std::string_view name;
  std::span<const Param> params = {};
};
constexpr Filter filters[] = {{"blur", blur_params}, {"copy"}};

Spec<Filter> parsed(std::string_view text) { return parse_spec("filter", std::span<const Filter>(filters), text); }

std::string refusal(std::string_view text) {
  try {
    parsed(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    return error.what();
  }
  return "";
}

TEST(Spec, ReadsValuesOfEveryKindAndKeepsTheDefaultsOfOthers) {
  const auto [row, settings] = parsed("blur:radius=6,sigma=2.5e0,pattern=sobol,turn=-.5");
  EXPECT_EQ(row.name, "blur");
  EXPECT_EQ(settings.number("sigma"), 2.5);
  EXPECT_EQ(settings.integer("radius"), 6);
  EXPECT_EQ(settings.integer("n"), 4);
  EXPECT_EQ(settings.chosen("pattern"), "sobol");
  EXPECT_EQ(settings.integer("pattern"), 2);
  EXPECT_EQ(settings.number("turn"), -0.5);
  EXPECT_TRUE(settings.is_given("turn"));
  EXPECT_FALSE(settings.is_given("n"));
  EXPECT_EQ(settings.numbers(), (std::vector<double>{2.5, 6, 4, 2, -0.5}));
}

TEST(Spec, DecimalsAreExactUnitsOfTheLast) {
  const std::span<const Param> decimals = std::span(blur_params).subspan(4);
  const auto units = [&](std::string_view text) { return Settings("wheel", decimals, text).units()[0]; };
  EXPECT_EQ(units("w"), 250);
  EXPECT_EQ(units("w:turn=0.007"), 7);
  EXPECT_EQ(units("w:turn=1."), 1000);
  EXPECT_EQ(units("w:turn=-2"), -2000);
}

TEST(Spec, TextIsTheSameForEveryOrderAndSpelling) {
  EXPECT_EQ(parsed("blur:sigma=2.50,radius=6,pattern=grid").text(), "blur:pattern=grid,radius=6,sigma=2.5");
  EXPECT_EQ(parsed("blur").text(), "blur");
}

TEST(Spec, MessagesNameWhatWasFoundWhatIsWantedAndTheClosest) {
  EXPECT_EQ(refusal("blurr:n=2"), "unknown filter 'blurr'; did you mean 'blur'?");
  EXPECT_EQ(refusal("sharpen"), "unknown filter 'sharpen'; there are blur, copy");
  EXPECT_EQ(refusal(""), "unknown filter ''; there are blur, copy");
  EXPECT_EQ(refusal("blur:radus=2"), "filter blur: unknown parameter 'radus'; did you mean 'radius'?");
  EXPECT_EQ(refusal("blur:lobes=3"), "filter blur: unknown parameter 'lobes'; it has sigma, radius, n, pattern, turn");
  EXPECT_EQ(refusal("copy:n=1"), "filter copy: unknown parameter 'n'; it has none");
  EXPECT_EQ(refusal("copy:"), "filter copy: unknown parameter ''; it has none");
  EXPECT_EQ(refusal("blur:n=2,"), "filter blur: unknown parameter ''; it has sigma, radius, n, pattern, turn");
  EXPECT_EQ(refusal("blur:n=2,n=4"), "filter blur: n is given twice");
  EXPECT_EQ(refusal("blur:n=3"), "filter blur: n is '3', expected 2, 4 or 8");
  EXPECT_EQ(refusal("blur:pattern=sobl"),
            "filter blur: pattern is 'sobl', expected grid, halton or sobol; did you mean 'sobol'?");
  EXPECT_EQ(refusal("blur:radius=1.5"), "filter blur: radius is '1.5', expected a whole number from 1 to 8");
  EXPECT_EQ(refusal("blur:radius=9"), "filter blur: radius is '9', expected a whole number from 1 to 8");
  EXPECT_EQ(refusal("blur:radius"), "filter blur: radius requires a value: 1 to 8");
  for (const char* value : {"0", "2x", "nan", "inf", "1e400", "", "0x1p3", " 2"})
    EXPECT_EQ(refusal(std::string("blur:sigma=") + value),
              "filter blur: sigma is '" + std::string(value) + "', expected a number from 0.1 to 100");
  for (const char* value : {"", ".", "-", "1e0", "0.1234", "3", "+1", "99999999999999999999"})
    EXPECT_EQ(refusal(std::string("blur:turn=") + value),
              "filter blur: turn is '" + std::string(value) + "', expected a number of 3 decimals from -2 to 2");
}

}  // namespace
}  // namespace zoneplate
