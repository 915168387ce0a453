// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/method.h"

#include <gtest/gtest.h>

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
