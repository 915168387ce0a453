#include "zoneplate/render/method.h"

#include <algorithm>
#include <charconv>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

std::string listed(std::span<const std::string_view> words) {
  std::string out;
  for (const std::string_view w : words) out += (out.empty() ? "" : ", ") + std::string(w);
  return out;
}

[[noreturn]] void reject(std::string_view method, const std::string& what) {
  throw Error(ErrorKind::Usage, std::string(method) + ": " + what);
}

int power_of_ten(int exponent) {
  int power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

/// The text as a number of at most so many decimals, as a whole number of the last of them; nothing if it is none.
std::optional<int> parse_decimals(std::string_view text, int decimals) {
  const std::size_t point = decimals > 0 ? text.find('.') : std::string_view::npos;
  std::string digits(text.substr(0, point));
  const std::string_view fraction = point == std::string_view::npos ? std::string_view{} : text.substr(point + 1);
  if (fraction.size() > static_cast<std::size_t>(decimals) || text == ".") return std::nullopt;
  digits.append(fraction).append(static_cast<std::size_t>(decimals) - fraction.size(), '0');
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (text.empty() || error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

int parse_value(std::string_view method, const Param& param, std::string_view text) {
  const std::string name(param.name);
  if (!param.names.empty()) {
    const auto it = std::find(param.names.begin(), param.names.end(), text);
    if (it == param.names.end())
      reject(method, name + " is one of " + listed(param.names) + ", not '" + std::string(text) + "'");
    return static_cast<int>(it - param.names.begin());
  }
  const std::optional<int> parsed = parse_decimals(text, param.decimals);
  if (!parsed)
    reject(method, name + (param.decimals == 0 ? " is a whole number, not '" : " is a number, not '") +
                       std::string(text) + "'");
  const int number = *parsed;
  if (!param.choices.empty() && std::find(param.choices.begin(), param.choices.end(), number) == param.choices.end()) {
    std::string choices;
    for (const int c : param.choices) choices += (choices.empty() ? "" : ", ") + std::to_string(c);
    reject(method, name + " is one of " + choices + ", not " + std::to_string(number));
  }
  if (param.choices.empty() && (number < param.low || number > param.high))
    reject(method, name + " is from " + shown_value(param, param.low) + " to " + shown_value(param, param.high) +
                       ", not " + shown_value(param, number));
  return number;
}

std::string example_of(const Param& param) {
  const std::string value = param.names.empty() ? shown_value(param, param.value)
                                                : std::string(param.names[static_cast<std::size_t>(param.value)]);
  return std::string(param.name) + "=" + value;
}

}  // namespace

Settings::Settings(std::string_view method, std::span<const Param> params, std::string_view text) : params_(params) {
  std::vector<std::string_view> names;
  for (const Param& p : params) {
    values_[p.name] = {p.value, false};
    names.push_back(p.name);
  }
  while (!text.empty()) {
    const std::string_view item = text.substr(0, text.find(','));
    text.remove_prefix(std::min(text.size(), item.size() + 1));
    const std::string_view key = item.substr(0, item.find('='));
    const auto param = std::find_if(params.begin(), params.end(), [&](const Param& p) { return p.name == key; });
    if (param == params.end() || key.size() == item.size())
      reject(method,
             "unknown parameter '" + std::string(item) + "'" +
                 (names.empty() ? "; it has none" : "; it has " + listed(names) + ", as in " + example_of(params[0])));
    values_[param->name] = {parse_value(method, *param, item.substr(key.size() + 1)), true};
  }
}

std::string shown_value(const Param& param, int value) {
  std::string text = std::to_string(value / power_of_ten(param.decimals));
  std::string fraction = std::to_string(value % power_of_ten(param.decimals));
  fraction.insert(0, static_cast<std::size_t>(std::max(0, param.decimals - static_cast<int>(fraction.size()))), '0');
  fraction.erase(fraction.find_last_not_of('0') + 1);
  return fraction.empty() || param.decimals == 0 ? text : text + '.' + fraction;
}

int Settings::integer(std::string_view name) const { return values_.at(name).number; }

double Settings::number(std::string_view name) const {
  const auto param = std::find_if(params_.begin(), params_.end(), [&](const Param& p) { return p.name == name; });
  return static_cast<double>(integer(name)) / power_of_ten(param->decimals);
}

std::string_view Settings::chosen(std::string_view name) const {
  const auto param = std::find_if(params_.begin(), params_.end(), [&](const Param& p) { return p.name == name; });
  return param->names[static_cast<std::size_t>(integer(name))];
}

bool Settings::is_given(std::string_view name) const { return values_.at(name).given; }

std::string_view closest(std::string_view word, std::span<const std::string_view> names) {
  std::string_view best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string_view name : names) {
    const std::size_t d = edit_distance(word, name);
    if (d < least) least = d, best = name;
  }
  return best;
}

std::unique_ptr<Resolver> make_resolver(std::span<const Method> catalogue, std::string_view text) {
  const std::string_view name = text.substr(0, text.find(':'));
  const std::string_view params = name.size() < text.size() ? text.substr(name.size() + 1) : std::string_view{};
  std::vector<std::string_view> names;
  for (const Method& m : catalogue) {
    names.push_back(m.name);
    if (m.name == name) return m.make(Settings(m.name, m.params, params));
  }
  const std::string_view near = closest(name, names);
  throw Error(ErrorKind::Usage,
              "unknown method '" + std::string(name) + "'" +
                  (near.empty() ? "; there are " + listed(names) : "; did you mean '" + std::string(near) + "'?"));
}

}  // namespace zoneplate
