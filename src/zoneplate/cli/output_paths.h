// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace zoneplate::cli {

/// Checks before any work that `save_folder(path)` will succeed: there must be nothing under this name, and a folder
/// that it can be made in. Of single files: check_savable (os/file.h).
///
/// Errors    ErrorKind::Usage for an empty path; ErrorKind::Output naming the path and the cause.
void check_output_folder(const std::string& path);

/// A file of a folder: its name within the folder, with at most one folder of its own before a '/'.
struct OutputFile {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

/// Makes a folder with these files, whole or not at all. Nothing that was there before is replaced or removed.
///
/// The files are written into a folder `.NAME.PID.tmp` next to `path`. This call creates that folder, under a name that
/// was free, and renames it when the last file is written. After an error it removes what it made itself, name by name.
/// SIGINT, SIGTERM and SIGHUP are held back from the calling thread meanwhile: one that arrives ends the writing
/// before the next file, and is delivered when the unfinished folder is removed.
/// Requires  no other thread that takes these signals.
/// Errors    ErrorKind::Output naming the path and the cause, among them that another run has made the folder
/// meanwhile.
void save_folder(const std::string& path, std::span<const OutputFile> files);

}  // namespace zoneplate::cli
