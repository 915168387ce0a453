// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/json.h"

#include <gtest/gtest.h>

#include <limits>

#include "zoneplate/report/json_for_test.h"

namespace zoneplate {

nlohmann::json parsed_json(std::string_view text) { return nlohmann::json::parse(text); }

namespace {

TEST(Json, WritesEveryKind) {
  EXPECT_EQ(Json().text(), "null");
  EXPECT_EQ(Json(true).text(), "true");
  EXPECT_EQ(Json(-3).text(), "-3");
  EXPECT_EQ(Json(~std::uint64_t{0}).text(), "18446744073709551615");
  EXPECT_EQ(Json(0.25).text(), "0.25");
  EXPECT_EQ(Json("a\"b\n").text(), R"("a\"b\n")");
  EXPECT_EQ(Json(Json::Array{1, "x", Json()}).text(), R"([1,"x",null])");
  EXPECT_EQ(Json(Json::Array{}).text(), "[]");
  EXPECT_EQ(Json(Json::Object{}).text(), "{}");
}

TEST(Json, KeepsTheOrderOfMembers) {
  EXPECT_EQ(Json(Json::Object{{"z", 1}, {"a", Json::Object{{"y", 2}, {"b", 3}}}}).text(),
            R"({"z":1,"a":{"y":2,"b":3}})");
}

TEST(Json, WritesFloatsWithTheirOwnDigits) {
  EXPECT_EQ(Json(0.1f).text(), "0.1");
  EXPECT_EQ(Json(0.1).text(), "0.1");
  EXPECT_EQ(Json(1.0f / 3).text(), "0.33333334");
}

TEST(Json, WritesNullForWhatIsNotFinite) {
  EXPECT_EQ(Json(std::numeric_limits<double>::infinity()).text(), "null");
  EXPECT_EQ(Json(std::numeric_limits<float>::quiet_NaN()).text(), "null");
}

TEST(Json, ReplacesBytesThatAreNotUtf8) { EXPECT_EQ(Json("a\xff").text(), "\"a\xef\xbf\xbd\""); }

TEST(Json, IndentsByTwo) { EXPECT_EQ(Json(Json::Object{{"a", 1}}).indented(), "{\n  \"a\": 1\n}"); }

}  // namespace
}  // namespace zoneplate
