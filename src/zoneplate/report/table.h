// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/report/figure.h"

namespace zoneplate {

/// Rows of words and numbers under a head. The first column is left-aligned, the others, numbers, right-aligned.
///
/// Requires  every row is as long as the head.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// For a terminal: columns two spaces apart, each line ended.
std::string table_text(const Table& table);

/// For a figure, in its style; at least `least_width` wide, its rim is paper.
Rgba8Image table_picture(const Table& table, const FigureStyle& style, int least_width = 0);

}  // namespace zoneplate
