// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/batch/input_names.h"
#include "zoneplate/batch/ledger.h"
#include "zoneplate/batch/output_name.h"
#include "zoneplate/cli/config/config.h"
#include "zoneplate/cli/render/args.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/output/film.h"
#include "zoneplate/job/output/frame_name.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void check_output(const RenderArgs& args) {
  if (args.output.empty()) throw Error(ErrorKind::Usage, "no output: give -o OUT.png, or -o - for stdout");
  if (args.output == "-") {
    if (!args.aovs.empty() && args.stdout_format != "exr")
      throw Error(ErrorKind::Usage, "--aov writes files next to OUT, which cannot be -; an .exr contains the passes");
    if (args.sequence.requests_frames()) throw Error(ErrorKind::Usage, "several frames cannot be written to -");
    return;
  }
  if (args.stdout_format != "png")
    throw Error(ErrorKind::Usage, "--output-format requires -o -: otherwise the extension of OUT selects the format");
  check_output_name(args.output);
}

// A single operand that is a list of jobs is the manifest.
void take_manifest(RenderArgs& args, std::vector<std::string>& operands) {
  if (operands.size() != 1 || extension_of(operands.front()) != ".jsonl") return;
  if (!args.manifest.empty())
    throw Error(ErrorKind::Usage, fmt::format("two manifests: {} and {}", args.manifest, operands.front()));
  args.manifest = std::move(operands.front());
  operands.clear();
}

// The shard of the options; the ledger, if there is one, pins their number.
Shard shard_of(const RenderArgs& args) {
  if (args.shard_text.empty()) return {};
  try {
    const std::optional<BatchPin> pinned = args.ledger.empty() ? std::nullopt : find_pin(args.ledger, args.load.limits);
    return parse_shard(args.shard_text, pinned ? std::optional(pinned->shards) : std::nullopt);
  } catch (const Error& error) {
    throw Error(error.kind(), std::string(error.kind() == ErrorKind::Usage ? "--shard: " : "") + error.what());
  }
}

// Several inputs, and one file for all of them. After `convert in out` an output without -o is a likely mistake.
[[noreturn]] void refuse_single_output(const RenderArgs& args) {
  const std::string& last = args.inputs.back();
  if (args.output.empty() &&
      (is_encoded_by_ffmpeg(last) ||
       is_one_of(extension_of(last), {".png", ".jpg", ".jpeg", ".webp", ".avif", ".jxl", ".pfm", ".exr"})))
    throw Error(ErrorKind::Usage, fmt::format("no output: did you mean -o {}?", last));
  throw Error(
      ErrorKind::Usage,
      "several inputs require a folder as output, as pictures/, or {model} in its name, as pictures/{model}.png");
}

}  // namespace

void set_output(RenderArgs& args, const std::string& pattern, std::uint64_t index) {
  OutputName name = output_name(pattern, args.input, index, args.sequence.requests_frames());
  args.output = std::move(name.text), args.frame_place = name.frame;
}

void check_args(RenderArgs& args) {
  check_output(args);
  args.sequence.skips_finished = args.skip_existing;
  check_job(args);
}

std::optional<RenderArgs> parse_render_args(std::span<const std::string> arguments,
                                            const std::function<void(Syntax&)>& adapt) {
  // The command line is parsed twice: first for the choice of a preset, then on top of the configuration.
  RenderArgs first;
  Syntax first_syntax = render_syntax(first);
  if (adapt) adapt(first_syntax);
  if (!parse(first_syntax, arguments)) return std::nullopt;
  RenderArgs args;
  Syntax syntax = render_syntax(args);
  if (adapt) adapt(syntax);
  if (!first.reads_config && !first.preset.empty())
    throw Error(ErrorKind::Usage, "--preset requires the configuration, which --no-config ignores");
  if (first.reads_config) apply_config(user_config(), first.preset, syntax);
  parse(syntax, arguments);
  take_manifest(args, syntax.found_operands);
  args.shard = shard_of(args);
  args.inputs = with_folders_listed(syntax.found_operands, say_warning);
  if (!args.manifest.empty()) {
    if (!args.inputs.empty())
      throw Error(ErrorKind::Usage, "--manifest lists the inputs: remove " + args.inputs.front());
    return args;
  }
  if (args.inputs.empty()) throw Error(ErrorKind::Usage, "no input: give a model or a built-in scene");
  args.has_placeholders = names_input(args.output);
  if (args.inputs.size() > 1 && !args.has_placeholders) refuse_single_output(args);
  args.input = args.inputs.front();
  RenderArgs item = args;
  set_output(item, args.output, 0);
  first.output = item.output, first.frame_place = item.frame_place;
  check_effects(first);
  if (!args.is_batch() && (first.grace > 0 || first.retries > 0))
    throw Error(ErrorKind::Usage,
                "--grace and --retries are for batches: give several inputs, a manifest or a --ledger");
  check_args(item);
  return args.is_batch() ? args : item;  // each item of a batch is checked by its own name
}

}  // namespace zoneplate::cli
