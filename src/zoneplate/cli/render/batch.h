// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/cli/render/args.h"

namespace zoneplate::cli {

/// Renders several inputs, or the jobs of a manifest, one after the other, and prints a line of JSON for each.
///
/// A manifest has a JSON object a line: "input", "output", and options by their names without dashes, which override
/// those of the command line: {"input": "a.glb", "output": "a.png", "size": "64x64", "no-background": true}. Of several
/// items that follow each other with the same input, the model is read once. An item fails alone, whatever it throws
/// and whatever the system does to its process (items.h).
/// Errors    PartialFailure where some items failed, after all others were made; ErrorKind::Usage for the manifest.
void render_batch(const RenderArgs& args);

}  // namespace zoneplate::cli
