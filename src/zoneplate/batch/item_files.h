// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/batch/item.h"
#include "zoneplate/batch/ledger.h"
#include "zoneplate/batch/output_files.h"

namespace zoneplate {

/// Adds all files that an item writes, and those that it reads and that an image could replace. `item` is its number.
void add_files(const BatchItem& args, std::uint64_t item, OutputFiles& files);

/// Fails early, and not after a long rendering, if one of the item's files cannot be written.
///
/// Errors    ErrorKind::Output; ErrorKind::Usage for a terminal.
void check_outputs(const BatchItem& args);

/// Errors    ErrorKind::Usage if the item would write a file that it reads.
void check_own_files(const BatchItem& args);

/// The digest of what determines the files of an item: its input's name, its options as they are given, and the format.
/// The contents of the input are not part of it.
std::string job_digest(const BatchItem& args);

/// Whether all files of an item are there, its image and its data passes: with a ledger those that it records as whole
/// (Ledger::has_whole), else, with --skip-existing, those that can be whole (batch/whole_file.h). False for
/// numbered frames, of which `finished_frames` are skipped.
bool is_finished(const BatchItem& args, const Ledger* ledger = nullptr);

/// The frames of an item whose files are all there and whole, in the same sense, sorted.
std::vector<int> finished_frames(const BatchItem& args, const Ledger* ledger = nullptr);

/// The length of the folder in an item's output, with its slash; that before the frame number, if a folder has it.
std::size_t folder_end(const BatchItem& args);

/// Whether the bytes of a file can be those of a whole one of the item.
///
/// Errors    ErrorKind::Input if it cannot be read.
bool can_be_whole(const BatchItem& args, const std::string& path);

}  // namespace zoneplate
