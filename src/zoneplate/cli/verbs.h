// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace zoneplate::cli {

/// Some of several items failed, each with its own message: exit code 5.
class PartialFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A comparison found a difference without an error: exit code 1, and one line on stderr that is not an error message.
class Difference : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// SIGTERM ended a batch between two items: exit code 143, and one line on stderr that is not an error message.
class Terminated : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A word after `zoneplate`, or after `zoneplate signal`, and the function that it calls with the following arguments.
struct Verb {
  std::string_view name, summary;
  void (*run)(std::span<const std::string> arguments);
  std::span<const Verb> (*subcommands)() = nullptr;  ///< of a verb that only chooses one of them
};

/// The verbs of the command.
std::span<const Verb> all_verbs();
///@{
/// The subcommands of these verbs.
std::span<const Verb> signal_verbs();
std::span<const Verb> texture_verbs();
std::span<const Verb> sdf_verbs();
///@}

/// One line per verb, with its name in a column of `width` characters.
inline std::string lines_of(std::span<const Verb> verbs, int width) {
  std::string text;
  for (const Verb& verb : verbs) text += fmt::format("  {:<{}}{}\n", verb.name, width, verb.summary);
  return text;
}

// The verbs of the command. Each takes the arguments after its name, writes its result to stdout or files, and throws
// zoneplate::Error on failure.

void run_render(std::span<const std::string> arguments);
void run_contact_sheet(std::span<const std::string> arguments);
void run_list(std::span<const std::string> arguments);
void run_info(std::span<const std::string> arguments);
void run_metrics(std::span<const std::string> arguments);
void run_plan(std::span<const std::string> arguments);
void run_verify(std::span<const std::string> arguments);
void run_filter(std::span<const std::string> arguments);
void run_compare(std::span<const std::string> arguments);
void run_dataset(std::span<const std::string> arguments);
void run_fidelity(std::span<const std::string> arguments);
void run_bench(std::span<const std::string> arguments);
void run_demo(std::span<const std::string> arguments);
void run_signal(std::span<const std::string> arguments);
void run_texture(std::span<const std::string> arguments);
void run_sdf(std::span<const std::string> arguments);
void run_completions(std::span<const std::string> arguments);
void run_man(std::span<const std::string> arguments);

}  // namespace zoneplate::cli
