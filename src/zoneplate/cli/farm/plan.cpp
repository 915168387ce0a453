// SPDX-License-Identifier: Apache-2.0
// zoneplate plan: what a batch costs, from a sample of its items, and into how many tasks it is divided.
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/size_text.h"
#include "zoneplate/batch/item_files.h"
#include "zoneplate/batch/ledger.h"
#include "zoneplate/cli/render/batch.h"
#include "zoneplate/cli/render/batch_items.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/report/report_version.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

struct PlanArgs {
  int sample = 100;
  double task_seconds = 60;
  std::optional<std::uint64_t> shards;
};

/// The most tasks of an array in Slurm's default configuration (MaxArraySize 1001).
constexpr std::uint64_t max_shards = 1000;

/// A folder that is removed with its contents.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    path_ = (fs::temp_directory_path() / "zoneplate-plan-XXXXXX").string();
    if (::mkdtemp(path_.data()) == nullptr)
      throw Error(ErrorKind::Output, fmt::format("{}: cannot be made: {}", path_, std::strerror(errno)));
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Moves the output of an item into a folder of its own in here, the folder of frames included.
  void take_output(RenderArgs& args) const {
    const std::size_t cut = folder_end(args);
    const std::string folder = fmt::format("{}/{}/", path_, args.number);
    args.output = folder + args.output.substr(cut);
    if (args.frame_place) args.frame_place->begin += folder.size() - cut;
  }
  /// The bytes of an item's files, which are removed.
  std::uint64_t take_bytes(std::uint64_t item) const {
    const std::string folder = fmt::format("{}/{}", path_, item);
    std::uint64_t bytes = 0;
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
      if (entry->is_regular_file(error)) bytes += entry->file_size(error);
    fs::remove_all(folder, error);
    return bytes;
  }

 private:
  std::string path_;
};

/// What is known of the items before they are rendered.
struct Inputs {
  std::vector<std::uint64_t> bytes;  ///< of the models' files; 0 for built-in scenes and items that will fail
  std::vector<std::string> models;   ///< items of one key share a model
};

Inputs look_at(BatchItems& items) {
  Inputs out;
  for (std::uint64_t i = 0; i < items.count(); ++i) try {
      const RenderArgs args = items.args(i);
      std::error_code error;
      const std::uint64_t bytes = fs::file_size(args.input, error);
      out.bytes.push_back(error ? 0 : bytes);
      out.models.push_back(model_key(args));
    } catch (const Error&) {
      out.bytes.push_back(0);
      out.models.emplace_back();
    }
  return out;
}

/// `most` items in equal distances of the order of their models' sizes, which spread over all sizes; in their order.
std::vector<std::uint64_t> sample_of(const Inputs& inputs, std::size_t most) {
  std::vector<std::uint64_t> order(inputs.bytes.size());
  std::iota(order.begin(), order.end(), std::uint64_t{0});
  std::ranges::stable_sort(order, {}, [&](std::uint64_t i) { return inputs.bytes[i]; });
  const std::size_t count = std::min(most, order.size());
  std::vector<std::uint64_t> sample;
  for (std::size_t i = 0; i < count; ++i) sample.push_back(order[(2 * i + 1) * order.size() / (2 * count)]);
  std::ranges::sort(sample);
  return sample;
}

/// The fraction of items that read their model, because that before them in the list has another one.
double reading_fraction(const std::vector<std::string>& models, std::span<const std::uint64_t> items) {
  std::size_t reading = 0;
  for (std::size_t i = 0; i < items.size(); ++i) reading += i == 0 || models[items[i]] != models[items[i - 1]];
  return static_cast<double>(reading) / static_cast<double>(items.size());
}
/// The same in all of `shards` shards.
double reading_fraction(const std::vector<std::string>& models, std::uint64_t shards) {
  std::size_t reading = 0;
  for (std::size_t i = 0; i < models.size(); ++i) reading += i < shards || models[i] != models[i - shards];
  return static_cast<double>(reading) / static_cast<double>(models.size());
}

/// The result of a sample.
struct Sample {
  std::vector<double> seconds = {};   ///< of each item, while others render at the same time
  double wall = 0, start = 0;         ///< of all of them; and once for each task
  double read_share = 0;              ///< of the items' time
  double reading = 1;                 ///< fraction of items that read their model
  std::uint64_t bytes = 0, peak = 0;  ///< of the files; of the memory of the largest item
  std::uint64_t failed = 0;
};

