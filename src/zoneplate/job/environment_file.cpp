// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/environment_file.h"

#include <fmt/format.h>

#include <new>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/os/cache_folder.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/os/memory_limit.h"
#include "zoneplate/shade/environment/equirectangular.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/environment/studio.h"

namespace zoneplate {
namespace {

using Map = std::shared_ptr<const PreparedEnvironment>;

constexpr std::string_view environment_extension = ".env";

/// The environment of a file of the cache; null where there is none, or a damaged one.
Map read_cached(const std::string& cache, std::uint64_t key) {
  const std::optional<CacheFolder> folder = CacheFolder::open(cache);
  if (!folder) return nullptr;
  const std::optional<FileBytes> file = folder->read(environment_name(key), PreparedEnvironment::max_bytes());
  if (!file) return nullptr;
  std::optional<PreparedEnvironment> found = PreparedEnvironment::from_bytes(file->bytes());
  return found ? std::make_shared<const PreparedEnvironment>(std::move(*found)) : nullptr;
}

/// An environment of the cache, or a new one, which is stored there.
Map find_or_make(const std::string& cache, std::uint64_t key, const Environments::Store& store,
                 const std::function<PreparedEnvironment()>& make) {
  if (!cache.empty())
    if (Map found = read_cached(cache, key)) return found;
  const Map made = growing("environment", [&] { return std::make_shared<const PreparedEnvironment>(make()); });
  if (!cache.empty() && store) store(key, made->bytes());
  return made;
}

}  // namespace

std::string environment_name(std::uint64_t key) { return fmt::format("{:016x}{}", key, environment_extension); }

void store_environment(const std::string& cache, std::uint64_t key, std::span<const std::uint8_t> bytes) {
  const std::optional<CacheFolder> folder = CacheFolder::make(cache);
  if (!folder) return;
  folder->store(environment_name(key), bytes);
  folder->trim(environment_extension, max_cache_bytes);
}

std::vector<std::string> environment_files(const Job& job) {
  constexpr std::string_view face = "{face}";
  const std::string& name = job.hdri_file;
  if (name.empty()) return {};
  const std::size_t at = name.find(face);
  if (at == name.npos) return {name};
  std::vector<std::string> files;
  for (const char* of_face : {"px", "nx", "py", "ny", "pz", "nz"})
    files.push_back(std::string(name).replace(at, face.size(), of_face));
  return files;
}

namespace {

/// The squares of a cube map side by side.
TexelImage strip_of(const std::vector<TexelImage>& squares, const std::vector<std::string>& names) {
  const int side = squares.front().width();
  Plane<float4> strip(side * static_cast<int>(squares.size()), side);
  for (std::size_t k = 0; k < squares.size(); ++k) {
    const int width = squares[k].width(), height = squares[k].height();
    if (width != side || height != side)
      throw Error(ErrorKind::Input, fmt::format("{}: is {} x {} pixels, expected a square of {} x {}, as {}", names[k],
                                                width, height, side, side, names.front()));
    const Plane<float3> light = light_of(squares[k]);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const float3 c = light(x, y);
        strip(side * static_cast<int>(k) + x, y) = {c.x, c.y, c.z, 1};
      }
  }
  return strip;
}

/// The files of an environment, open.
struct EnvironmentSource {
  std::vector<std::string> names;
  std::vector<FileBytes> files;

  EnvironmentSource(const Job& job) : names(environment_files(job)) {
    for (const std::string& name : names) files.emplace_back(name, job.load.limits.memory);
  }

  /// The number of the prepared environment.
  std::uint64_t key(const Job& job) const {
    std::vector<std::uint64_t> parts = {job.hdri_layout ? 1 + static_cast<std::uint64_t>(*job.hdri_layout) : 0};
    for (const FileBytes& file : files) parts.push_back(content_hash(file.bytes()));
    return content_hash({reinterpret_cast<const std::uint8_t*>(parts.data()), parts.size() * sizeof parts[0]});
  }

  CubeImage cube(const Job& job) const {
    const LoadLimits& limits = job.load.limits;
    std::uint64_t need = 0;
    for (const FileBytes& file : files) need += decoded_image_memory(file.bytes()) + image_working_memory(file.bytes());
    ImportBudget(names.front(), limits).take(need);
    std::vector<TexelImage> images;
    for (std::size_t k = 0; k < files.size(); ++k)
      images.push_back(decode_image(files[k].bytes(), names[k], limits.pixels).whole());
    if (images.size() > 1) return cube_of(strip_of(images, names), EnvironmentLayout::Strip);
    const TexelImage& image = images.front();
    return cube_of(image, job.hdri_layout.value_or(layout_of(image.width(), image.height())));
  }
};

/// Calls `read` within the limit of time. Errors about limits name the image, not the model that it lights.
void read_environment(const Job& job, const std::function<void()>& read) {
  try {
    within_import_time("--hdri-file " + job.hdri_file, job.load.limits, read);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::Input,
                fmt::format("--hdri-file {}: reading it needs more memory than the limit of {}", job.hdri_file,
                            memory_limit_text(job.load.limits.memory, "--max-memory")));
  }
}

}  // namespace

Map Environments::load(const Job& job, const Store& store, const Progress& progress) const {
  const MappedFileWatch watch;
  std::optional<EnvironmentSource> source;
  read_environment(job, [&] { source.emplace(job); });
  const Map map = find_or_make(job.cache, source->key(job), store, [&] {
    CubeImage cube;
    read_environment(job, [&] { cube = source->cube(job); });
    return PreparedEnvironment(cube, progress);
  });
  watch.check(job.hdri_file);
  return map;
}

void Environments::complete(Job& job, const Store& store, const Progress& progress) {
  job.lighting.studio = shared_studio;
  if (!job.cache.empty())
    job.lighting.studio = [this, cache = job.cache, store] {
      if (!studio_) studio_ = find_or_make(cache, studio_key_number(), store, prepare_studio);
      return studio_;
    };
  if (job.is_in_studio) job.lighting.environment->map = job.lighting.studio();
  if (job.hdri_file.empty()) return;
  const std::string key =
      fmt::format("{} {}", job.hdri_layout ? static_cast<int>(*job.hdri_layout) : -1, job.hdri_file);
  if (key != key_) {
    map_ = load(job, store, progress);
    key_ = key;
  }
  job.lighting.environment->map = map_;
}

std::function<Map()> prepared_studio(const std::string& cache) {
  const auto store = [&](std::uint64_t key, auto bytes) { store_environment(cache, key, bytes); };
  Map studio;
  with_threads(thread_limit(), [&] { studio = find_or_make(cache, studio_key_number(), store, prepare_studio); });
  return [studio] { return studio; };
}

void complete_environments(Environments& environments, Job& job, const Environments::Store& store, JobSink& sink) {
  bool is_filtering = false;
  if (!job.hdri_file.empty()) sink.begins_to_read("--hdri-file " + job.hdri_file);
  const auto report = sink.progress_of("environment", 0, 0.1);
  environments.complete(job, store, [&](double done) {
    if (!is_filtering) sink.has_read(), is_filtering = true;
    if (report) report(done);
  });
  if (is_filtering || !job.hdri_file.empty()) sink.begins_to_read("");
}

}  // namespace zoneplate
