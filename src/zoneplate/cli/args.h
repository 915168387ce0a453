// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/job/option/option.h"

namespace zoneplate::cli {

/// The arguments of a verb, and the texts of its help.
struct Syntax {
  std::string verb, summary;
  std::string operands;  ///< placeholders: "IN"
  std::string examples;  ///< lines of the short help, formatted
  std::string notes;     ///< paragraphs at the end of the full help
  std::vector<Option> options;
  std::vector<std::string> found_operands;  ///< filled by `parse`
  std::string program = "zoneplate";
};

/// Parses the arguments after the verb: options in any order, `--name=value` or `--name value`; `--` ends options, and
/// the last one of a repeated option counts. Returns false after printing the help for -h, --help or --help=FORM: FORM
/// is the heading of a group of options, man (man_page.h), or bash, zsh or fish (completions.h).
///
/// Errors    ErrorKind::Usage naming the option: unknown (with the closest one), without its value, or rejected by
///           `set`.
bool parse(Syntax& syntax, std::span<const std::string> arguments);

/// Sets one option, named without dashes, for a job of a manifest; `value` is nothing for a switch.
///
/// Errors    as `parse`.
void set_option(const Syntax& syntax, const std::string& name, const std::optional<std::string>& value);

/// The text of the short help (-h), of the full one (--help), and of the options of one group (--help=camera).
std::string short_help(const Syntax& syntax);
std::string full_help(const Syntax& syntax);
/// Errors    ErrorKind::Usage for a heading that no group has.
std::string group_help(const Syntax& syntax, const std::string& heading);

}  // namespace zoneplate::cli
