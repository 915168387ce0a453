// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/compare/methods.h"

#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

/// Every method with its defaults and all of its variants.
std::vector<std::string> all_methods() {
  std::vector<std::string> out;
  for (const Method& m : antialias::methods()) {
    if (m.is_reference) continue;
    out.emplace_back(m.name);
    for (const std::string_view v : m.variants) out.push_back(fmt::format("{}:{}", m.name, v));
  }
  return out;
}

}  // namespace

bool is_method(std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  return std::ranges::any_of(antialias::methods(), [&](const Method& m) { return m.name == name; });
}

std::vector<std::string> compared_methods(const std::string& text) {
  std::vector<std::string> out;
  for (const std::string& item : split_specs(text)) {
    const std::vector<std::string> own = item == "all" ? all_methods() : std::vector{item};
    for (const std::string& m : own) {
      upscale::make_method(m);  // throws if it is invalid
      if (std::ranges::find(out, m) == out.end()) out.push_back(m);
    }
  }
  return out;
}

}  // namespace zoneplate
