// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/batch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/batch/input_names.h"
#include "zoneplate/batch/item_files.h"
#include "zoneplate/batch/items.h"
#include "zoneplate/batch/job_report.h"
#include "zoneplate/batch/output_files.h"
#include "zoneplate/batch/output_name.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/os/memory_limit.h"
#include "zoneplate/process/grace_period.h"
#include "zoneplate/process/item_error.h"
#include "zoneplate/report/report_version.h"

namespace zoneplate::cli {
namespace {

// The reports of a batch: lines of results, progress, and records of the ledger. The first line that cannot be written
// is the last that is tried: the images matter more than their reports.
class BatchReports {
 public:
  // `ledger` may be null.
  BatchReports(const RenderArgs& common, Ledger* ledger)
      : common_(common),
        ledger_(ledger),
        progress_(common.progress ? *common.progress : parse_progress("auto")),
        prints_text_(::isatty(STDOUT_FILENO) == 1 && !common.prints_json) {}

  void begin(const std::string& stage, double done) { progress_.begin(stage, done); }
  void warn(const std::string& text) {
    progress_.clear();
    say_warning(text);
  }
  void fail(const std::string& text) {
    progress_.clear();
    say_error(text);
  }
  // One line for a person at a terminal; failures are reported on stderr alone.
  void add_text(const std::string& text) {
    progress_.clear();
    if (prints_text_) print_line(text);
  }
  void add(Json::Object line) {
    progress_.clear();
    if (!prints_text_) print_line(Json(std::move(line)).text());
  }
  void record(std::uint64_t number, const Json::Object& line) {
    if (ledger_ == nullptr) return;
    Json::Object result{{"item", number}};
    for (const char* name : {"status", "error", "cause", "attempts", "frames", "seconds"})
      for (const auto& [key, value] : line)
        if (key == name) result.emplace_back(key, value);
    attempt([&] { ledger_->add_result(std::move(result)); });
  }
  void finish() const {
    if (!trouble_.empty()) throw Error(ErrorKind::Output, "not all reports could be printed: " + trouble_);
  }

 private:
  void print_line(const std::string& text) {
    if (common_.verbosity == Verbosity::Quiet) return;
    attempt([&] { common_.is_dry_run ? print(text + '\n') : print_report(text + '\n'); });
  }

  template <class Write>
  void attempt(const Write& write) {
    if (!trouble_.empty()) return;
    try {
      write();
    } catch (const Error& error) {
      trouble_ = error.what();
      say_error(trouble_ + "; the batch goes on without reports");
    }
  }

  const RenderArgs& common_;
  Ledger* const ledger_;
  Progress progress_;
  const bool prints_text_;
  std::string trouble_;  ///< why reports are no longer written; empty if they are
};

// Processes items, several at once, and reports them in order. Consecutive items with one model form a group, which is
// processed in one process.
class Batch {
 public:
  // `ledger` may be null.
  Batch(const RenderArgs& common, std::uint64_t size, Ledger* ledger, BatchResult took)
      : common_(common),
        ledger_(ledger),
        took_(std::move(took)),
        size_(size),
        threads_(thread_limit()),
        max_at_once_(max_at_once(common.load.limits.memory)),
        reports_(common, ledger) {}

  // Adds the item that `make` returns; if it throws, the item has failed.
  template <class Make>
  void add(const std::string& name, std::uint64_t number, const Make& make) {
    try {
      RenderArgs args = make();
      const bool is_alike = !groups_.empty() && groups_.back().is_open(args);
      if (!is_alike) add_group().is_ahead = can_be_ahead(args);
      groups_.back().items.push_back({name, number, std::move(args), nullptr});
    } catch (const std::exception&) {
      add_group().items.push_back({name, number, {}, std::current_exception()});
    }
  }

  std::uint64_t failed() const { return failed_; }

  void finish() {
    while (!groups_.empty()) report_first();
    if (failed_ > 0) throw PartialFailure(fmt::format("{} of {} items failed", failed_, count_));
    reports_.finish();
  }

 private:
  struct Item {
    std::string name;
    std::uint64_t number = 0;
    RenderArgs args;
    std::exception_ptr error;  ///< of its arguments
    bool is_rendered = false;  ///< by the group's process
  };
  struct Group {
    std::vector<Item> items;
    bool is_ahead = false;    ///< may be processed before all earlier items are complete
    bool is_started = false;  ///< `process` is complete
    std::optional<RenderItems> process;
    int threads = 1;  ///< of the process

    bool is_open(const RenderArgs& next) const {
      if (items.front().error || next.input == "-" || items.size() >= max_together) return false;
      const RenderArgs& args = items.front().args;
      return model_key(next) == model_key(args) && next.max_seconds == args.max_seconds &&
             next.is_sandboxed == args.is_sandboxed && can_be_ahead(next) == is_ahead;
    }
    bool is_working() const { return process && process->is_working(); }
  };
  static constexpr std::size_t max_together = 64;  // limits the delay of results in a long batch
  static constexpr std::size_t max_waiting = 8;    // groups for each that is processed, while the first one takes long

