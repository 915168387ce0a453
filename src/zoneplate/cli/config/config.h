// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/cli/args.h"

namespace zoneplate::cli {

/// An option of a configuration, without its dashes.
struct ConfigEntry {
  std::string preset;                ///< empty: it applies without a preset
  std::string name;                  ///< "size"
  std::optional<std::string> value;  ///< none: a switch
  int line = 0;                      ///< from 1
};

/// The options of a user's configuration file:
///
///     # A comment. Options before the first preset always apply.
///     aa = ssaa:n=4
///     [thumbnail]
///     size = 256
///     no-background
struct Config {
  std::string path;                  ///< for messages
  std::vector<std::string> presets;  ///< names, in the file's order
  std::vector<ConfigEntry> entries;
};

/// Parses the text of a configuration.
///
/// Errors    ErrorKind::Usage naming `path` and the line.
Config parse_config(std::string_view text, const std::string& path);

/// The user's configuration: $XDG_CONFIG_HOME/zoneplate/config or ~/.config/zoneplate/config; empty if there is none.
///
/// Errors    those of reading and parsing it.
Config user_config();

/// Sets the options that always apply, and then those of a preset unless its name is empty.
///
/// Errors    ErrorKind::Usage naming path and line of a wrong option or value, or the presets that there are.
void apply_config(const Config& config, const std::string& preset, const Syntax& syntax);

}  // namespace zoneplate::cli
