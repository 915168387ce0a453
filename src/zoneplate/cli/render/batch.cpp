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
#include "zoneplate/cli/batch/input_names.h"
#include "zoneplate/cli/batch/manifest.h"
#include "zoneplate/cli/batch/output_files.h"
#include "zoneplate/cli/batch/output_name.h"
#include "zoneplate/cli/render/item_files.h"
#include "zoneplate/cli/render/items.h"
#include "zoneplate/cli/report_version.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/os/memory_limit.h"

namespace zoneplate::cli {
namespace {

// Parses the jobs of a manifest: each has the options of the command line, overridden by its own. A manifest may come
// from a stranger: a line cannot lift the sandbox, nor raise a limit of the command line.
class Jobs {
 public:
  explicit Jobs(const RenderArgs& common) : common_(common), syntax_(render_syntax(args_)) {}
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  // Errors    ErrorKind::Input or Usage, naming the line.
  RenderArgs read(std::string_view text, const std::string& place, std::uint64_t index) {
    ImportBudget budget(place, common_.load.limits);
    const JsonValue job = parse_json({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, budget);
    try {
      return read(job, JsonView(job, place), index);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Usage) throw;
      throw Error(ErrorKind::Usage, place + ": " + error.what());
    }
  }

 private:
  RenderArgs read(const JsonValue& job, const JsonView& view, std::uint64_t index) {
    args_ = common_;
    args_.input.clear();
    for (std::size_t i = 0; i < job.items.size(); ++i) set(job.keys[i], job.items[i], view);
    if (args_.input.empty()) view.fail("has no input");
    args_.inputs = {args_.input};
    check_limits(view);
    set_output(args_, args_.output, index);
    check_args(args_);
    return args_;
  }

  void check_limits(const JsonView& view) const {
    const auto check = [&view](const char* option, auto limit, auto most) {
      if (limit > most)
        view.fail(fmt::format("{} can only be lowered by a line, and is {:.6g} on the command line", option,
                              static_cast<double>(most)));
    };
    const LoadLimits &limits = args_.load.limits, &most = common_.load.limits;
    check("max-memory", limits.memory, most.memory);
    check("max-pixels", limits.pixels, most.pixels);
    check("max-import-seconds", limits.seconds, most.seconds);
    check("max-seconds", args_.max_seconds, common_.max_seconds);
  }

  void set(const std::string& key, const JsonValue& value, const JsonView& view) {
    using Kind = JsonValue::Kind;
    if (value.kind != Kind::Boolean && value.kind != Kind::Text && value.kind != Kind::Number)
      view.fail(key + " is neither a text, nor a number, nor true or false");
    const std::string text = value.kind == Kind::Number ? fmt::format("{}", value.number) : value.text;
    if (text.find('\0') != text.npos) view.fail(key + " has a character of code 0");
    for (const char* common : {"manifest", "shard", "preset", "no-config", "dry-run"})
      if (key == common) view.fail(key + " is for all jobs together, not for one");
    for (const char* right : {"no-sandbox", "allow-path"})
      if (key == right) view.fail(key + " is for the command line alone, because a manifest may come from a stranger");
    if (key == "input" && value.kind != Kind::Boolean)
      args_.input = text;
    else if (value.kind != Kind::Boolean)
      set_option(syntax_, key, text);
    else if (value.boolean)
      set_option(syntax_, key, std::nullopt);
  }

  const RenderArgs& common_;
  RenderArgs args_;
  Syntax syntax_;  ///< its options set args_
};

// How many models are processed at once: as many as there are threads, if their memory limits together do not exceed
// the machine's memory.
std::size_t most_at_once(std::uint64_t memory_limit) {
  const std::uint64_t fit = machine_memory() / std::max<std::uint64_t>(memory_limit, 1);
  return static_cast<std::size_t>(std::clamp<std::uint64_t>(fit, 1, static_cast<std::uint64_t>(thread_limit())));
}

// Processes items, several at once, and reports them in order. Consecutive items with one model form a group, which is
// processed in one process.
class Batch {
 public:
  Batch(const RenderArgs& common, std::uint64_t size)
      : common_(common),
        size_(size),
        threads_(thread_limit()),
        most_at_once_(most_at_once(common.load.limits.memory)),
        progress_(common.progress ? *common.progress : parse_progress("auto")),
        prints_text_(::isatty(STDOUT_FILENO) == 1 && !common.prints_json) {}