  // Whether an item's result may wait in memory. A sequence may be too large for that; and a process whose results are
  // not yet read may come to a stop, which a limit of time would count.
  static bool can_be_ahead(const RenderArgs& args) {
    return !args.sequence.is_sequence() && args.max_seconds == std::numeric_limits<double>::infinity();
  }

  Group& add_group() {
    while (groups_.size() >= max_waiting * max_at_once_) report_first();
    return groups_.emplace_back();
  }

  void start(Group& group) {
    group.is_started = true;
    std::vector<BatchItem> to_render;
    for (Item& item : group.items) {
      item.is_rendered = !item.error && !common_.is_dry_run && !is_finished(item.args, ledger_);
      if (item.is_rendered) to_render.push_back(item.args);
    }
    if (to_render.empty()) return;
    group.threads = threads_ / static_cast<int>(std::min(max_at_once_, groups_.size()));
    group.process.emplace(std::move(to_render), RunEvents{.warn = say_warning}, &processes_, ledger_);
    with_threads(group.threads, [&] { group.process->start_ahead(); });
  }

  // Starts the first group, and as many of the next ones as can be processed at the same time.
  void start_some() {
    std::size_t working = 0;
    for (const Group& group : groups_) working += group.is_working() ? 1 : 0;
    for (Group& group : groups_) {
      const bool is_first = &group == &groups_.front();
      if (group.is_started || (!is_first && (working >= max_at_once_ || !group.is_ahead))) continue;
      start(group);
      working += group.is_working() ? 1 : 0;
    }
  }

  void report_first() {
    start_some();
    Group& group = groups_.front();
    for (const Item& item : group.items) {
      if (GracePeriod::has_begun())
        throw Terminated(fmt::format("SIGTERM: {} of {} items are complete; run again to go on", count_, size_));
      const Stopwatch watch;
      report(item,
             item.error           ? failure(item, item.error)
             : item.is_rendered   ? render(item, group)
             : common_.is_dry_run ? planned(item)
                                  : skipped(item),
             watch);
    }
    groups_.pop_front();
  }

  Json::Object render(const Item& item, Group& group) {
    reports_.begin(fmt::format("{} of {}: {}", count_ + 1, size_, item.name),
                   static_cast<double>(count_) / static_cast<double>(size_));
    for (int attempt = 1;; ++attempt) try {
        const Summary summary = attempt == 1 ? first_attempt(group) : next_attempt(item);
        reports_.add_text(fmt::format("{} -> {}, {} × {}, {:.0f} ms", item.name, summary.output, summary.width,
                                      summary.height, summary.total_ms()));
        Json::Object line = summary_json(item.args, summary);
        line.emplace(line.begin() + 4, "status", "done");
        if (attempt > 1) line.emplace_back("attempts", attempt);
        line.emplace_back("seconds", summary.total_ms() / 1000);
        if (took_) took_(item.args, summary);
        return line;
      } catch (const Error& error) {
        if (attempt > common_.retries || !may_pass(error) || GracePeriod::has_begun())
          return failure(item, std::current_exception(), attempt);
        reports_.warn(std::string(error.what()) + "; it is tried again");
      } catch (const std::exception&) {
        return failure(item, std::current_exception(), attempt);
      }
  }

  Summary first_attempt(Group& group) {
    Summary summary;
    with_threads(group.threads, [&] { summary = group.process->next(); });
    return summary;
  }
  // In a process of its own.
  Summary next_attempt(const Item& item) {
    Summary summary;
    with_threads(threads_,
                 [&] { summary = RenderItems({item.args}, {.warn = say_warning}, &processes_, ledger_).next(); });
    return summary;
  }

  // Whether the same job may succeed: what the job itself causes, such as a corrupt input or too small a limit of
  // memory, would happen again.
  static bool may_pass(const Error& error) {
    const std::string_view cause = cause_name(error);
    return cause == "killed" || cause == "time" || cause == "output";
  }

  Json::Object skipped(const Item& item) {
    reports_.add_text(fmt::format("{}: {} exists already", item.name, item.args.output));
    return plan_json(item.args, "skipped");
  }
  Json::Object planned(const Item& item) {
    const bool is_left_out = is_finished(item.args, ledger_);
    reports_.add_text(is_left_out ? fmt::format("{}: {} exists already", item.name, item.args.output)
                                  : plan_text(item.args));
    return plan_json(item.args, is_left_out ? "skipped" : "planned");
  }

