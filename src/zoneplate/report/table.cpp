// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/report/table.h"

#include <algorithm>
#include <cassert>

#include "zoneplate/base/utf8.h"
#include "zoneplate/report/typeface.h"

namespace zoneplate {
namespace {

/// The number of code points, which for the letters of tables is the number of a terminal's columns.
std::size_t length_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) >> 6) != 2; }));
}

/// The width of each column, measured by `measure`.
template <class Measure>
auto widths_of(const Table& table, Measure measure) {
  std::vector<decltype(measure(std::string{}, true))> widths(table.head.size());
  const auto widen = [&](const std::vector<std::string>& row, bool is_head) {
    assert(row.size() == widths.size());
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], measure(row[i], is_head));
  };
  widen(table.head, true);
  for (const auto& row : table.rows) widen(row, false);
  return widths;
}

}  // namespace

std::string table_text(const Table& table) {
  const auto widths = widths_of(table, [](const std::string& cell, bool) { return length_of(printable(cell)); });
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string cell = printable(row[i]);
      const std::string blank(widths[i] - length_of(cell), ' ');
      text += i == 0 ? cell + blank : "  " + blank + cell;
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  };
  add(table.head);
  for (const auto& row : table.rows) add(row);
  return text;
}

Rgba8Image table_picture(const Table& table, const FigureStyle& style, int min_width) {
  constexpr int rule_share = 110;  // of 255: darkness of the line below the header
  const Typeface text(Typeface::Weight::Regular, style.text_px), head(Typeface::Weight::Bold, style.text_px);
  const auto widths = widths_of(table, [&](const std::string& cell, bool is_head) {
    return static_cast<int>((is_head ? head : text).width(cell) + 1);
  });

  // The remaining width is divided between the columns.
  int sum = 0;
  for (const int w : widths) sum += w;
  const int gaps = std::max(1, static_cast<int>(widths.size()) - 1);
  const int gap = std::max(style.text_px * 3 / 2, (min_width - sum - 2) / gaps);
  const int row_height = text.leading() + style.text_px / 5, head_height = row_height + style.text_px / 3;
  const int width = std::max(min_width, sum + gap * (static_cast<int>(widths.size()) - 1) + 2);
  const int height = head_height + static_cast<int>(table.rows.size()) * row_height + 2;

  Rgba8Image picture(width, height, style.paper);
  const auto draw = [&](const std::vector<std::string>& row, const Typeface& face, int top) {
    int right = 1 - gap;
    for (std::size_t i = 0; i < row.size(); ++i) {
      right += gap + widths[i];
      const int left = i == 0 ? right - widths[i] : right - static_cast<int>(face.width(row[i]) + 0.5);
      face.draw(picture, left, top, row[i], style.ink);
    }
  };
  draw(table.head, head, 1);
  const Rgba8 rule = laid_over(style.paper, style.ink, rule_share);
  for (int x = 1; x < width - 1; ++x) picture(x, row_height + 1) = rule;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    draw(table.rows[i], text, 1 + head_height + static_cast<int>(i) * row_height);
  return picture;
}

}  // namespace zoneplate
