// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/cli/process/item_messages.h"
#include "zoneplate/cli/render/args.h"

namespace zoneplate::cli {

/// The folder of prepared environments (os/cache_folder.h): zoneplate in $XDG_CACHE_HOME, or else in $HOME/.cache;
/// empty where neither is an absolute path.
std::string environment_cache();

/// The name of a prepared environment in the folder.
std::string environment_name(std::uint64_t key);

/// The files of --hdri-file: one, or the six squares of a cube map; none where it is not given.
std::vector<std::string> environment_files(const RenderArgs& args);

/// Stores an environment that the item's process has prepared, and removes others that exceed `most_cache_bytes`. The
/// cache is an optimisation: nothing happens where it cannot be written.
void store_environment(const std::string& cache, std::uint64_t key, std::span<const std::uint8_t> bytes);
inline constexpr std::uint64_t most_cache_bytes = std::uint64_t{256} << 20;

/// The environments of an item's process.
class Environments {
 public:
  /// Takes the bytes of an environment that was not in the cache, by its key.
  using Store = std::function<void(std::uint64_t key, std::span<const std::uint8_t> bytes)>;
  using Progress = std::function<void(double done)>;

  /// Reads and filters the image of --hdri-file, if it is given, into the environment of `args.lighting`, and lets the
  /// default light take its studio from here. Both are taken from the cache of `args`, or else prepared and given to
  /// `store`, if it is not empty. While that image is filtered, `progress` takes the fraction that is complete, if it
  /// is not empty.
  ///
  /// Requires  this object and `store` outlive the use of `args`.
  /// Errors    ErrorKind::Input naming the file: missing, no image, too large for --max-memory or --max-pixels, or not
  ///           read within --max-import-seconds, which does not count the time of filtering.
  void complete(RenderArgs& args, const Store& store = {}, const Progress& progress = {});

 private:
  using Map = std::shared_ptr<const PreparedEnvironment>;
  Map load(const RenderArgs& args, const Store& store, const Progress& progress) const;

  std::string key_;  ///< of `map_`: its files and layout
  Map map_, studio_;
};

/// Environments::complete in an item's process: reports the progress of filtering, whose time the limit of reading does
/// not count.
void complete_environments(Environments& environments, RenderArgs& args, const Environments::Store& store,
                           ItemSender& sender);

}  // namespace zoneplate::cli
