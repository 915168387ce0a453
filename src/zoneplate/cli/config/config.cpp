// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/config/config.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "zoneplate/base/closest.h"
#include "zoneplate/base/error.h"
#include "zoneplate/os/file.h"

namespace zoneplate::cli {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

[[noreturn]] void fail(const std::string& path, int line, const std::string& what) {
  throw Error(ErrorKind::Usage, fmt::format("{}: line {}: {}", path, line, what));
}

// The path of a file in a folder that a variable names; empty if it is not an absolute path.
std::string below_variable(const char* variable, const char* path) {
  const char* const folder = std::getenv(variable);
  return folder != nullptr && folder[0] == '/' ? std::string(folder) + path : std::string();
}

std::string config_path() {
  const std::string own = below_variable("XDG_CONFIG_HOME", "/zoneplate/config");
  return own.empty() ? below_variable("HOME", "/.config/zoneplate/config") : own;
}

}  // namespace

Config parse_config(std::string_view text, const std::string& path) {
  Config config{.path = path};
  std::string preset;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = trimmed(text.substr(at, end - at));
    ++number, at = end + 1;
    if (line.empty() || line[0] == '#' || line[0] == ';') continue;
    if (line[0] == '[') {
      preset = trimmed(line.substr(1, line.size() - 2));
      if (line.back() != ']' || preset.empty()) fail(path, number, "expected a preset, as [thumbnail]");
      if (std::ranges::find(config.presets, preset) != config.presets.end())
        fail(path, number, fmt::format("a second preset {}", preset));
      config.presets.push_back(preset);
      continue;
    }
    const std::size_t equals = line.find('=');
    std::string_view name = trimmed(line.substr(0, equals));
    while (name.starts_with('-')) name.remove_prefix(1);
    if (name.empty()) fail(path, number, "expected an option, as size = 512");
    ConfigEntry entry{.preset = preset, .name = std::string(name), .value = std::nullopt, .line = number};
    if (equals != line.npos) entry.value = trimmed(line.substr(equals + 1));
    config.entries.push_back(std::move(entry));
  }
  return config;
}

Config user_config() {
  const std::string path = config_path();
  std::error_code ignored;
  if (path.empty() || !std::filesystem::is_regular_file(path, ignored)) return {.path = path};
  constexpr std::uint64_t max_bytes = 1 << 20;
  const FileBytes file(path, max_bytes);
  return parse_config({reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size()}, path);
}

void apply_config(const Config& config, const std::string& preset, const Syntax& syntax) {
  if (!preset.empty() && std::ranges::find(config.presets, preset) == config.presets.end()) {
    const std::vector<std::string_view> names(config.presets.begin(), config.presets.end());
    const std::string_view near = closest(preset, names);
    throw Error(ErrorKind::Usage, fmt::format("--preset: there is no preset {} in {}; {}", preset,
                                              config.path.empty() ? "a configuration" : config.path,
                                              !near.empty()   ? fmt::format("did you mean {}?", near)
                                              : names.empty() ? "a preset is a line [NAME] and the options after it"
                                                              : fmt::format("there are {}", fmt::join(names, ", "))));
  }
  constexpr std::string_view refused[] = {"preset", "no-config", "help"};
  for (const std::string& section : {std::string(), preset}) {
    for (const ConfigEntry& entry : config.entries) {
      if (entry.preset != section) continue;
      if (std::ranges::find(refused, entry.name) != std::end(refused))
        fail(config.path, entry.line, entry.name + " is for the command line alone");
      try {
        set_option(syntax, entry.name, entry.value);
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::Usage) throw;
        fail(config.path, entry.line, error.what());
      }
    }
    if (preset.empty()) break;
  }
}

}  // namespace zoneplate::cli
