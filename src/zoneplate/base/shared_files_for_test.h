// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "zoneplate/base/paths_for_test.h"

namespace zoneplate {

// Third-party models and images are not part of the sources. If they are present in `../shared`, parametrised tests use
// them; otherwise these tests do not exist, and their subject is tested with procedural files only.

/// The existing ones of the named files in a folder of `../shared`.
inline std::vector<std::string> shared_files(const std::string& folder, std::vector<std::string> names) {
  const std::filesystem::path root = std::filesystem::path(source_root) / "../shared" / folder;
  for (std::string& name : names) name = (root / name).string();
  std::erase_if(names, [](const std::string& path) { return !std::filesystem::exists(path); });
  return names;
}

/// All files in a folder of `../shared` and its subfolders with one of these endings, sorted by name.
inline std::vector<std::string> shared_files_ending(const std::string& folder,
                                                    const std::vector<std::string>& endings) {
  const std::filesystem::path root = std::filesystem::path(source_root) / "../shared" / folder;
  std::vector<std::string> out;
  if (!std::filesystem::exists(root)) return out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
    if (std::ranges::find(endings, entry.path().extension().string()) != endings.end()) out.push_back(entry.path());
  std::ranges::sort(out);
  return out;
}

}  // namespace zoneplate
