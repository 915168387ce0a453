// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/option/option.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "zoneplate/base/closest.h"
#include "zoneplate/job/option/values.h"

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

std::string row_name(const Option& option) { return names_of(option).front().substr(2); }

std::string without_dashes(const std::vector<Option>& options, std::string text) {
  for (std::size_t at = 0; (at = text.find("--", at)) != text.npos;) {
    const std::size_t end = std::min(text.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", at + 2), text.size());
    if (find_option(options, std::string_view(text).substr(at + 2, end - at - 2)) != nullptr)
      text.erase(at, 2);
    else
      at += 2;
  }
  return text;
}

void refuse_rows(std::vector<Option>& options, std::string_view names, const std::string& reason) {
  for (std::size_t end = 0; !names.empty(); names.remove_prefix(std::min(end + 1, names.size()))) {
    end = std::min(names.find(' '), names.size());
    const auto row = std::ranges::find(options, names.substr(0, end), row_name);
    assert(row != options.end());
    row->set.set = [reason](const std::string&) { throw Error(ErrorKind::Usage, reason); };
    row->is_refused = true;
  }
}

void set_row(const std::vector<Option>& options, const std::string& name, const char* value) {
  const Option* const row = find_option(options, name);
  if (row == nullptr) {
    std::vector<std::string> names;
    for (const Option& option : options)
      for (const std::string& form : names_of(option))
        if (form.starts_with("--")) names.push_back(form.substr(2));
    const std::string_view near = closest(name, std::vector<std::string_view>(names.begin(), names.end()));
    throw Error(ErrorKind::Usage, fmt::format("{}: there is no such option{}", name,
                                              near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }
  if (row->kind() == ValueKind::Switch && value != nullptr)
    throw Error(ErrorKind::Usage, fmt::format("{}: takes no value", name));
  if (row->kind() != ValueKind::Switch && value == nullptr)
    throw Error(ErrorKind::Usage, fmt::format("{}: needs a value: {}", name, row->value));
  try {
    row->set(value == nullptr ? "" : value);
  } catch (const Error& error) {
    throw Error(error.kind(), name + ": " + without_dashes(options, error.what()));
  }
}

}  // namespace zoneplate
