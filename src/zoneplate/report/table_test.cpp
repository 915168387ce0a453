// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/table.h"

#include <gtest/gtest.h>

namespace zoneplate {
namespace {

const Table table{{"kernel", "dB"}, {{"box", "-3.21"}, {"σ-gaussian", "-41"}}};

TEST(Table, AlignsItsColumnsAsText) {
  EXPECT_EQ(table_text(table),
            "kernel         dB\n"
            "box         -3.21\n"
            "σ-gaussian    -41\n");
  EXPECT_EQ(table_text({{"a"}, {}}), "a\n");
}

TEST(Table, IsDrawnWithARuleUnderItsHeadAndPaperAround) {
  const FigureStyle style;
  const Rgba8Image picture = table_picture(table, style, 300);
  ASSERT_EQ(picture.width(), 300);
  int rules = 0;
  for (int y = 0; y < picture.height(); ++y) {
    bool is_rule = true;
    for (int x = 1; x < 299; ++x) is_rule = is_rule && picture(x, y) != style.paper && picture(x, y) == picture(1, y);
    rules += is_rule;
    EXPECT_EQ(picture(0, y), style.paper);
    EXPECT_EQ(picture(299, y), style.paper);
  }
  EXPECT_EQ(rules, 1);
  EXPECT_GT(table_picture(table, style).width(), 100);
  EXPECT_LT(table_picture(table, style).width(), 300);
}

}  // namespace
}  // namespace zoneplate
