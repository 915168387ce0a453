// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"

namespace zoneplate {

/// Names of which an option takes one, or a list.
using Choices = std::vector<std::string_view>;

/// What the text of an option is.
enum class ValueKind { Switch, Number, Whole, Choice, Text };

/// Sets a value by its text: any callable that takes a text, or one of the functions below, which state a range.
struct OptionSetter {
  std::function<void(const std::string&)> set;
  ValueKind kind = ValueKind::Text;
  double low = 0, high = 0;  ///< of Number and Whole

  OptionSetter() = default;
  OptionSetter(std::function<void(const std::string&)> setter, ValueKind value_kind, double min = 0, double max = 0)
      : set(std::move(setter)), kind(value_kind), low(min), high(max) {}
  template <class Set>
  requires std::is_invocable_v<const Set&, const std::string&> OptionSetter(Set setter) : set(std::move(setter)) {}
  void operator()(const std::string& text) const { set(text); }
};

/// A number in [low, high], a whole number, and an angle in degrees that `set` takes in radians.
OptionSetter number(double low, double high, std::function<void(double)> set);
OptionSetter whole(int low, int high, std::function<void(int)> set);
OptionSetter angle(double low, double high, std::function<void(float)> set);

/// One option of a job or of a verb. Parsing, help and the interfaces for other languages use the same table.
struct Option {
  std::string names;        ///< all forms, the one for messages first: "--output,-o"
  std::string value;        ///< placeholder of the value in help, "FILE"; empty for a switch
  std::string meaning;      ///< one sentence, without a full stop
  std::string group;        ///< heading in the full help
  bool is_basic = false;    ///< included in the short help
  OptionSetter set;         ///< takes the value's text (empty for a switch)
  Choices choices{};        ///< values that shells complete
  bool repeats = false;     ///< may be given several times; otherwise the last value counts
  bool is_refused = false;  ///< by refuse_rows

  ValueKind kind() const { return value.empty() ? ValueKind::Switch : set.kind; }
};

/// An option whose value is one of `choices`; `set` takes the index of the chosen one.
Option choice_option(std::string names, std::string value, std::string meaning, std::string group, bool is_basic,
                     Choices choices, std::function<void(std::size_t)> set);

/// All forms of an option's name, as in the table.
std::vector<std::string> names_of(const Option& option);

/// The option of that name without dashes; null if there is none.
const Option* find_option(const std::vector<Option>& options, std::string_view name);

/// What interfaces without dashes call the option: its first long form, without them.
std::string row_name(const Option& option);

/// Sets the option of that name without dashes by the text of its value, which is null for a switch alone.
///
/// Errors    ErrorKind::Usage naming the row: one that is not there, a value that is missing, or wrong.
void set_row(const std::vector<Option>& options, const std::string& name, const char* value);

/// Lets the options of these names, which are separated by spaces, be errors with a reason: they cannot act in the
/// interface that has the table.
void refuse_rows(std::vector<Option>& options, std::string_view names, const std::string& reason);

/// A message of the library, in which options have the dashes of the command, as one about rows.
std::string without_dashes(const std::vector<Option>& options, std::string text);

/// Calls `body`; its errors name options as rows.
template <class Body>
void naming_rows(const std::vector<Option>& options, const Body& body) {
  try {
    body();
  } catch (const Error& error) {
    throw Error(error.kind(), without_dashes(options, error.what()));
  }
}

}  // namespace zoneplate
