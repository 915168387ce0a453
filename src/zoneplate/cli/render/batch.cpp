// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/batch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <new>
#include <optional>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/render/frame_name.h"
#include "zoneplate/cli/render/input_names.h"
#include "zoneplate/cli/render/items.h"
#include "zoneplate/cli/render/output_name.h"
#include "zoneplate/cli/report_version.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/os/file.h"

namespace zoneplate::cli {
namespace {

// A non-empty line of the manifest, and its name for messages.
struct Line {
  std::string text, place;
};

std::vector<Line> lines_of(const std::string& path) {
  const FileBytes file(path, std::uint64_t{1} << 30);
  const std::string_view text(reinterpret_cast<const char*>(file.bytes().data()), file.bytes().size());
  std::vector<Line> lines;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    ++number;
    if (line.find_first_not_of(" \t\r") != line.npos)
      lines.push_back({std::string(line), fmt::format("{}: line {}", path == "-" ? "standard input" : path, number)});
    at = end + 1;
  }
  return lines;
}

// Parses the jobs of a manifest: each has the options of the command line, overridden by its own.
class Jobs {
 public:
  explicit Jobs(const RenderArgs& common) : common_(common), syntax_(render_syntax(args_)) {}
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  // Errors    ErrorKind::Input or Usage, naming the line.
  RenderArgs read(const Line& line, std::uint64_t index) {
    ImportBudget budget(line.place, common_.load.limits);
    const JsonValue job =
        parse_json({reinterpret_cast<const std::uint8_t*>(line.text.data()), line.text.size()}, budget);
    try {
      return read(job, JsonView(job, line.place), index);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::Usage) throw;
      throw Error(ErrorKind::Usage, line.place + ": " + error.what());
    }
  }

 private:
  RenderArgs read(const JsonValue& job, const JsonView& view, std::uint64_t index) {
    args_ = common_;
    args_.input.clear();
    for (std::size_t i = 0; i < job.items.size(); ++i) set(job.keys[i], job.items[i], view);
    if (args_.input.empty()) view.fail("has no input");
    args_.inputs = {args_.input};
    args_.output = output_name(args_.output, args_.input, index);
    check_args(args_);
    return args_;
  }

