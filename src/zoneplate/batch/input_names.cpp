// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/input_names.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/formats/assimp/assimp.h"
#include "zoneplate/formats/load.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

bool is_model(const std::string& path) {
  const std::string extension = extension_of(path);
  const auto has_it = [&](const SceneFormat& format) { return format.extension == extension; };
  return std::ranges::any_of(scene_formats(), has_it) || std::ranges::any_of(assimp_formats(), has_it);
}

// The models of a folder and of those in it, which links do not belong to. A folder that cannot be read is left out
// with a warning, unless it is the first.
std::vector<std::string> models_in(const std::string& folder, const std::function<void(const std::string&)>& warn) {
  std::vector<std::string> found;
  std::vector<fs::path> folders{folder};
  while (!folders.empty()) {
    const fs::path place = std::move(folders.back());
    folders.pop_back();
    std::error_code error, ignored;
    for (fs::directory_iterator entry(place, error), end; !error && entry != end; entry.increment(error)) {
      if (entry->is_directory(ignored) && !entry->is_symlink(ignored))
        folders.push_back(entry->path());
      else if (is_model(entry->path()) && (entry->is_regular_file(ignored) || !entry->exists(ignored)))
        found.push_back(entry->path());  // also a link that leads nowhere, whose item then fails
    }
    if (!error) continue;
    const std::string cause = place.string() + ": " + error.message();
    if (place == folder) throw Error(ErrorKind::Input, cause);
    warn(cause + "; its models are left out");
  }
  if (found.empty()) throw Error(ErrorKind::Input, folder + ": a folder without models (zoneplate list formats)");
  std::ranges::sort(found);
  return found;
}

}  // namespace

std::vector<std::string> with_folders_listed(const std::vector<std::string>& inputs,
                                             const std::function<void(const std::string&)>& warn) {
  std::vector<std::string> out;
  std::error_code ignored;
  for (const std::string& input : inputs) {
    if (!is_builtin_scene(input) && fs::is_directory(input, ignored)) {
      const std::vector<std::string> models = models_in(input, warn);
      out.insert(out.end(), models.begin(), models.end());
    } else {
      out.push_back(input);
    }
  }
  return out;
}

void check_input(const std::string& input, const std::string& format) {
  std::error_code ignored;
  if (input == "-" || (format.empty() && is_builtin_scene(input))) return;
  if (!fs::exists(input, ignored))
    throw Error(ErrorKind::Input, input + ": no such file, and no built-in scene of that name");
  if (format.empty() && !is_model(input))
    throw Error(ErrorKind::Input, input + ": not a format that can be read (zoneplate list formats)");
}

}  // namespace zoneplate
