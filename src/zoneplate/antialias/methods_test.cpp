// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/method.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

std::string refusal(std::string_view text) {
  try {
    make_resolver(antialias::methods(), text);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Usage);
    return e.what();
  }
  return "accepted";
}

TEST(Method, TextsMakeRequests) {
  const auto request = [](std::string_view text) { return make_resolver(antialias::methods(), text)->request({}); };
  EXPECT_EQ(request("none").samples.size(), 1u);
  EXPECT_EQ(request("msaa").samples, standard_pattern(4));
  EXPECT_EQ(request("msaa:n=16").samples, standard_pattern(16));
  EXPECT_EQ(request("msaa:grid=4").samples, grid_pattern(4));
  EXPECT_EQ(request("msaa:grid=4").rate, Rate::Surface);
  EXPECT_EQ(request("ssaa:n=3").samples, grid_pattern(3));
  EXPECT_EQ(request("ssaa:n=3").rate, Rate::Sample);
  EXPECT_EQ(request("ssaa:pattern=halton,samples=64").samples, named_pattern("halton", 64));
}

// The mean of the samples of a period is where the image lies; engines' presets keep the jitter that they publish.
TEST(Method, OwnJittersDoNotMoveTheImage) {
  const auto distance = [](const std::string& text, int period) {
    const auto method = make_resolver(antialias::methods(), text);
    double x = 0, y = 0;
    for (int i = 0; i < period; ++i) {
      const SamplePosition s = method->request({.index = i}).samples[0];
      x += s.x - 128, y += s.y - 128;
    }
    return std::max(std::abs(x), std::abs(y)) / (256 * period);
  };
  for (const char* text : {"taa", "taa:jitter=r2", "taa:preset=salvi", "oracle-taa", "history-guided"})
    for (const int period : {1, 2, 3, 5, 8, 16, 32, 100, 1024}) {
      const std::string length = (std::string(text).find(':') == std::string::npos ? ":length=" : ",length=");
      EXPECT_LE(distance(text + length + std::to_string(period), period), 1.0 / 512) << text << ' ' << period;
    }
  EXPECT_LE(distance("taa:preset=karis,jitter=halton", 8), 1.0 / 512);
  const auto method = make_resolver(antialias::methods(), "taa:preset=karis");
  for (int i = 0; i < 16; ++i)
    EXPECT_EQ(method->request({.index = i}).samples[0], halton_sequence(8)[static_cast<std::size_t>(i % 8)]);
}

TEST(Method, ReferencesDrawForThemselves) {
  const auto request = [](std::string_view text) { return make_resolver(antialias::methods(), text)->request({}); };
  for (const char* text : {"analytic", "analytic:filter=mitchell,shading=4,order=display", "converged",
                           "converged:samples=64,filter=gaussian,order=display"}) {
    EXPECT_TRUE(request(text).draw) << text;
    EXPECT_FALSE(request(text).resolves_per_pixel) << text;
    EXPECT_TRUE(request(text).estimates_error) << text;
  }
  EXPECT_FALSE(request("ssaa").draw);
}

TEST(Method, MixCodesIsDisplayReferred) {
  for (const char* text : {"msaa:mix=codes", "ssaa:n=4,mix=codes", "msaa:mix=codes,resolve=display,filter=tent"})
    EXPECT_TRUE(make_resolver(antialias::methods(), text)->request({}).is_display_referred) << text;
  EXPECT_FALSE(make_resolver(antialias::methods(), "msaa:mix=light")->request({}).is_display_referred);
  EXPECT_EQ(refusal("msaa:resolve=karis,mix=codes"),
            "msaa: resolve=karis weighs scene-linear values, mix=codes averages sRGB-encoded ones: give one of them");
}

TEST(Method, WrongTextsAreNamed) {
  EXPECT_NE(refusal("mssa").find("did you mean 'msaa'"), std::string::npos);
  EXPECT_NE(refusal("raytracing").find("none, ssaa, msaa"), std::string::npos);
  EXPECT_NE(refusal("msaa:n=3").find("2, 4, 8 or 16"), std::string::npos);
  EXPECT_NE(refusal("msaa:m=4").find("n, grid"), std::string::npos);
  EXPECT_NE(refusal("msaa:n=4,grid=4").find("exclude"), std::string::npos);
  EXPECT_NE(refusal("ssaa:n=17").find("1 to 16"), std::string::npos);
  EXPECT_NE(refusal("ssaa:n=x").find("whole number"), std::string::npos);
  EXPECT_EQ(refusal("ssaa:n"), "method ssaa: n requires a value: 1 to 16");
  EXPECT_NE(refusal("analytic:filter=gaussian").find("box, tent, quadratic"), std::string::npos);
  EXPECT_NE(refusal("converged:samples=1000").find("512, 1024"), std::string::npos);
  EXPECT_NE(refusal("none:n=1").find("it has none"), std::string::npos);
}

}  // namespace
}  // namespace zoneplate