  void set(const std::string& key, const JsonValue& value, const JsonView& view) {
    using Kind = JsonValue::Kind;
    if (value.kind != Kind::Boolean && value.kind != Kind::Text && value.kind != Kind::Number)
      view.fail(key + " is neither a text, nor a number, nor true or false");
    const std::string text = value.kind == Kind::Number ? fmt::format("{}", value.number) : value.text;
    if (text.find('\0') != text.npos) view.fail(key + " has a character of code 0");
    for (const char* common : {"manifest", "shard", "preset", "no-config", "dry-run"})
      if (key == common) view.fail(key + " is for all jobs together, not for one");
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

// Processes items in order. Consecutive items with one model are processed together, in one process.
class Batch {
 public:
  Batch(const RenderArgs& common, std::uint64_t size)
      : common_(common),
        size_(size),
        progress_(common.progress ? *common.progress : parse_progress("auto")),
        prints_text_(::isatty(STDOUT_FILENO) == 1 && !common.prints_json) {}

  // Adds the item that `make` returns; if it throws, the item has failed.
  template <class Make>
  void add(const std::string& name, const Make& make) {
    try {
      RenderArgs args = make();
      args.progress = ProgressKind::None;
      const bool is_alike = !items_.empty() && args.input != "-" && model_key(args) == model_key(items_.front().args) &&
                            args.max_seconds == items_.front().args.max_seconds &&
                            args.is_sandboxed == items_.front().args.is_sandboxed;
      if (!is_alike || items_.size() >= most_together) flush();
      items_.push_back({name, std::move(args)});
    } catch (const std::exception& error) {
      flush();
      report(failure(name, error), Stopwatch());
    }
  }

  void finish() {
    flush();
    if (failed_ > 0) throw PartialFailure(fmt::format("{} of {} items failed", failed_, count_));
  }

 private:
  struct Item {
    std::string name;
    RenderArgs args;
  };
  static constexpr std::size_t most_together = 64;  // limits the delay of results in a long batch

  void flush() {
    std::vector<Item> items = std::exchange(items_, {});
    std::vector<RenderArgs> to_render;
    std::vector<bool> is_rendered;
    for (const Item& item : items) {
      is_rendered.push_back(!common_.is_dry_run && !is_skipped(item.args));
      if (is_rendered.back()) to_render.push_back(item.args);
    }
    std::optional<RenderItems> process;
    if (!to_render.empty()) process.emplace(std::move(to_render));
    for (std::size_t i = 0; i < items.size(); ++i) {
      const Stopwatch watch;
      report(is_rendered[i]       ? render(items[i], *process)
             : common_.is_dry_run ? planned(items[i])
                                  : skipped(items[i]),
             watch);
    }
  }

  Json::Object render(const Item& item, RenderItems& process) {
    progress_.begin(fmt::format("{} of {}: {}", count_ + 1, size_, item.name),
                    static_cast<double>(count_) / static_cast<double>(size_));
    try {
      const Stopwatch watch;
      const Summary summary = process.next();
      print_text(fmt::format("{} -> {}, {} × {}, {:.0f} ms", item.name, item.args.output, summary.width, summary.height,
                             watch.ms()));
      Json::Object line = summary_json(item.args, summary);
      line.emplace(line.begin() + 4, "status", "done");
      return line;
    } catch (const std::exception& error) {
      return failure(item.name, error);
    }
  }

  static bool is_skipped(const RenderArgs& args) {
    return args.skip_existing && !has_frame_number(args.output) && exists(args.output);
  }
  Json::Object skipped(const Item& item) {
    print_text(fmt::format("{}: {} exists already", item.name, item.args.output));
    return plan_json(item.args, "skipped");
  }
  Json::Object planned(const Item& item) {
    const bool is_left_out = is_skipped(item.args);
    print_text(is_left_out ? fmt::format("{}: {} exists already", item.name, item.args.output) : plan_text(item.args));
    return plan_json(item.args, is_left_out ? "skipped" : "planned");
  }

  Json::Object failure(const std::string& name, const std::exception& error) {
    ++failed_;
    const bool is_memory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
    const std::string cause = is_memory ? name + ": out of memory" : error.what();
    progress_.clear();
    say_error(cause);
    return {{"format", "zoneplate-render"},
            {"version", report_version},
            {"input", name},
            {"output", Json()},
            {"status", "failed"},
            {"error", cause}};
  }

  void report(Json::Object line, const Stopwatch& watch) {
    line.emplace_back("seconds", watch.ms() / 1000);
    ++count_;
    progress_.clear();
    if (common_.verbosity != Verbosity::Quiet && !prints_text_) print(Json(std::move(line)).text() + '\n');
  }

  // One line for a person at a terminal; failures are reported on stderr alone.
  void print_text(const std::string& text) {
    progress_.clear();
    if (common_.verbosity != Verbosity::Quiet && prints_text_) print(text + '\n');
  }

  const RenderArgs& common_;
  const std::uint64_t size_;
  Progress progress_;
  const bool prints_text_;
  std::vector<Item> items_;  ///< pending items, all with one model
  std::uint64_t count_ = 0, failed_ = 0;
};

// The items of the command line, or of the manifest.
class BatchItems {
 public:
  explicit BatchItems(const RenderArgs& common) : common_(common), jobs_(common) {
    if (!common.manifest.empty()) lines_ = lines_of(common.manifest);
  }

  std::uint64_t count() const { return common_.manifest.empty() ? common_.inputs.size() : lines_.size(); }
  const std::string& name(std::uint64_t i) const {
    return common_.manifest.empty() ? common_.inputs[i] : lines_[i].place;
  }
  // Errors    ErrorKind::Input or Usage, naming the line.
  RenderArgs args(std::uint64_t i) {
    if (!common_.manifest.empty()) return jobs_.read(lines_[i], i);
    RenderArgs args = common_;
    args.input = common_.inputs[i];
    args.output = output_name(args.output, args.input, i);
    return args;
  }

 private:
  const RenderArgs& common_;
  Jobs jobs_;
  std::vector<Line> lines_;
};

// Fails before the first item is rendered if two items have the same output.
void check_output_names(BatchItems& items) {
  OutputNames names;
  for (std::uint64_t i = 0; i < items.count(); ++i) {
    std::optional<RenderArgs> args;
    try {
      args = items.args(i);
    } catch (const Error&) {
      continue;  // fails alone, when its turn comes
    }
    names.add(*args, items.name(i));
  }
}

// Makes the folder of an output whose name depends on its input, such as thumbs/{dir}/{model}.png.
void make_folder(const std::string& output) {
  const std::filesystem::path folder = std::filesystem::path(output).parent_path();
  if (folder.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(ErrorKind::Output, fmt::format("{}: {}", folder.string(), error.message()));
}

}  // namespace

void render_batch(const RenderArgs& common) {
  BatchItems items(common);
  check_output_names(items);
  Batch batch(common, common.shard.size_of(items.count()));
  for (std::uint64_t i = 0; i < items.count(); ++i) {
    if (!common.shard.has(i)) continue;
    batch.add(items.name(i), [&] {
      RenderArgs args = items.args(i);
      if (common.is_dry_run) {
        check_input(args.input, args.load.format);
        return args;
      }
      if (names_input(common.output)) make_folder(args.output);
      check_outputs(args);
      return args;
    });
  }
  batch.finish();
}

}  // namespace zoneplate::cli