  // Adds the item that `make` returns; if it throws, the item has failed.
  template <class Make>
  void add(const std::string& name, const Make& make) {
    try {
      RenderArgs args = make();
      args.progress = ProgressKind::None;
      const bool is_alike = !groups_.empty() && groups_.back().is_open(args);
      if (!is_alike) add_group().is_ahead = can_be_ahead(args);
      groups_.back().items.push_back({name, std::move(args), nullptr});
    } catch (const std::exception&) {
      add_group().items.push_back({name, {}, std::current_exception()});
    }
  }

  void finish() {
    while (!groups_.empty()) report_first();
    if (failed_ > 0) throw PartialFailure(fmt::format("{} of {} items failed", failed_, count_));
    if (!trouble_.empty()) throw Error(ErrorKind::Output, "not all reports could be printed: " + trouble_);
  }

 private:
  struct Item {
    std::string name;
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
      if (items.front().error || next.input == "-" || items.size() >= most_together) return false;
      const RenderArgs& args = items.front().args;
      return model_key(next) == model_key(args) && next.max_seconds == args.max_seconds &&
             next.is_sandboxed == args.is_sandboxed && can_be_ahead(next) == is_ahead;
    }
    bool is_working() const { return process && process->is_working(); }
  };
  static constexpr std::size_t most_together = 64;  // limits the delay of results in a long batch
  static constexpr std::size_t most_waiting = 8;    // groups for each that is processed, while the first one takes long

  // Whether an item's result may wait in memory. A sequence may be too large for that; and a process whose results are
  // not yet read may come to a stop, which a limit of time would count.
  static bool can_be_ahead(const RenderArgs& args) {
    return !args.sequence.is_sequence() && args.max_seconds == std::numeric_limits<double>::infinity();
  }

  Group& add_group() {
    while (groups_.size() >= most_waiting * most_at_once_) report_first();
    return groups_.emplace_back();
  }

  void start(Group& group) {
    group.is_started = true;
    std::vector<RenderArgs> to_render;
    for (Item& item : group.items) {
      item.is_rendered = !item.error && !common_.is_dry_run && !is_finished(item.args);
      if (item.is_rendered) to_render.push_back(item.args);
    }
    if (to_render.empty()) return;
    group.threads = threads_ / static_cast<int>(std::min(most_at_once_, groups_.size()));
    group.process.emplace(std::move(to_render), &processes_);
    with_threads(group.threads, [&] { group.process->start_ahead(); });
  }

  // Starts the first group, and as many of the next ones as can be processed at the same time.
  void start_some() {
    std::size_t working = 0;
    for (const Group& group : groups_) working += group.is_working() ? 1 : 0;
    for (Group& group : groups_) {
      const bool is_first = &group == &groups_.front();
      if (group.is_started || (!is_first && (working >= most_at_once_ || !group.is_ahead))) continue;
      start(group);
      working += group.is_working() ? 1 : 0;
    }
  }

  void report_first() {
    start_some();
    Group& group = groups_.front();
    for (const Item& item : group.items) {
      const Stopwatch watch;
      report(item.error           ? failure(item, item.error)
             : item.is_rendered   ? render(item, group)
             : common_.is_dry_run ? planned(item)
                                  : skipped(item),
             watch);
    }
    groups_.pop_front();
  }

  Json::Object render(const Item& item, Group& group) {
    progress_.begin(fmt::format("{} of {}: {}", count_ + 1, size_, item.name),
                    static_cast<double>(count_) / static_cast<double>(size_));
    try {
      Summary summary;
      with_threads(group.threads, [&] { summary = group.process->next(); });
      print_text(fmt::format("{} -> {}, {} × {}, {:.0f} ms", item.name, summary.output, summary.width, summary.height,
                             summary.total_ms()));
      Json::Object line = summary_json(item.args, summary);
      line.emplace(line.begin() + 4, "status", "done");
      line.emplace_back("seconds", summary.total_ms() / 1000);
      return line;
    } catch (const std::exception&) {
      return failure(item, std::current_exception());
    }
  }

  Json::Object skipped(const Item& item) {
    print_text(fmt::format("{}: {} exists already", item.name, item.args.output));
    return plan_json(item.args, "skipped");
  }
  Json::Object planned(const Item& item) {
    const bool is_left_out = is_finished(item.args);
    print_text(is_left_out ? fmt::format("{}: {} exists already", item.name, item.args.output) : plan_text(item.args));
    return plan_json(item.args, is_left_out ? "skipped" : "planned");
  }