  Json::Object failure(const Item& item, const std::exception_ptr& error, int attempts = 1) {
    ++failed_;
    const auto [word, cause] = cause_of(item.name, error);
    reports_.fail(cause);
    const std::string& output = item.args.output;
    Json::Object line{{"format", "zoneplate-render"},
                      {"version", report_version},
                      {"input", item.name},
                      {"output", Json()},
                      {"status", "failed"}};
    if (!output.empty()) line.emplace_back("not_written", output);
    line.emplace_back("error", cause);
    line.emplace_back("cause", word);
    if (attempts > 1) line.emplace_back("attempts", attempts);
    return line;
  }

  // The word for the cause (process/item_error.h), and the message.
  static std::pair<std::string, std::string> cause_of(const std::string& name, const std::exception_ptr& error) {
    try {
      std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
      return {"memory", name + ": out of memory"};
    } catch (const Error& cause) {
      return {std::string(cause_name(cause)), cause.what()};
    } catch (const std::exception& cause) {
      return {"failed", cause.what()};
    }
  }

  void report(const Item& item, Json::Object line, const Stopwatch& watch) {
    const bool is_made = line.back().first == "seconds";
    if (!is_made) line.emplace_back("seconds", watch.ms() / 1000);
    if (item.is_rendered || item.error) reports_.record(item.number, line);  // others have an earlier record
    ++count_;
    reports_.add(std::move(line));
  }

  const RenderArgs& common_;
  Ledger* const ledger_;
  const BatchResult took_;
  const std::uint64_t size_;
  const int threads_;
  const std::size_t max_at_once_;
  BatchReports reports_;
  LimitedChildren processes_{[this] { start_some(); }};
  std::deque<Group> groups_;  ///< those that are not yet reported
  std::uint64_t count_ = 0, failed_ = 0;
};

// Fails before the first item is rendered if two items would write the same file, or one a file that another reads.
void check_files(BatchItems& items, const std::string& output) {
  OutputFiles files;
  for (std::uint64_t i = 0; i < items.count(); ++i) {
    try {
      add_files(items.args(i), i, files);
    } catch (const Error&) {  // fails alone, when its turn comes
    }
  }
  const std::optional<OutputFiles::Collision> found = files.find_collision();
  if (!found) return;
  if (found->is_read)
    throw Error(ErrorKind::Usage, fmt::format("{} would be written to {}, which {} reads", items.name(found->first),
                                              found->path, items.name(found->second)));
  throw Error(
      ErrorKind::Usage,
      fmt::format("{} and {} would both be written to {}{}", items.name(found->first), items.name(found->second),
                  found->path, names_input(output) ? ": use {dir}, {ext} or {index} in the output's name" : ""));
}

// Makes the folder of an output, up to a folder whose name has the number of a frame.
void make_folder(const RenderArgs& args) {
  const auto folder = std::filesystem::path(args.output.substr(0, folder_end(args))).parent_path();
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(ErrorKind::Output, fmt::format("{}: {}", folder.string(), error.message()));
}

// The arguments of an item that is to be rendered, after its folder is made.
RenderArgs prepared(RenderArgs args) {
  make_folder(args);
  check_outputs(args);
  return args;
}

}  // namespace

std::size_t max_at_once(std::uint64_t memory_limit) {
  const std::uint64_t fit = machine_memory() / std::max<std::uint64_t>(memory_limit, 1);
  return static_cast<std::size_t>(std::clamp<std::uint64_t>(fit, 1, static_cast<std::uint64_t>(thread_limit())));
}

void render_batch(const RenderArgs& common) {
  BatchItems items(common);
  check_files(items, common.output);
  std::optional<Ledger> ledger;
  if (!common.ledger.empty())
    ledger.emplace(common.ledger, common.shard.index, items.pin(), common.load.limits,
                   common.is_dry_run ? Ledger::Access::Read : Ledger::Access::Write);
  const GracePeriod grace(common.is_dry_run ? 0 : common.grace);
  Batch batch(common, common.shard.size_of(items.count()), ledger ? &*ledger : nullptr, {});
  for (std::uint64_t i = 0; i < items.count(); ++i) {
    if (!common.shard.has(i)) continue;
    batch.add(items.name(i), i, [&] {
      RenderArgs args = items.args(i);
      if (!common.is_dry_run) return prepared(std::move(args));
      check_input(args.input, args.load.format);
      return args;
    });
  }
  batch.finish();
}

std::uint64_t render_sample(const RenderArgs& common, BatchItems& items, std::span<const std::uint64_t> numbers,
                            const std::function<void(RenderArgs&)>& complete, const BatchResult& took) {
  RenderArgs quiet = common;
  quiet.verbosity = Verbosity::Quiet;
  Batch batch(quiet, numbers.size(), nullptr, took);
  for (const std::uint64_t i : numbers)
    batch.add(items.name(i), i, [&] {
      RenderArgs args = items.args(i);
      complete(args);
      return prepared(std::move(args));
    });
  try {
    batch.finish();
  } catch (const PartialFailure&) {
  }
  return batch.failed();
}

}  // namespace zoneplate::cli
