// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "zoneplate/report/html_page.h"

namespace zoneplate {

Json page_table(const Table& table, std::string_view title, Json::Array targets) {
  const auto cells = [](const std::vector<std::string>& row) { return Json::Array(row.begin(), row.end()); };
  Json::Array rows;
  for (const auto& row : table.rows) rows.emplace_back(cells(row));
  return Json::Object{
      {"title", title}, {"head", cells(table.head)}, {"rows", std::move(rows)}, {"targets", std::move(targets)}};
}

}  // namespace zoneplate
