// SPDX-License-Identifier: Apache-2.0
// Lessons as text for a terminal.
#include "zoneplate/lessons/demo.h"

namespace zoneplate::lessons {
namespace {

/// Wraps words for a terminal; all lines are indented.
std::string paragraph(std::string_view words, std::string_view indent) {
  constexpr std::size_t columns = 100;
  std::string text;
  std::size_t column = 0;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find_first_of(" \n"), words.size());
    const std::string_view word = words.substr(0, end);
    if (column > 0 && column + 1 + word.size() > columns) text += '\n', column = 0;
    const std::string_view before = column == 0 ? indent : " ";
    text.append(before).append(word);
    column += before.size() + word.size();
    if (end < words.size() && words[end] == '\n') text += '\n', column = 0;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return text + '\n';
}

}  // namespace

std::string text_of(const Lesson& lesson) {
  const Figure& figure = lesson.frames.at(0);
  std::string text = paragraph(figure.title, "") + '\n';
  for (const auto& row : figure.rows)
    for (const Panel& panel : row) {
      if (panel.caption.empty()) continue;
      std::string caption = panel.caption;
      const std::size_t end = caption.find('\n');
      if (end != std::string::npos) caption.replace(end, 1, ": ");
      text += paragraph(caption, "  ");
    }
  for (const Table& table : lesson.tables) text += '\n' + table_text(table);
  if (!figure.text.empty()) text += '\n' + paragraph(figure.text, "");
  return text;
}

}  // namespace zoneplate::lessons
