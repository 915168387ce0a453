// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/environment_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/environment/studio.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;
using Map = std::shared_ptr<const PreparedEnvironment>;

/// A prepared environment of the largest side takes 45 MB.
constexpr std::uint64_t most_bytes = std::uint64_t{1} << 26;

std::string absolute_variable(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr && value[0] == '/' ? value : "";
}

/// The environment of a file of the cache; null where there is none, or a damaged one.
Map read_cached(const std::string& path) {
  std::error_code ignored;
  if (path.empty() || !fs::is_regular_file(path, ignored)) return nullptr;
  try {
    const FileBytes file(path, most_bytes);
    std::optional<PreparedEnvironment> found = PreparedEnvironment::from_bytes(file.bytes());
    return found ? std::make_shared<const PreparedEnvironment>(std::move(*found)) : nullptr;
  } catch (const Error&) {
    return nullptr;
  }
}

/// An environment of the cache, or a new one, which is stored there.
Map find_or_make(const std::string& cache, std::uint64_t key, const Environments::Store& store,
                 const std::function<PreparedEnvironment()>& make) {
  if (!cache.empty())
    if (Map found = read_cached(environment_path(cache, key))) return found;
  const Map made = growing("environment", [&] { return std::make_shared<const PreparedEnvironment>(make()); });
  if (!cache.empty() && store) store(key, made->bytes());
  return made;
}

}  // namespace

std::string environment_cache() {
  if (const std::string cache = absolute_variable("XDG_CACHE_HOME"); !cache.empty()) return cache + "/zoneplate";
  const std::string home = absolute_variable("HOME");
  return home.empty() ? "" : home + "/.cache/zoneplate";
}

std::string environment_path(const std::string& cache, std::uint64_t key) {
  return fmt::format("{}/{:016x}.env", cache, key);
}

void store_environment(const std::string& path, std::uint64_t size,
                       const std::function<void(std::span<std::uint8_t>)>& read) {
  if (size > most_bytes) throw Error(ErrorKind::Failed, path + ": larger than any prepared environment");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  read(bytes);
  std::error_code failure;
  fs::create_directories(fs::path(path).parent_path(), failure);
  if (failure) return;
  try {
    save_bytes(path, bytes);
  } catch (const Error&) {  // of a cache that cannot be written
  }
}

Map Environments::load(const RenderArgs& args, const Store& store) const {
  const std::string& path = args.hdri_file;
  const LoadLimits& limits = args.load.limits;
  const MappedFileWatch watch;
  const FileBytes file(path, limits.memory);
  const Map map = find_or_make(args.cache, content_hash(file.bytes()), store, [&] {
    ImportBudget budget(path, limits);
    budget.take(decoded_image_memory(file.bytes()) + image_working_memory(file.bytes()));
    return prepare_equirectangular(decode_image(file.bytes(), path, limits.pixels));
  });
  watch.check(path);
  return map;
}

void Environments::complete(RenderArgs& args, const Store& store) {
  args.lighting.studio = [this, cache = args.cache, store] {
    if (!studio_) studio_ = find_or_make(cache, studio_key_number(), store, prepare_studio);
    return studio_;
  };
  if (args.hdri_file.empty()) return;
  if (args.hdri_file != file_) {
    map_ = load(args, store);
    file_ = args.hdri_file;
  }
  args.lighting.environment->map = map_;
}

}  // namespace zoneplate::cli