Sample render_sample(const RenderArgs& common, BatchItems& items, const Inputs& inputs,
                     std::span<const std::uint64_t> numbers) {
  const TemporaryFolder folder;
  const auto complete = [&](RenderArgs& args) { folder.take_output(args); };
  Sample out;
  double read_ms = 0, total_ms = 0;
  const auto took = [&](const RenderArgs& args, const Summary& summary) {
    out.seconds.push_back(summary.total_ms() / 1000);
    out.bytes += folder.take_bytes(args.number);
    out.peak = std::max(out.peak, summary.peak_memory);
    total_ms += summary.total_ms();
    for (const auto& [name, ms] : summary.times)
      if (name == "read" || name == "textures") read_ms += ms;
  };
  // The first item alone has the costs of a start, such as the light of the studio.
  const Stopwatch first;
  render_sample(common, items, numbers.first(1), complete, took);
  const double first_seconds = first.ms() / 1000;
  const Stopwatch again;
  out = {}, read_ms = total_ms = 0;
  render_sample(common, items, numbers.first(1), complete, took);
  out = {.start = std::max(first_seconds - again.ms() / 1000, 0.0)}, read_ms = total_ms = 0;
  const Stopwatch watch;
  out.failed = render_sample(common, items, numbers, complete, took);
  out.wall = watch.ms() / 1000;
  out.read_share = total_ms > 0 ? read_ms / total_ms : 0;
  out.reading = reading_fraction(inputs.models, numbers);
  return out;
}

/// Twice the standard error of the mean, relative to it: of independent items, which is more than that of this sample.
double relative_error(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  if (values.size() < 2) return 1;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return mean > 0 ? 2 * std::sqrt(squares / (n - 1) / n) / mean : 0;
}

/// The costs of the whole batch.
struct Costs {
  std::uint64_t items = 0, shards = 1, items_per_task = 0, bytes = 0, memory = 0;
  double seconds = 0, task_seconds = 0;  ///< of all items, without the starts; of a task with its start
};

Costs costs_of(const PlanArgs& plan, const RenderArgs& common, const Inputs& inputs, const Sample& sample,
               std::size_t sampled) {
  Costs out{.items = inputs.models.size()};
  const double scale = static_cast<double>(out.items) / static_cast<double>(sampled);
  const auto seconds_of = [&](std::uint64_t shards) {
    const double reading = reading_fraction(inputs.models, shards) / sample.reading;
    return sample.wall * scale * (1 - sample.read_share + sample.read_share * reading);
  };
  // More shards may have to read more models, and take longer.
  const auto shards_for = [&](double seconds) {
    return std::clamp<std::uint64_t>(static_cast<std::uint64_t>(seconds / plan.task_seconds), 1,
                                     std::min(max_shards, out.items));
  };
  out.shards = plan.shards ? *plan.shards : shards_for(seconds_of(shards_for(seconds_of(1))));
  out.seconds = seconds_of(out.shards);
  out.items_per_task = (out.items + out.shards - 1) / out.shards;
  out.task_seconds = sample.start + out.seconds / static_cast<double>(out.shards);
  constexpr double record_bytes = 400;  // of a file and a result in the ledger
  out.bytes = static_cast<std::uint64_t>(scale * static_cast<double>(sample.bytes) +
                                         record_bytes * static_cast<double>(out.items));
  constexpr std::uint64_t own_bytes = std::uint64_t{64} << 20;  // of the process that writes, and of waiting results
  out.memory = sample.peak * max_at_once(common.load.limits.memory) + own_bytes;
  return out;
}

