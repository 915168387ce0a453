// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/job/job.h"
#include "zoneplate/job/job_sink.h"

namespace zoneplate {

/// The name of a prepared environment in the folder.
std::string environment_name(std::uint64_t key);

/// The files of --hdri-file: one, or the six squares of a cube map; none where it is not given.
std::vector<std::string> environment_files(const Job& job);

/// Stores an environment that was prepared, and removes others that exceed `max_cache_bytes`. The
/// cache is an optimisation: nothing happens where it cannot be written.
void store_environment(const std::string& cache, std::uint64_t key, std::span<const std::uint8_t> bytes);
inline constexpr std::uint64_t max_cache_bytes = std::uint64_t{256} << 20;

/// The studio of the default light, from that folder or stored there; for processes that are forked afterwards and
/// share it: the threads that prepare it have ended then.
std::function<std::shared_ptr<const PreparedEnvironment>()> prepared_studio(const std::string& cache);

/// The environments of jobs, one after the other.
class Environments {
 public:
  /// Takes the bytes of an environment that was not in the cache, by its key.
  using Store = std::function<void(std::uint64_t key, std::span<const std::uint8_t> bytes)>;
  using Progress = std::function<void(double done)>;

  /// Reads and filters the image of --hdri-file, if it is given, into the environment of `job.lighting`, and lets the
  /// default light take its studio from here. Both are taken from the cache of `job`, or else prepared and given to
  /// `store`, if it is not empty. While that image is filtered, `progress` takes the fraction that is complete, if it
  /// is not empty.
  ///
  /// Requires  this object and `store` outlive the use of `job`.
  /// Errors    ErrorKind::Input naming the file: missing, no image, too large for --max-memory or --max-pixels, or not
  ///           read within --max-import-seconds, which does not count the time of filtering.
  void complete(Job& job, const Store& store = {}, const Progress& progress = {});

 private:
  using Map = std::shared_ptr<const PreparedEnvironment>;
  Map load(const Job& job, const Store& store, const Progress& progress) const;

  std::string key_;  ///< of `map_`: its files and layout
  Map map_, studio_;
};

/// Environments::complete of a job that runs: reports the progress of filtering, whose time the limit of reading does
/// not count.
void complete_environments(Environments& environments, Job& job, const Environments::Store& store, JobSink& sink);

}  // namespace zoneplate
