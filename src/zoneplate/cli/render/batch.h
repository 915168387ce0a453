// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/cli/render/args.h"

namespace zoneplate::cli {

/// Renders several inputs, or the jobs of a manifest, and prints a line of JSON for each, in their order.
///
/// A manifest has one JSON object per line: "input", "output", and options by their names without dashes, which
/// override those of the command line: {"input": "a.glb", "output": "a.png", "size": "64x64", "no-background": true}.
/// For consecutive items with the same input, the model is read once. As many models as there are threads are processed
/// at once, unless their memory limits together exceed the machine's memory; the threads are divided among them. A
/// failing item does not affect the others, even
/// if its process is killed (items.h).
/// Errors    PartialFailure if some items failed, after all others are complete; ErrorKind::Usage for the manifest.
void render_batch(const RenderArgs& args);

}  // namespace zoneplate::cli
