// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "zoneplate/cli/args.h"

namespace zoneplate::cli {

/// A shell for which completions are made.
enum class Shell { Bash, Zsh, Fish };

/// The shell of that name: bash, zsh or fish.
std::optional<Shell> shell_of(std::string_view name);

/// The part of a verb in the shell's completions: its options, and the values of those that have a list of them.
std::string completions_of(const Syntax& syntax, Shell shell);

}  // namespace zoneplate::cli