  Json::Object failure(const Item& item, const std::exception_ptr& error) {
    ++failed_;
    const std::string cause = cause_of(item.name, error);
    progress_.clear();
    say_error(cause);
    const std::string& output = item.args.output;
    Json::Object line{{"format", "zoneplate-render"},
                      {"version", report_version},
                      {"input", item.name},
                      {"output", Json()},
                      {"status", "failed"}};
    if (!output.empty()) line.emplace_back("not_written", output);
    line.emplace_back("error", cause);
    return line;
  }

  static std::string cause_of(const std::string& name, const std::exception_ptr& error) {
    try {
      std::rethrow_exception(error);
    } catch (const std::bad_alloc&) {
      return name + ": out of memory";
    } catch (const std::exception& cause) {
      return cause.what();
    }
  }

  void report(Json::Object line, const Stopwatch& watch) {
    if (line.back().first != "seconds") line.emplace_back("seconds", watch.ms() / 1000);
    ++count_;
    progress_.clear();
    if (!prints_text_) print_line(Json(std::move(line)).text());
  }

  // One line for a person at a terminal; failures are reported on stderr alone.
  void print_text(const std::string& text) {
    progress_.clear();
    if (prints_text_) print_line(text);
  }

  // The first line that cannot be printed is the last that is tried: the images matter more than their reports.
  void print_line(const std::string& text) {
    if (common_.verbosity == Verbosity::Quiet || !trouble_.empty()) return;
    try {
      common_.is_dry_run ? print(text + '\n') : print_report(text + '\n');
    } catch (const Error& error) {
      trouble_ = error.what();
      say_error(trouble_ + "; the batch goes on without reports");
    }
  }

  const RenderArgs& common_;
  const std::uint64_t size_;
  const int threads_;
  const std::size_t most_at_once_;
  Progress progress_;
  const bool prints_text_;
  LimitedChildren processes_{[this] { start_some(); }};
  std::deque<Group> groups_;  ///< those that are not yet reported
  std::uint64_t count_ = 0, failed_ = 0;
  std::string trouble_;  ///< why reports are no longer printed; empty if they are
};

// The items of the command line, or of the manifest.
class BatchItems {
 public:
  explicit BatchItems(RenderArgs common)
      : inputs_(std::exchange(common.inputs, {})), common_(std::move(common)), jobs_(common_) {
    constexpr std::uint64_t most_bytes = std::uint64_t{1} << 30;
    if (!common_.manifest.empty())
      manifest_.emplace(common_.manifest, std::min(most_bytes, common_.load.limits.memory / 2));
  }

  std::uint64_t count() const { return manifest_ ? manifest_->size() : inputs_.size(); }
  std::string name(std::uint64_t i) const { return manifest_ ? manifest_->place(i) : inputs_[i]; }
  // Errors    ErrorKind::Input or Usage, naming the line.
  RenderArgs args(std::uint64_t i) {
    if (manifest_) return jobs_.read(manifest_->text(i), manifest_->place(i), i);
    RenderArgs args = common_;
    args.input = inputs_[i];
    set_output(args, args.output, i);
    check_args(args);
    return args;
  }

 private:
  const std::vector<std::string> inputs_;
  const RenderArgs common_;  ///< without the inputs
  Jobs jobs_;
  std::optional<Manifest> manifest_;
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
  const std::filesystem::path folder =
      std::filesystem::path(args.output.substr(0, args.frame_place ? args.frame_place->begin : args.output.npos))
          .parent_path();
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(ErrorKind::Output, fmt::format("{}: {}", folder.string(), error.message()));
}

}  // namespace

void render_batch(const RenderArgs& common) {
  BatchItems items(common);
  check_files(items, common.output);
  Batch batch(common, common.shard.size_of(items.count()));
  for (std::uint64_t i = 0; i < items.count(); ++i) {
    if (!common.shard.has(i)) continue;
    batch.add(items.name(i), [&] {
      RenderArgs args = items.args(i);
      if (common.is_dry_run) {
        check_input(args.input, args.load.format);
        return args;
      }
      make_folder(args);
      check_outputs(args);
      return args;
    });
  }
  batch.finish();
}

}  // namespace zoneplate::cli
