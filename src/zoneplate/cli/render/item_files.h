// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/cli/batch/output_files.h"
#include "zoneplate/cli/render/args.h"

namespace zoneplate::cli {

/// Adds all files that an item writes, and those that it reads and that an image could replace. `item` is its number.
void add_files(const RenderArgs& args, std::uint64_t item, OutputFiles& files);

/// Errors    ErrorKind::Usage if the item would write a file that it reads.
void check_own_files(const RenderArgs& args);

/// For --skip-existing: whether all files of an item are there and whole (cli/batch/whole_file.h), its image and its
/// data passes. False for numbered frames, of which `finished_frames` are skipped.
bool is_finished(const RenderArgs& args);

/// The frames of an item whose files are all there and whole, sorted; none without --skip-existing.
std::vector<int> finished_frames(const RenderArgs& args);

}  // namespace zoneplate::cli
