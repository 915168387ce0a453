#include "zoneplate/signal/spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "zoneplate/base/error.h"

namespace zoneplate {

Spec parse_spec(std::string_view text) {
  const std::size_t colon = text.find(':');
  Spec spec{std::string(text.substr(0, colon)), {}};
  if (spec.name.empty()) throw Error(ErrorKind::Usage, fmt::format("'{}': wants a name, as in gaussian:sigma=2", text));
  std::string_view rest = colon == std::string_view::npos ? std::string_view{} : text.substr(colon + 1);
  if (colon != std::string_view::npos && rest.empty())
    throw Error(ErrorKind::Usage, fmt::format("'{}': nothing follows the colon, wants name=value", text));
  while (!rest.empty()) {
    const std::size_t comma = rest.find(',');
    const std::string_view item = rest.substr(0, comma);
    rest = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos || equals == 0)
      throw Error(ErrorKind::Usage, fmt::format("'{}': found '{}', wants name=value", text, item));
    const std::string_view number = item.substr(equals + 1);
    double value = 0;
    const auto [end, code] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (code != std::errc{} || end != number.data() + number.size() || !std::isfinite(value))
      throw Error(ErrorKind::Usage,
                  fmt::format("'{}': {} is '{}', wants a number", text, item.substr(0, equals), number));
    if (!spec.values.emplace(item.substr(0, equals), value).second)
      throw Error(ErrorKind::Usage, fmt::format("'{}': {} is given twice", text, item.substr(0, equals)));
  }
  return spec;
}

std::vector<double> settle(const Spec& spec, const std::vector<SpecParam>& params) {
  for (const auto& [name, value] : spec.values) {
    const auto is_name = [&, wanted = std::string_view(name)](const SpecParam& p) { return p.name == wanted; };
    const auto p = std::find_if(params.begin(), params.end(), is_name);
    if (p == params.end()) {
      std::string known;
      for (const SpecParam& k : params) known += (known.empty() ? "wants " : ", ") + std::string(k.name);
      throw Error(ErrorKind::Usage, fmt::format("{}: no parameter '{}'; {}", spec.name, name,
                                                known.empty() ? std::string("it has none") : known));
    }
    if (value < p->low || value > p->high)
      throw Error(ErrorKind::Usage,
                  fmt::format("{}: {} is {}, wants {} to {}", spec.name, name, value, p->low, p->high));
  }
  std::vector<double> out;
  for (const SpecParam& p : params) {
    const auto given = spec.values.find(p.name);
    out.push_back(given == spec.values.end() ? p.value : given->second);
  }
  return out;
}

std::string text_of(const Spec& spec) {
  std::string text = spec.name;
  for (const auto& [name, value] : spec.values)
    text += fmt::format("{}{}={}", text.size() == spec.name.size() ? ":" : ",", name, value);
  return text;
}

}  // namespace zoneplate
