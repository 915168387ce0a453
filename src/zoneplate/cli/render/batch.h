// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>

#include "zoneplate/cli/render/args.h"
#include "zoneplate/cli/render/batch_items.h"
#include "zoneplate/job/summary.h"

namespace zoneplate::cli {

/// Renders several inputs, or the jobs of a manifest, and prints a line of JSON for each, in their order.
///
/// A manifest has one JSON object per line: "input", "output", and options by their names without dashes, which
/// override those of the command line: {"input": "a.glb", "output": "a.png", "size": "64x64", "no-background": true}.
/// For consecutive items with the same input, the model is read once. As many models as there are threads are processed
/// at once, unless their memory limits together exceed the machine's memory; the threads are divided among them. A
/// failing item does not affect the others, even if its process is killed (items.h).
/// With a ledger (batch/ledger.h), files and results are recorded there, and what it records as whole is skipped.
/// Errors    PartialFailure if some items failed, after all others are complete; Terminated after SIGTERM, within the
///           period of grace; ErrorKind::Usage for the manifest, and for a ledger of another batch.
void render_batch(const RenderArgs& args);

/// How many models are processed at once: as many as there are threads, if their memory limits together do not exceed
/// the machine's memory.
std::size_t max_at_once(std::uint64_t memory_limit);

/// Takes the result of an item.
using BatchResult = std::function<void(const RenderArgs& args, const Summary& summary)>;

/// Renders these items as `render_batch` does, without a ledger, and prints nothing. `complete` may change the
/// arguments of each before it is rendered; `took` gets the results. How many failed is returned.
std::uint64_t render_sample(const RenderArgs& common, BatchItems& items, std::span<const std::uint64_t> numbers,
                            const std::function<void(RenderArgs&)>& complete, const BatchResult& took);

}  // namespace zoneplate::cli
