// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#pragma GCC visibility push(default)
namespace zoneplate {

/// A parameter in a text of the form name:key=value: n of `msaa:n=4`.
///
/// The value is one of the words `names` if there are any, one of the integers `choices` if there are any, and
/// otherwise a number in [low, high] with at most `decimals` decimals.
struct Param {
  static constexpr int real = -1;  ///< of `decimals`: any number of decimals, and an exponent

  std::string_view name{};                       ///< n of `msaa:n=4`
  std::string_view meaning{};                    ///< one line of help
  double value = 0;                              ///< the default; among names, its index
  double low = 0, high = 0;                      ///< the range, both ends included
  std::span<const int> choices = {};             ///< the only values; empty: any number in the range
  std::span<const std::string_view> names = {};  ///< the words that are the values; empty: numbers
  int decimals = 0;                              ///< 0: a whole number
};

/// A parameter that takes any number in [low, high].
constexpr Param real_param(std::string_view name, std::string_view meaning, double value, double low, double high) {
  return {.name = name, .meaning = meaning, .value = value, .low = low, .high = high, .decimals = Param::real};
}

/// The values that a parameter takes, for help and messages: "1 to 1000", "2, 4 or 8".
std::string values_of(const Param& param);

/// The values of parameters: from a text, or the defaults.
///
/// Requires  the parameters outlive this object.
class Settings {
 public:
  /// All parameters with their default values.
  explicit Settings(std::span<const Param> params = {});
  /// Parses a text such as `msaa` or `msaa:n=4,resolve=karis`; `kind` is the noun for messages ("method").
  ///
  /// Errors    ErrorKind::Usage naming an unknown or repeated parameter, or an invalid value.
  Settings(std::string_view kind, std::span<const Param> params, std::string_view text);

  int integer(std::string_view name) const;              ///< a whole number, or the index of a name
  double number(std::string_view name) const;            ///< the value, or the index of a name
  std::string_view chosen(std::string_view name) const;  ///< the name itself
  bool is_given(std::string_view name) const;  ///< true if the text has this parameter, even with its default value

  /// All values in the order of the parameters.
  std::vector<double> numbers() const;
  /// The same, in units of each parameter's last decimal, exact: 1.5 with two decimals is 150.
  ///
  /// Requires  no parameter is real.
  std::vector<std::int64_t> units() const;

  /// The values that were given, in the shortest form that reads back the same: `a=1,b=halton`, sorted by name.
  std::string text() const;

 private:
  struct Value {
    double number = 0;
    std::int64_t units = 0;
    bool is_given = false;
  };
  std::size_t index_of(std::string_view name) const;
  void set(const std::string& owner, std::string_view item);

  std::span<const Param> params_;
  std::vector<Value> values_;  ///< one for each parameter
};

/// The row of a catalogue that a text such as `msaa:n=4` names, or null.
///
/// Requires  `Row` has a `name`.
template <class Row>
const Row* find_row(std::span<const Row> rows, std::string_view text) {
  for (const Row& row : rows)
    if (row.name == text.substr(0, text.find(':'))) return &row;
  return nullptr;
}

/// Throws the error for a name that is in no catalogue.
/// Errors    ErrorKind::Usage: no `kind` has this name; the message has the closest of `names`, or all of them.
[[noreturn]] void refuse_name(std::string_view kind, std::string_view text, std::span<const std::string_view> names);

/// A row of a catalogue and the values of its parameters.
template <class Row>
struct Spec {
  const Row& row;       ///< of the catalogue, which outlives the Spec
  Settings settings{};  ///< the values of the row's parameters

  /// The text in canonical form: `name` or `name:a=1,b=2`.
  std::string text() const {
    const std::string given = settings.text();
    return std::string(row.name) + (given.empty() ? "" : ":" + given);
  }
};

/// Parses a text such as `msaa:n=4` against a catalogue, whose rows have `name` and `params`.
///
/// Errors    ErrorKind::Usage naming an unknown row, parameter or value, with the closest known one or all of them.
template <class Row>
Spec<Row> parse_spec(std::string_view kind, std::span<const Row> rows, std::string_view text) {
  if (const Row* row = find_row(rows, text)) return {*row, Settings(kind, row->params, text)};
  std::vector<std::string_view> names;
  for (const Row& row : rows) names.push_back(row.name);
  refuse_name(kind, text, names);
}

}  // namespace zoneplate
#pragma GCC visibility pop
