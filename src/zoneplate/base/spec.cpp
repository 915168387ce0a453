// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <optional>

#include "zoneplate/base/closest.h"
#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

std::int64_t power_of_ten(int exponent) {
  std::int64_t power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

/// Parses the whole of `text` as a number; nothing if it is not one.
template <class Number>
std::optional<Number> parse_whole(std::string_view text) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Parses a number with at most `decimals` decimals, in units of the last one; nothing for any other text.
std::optional<std::int64_t> parse_decimals(std::string_view text, int decimals) {
  const std::size_t point = decimals > 0 ? text.find('.') : std::string_view::npos;
  const std::string_view fraction = point == std::string_view::npos ? std::string_view{} : text.substr(point + 1);
  const bool has_digit = text.find_first_of("0123456789") != std::string_view::npos;
  if (fraction.size() > static_cast<std::size_t>(decimals) || !has_digit) return std::nullopt;
  std::string digits(text.substr(0, point));
  digits.append(fraction).append(static_cast<std::size_t>(decimals) - fraction.size(), '0');
  return parse_whole<std::int64_t>(digits);
}

/// Formats a list of alternatives: "a, b or c".
template <class List>
std::string alternatives(const List& list) {
  if (list.size() < 2) return fmt::format("{}", fmt::join(list, ""));
  return fmt::format("{} or {}", fmt::join(list.first(list.size() - 1), ", "), list.back());
}

[[noreturn]] void refuse_value(const std::string& owner, const Param& param, std::string_view value) {
  std::string kind;
  if (param.names.empty() && param.choices.empty())
    kind = param.decimals == 0  ? "a whole number from "
           : param.decimals > 0 ? fmt::format("a number of {} decimals from ", param.decimals)
                                : "a number from ";
  const std::string_view near = closest(value, param.names);
  throw Error(ErrorKind::Usage,
              fmt::format("{}: {} is '{}', expected {}{}{}", owner, param.name, value, kind, values_of(param),
                          near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

}  // namespace

std::string values_of(const Param& param) {
  if (!param.names.empty()) return alternatives(param.names);
  if (!param.choices.empty()) return alternatives(param.choices);
  return fmt::format("{} to {}", param.low, param.high);
}

Settings::Settings(std::span<const Param> params) : params_(params) {
  for (const Param& param : params) {
    const double scale = static_cast<double>(power_of_ten(std::max(0, param.decimals)));
    values_.push_back({.number = param.value, .units = std::llround(param.value * scale)});
  }
}

Settings::Settings(std::string_view kind, std::span<const Param> params, std::string_view text) : Settings(params) {
  const std::string owner = fmt::format("{} {}", kind, text.substr(0, text.find(':')));
  for (std::size_t begin = text.find(':'); begin != std::string_view::npos;) {
    const std::size_t end = text.find(',', begin + 1);
    set(owner, text.substr(begin + 1, end == std::string_view::npos ? end : end - begin - 1));
    begin = end;
  }
}

/// Parses and stores `name=value`.
void Settings::set(const std::string& owner, std::string_view item) {
  const std::string_view name = item.substr(0, item.find('='));
  const std::string_view text = item.substr(std::min(item.size(), name.size() + 1));
  const auto found = std::ranges::find(params_, name, &Param::name);
  if (found == params_.end()) {
    std::vector<std::string_view> names;
    for (const Param& param : params_) names.push_back(param.name);
    const std::string_view near = closest(name, names);
    throw Error(ErrorKind::Usage, fmt::format("{}: unknown parameter '{}'; {}", owner, name,
                                              !near.empty()   ? fmt::format("did you mean '{}'?", near)
                                              : names.empty() ? "it has none"
                                                              : fmt::format("it has {}", fmt::join(names, ", "))));
  }

  const Param& param = *found;
  if (name.size() == item.size())
    throw Error(ErrorKind::Usage, fmt::format("{}: {} requires a value: {}", owner, name, values_of(param)));
  Value& value = values_[static_cast<std::size_t>(found - params_.begin())];
  if (value.is_given) throw Error(ErrorKind::Usage, fmt::format("{}: {} is given twice", owner, name));
  bool is_valid = false;
  if (!param.names.empty()) {
    value.units = std::ranges::find(param.names, text) - param.names.begin();
    value.number = static_cast<double>(value.units);
    is_valid = static_cast<std::size_t>(value.units) < param.names.size();
  } else if (param.decimals == Param::real) {
    value.number = parse_whole<double>(text).value_or(NAN);
    is_valid = value.number >= param.low && value.number <= param.high;
  } else if (const auto units = parse_decimals(text, param.decimals)) {
    value.units = *units;
    value.number = static_cast<double>(*units) / static_cast<double>(power_of_ten(param.decimals));
    is_valid = param.choices.empty() ? value.number >= param.low && value.number <= param.high
                                     : std::ranges::find(param.choices, *units) != param.choices.end();
  }
  if (!is_valid) refuse_value(owner, param, text);
  value.is_given = true;
}

std::size_t Settings::index_of(std::string_view name) const {
  const auto found = std::ranges::find(params_, name, &Param::name);
  assert(found != params_.end());
  return static_cast<std::size_t>(found - params_.begin());
}

int Settings::integer(std::string_view name) const {
  const std::size_t i = index_of(name);
  assert(params_[i].decimals == 0);
  return static_cast<int>(values_[i].units);
}

double Settings::number(std::string_view name) const { return values_[index_of(name)].number; }

std::string_view Settings::chosen(std::string_view name) const {
  const std::size_t i = index_of(name);
  return params_[i].names[static_cast<std::size_t>(values_[i].units)];
}

bool Settings::is_given(std::string_view name) const { return values_[index_of(name)].is_given; }

std::vector<double> Settings::numbers() const {
  std::vector<double> out;
  for (const Value& value : values_) out.push_back(value.number);
  return out;
}

std::vector<std::int64_t> Settings::units() const {
  assert(std::ranges::none_of(params_, [](const Param& param) { return param.decimals == Param::real; }));
  std::vector<std::int64_t> out;
  for (const Value& value : values_) out.push_back(value.units);
  return out;
}

std::string Settings::text() const {
  std::vector<std::string> given;
  for (std::size_t i = 0; i < params_.size(); ++i) {
    if (!values_[i].is_given) continue;
    given.push_back(params_[i].names.empty() ? fmt::format("{}={}", params_[i].name, values_[i].number)
                                             : fmt::format("{}={}", params_[i].name, chosen(params_[i].name)));
  }
  std::ranges::sort(given);
  return fmt::format("{}", fmt::join(given, ","));
}

void refuse_name(std::string_view kind, std::string_view text, std::span<const std::string_view> names) {
  const std::string_view name = text.substr(0, text.find(':')), near = closest(name, names);
  throw Error(ErrorKind::Usage, near.empty()
                                    ? fmt::format("unknown {} '{}'; there are {}", kind, name, fmt::join(names, ", "))
                                    : fmt::format("unknown {} '{}'; did you mean '{}'?", kind, name, near));
}

}  // namespace zoneplate
