// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/report/figure.h"

namespace zoneplate {

/// Rows of words and numbers below a header row. The first column is left-aligned, the others, which have numbers,
/// right-aligned.
///
/// Requires  every row has as many cells as the header.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// The table for a terminal: columns two spaces apart, each line terminated.
std::string table_text(const Table& table);

/// The table for a figure, in its style; at least `min_width` wide, with a border in the background colour.
Rgba8Image table_picture(const Table& table, const FigureStyle& style, int min_width = 0);

}  // namespace zoneplate
