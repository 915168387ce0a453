// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace zoneplate {

/// The files and subfolders of an earlier output, by their names within its folder: what may be replaced. Nothing if
/// there is no earlier output.
using EarlierFiles = std::optional<std::set<std::string>>;

/// Checks before any work that `save_folder(path, files, earlier)` can succeed: the name must be unused, or that of a
/// folder that holds nothing but `earlier` files, and its parent folder writable. For single files, see check_savable
/// (os/file.h).
///
/// Errors    ErrorKind::Usage for an empty path; ErrorKind::Output naming the path and the cause, for example the file
///           that is not an earlier one.
void check_output_folder(const std::string& path, const EarlierFiles& earlier = {});

/// A file of a folder: its name within the folder, with at most one subfolder before a '/'.
struct OutputFile {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

/// Creates a folder with these files, completely or not at all. It replaces a folder only if that holds nothing but
/// `earlier` files, regular ones; otherwise no existing file is replaced or removed. A file that appears in the folder
/// while it is replaced is kept, and the error names its place.
///
/// The files are written into a folder `.NAME.PID.tmp` next to `path`. This call creates that folder under an unused
/// name, and renames it after the last file. After an error it removes what it created, name by name. Meanwhile SIGINT,
/// SIGTERM and SIGHUP are blocked for the calling thread: a signal that arrives ends the writing before the next file,
/// and is delivered after the unfinished folder is removed.
/// Requires  no other thread receives these signals.
/// Errors    ErrorKind::Output naming the path and the cause, for example that another run has created the folder in
///           the meantime; ErrorKind::Failed for a name with more than one subfolder, or that leads elsewhere.
void save_folder(const std::string& path, std::span<const OutputFile> files, const EarlierFiles& earlier = {});

}  // namespace zoneplate
