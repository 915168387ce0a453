// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace zoneplate::cli {

/// Checks before any work that `save_folder(path, files, replaced)` can succeed: the name must be unused, or that of a
/// folder with a file of the name `replaced`, and its parent folder writable. For single files, see check_savable
/// (os/file.h).
///
/// Errors    ErrorKind::Usage for an empty path; ErrorKind::Output naming the path and the cause.
void check_output_folder(const std::string& path, const std::string& replaced = "");

/// A file of a folder: its name within the folder, with at most one subfolder before a '/'.
struct OutputFile {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

/// Creates a folder with these files, completely or not at all. It replaces a folder only if `replaced` is not empty
/// and that folder has a file of this name, by which a command recognises its own output; otherwise no existing file is
/// replaced or removed.
///
/// The files are written into a folder `.NAME.PID.tmp` next to `path`. This call creates that folder under an unused
/// name, and renames it after the last file. After an error it removes what it created, name by name. Meanwhile SIGINT,
/// SIGTERM and SIGHUP are blocked for the calling thread: a signal that arrives ends the writing before the next file,
/// and is delivered after the unfinished folder is removed.
/// Requires  no other thread receives these signals.
/// Errors    ErrorKind::Output naming the path and the cause, for example that another run has created the folder in
///           the meantime.
void save_folder(const std::string& path, std::span<const OutputFile> files, const std::string& replaced = "");

}  // namespace zoneplate::cli