std::string time_text(double seconds) {
  if (seconds < 120) return fmt::format("{:.1f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.1f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

void print_plan(const RenderArgs& common, const Costs& costs, const Sample& sample, std::size_t sampled) {
  const double error = relative_error(sample.seconds);
  const std::string array = costs.shards == 1 ? "0" : fmt::format("0-{}", costs.shards - 1);
  if (::isatty(STDOUT_FILENO) == 1 && !common.prints_json) {
    print(fmt::format("{} items, of which {} were rendered{}\n", costs.items, sampled,
                      sample.failed > 0 ? fmt::format(" and {} failed", sample.failed) : "") +
          fmt::format("time    {} on this machine with {} threads (± {:.0f} %), {:.2f} core hours\n",
                      time_text(costs.seconds), thread_limit(), error * 100, costs.seconds * thread_limit() / 3600) +
          fmt::format("disk    {}\nmemory  {} for each task\n", size_text(costs.bytes), size_text(costs.memory)) +
          fmt::format("tasks   {} of {} items and {} each: --array={} --shard auto/{}\n", costs.shards,
                      costs.items_per_task, time_text(costs.task_seconds), array, costs.shards));
    return;
  }
  print(Json(Json::Object{{"format", "zoneplate-plan"},
                          {"version", report_version},
                          {"items", costs.items},
                          {"sample", std::uint64_t{sampled}},
                          {"failed", sample.failed},
                          {"threads", thread_limit()},
                          {"seconds", costs.seconds},
                          {"relative_error", error},
                          {"core_hours", costs.seconds * thread_limit() / 3600},
                          {"start_seconds", sample.start},
                          {"disk_bytes", costs.bytes},
                          {"memory_bytes", costs.memory},
                          {"shards", costs.shards},
                          {"items_per_task", costs.items_per_task},
                          {"task_seconds", costs.task_seconds},
                          {"array", array}})
            .text() +
        '\n');
}

constexpr const char* plan_examples =
    "  zoneplate plan jobs.jsonl --size 512 --threads 1 --ledger out/ledger\n"
    "  zoneplate plan models/ -o thumbs/ --size 512 --task-seconds 300 --json\n";

constexpr const char* plan_notes =
    "IN, OUT and the options are those of the batch (zoneplate render); a single IN that ends with .jsonl is its\n"
    "manifest. A sample of the items, spread over the sizes of their models, is rendered into a temporary folder\n"
    "($TMPDIR), as the batch would: give --threads as the tasks will have. With --ledger the number of shards is\n"
    "pinned there, and --shard auto takes it. The models are not copied: their disk is not counted.\n";

}  // namespace

void run_plan(std::span<const std::string> arguments) {
  PlanArgs plan;
  const std::optional<RenderArgs> common = parse_render_args(arguments, [&](Syntax& syntax) {
    syntax.verb = "plan", syntax.summary = "Estimate the time, disk and memory of a batch, and divide it into tasks";
    syntax.operands = "MANIFEST | IN... -o OUT", syntax.examples = plan_examples, syntax.notes = plan_notes;
    const std::string group = "Batches";
    syntax.options.push_back({"--sample", "N", "Number of items that are rendered; default 100", group, false,
                              [&](auto& text) { plan.sample = parse_whole(text, 1, 100'000); }});
    syntax.options.push_back({"--task-seconds", "S", "Least time of a task; default 60", group, false,
                              [&](auto& text) { plan.task_seconds = parse_number(text, 0.001, 1e7); }});
    syntax.options.push_back(
        {"--shards", "N", "Number of tasks; default: as many as take --task-seconds or more, at most 1000", group,
         false, [&](auto& text) { plan.shards = static_cast<std::uint64_t>(parse_whole(text, 1, 1'000'000'000)); }});
  });
  if (!common) return;
  if (common->is_dry_run) throw Error(ErrorKind::Usage, "--dry-run is for render: plan measures items that it renders");
  BatchItems items(*common);
  if (items.count() == 0) throw Error(ErrorKind::Input, common->manifest + ": no items");
  const auto pin_shards = [&](std::uint64_t shards) {
    if (common->ledger.empty()) return;
    BatchPin own = items.pin();
    own.shards = shards;
    pin(common->ledger, own, common->load.limits);
  };
  // A batch that is begun keeps its number of shards; another one is refused before the sample is rendered.
  const std::optional<BatchPin> pinned =
      common->ledger.empty() ? std::nullopt : find_pin(common->ledger, common->load.limits);
  if (pinned && !plan.shards) plan.shards = pinned->shards;
  if (pinned) pin_shards(*plan.shards);
  const Inputs inputs = look_at(items);
  const std::vector<std::uint64_t> numbers = sample_of(inputs, static_cast<std::size_t>(plan.sample));
  with_isa(common->isa, [&] {
    with_threads(common->threads, [&] {
      const Sample sample = render_sample(*common, items, inputs, numbers);
      if (sample.seconds.empty()) throw Error(ErrorKind::Failed, "no item of the sample could be rendered");
      const Costs costs = costs_of(plan, *common, inputs, sample, numbers.size());
      pin_shards(costs.shards);
      print_plan(*common, costs, sample, numbers.size());
    });
  });
}

}  // namespace zoneplate::cli
