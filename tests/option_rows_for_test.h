// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/base/paths_for_test.h"

namespace zoneplate {

/// An option as a name and a text; a switch has an empty one.
using OptionText = std::pair<std::string, std::string>;

/// A line of tests/options/rows.txt.
struct OptionRow {
  OptionText option;
  std::string model, output;
  std::vector<OptionText> others;
  bool changes_bytes = true;
};

inline OptionText split_option(const std::string& text, char at) {
  const std::size_t end = text.find(at);
  return {text.substr(0, end), end == text.npos ? "" : text.substr(end + 1)};
}

inline std::string trimmed_text(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

inline std::vector<OptionRow> option_rows() {
  std::vector<OptionRow> out;
  std::ifstream file(std::filesystem::path(source_root) / "tests/options/rows.txt");
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::stringstream parts(line);
    std::vector<std::string> columns;
    for (std::string part; std::getline(parts, part, '|');) columns.push_back(trimmed_text(part));
    columns.resize(4);
    OptionRow row{.option = split_option(columns[0], ' '), .model = columns[1], .output = columns[2]};
    std::stringstream others(columns[3]);
    for (std::string word; others >> word;) {
      if (word == "=")
        row.changes_bytes = false;
      else
        row.others.push_back(split_option(word, '='));
    }
    out.push_back(std::move(row));
  }
  return out;
}

}  // namespace zoneplate
