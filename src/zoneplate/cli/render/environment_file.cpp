// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/environment_file.h"

#include <fmt/format.h>

#include <cstdlib>
#include <new>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/cli/process/item_process.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/os/cache_folder.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/os/memory_limit.h"
#include "zoneplate/shade/environment/equirectangular.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/environment/studio.h"

namespace zoneplate::cli {
namespace {

using Map = std::shared_ptr<const PreparedEnvironment>;

constexpr std::string_view environment_extension = ".env";

std::string absolute_variable(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr && value[0] == '/' ? value : "";
}

/// The environment of a file of the cache; null where there is none, or a damaged one.
Map read_cached(const std::string& cache, std::uint64_t key) {
  const std::optional<CacheFolder> folder = CacheFolder::open(cache);
  if (!folder) return nullptr;
  const std::optional<FileBytes> file = folder->read(environment_name(key), PreparedEnvironment::most_bytes());
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

std::string environment_cache() {
  if (const std::string cache = absolute_variable("XDG_CACHE_HOME"); !cache.empty()) return cache + "/zoneplate";
  const std::string home = absolute_variable("HOME");
  return home.empty() ? "" : home + "/.cache/zoneplate";
}

std::string environment_name(std::uint64_t key) { return fmt::format("{:016x}{}", key, environment_extension); }

void store_environment(const std::string& cache, std::uint64_t key, std::span<const std::uint8_t> bytes) {
  const std::optional<CacheFolder> folder = CacheFolder::make(cache);
  if (!folder) return;
  folder->store(environment_name(key), bytes);
  folder->trim(environment_extension, most_cache_bytes);
}

std::vector<std::string> environment_files(const RenderArgs& args) {
  constexpr std::string_view face = "{face}";
  const std::string& name = args.hdri_file;
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

  EnvironmentSource(const RenderArgs& args) : names(environment_files(args)) {
    for (const std::string& name : names) files.emplace_back(name, args.load.limits.memory);
  }

  /// The number of the prepared environment.
  std::uint64_t key(const RenderArgs& args) const {
    std::vector<std::uint64_t> parts = {args.hdri_layout ? 1 + static_cast<std::uint64_t>(*args.hdri_layout) : 0};
    for (const FileBytes& file : files) parts.push_back(content_hash(file.bytes()));
    return content_hash({reinterpret_cast<const std::uint8_t*>(parts.data()), parts.size() * sizeof parts[0]});
  }

  CubeImage cube(const RenderArgs& args) const {
    const LoadLimits& limits = args.load.limits;
    std::uint64_t need = 0;
    for (const FileBytes& file : files) need += decoded_image_memory(file.bytes()) + image_working_memory(file.bytes());
    ImportBudget(names.front(), limits).take(need);
    std::vector<TexelImage> images;
    for (std::size_t k = 0; k < files.size(); ++k)
      images.push_back(decode_image(files[k].bytes(), names[k], limits.pixels).whole());
    if (images.size() > 1) return cube_of(strip_of(images, names), EnvironmentLayout::Strip);
    const TexelImage& image = images.front();
    return cube_of(image, args.hdri_layout.value_or(layout_of(image.width(), image.height())));
  }
};

/// Calls `read` within the limit of time. Errors about limits name the image, not the model that it lights.
void read_environment(const RenderArgs& args, const std::function<void()>& read) {
  try {
    within_import_time("--hdri-file " + args.hdri_file, args.load.limits, read);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::Input,
                fmt::format("--hdri-file {}: reading it needs more memory than the limit of {}", args.hdri_file,
                            memory_limit_text(args.load.limits.memory, "--max-memory")));
  }
}

}  // namespace

Map Environments::load(const RenderArgs& args, const Store& store, const Progress& progress) const {
  const MappedFileWatch watch;
  std::optional<EnvironmentSource> source;
  read_environment(args, [&] { source.emplace(args); });
  const Map map = find_or_make(args.cache, source->key(args), store, [&] {
    CubeImage cube;
    read_environment(args, [&] { cube = source->cube(args); });
    return PreparedEnvironment(cube, progress);
  });
  watch.check(args.hdri_file);
  return map;
}

void Environments::complete(RenderArgs& args, const Store& store, const Progress& progress) {
  args.lighting.studio = [this, cache = args.cache, store] {
    if (!studio_) studio_ = find_or_make(cache, studio_key_number(), store, prepare_studio);
    return studio_;
  };
  if (args.is_in_studio) args.lighting.environment->map = args.lighting.studio();
  if (args.hdri_file.empty()) return;
  const std::string key =
      fmt::format("{} {}", args.hdri_layout ? static_cast<int>(*args.hdri_layout) : -1, args.hdri_file);
  if (key != key_) {
    map_ = load(args, store, progress);
    key_ = key;
  }
  args.lighting.environment->map = map_;
}

void complete_environments(Environments& environments, RenderArgs& args, const Environments::Store& store,
                           ItemSender& sender) {
  bool is_filtering = false;
  if (!args.hdri_file.empty()) sender.begins_to_read("--hdri-file " + args.hdri_file);
  const auto report = sender.progress_of("environment", 0, 0.1);
  environments.complete(args, store, [&](double done) {
    if (!is_filtering) sender.has_read(), is_filtering = true;
    report(done);
  });
  if (is_filtering || !args.hdri_file.empty()) sender.begins_to_read();
}

}  // namespace zoneplate::cli
