// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/json/json_edits.h"

#include <gtest/gtest.h>

#include <string>

namespace zoneplate {
namespace {

JsonValue parse_root(const std::string& text) {
  ImportBudget budget("file", {});
  return parse_json({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, budget);
}

JsonValue number(double x) { return {.kind = JsonValue::Kind::Number, .number = x}; }

TEST(JsonEdits, PointersFollowObjectsAndLists) {
  JsonValue root = parse_root(R"({"a":[{"b":1},{"b":2,"c/d":3,"e~f":4}],"":5})");
  EXPECT_EQ(find_at(root, ""), &root);
  EXPECT_EQ(find_at(root, "/a/1/b")->number, 2);
  EXPECT_EQ(find_at(root, "/a/1/c~1d")->number, 3);
  EXPECT_EQ(find_at(root, "/a/1/e~0f")->number, 4);
  EXPECT_EQ(find_at(root, "/")->number, 5);
  for (const char* nothing : {"a", "/a/2", "/a/-1", "/a/x", "/a/0/b/c", "/z", "/a/", "/a/99999999999999999999999"})
    EXPECT_EQ(find_at(root, nothing), nullptr) << nothing;
}

TEST(JsonEdits, ChangesAreTakenBack) {
  JsonValue root = parse_root(R"({"a":[{"b":1}]})");
  JsonEdits edits(root);
  EXPECT_TRUE(edits.set("/a/0/b", number(7)));
  EXPECT_TRUE(edits.set("/a/0/new", number(8)));
  EXPECT_TRUE(edits.set("/a/0/b", number(9)));
  EXPECT_FALSE(edits.set("/a/1", number(0)));
  EXPECT_FALSE(edits.set("/z/b", number(0)));
  EXPECT_FALSE(edits.set("a", number(0)));
  EXPECT_EQ(edits.find("/a/0/b")->number, 9);
  EXPECT_EQ(edits.find("/a/0/new")->number, 8);
  EXPECT_TRUE(edits.touch("/a/"));
  EXPECT_FALSE(edits.touch("/z/"));
  edits.undo();
  EXPECT_FALSE(edits.touch("/"));
  EXPECT_EQ(edits.find("/a/0/b")->number, 1);
  EXPECT_EQ(edits.find("/a/0/new"), nullptr);
  EXPECT_EQ(find_at(root, "/a/0")->keys.size(), 1u);
}

}  // namespace
}  // namespace zoneplate
