// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/json/json.h"

#include <gtest/gtest.h>

#include "zoneplate/base/deadline.h"

namespace zoneplate {
namespace {

JsonValue parse(const std::string& text, const LoadLimits& limits = {}) {
  ImportBudget budget("f.gltf", limits);
  return parse_json({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, budget);
}

std::string json_error(const std::string& text, const LoadLimits& limits = {}) {
  try {
    parse(text, limits);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    return e.what();
  }
  return "";
}

template <class F>
std::string error_in(const std::string& text, const F& read) {
  const JsonValue v = parse(text);
  try {
    read(JsonView(v, "f.gltf:"));
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(GltfJson, KeepsEveryKindOfValue) {
  const JsonValue v = parse(R"({"a":[1,-2.5,true,null,"x\u00e9",{"b":18446744073709551615}]})" + std::string(3, '\0'));
  const auto& list = v.items.at(0).items;
  ASSERT_EQ(list.size(), 6u);
  EXPECT_EQ(list[0].number, 1);
  EXPECT_EQ(list[1].number, -2.5);
  EXPECT_TRUE(list[2].boolean);
  EXPECT_EQ(list[3].kind, JsonValue::Kind::Null);
  EXPECT_EQ(list[4].text, "x\xc3\xa9");
  EXPECT_EQ(list[5].items[0].number, 18446744073709551616.0);
}

TEST(GltfJson, RefusesWhatIsNotJson) {
  EXPECT_NE(json_error("").find("f.gltf: not JSON: "), std::string::npos);
  EXPECT_NE(json_error("{\"a\":1,}").find("line 1, column 8"), std::string::npos);
  EXPECT_NE(json_error("{} x"), "");
  EXPECT_NE(json_error("{\"a\":\"\xff\"}"), "");
  EXPECT_NE(json_error("{\"a\":1e999}"), "");
  EXPECT_EQ(json_error("{\"a\":\"b\nc\"}").find('\n'), std::string::npos);
}

TEST(GltfJson, LimitsDepthAndMemory) {
  EXPECT_EQ(json_error(std::string(64, '[') + std::string(64, ']')), "");
  EXPECT_EQ(json_error(std::string(65, '[') + std::string(65, ']')), "f.gltf: JSON nested deeper than 64");
  EXPECT_NE(json_error(std::string(1000000, '[')), "");
  std::string many = "[0";
  for (int i = 0; i < 1000; ++i) many += ",0";
  EXPECT_NE(json_error(many + "]", {.memory = 100000}).find("--max-memory"), std::string::npos);
}

TEST(GltfJson, DefaultsStandForMissingKeysOnly) {
  const JsonValue v = parse(R"({"n":2,"t":"x","b":true,"l":[1,2],"o":{"p":3},"s":["a"]})");
  const JsonView j(v, "f.gltf:");
  EXPECT_EQ(j.number("n", 7.0f), 2);
  EXPECT_EQ(j.number("none", 7.0f), 7);
  EXPECT_EQ(j.whole("n", 7), 2u);
  EXPECT_EQ(j.text("t", "y"), "x");
  EXPECT_EQ(j.text("none", "y"), "y");
  EXPECT_TRUE(j.flag("b", false));
  EXPECT_EQ(j.numbers("l", 2), (std::vector<float>{1, 2}));
  EXPECT_TRUE(j.numbers("none", 2).empty());
  EXPECT_EQ(j.object("o").number("p"), 3);
  EXPECT_EQ(j.object("none").place(), "f.gltf: none");
  EXPECT_EQ(j.texts("s"), std::vector<std::string>{"a"});
  EXPECT_EQ(*j.find_index("n", 3), 2u);
  EXPECT_FALSE(j.find_index("none", 3));
}

TEST(GltfJson, TheLastOfEqualKeysCounts) {
  const JsonValue v = parse(R"({"n":1,"n":2})");
  EXPECT_EQ(JsonView(v, "").number("n"), 2);
}

TEST(GltfJson, MessagesNameThePlaceTheFoundAndTheWanted) {
  const std::string text = R"({"a":[{"n":-1,"f":1.5,"t":"x","big":1e300}],"l":[1,"x"]})";
  const auto first = [](const JsonView& j) { return j.element("a", 0, "thing"); };
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { first(j).whole("n"); }),
            "f.gltf: thing 0: n is -1, expected a whole number from 0 to 9007199254740992");
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { first(j).whole("f"); }),
            "f.gltf: thing 0: f is 1.5, expected a whole number from 0 to 9007199254740992");
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { first(j).number("t"); }),
            "f.gltf: thing 0: t is a string, expected a number");
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { first(j).number("big"); }),
            "f.gltf: thing 0: big is 1e+300, expected a number within a float's range");
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { first(j).number("none"); }), "f.gltf: thing 0: none is missing");
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { j.numbers("l", 2); }),
            "f.gltf: l holds a string, expected numbers");
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { j.numbers("a", 0); }),
            "f.gltf: a holds an object, expected numbers");
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { j.indices("l", 1); }),
            "f.gltf: l holds 1, expected indices below 1");
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { j.count("n"), j.object("a"); }),
            "f.gltf: a is an array, expected an object");
  EXPECT_EQ(error_in(text, [&](const JsonView& j) { j.element("l", 0, "thing"); }),
            "f.gltf: thing 0: is a number, expected an object");
}

TEST(GltfJson, QuotedTextsStayOnOneLine) {
  EXPECT_EQ(quoted("a\nb\x1b"), "'a?b?'");
  EXPECT_EQ(quoted(std::string(200, 'x')), "'" + std::string(120, 'x') + "...'");
}

TEST(GltfJson, ManyKeysAreFoundToo) {
  std::string text = "{";
  for (int i = 0; i < 1000; ++i) text += "\"k" + std::to_string(i % 900) + "\":" + std::to_string(i) + ",";
  const JsonValue v = parse(text + R"("a\u0000b":1,"z":"end"})");
  const JsonView j(v, "");
  for (int i = 0; i < 900; ++i)
    EXPECT_EQ(j.whole(("k" + std::to_string(i)).c_str()), static_cast<std::uint64_t>(i < 100 ? i + 900 : i)) << i;
  EXPECT_EQ(j.text("z"), "end");
  EXPECT_FALSE(j.has("k900"));
  EXPECT_FALSE(j.has(""));
  EXPECT_FALSE(j.has("zz"));
}

TEST(GltfJson, TimeIsCheckedOnTheWay) {
  std::string many = "[0";
  for (int i = 0; i < 5000; ++i) many += ",0";
  const std::string late = "late";
  EXPECT_THROW(with_deadline(0, ErrorKind::Input, late, [&] { parse(many + "]"); }), Error);
}

}  // namespace
}  // namespace zoneplate
