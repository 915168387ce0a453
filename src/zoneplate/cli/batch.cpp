#include "zoneplate/cli/batch.h"

#include <fmt/format.h>

#include <filesystem>
#include <new>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/file.h"
#include "zoneplate/cli/frame_name.h"
#include "zoneplate/cli/render_job.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/scene/gltf_json.h"

namespace zoneplate::cli {
namespace {

// A line of the manifest that is not empty, and what messages call it.
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

// The jobs of a manifest: each is what the command line says, with options of its own over that.
class Jobs {
 public:
  explicit Jobs(const RenderArgs& common) : common_(common), syntax_(render_syntax(args_)) {}
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  // Errors    Trouble::Input or Usage, naming the line.
  RenderArgs read(const Line& line) {
    ImportBudget budget(line.place, common_.load.limits);
    const JsonValue job =
        parse_json({reinterpret_cast<const std::uint8_t*>(line.text.data()), line.text.size()}, budget);
    try {
      return read(job, JsonView(job, line.place));
    } catch (const Error& error) {
      if (error.trouble() != Trouble::Usage) throw;
      throw Error(Trouble::Usage, line.place + ": " + error.what());
    }
  }

 private:
  RenderArgs read(const JsonValue& job, const JsonView& view) {
    args_ = common_;
    args_.input.clear();
    for (std::size_t i = 0; i < job.items.size(); ++i) set(job.keys[i], job.items[i], view);
    if (args_.input.empty()) view.fail("has no input");
    args_.inputs = {args_.input};
    check_args(args_);
    return args_;
  }

  void set(const std::string& key, const JsonValue& value, const JsonView& view) {
    using Kind = JsonValue::Kind;
    if (value.kind != Kind::Boolean && value.kind != Kind::Text && value.kind != Kind::Number)
      view.fail(key + " is neither a text, nor a number, nor true or false");
    const std::string text = value.kind == Kind::Number ? fmt::format("{}", value.number) : value.text;
    if (text.find('\0') != text.npos) view.fail(key + " has a character of code 0");
    if (key == "manifest" || key == "shard") view.fail(key + " is for all jobs together, not for one");
    if (key == "input" && value.kind != Kind::Boolean)
      args_.input = text;
    else if (value.kind != Kind::Boolean)
      set_option(syntax_, key, text);
    else if (value.boolean)
      set_option(syntax_, key, std::nullopt);
  }

  const RenderArgs& common_;
  RenderArgs args_;
  Syntax syntax_;  ///< whose options set args_
};

// One job after the other; each failure is told and kept, and the next job begun.
class Batch {
 public:
  explicit Batch(const RenderArgs& common) : common_(common) {}

  // Runs what `make` answers, or tells why it cannot be made.
  template <class Make>
  void run(const std::string& name, const Make& make) {
    const Stopwatch watch;
    Json::Object line;
    try {
      RenderArgs args = make();
      args.progress = ProgressKind::None;
      if (args.skip_existing && !has_frame_number(args.output) && exists(args.output)) {
        line = {{"input", args.input}, {"output", args.output}, {"status", "skipped"}};
      } else {
        check_writable(args.output);
        const Summary summary = jobs_.run(args);
        line = summary_json(args, summary);
        line.emplace(line.begin() + 2, "status", "done");
      }
    } catch (const Error& error) {
      line = failure(name, error.what());
    } catch (const std::bad_alloc&) {
      line = failure(name, "out of memory");
    }
    line.emplace_back("seconds", watch.ms() / 1000);
    if (common_.verbosity != Verbosity::Quiet) print(Json(std::move(line)).text() + '\n');
    ++count_;
  }

  void finish() const {
    if (failed_ > 0) throw PartialFailure(fmt::format("{} of {} items failed", failed_, count_));
  }

 private:
  Json::Object failure(const std::string& name, const std::string& error) {
    ++failed_;
    say_error(error);
    return {{"input", name}, {"output", Json()}, {"status", "failed"}, {"error", error}};
  }

  const RenderArgs& common_;
  RenderJobs jobs_;
  std::uint64_t count_ = 0, failed_ = 0;
};

std::string model_of(const std::string& input) {
  std::string stem = std::filesystem::path(input).stem().string();
  for (char& c : stem)
    if (c == ':' || c == '/') c = '_';
  return stem;
}

}  // namespace

void render_batch(const RenderArgs& common) {
  Batch batch(common);
  std::uint64_t number = 0;
  for (const std::string& input : common.inputs) {
    if (!common.shard.has(number++)) continue;
    batch.run(input, [&] {
      RenderArgs args = common;
      args.input = input;
      if (!args.sequence.is_wanted()) args.output = frame_name(args.output, 0, model_of(input));
      return args;
    });
  }
  if (common.manifest.empty()) return batch.finish();
  Jobs jobs(common);
  for (const Line& line : lines_of(common.manifest)) {
    if (!common.shard.has(number++)) continue;
    batch.run(line.place, [&] { return jobs.read(line); });
  }
  batch.finish();
}

}  // namespace zoneplate::cli
