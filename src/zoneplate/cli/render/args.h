// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/batch/item.h"
#include "zoneplate/batch/shard.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/progress.h"
#include "zoneplate/job/check.h"

namespace zoneplate::cli {

/// The arguments of `zoneplate render`.
struct RenderArgs : BatchItem {
  std::vector<std::string> inputs;  ///< all inputs; `input` is the first
  std::string manifest;
  bool has_placeholders = false;  ///< the output's name depends on its input
  std::string shard_text;         ///< --shard as it is given; empty: all items
  Shard shard;                    ///< set from it by parse_render_args
  int retries = 0;                ///< of an item whose failure need not happen again
  bool is_dry_run = false;        ///< report the items, and render none
  std::string preset;             ///< section of the configuration; empty: none
  bool reads_config = true;
  bool prints_json = false;
  Verbosity verbosity = Verbosity::Normal;
  std::optional<ProgressKind> progress;  ///< nothing: a bar on a terminal

  /// Whether each item is reported by a line of its own: several inputs, a manifest, an output with placeholders, or a
  /// ledger.
  bool is_batch() const { return inputs.size() > 1 || !manifest.empty() || has_placeholders || !ledger.empty(); }
};

/// The options of the verb, which set `args`. The result refers to `args`.
Syntax render_syntax(RenderArgs& args);

/// Checks the arguments of one image or sequence after parsing, and completes them.
///
/// Errors    ErrorKind::Usage.
void check_args(RenderArgs& args);

/// Sets the output of an item from the text of --output, by its input and its number in the batch.
///
/// Errors    those of output_name.
void set_output(RenderArgs& args, const std::string& pattern, std::uint64_t index);

/// Parses and checks the whole command line of the verb; nothing after printing the help. `adapt` makes the options of
/// another verb about the same items of those of `render`.
///
/// Errors    ErrorKind::Usage.
std::optional<RenderArgs> parse_render_args(std::span<const std::string> arguments,
                                            const std::function<void(Syntax&)>& adapt = {});

}  // namespace zoneplate::cli
