#include "zoneplate/metrics/metric.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "zoneplate/base/error.h"

namespace zoneplate::metrics {
namespace {

/// The names of a list, "a, b, c", or "none".
template <class Named>
std::string names_of(std::span<const Named> list) {
  std::string names;
  for (const Named& item : list) names += (names.empty() ? "" : ", ") + std::string(item.name);
  return names.empty() ? "none" : names;
}

double parse_number(std::string_view metric, const Param& param, std::string_view text) {
  const std::string digits(text);
  char* end = nullptr;
  const double value = std::strtod(digits.c_str(), &end);
  const bool is_number = !digits.empty() && end == digits.c_str() + digits.size();
  const bool is_allowed = param.choices.empty() ? value >= param.low && value <= param.high
                                                : std::ranges::find(param.choices, value) != param.choices.end();
  if (!is_number || !is_allowed) {
    throw Error(ErrorKind::Usage, fmt::format("metric {}: {}={}: wants {}{}", metric, param.name, text,
                                              param.choices.empty() ? "a number from " : "", values_of(param)));
  }
  return value;
}

}  // namespace

std::string values_of(const Param& param) {
  if (param.choices.empty()) return fmt::format("{} to {}", param.low, param.high);
  const auto before_last = param.choices.first(param.choices.size() - 1);
  return fmt::format("{} or {}", fmt::join(before_last, ", "), param.choices.back());
}

Settings::Settings(std::string_view metric, std::span<const Param> params, std::string_view text) : params_(params) {
  for (const Param& param : params) values_.push_back(param.value);
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), item.size() + 1));
    const std::string_view name = item.substr(0, item.find('='));
    const auto found = std::ranges::find(params, name, &Param::name);
    if (found == params.end()) {
      throw Error(ErrorKind::Usage,
                  fmt::format("metric {}: unknown parameter {}; there is: {}", metric, name, names_of(params)));
    }
    const std::string_view value = item.substr(std::min(item.size(), name.size() + 1));
    values_[static_cast<std::size_t>(found - params.begin())] = parse_number(metric, *found, value);
  }
}

double Settings::number(std::string_view name) const {
  const auto found = std::ranges::find(params_, name, &Param::name);
  assert(found != params_.end());
  return values_[static_cast<std::size_t>(found - params_.begin())];
}

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double root_mean_square_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

Choice choose_metric(std::span<const Metric> catalogue, std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  const auto found = std::ranges::find(catalogue, name, &Metric::name);
  if (found == catalogue.end()) {
    throw Error(ErrorKind::Usage, fmt::format("unknown metric {}; there is: {}", name, names_of(catalogue)));
  }
  const std::string_view rest = text.substr(std::min(text.size(), name.size() + 1));
  return {&*found, Settings(name, found->params, rest)};
}

}  // namespace zoneplate::metrics
