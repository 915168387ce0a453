// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/formats/zip/zip_for_test.h"

namespace zoneplate::maker_3mf {

using Bytes = std::vector<std::uint8_t>;

inline constexpr const char* model_type = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

/// A relationship part whose relationships are pairs of a type and a target.
inline std::string relationships(const std::vector<std::pair<std::string, std::string>>& all) {
  std::string text =
      R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)";
  for (const auto& [type, target] : all)
    text += fmt::format(R"(<Relationship Id="r{}" Type="{}" Target="{}"/>)", text.size(), type, target);
  return text + "</Relationships>";
}

/// A model part.
inline std::string model(const std::string& resources, const std::string& build, const std::string& attributes = "") {
  return R"(<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" xml:lang="en-US" )"
         R"(xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" )"
         R"(xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02" )"
         R"(xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" )" +
         attributes + "><resources>" + resources + "</resources><build>" + build + "</build></model>";
}

/// The mesh of a tower of 10 x 10 x 30, whose triangle k has the attributes `of(k)`.
inline std::string tower(const std::function<std::string(int)>& of = [](int) { return ""; }) {
  constexpr int corners[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                  {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  std::string text = "<mesh><vertices>";
  for (int v = 0; v < 8; ++v)
    text += fmt::format(R"(<vertex x="{}" y="{}" z="{}"/>)", v % 2 * 10, v / 2 % 2 * 10, v / 4 * 30);
  text += "</vertices><triangles>";
  for (int k = 0; k < 12; ++k)
    text +=
        fmt::format(R"(<triangle v1="{}" v2="{}" v3="{}" {}/>)", corners[k][0], corners[k][1], corners[k][2], of(k));
  return text + "</triangles></mesh>";
}

inline std::string object(int id, const std::string& content, const std::string& attributes = "") {
  return fmt::format(R"(<object id="{}" type="model" {}>{}</object>)", id, attributes, content);
}
inline std::string item(int id, const std::string& attributes = "") {
  return fmt::format(R"(<item objectid="{}" {}/>)", id, attributes);
}

/// A package of a root model and other parts; `more` are further relationships of the package.
inline Bytes package(const std::string& root, const std::vector<ZipMember>& parts = {},
                     const std::vector<std::pair<std::string, std::string>>& more = {}) {
  std::vector<std::pair<std::string, std::string>> all = {{model_type, "/3D/3dmodel.model"}};
  all.insert(all.end(), more.begin(), more.end());
  std::vector<ZipMember> members = {
      {"[Content_Types].xml",
       R"(<?xml version="1.0"?><Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"/>)"},
      {"_rels/.rels", relationships(all)},
      {"3D/3dmodel.model", root, true}};
  members.insert(members.end(), parts.begin(), parts.end());
  return zip_of(members);
}

/// The tower alone.
inline Bytes plain() { return package(model(object(1, tower()), item(1))); }

}  // namespace zoneplate::maker_3mf
