// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/option.h"

#include <algorithm>

#include "zoneplate/job/values.h"

namespace zoneplate {

OptionSetter number(double low, double high, std::function<void(double)> set) {
  return {[=](const std::string& text) { set(parse_number(text, low, high)); }, ValueKind::Number, low, high};
}

OptionSetter whole(int low, int high, std::function<void(int)> set) {
  return {[=](const std::string& text) { set(parse_whole(text, low, high)); }, ValueKind::Whole,
          static_cast<double>(low), static_cast<double>(high)};
}

OptionSetter angle(double low, double high, std::function<void(float)> set) {
  return {[=](const std::string& text) { set(radians_of(parse_number(text, low, high))); }, ValueKind::Number, low,
          high};
}

Option choice_option(std::string names, std::string value, std::string meaning, std::string group, bool is_basic,
                     Choices choices, std::function<void(std::size_t)> set) {
  return {.names = std::move(names),
          .value = std::move(value),
          .meaning = std::move(meaning),
          .group = std::move(group),
          .is_basic = is_basic,
          .set = {[choices, set = std::move(set)](const std::string& text) { set(parse_choice(text, choices)); },
                  ValueKind::Choice},
          .choices = choices};
}

std::vector<std::string> names_of(const Option& option) { return split_list(option.names); }

const Option* find_option(const std::vector<Option>& options, std::string_view name) {
  const auto found = std::ranges::find_if(options, [&](const Option& option) {
    return std::ranges::any_of(
        names_of(option), [&](const std::string& form) { return form.substr(0, 2) == "--" && form.substr(2) == name; });
  });
  return found == options.end() ? nullptr : &*found;
}

}  // namespace zoneplate
