// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/os/limited_child.h"

namespace zoneplate {

/// The files and folders that an import may read: the model, its folder (the working directory if the model is standard
/// input, "-") and LoadLimits::allowed_paths.
inline std::vector<std::string> model_paths(const std::string& name, const LoadLimits& limits) {
  std::vector<std::string> paths = limits.allowed_paths;
  const std::string folder = name == "-" ? "." : std::filesystem::path(name).parent_path().string();
  paths.push_back(folder.empty() ? "." : folder);
  if (name != "-") paths.push_back(name);  // the model itself may be a symbolic link to another folder
  return paths;
}

/// The limits of a child process that imports a model. The budget must outlive it.
inline LimitedChild::Limits child_limits(const ImportBudget& budget) {
  // Memory in addition to the rest of the budget, for stacks of threads and data structures of libraries.
  constexpr std::uint64_t spare_bytes = std::uint64_t{16} << 20;
  return {.memory = budget.memory_left() + spare_bytes,
          .seconds = budget.limits().seconds,
          .options = "--max-memory, --max-import-seconds",
          .check_time = [&budget] { budget.check_time(); },
          .readable = model_paths(budget.file() == "standard input" ? "-" : budget.file(), budget.limits())};
}

}  // namespace zoneplate
