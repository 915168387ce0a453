// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/batch_items.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/sha256.h"
#include "zoneplate/formats/json/json.h"

namespace zoneplate::cli {

// Parses the jobs of a manifest: each has the options of the command line, overridden by its own. A manifest may come
// from a stranger: a line cannot lift the sandbox, nor raise a limit of the command line.
class BatchItems::Jobs {
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
    for (const char* common : {"manifest", "shard", "preset", "no-config", "dry-run", "ledger", "retries", "grace"})
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

BatchItems::BatchItems(RenderArgs common)
    : inputs_(std::exchange(common.inputs, {})), common_(std::move(common)), jobs_(std::make_unique<Jobs>(common_)) {
  constexpr std::uint64_t max_bytes = std::uint64_t{1} << 30;
  if (!common_.manifest.empty())
    manifest_.emplace(common_.manifest, std::min(max_bytes, common_.load.limits.memory / 2));
}

BatchItems::~BatchItems() = default;

RenderArgs BatchItems::args(std::uint64_t i) {
  RenderArgs args = manifest_ ? jobs_->read(manifest_->text(i), manifest_->place(i), i) : common_;
  args.number = i;
  if (manifest_) return args;
  args.input = inputs_[i];
  set_output(args, args.output, i);
  check_args(args);
  return args;
}

BatchPin BatchItems::pin() const {
  Sha256 digest;
  const auto add = [&digest](std::string_view text) {
    digest.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  for (std::uint64_t i = 0; i < count(); ++i) add(manifest_ ? manifest_->text(i) : inputs_[i]), add("\n");
  if (!manifest_) add(common_.output);
  return {.shards = common_.shard.count, .items = count(), .jobs = digest.hex().substr(0, 16)};
}

}  // namespace zoneplate::cli
