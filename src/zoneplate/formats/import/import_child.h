// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/os/limited_child.h"

namespace zoneplate {

/// The files and folders that the reader of a model may read: the model, its folder (the working directory where the
/// model is standard input, "-") and LoadLimits::allowed_paths.
inline std::vector<std::string> model_paths(const std::string& name, const LoadLimits& limits) {
  std::vector<std::string> paths = limits.allowed_paths;
  const std::string folder = name == "-" ? "." : std::filesystem::path(name).parent_path().string();
  paths.push_back(folder.empty() ? "." : folder);
  if (name != "-") paths.push_back(name);  // a symbolic link may lead out of its folder
  return paths;
}

/// The limits of a child process that reads for an import. The budget outlives it.
inline LimitedChild::Limits child_limits(const ImportBudget& budget) {
  // In addition to the rest of the budget: stacks of threads, and data structures of the libraries.
  constexpr std::uint64_t spare_bytes = std::uint64_t{16} << 20;
  return {.memory = budget.memory_left() + spare_bytes,
          .seconds = budget.limits().seconds,
          .options = "--max-memory, --max-import-seconds",
          .check_time = [&budget] { budget.check_time(); },
          .readable = model_paths(budget.file() == "standard input" ? "-" : budget.file(), budget.limits())};
}

}  // namespace zoneplate
