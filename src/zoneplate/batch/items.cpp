// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/items.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/batch/item_files.h"
#include "zoneplate/batch/program_name.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/output/film.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/os/cache_folder.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/usage.h"
#include "zoneplate/process/packed_summary.h"
#include "zoneplate/shade/environment/prepared_environment.h"

namespace zoneplate {
namespace {

/// The limits of several items with one model.
ItemLimits limits_of(const std::vector<BatchItem>& items, const RunEvents& events, LimitedChildren* siblings) {
  const BatchItem& args = items.front();
  std::vector<std::string> readable;
  for (const BatchItem& item : items)
    for (std::string& path : item_readable_paths(item)) readable.push_back(std::move(path));
  return {.name = args.input == "-" ? "standard input" : args.input,
          .load = args.load.limits,
          .seconds = args.max_seconds,
          .is_sandboxed = uses_sandbox(args.is_sandboxed, events.warn),
          .readable = std::move(readable),
          .ignores_termination = args.grace > 0,
          .siblings = siblings};
}

// Passes `size` bytes on in parts, so that a large file is never in memory as a whole.
template <class Take>
void for_parts(std::uint64_t size, const ItemEvents::Read& read, Take take) {
  std::vector<std::uint8_t> part(static_cast<std::size_t>(std::min<std::uint64_t>(size, 1 << 20)));
  for (std::uint64_t left = size; left > 0;) {
    const std::span<std::uint8_t> some(part.data(),
                                       static_cast<std::size_t>(std::min<std::uint64_t>(left, part.size())));
    read(some);
    take(some);
    left -= some.size();
  }
}

std::vector<BatchItem> with_finished_frames(std::vector<BatchItem> items, const Ledger* ledger) {
  for (BatchItem& item : items) item.sequence.finished = finished_frames(item, ledger);
  return items;
}

}  // namespace

std::vector<std::string> item_readable_paths(const BatchItem& item) {
  std::vector<std::string> paths = readable_paths(item.input, item.load);
  for (std::string& path : environment_files(item)) paths.push_back(std::move(path));
  if (CacheFolder::open(item.cache)) paths.push_back(item.cache);
  for (std::string& path : item.default_material.files()) paths.push_back(std::move(path));
  return paths;
}

EnvironmentStorer environment_storer(const BatchItem& item) {
  return [&item](std::uint64_t key, std::uint64_t size, const ItemEvents::Read& read) {
    if (item.cache.empty() || size > PreparedEnvironment::max_bytes())
      throw Error(ErrorKind::Failed, item.input + ": an environment that no cache takes");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    read(bytes);
    store_environment(item.cache, key, bytes);
  };
}

RenderItems::RenderItems(std::vector<BatchItem> items, RunEvents events, LimitedChildren* siblings, Ledger* ledger)
    : events_(std::move(events)),
      ledger_(ledger),
      items_(with_finished_frames(std::move(items), ledger)),
      process_(limits_of(items_, events_, siblings), items_.size(),
               [this, jobs = std::make_shared<RenderJobs>()](std::size_t i, ItemSender& sender) {
                 if (!events_.progress) sender.mute_progress();
                 Summary summary = jobs->run(items_[i], sender);
                 summary.peak_memory = peak_memory();
                 return pack_summary(summary);
               }) {}

/// A file that has its name now.
void RenderItems::record(const BatchItem& args, const std::string& path, std::uint64_t bytes, Sha256& digest) {
  if (ledger_ == nullptr || path == "-") return;
  ledger_->add_file(path, {.item = args.number,
                           .bytes = bytes,
                           .sha256 = digest.hex(),
                           .job = job_digest(args),
                           .program = program_name()});
}

Summary RenderItems::next() {
  const BatchItem& args = items_[next_++];
  const Stopwatch total;
  double write_ms = 0;
  std::string last_image;
  const auto check_time = [&] {
    if (total.ms() / 1000 > args.max_seconds)
      throw Error(ErrorKind::Failed,
                  fmt::format("{}: waits for ffmpeg longer than the limit of {:.6g} s (--max-seconds)", args.input,
                              args.max_seconds));
  };
  std::optional<FfmpegFilm> film;
  ItemEvents events;
  events.progress = events_.progress;
  events.file = [&](int frame, int layer, std::uint64_t size, const ItemEvents::Read& read) {
    const Stopwatch watch;
    if (layer >= static_cast<int>(args.aovs.size()))
      throw Error(ErrorKind::Failed, args.input + ": an unknown data pass");
    const std::string path = output_path(args, frame, layer);
    FileWriter file(path);
    Sha256 digest;
    for_parts(size, read, [&](std::span<const std::uint8_t> part) {
      file.write(part);
      if (ledger_ != nullptr) digest.add(part);
    });
    file.commit();
    record(args, path, size, digest);
    if (layer < 0) last_image = path;
    write_ms += watch.ms();
  };
  events.film_frame = [&](std::uint64_t size, const ItemEvents::Read& read) {
    const std::optional<Crop>& crop = args.options.crop;
    const int width = crop ? crop->width : args.options.width, height = crop ? crop->height : args.options.height;
    if (size != std::uint64_t{4} * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height))
      throw Error(ErrorKind::Failed, args.input + ": a frame of another size than the film's");
    if (!film) film.emplace(args.output, width, height, film_format(args.sequence.rate), check_time);
    for_parts(size, read, [&](std::span<const std::uint8_t> part) { film->add(part); });
  };

  events.environment = environment_storer(args);

  Summary summary = unpack_summary(process_.next(std::move(events)));
  if (film) {
    const Stopwatch watch;
    if (events_.progress) events_.progress("encode", 1);
    const std::vector<std::uint8_t> encoded = film->encode();
    save_bytes(args.output, encoded);
    Sha256 digest;
    if (ledger_ != nullptr) digest.add(encoded);
    record(args, args.output, encoded.size(), digest);
    write_ms += watch.ms();
  }
  summary.output = summary.frames == 1 && !last_image.empty() ? last_image : args.output;
  for (auto& [name, ms] : summary.times) {
    if (name == "write") ms = write_ms;
    if (name == "total") ms = std::max(ms + write_ms, total.ms());  // `total` is short if the process began earlier
  }
  return summary;
}

}  // namespace zoneplate
