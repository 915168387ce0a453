// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/output_paths.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fcntl.h>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <set>

#include "zoneplate/base/error.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorKind::Output, path + ": " + why);
}

constexpr const char* is_there = "is there already; give another folder or remove it";

/// The status of what has this name, itself and not where a link leads; nothing if there is nothing.
std::optional<struct stat> status_of(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0) return std::nullopt;
  return status;
}

/// The name within the folder of the first entry that is not an earlier file or subfolder; nothing if all are.
std::optional<std::string> foreign_entry(const std::string& folder, const std::set<std::string>& earlier) {
  std::set<std::string> foreign;
  for (fs::recursive_directory_iterator entry(folder), end; entry != end; ++entry) {
    const std::string name = entry->path().lexically_relative(folder).string();
    const bool is_plain = !entry->is_symlink() && (entry->is_directory() || entry->is_regular_file());
    if (is_plain && earlier.contains(name)) continue;
    foreign.insert(name);
    entry.disable_recursion_pending();
  }
  if (foreign.empty()) return std::nullopt;
  return *foreign.begin();
}

/// Requires  there is something of this name.
void check_replaceable(const std::string& path, const EarlierFiles& earlier) {
  const std::optional<struct stat> status = status_of(path);
  if (!earlier || !status || !S_ISDIR(status->st_mode)) refuse(path, is_there);
  std::optional<std::string> foreign;
  try {
    foreign = foreign_entry(path, *earlier);
  } catch (const fs::filesystem_error& error) {
    refuse(path, "cannot be read: " + error.code().message());
  }
  if (foreign)
    refuse(path, fmt::format("is not replaced, because it has {}, which is not of the earlier output", *foreign));
}

/// A name of a file, or of one in a subfolder.
bool is_inner_name(const std::string& name) {
  const std::size_t slash = name.find('/');
  const auto is_part = [](std::string_view part) {
    return !part.empty() && part != "." && part != ".." && part.find_first_of(std::string_view("/\0", 2)) == part.npos;
  };
  if (slash == name.npos) return is_part(name);
  return is_part(std::string_view(name).substr(0, slash)) && is_part(std::string_view(name).substr(slash + 1));
}

std::string without_slashes(std::string path) {
  while (path.size() > 1 && path.ends_with('/')) path.pop_back();
  return path;
}

void check_parent(const std::string& path) {
  const fs::path parent = fs::path(path).parent_path();
  const std::string folder = parent.empty() ? "." : parent.string();
  struct stat status {};
  if (::stat(folder.c_str(), &status) != 0)
    refuse(path, errno == ENOENT ? "no directory " + folder : folder + ": " + std::strerror(errno));
  if (!S_ISDIR(status.st_mode)) refuse(path, folder + " is not a directory");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse(path, fmt::format("nothing can be written into {}: {}", folder, std::strerror(errno)));
}

/// Blocks the signals that end the program for the calling thread, unless they are ignored.
class HeldSignals {
 public:
  HeldSignals() {
    ::sigemptyset(&held_);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      struct sigaction action {};
      if (::sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN) ::sigaddset(&held_, signal);
    }
    ::pthread_sigmask(SIG_BLOCK, &held_, &before_);
  }
  ~HeldSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  HeldSignals(const HeldSignals&) = delete;
  HeldSignals& operator=(const HeldSignals&) = delete;

  bool has_one() const {
    sigset_t pending;
    ::sigpending(&pending);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP})
      if (::sigismember(&held_, signal) == 1 && ::sigismember(&pending, signal) == 1) return true;
    return false;
  }

 private:
  sigset_t held_{}, before_{};
};

/// A new folder next to `target`, which `commit` renames to `target`; otherwise it is removed together with its files.
class StagedFolder {
 public:
  explicit StagedFolder(const std::string& target) : target_(target) {
    const fs::path path(target);
    // Only part of a very long name is used, so that the temporary name does not exceed the limit.
    const std::string stem = fmt::format(".{}.{}", path.filename().string().substr(0, 200), ::getpid());
    for (int attempt = 0; attempt < 100; ++attempt) {
      root_ = (path.parent_path() / (attempt == 0 ? stem + ".tmp" : fmt::format("{}.{}.tmp", stem, attempt))).string();
      if (::mkdir(root_.c_str(), 0777) == 0) return;
      if (errno != EEXIST) refuse(target, std::string("cannot be made: ") + std::strerror(errno));
    }
    refuse(target, "its temporary names are taken, as " + root_);
  }
  ~StagedFolder() {
    if (is_committed_) return;
    for (const std::string& file : files_) ::unlink(file.c_str());
    for (const std::string& folder : folders_) ::rmdir(folder.c_str());
    ::rmdir(root_.c_str());
  }
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  void write(const OutputFile& file) {
    if (!is_inner_name(file.name)) throw Error(ErrorKind::Failed, file.name + ": is no name of a file in a folder");
    if (const std::size_t slash = file.name.find('/'); slash != std::string::npos) {
      const std::string folder = root_ + '/' + file.name.substr(0, slash);
      if (folders_.insert(folder).second && ::mkdir(folder.c_str(), 0777) != 0)
        refuse(target_, std::string("cannot be made: ") + std::strerror(errno));
    }
    const std::string path = root_ + '/' + file.name;
    files_.insert(path);
    save_bytes(path, file.bytes);
  }

  void commit(const EarlierFiles& earlier) {
    if (earlier && status_of(target_)) {
      check_replaceable(target_, earlier);
      if (exchange(*earlier)) return;
    }
    int result = ::renameat2(AT_FDCWD, root_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE);
    // File systems without this flag use plain rename, which replaces only empty folders.
    if (result != 0 && (errno == EINVAL || errno == ENOSYS)) result = ::rename(root_.c_str(), target_.c_str());
    if (result != 0)
      refuse(target_, errno == EEXIST || errno == ENOTEMPTY || errno == ENOTDIR
                          ? is_there
                          : std::string("cannot be made: ") + std::strerror(errno));
    is_committed_ = true;
  }

 private:
  /// Gives the staged folder the target's name, and removes the earlier files. False if the file system cannot.
  bool exchange(const std::set<std::string>& earlier) {
    if (::renameat2(AT_FDCWD, root_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) != 0) return false;
    is_committed_ = true;
    for (const std::string& name : earlier) {
      const std::string path = root_ + '/' + name;
      const std::optional<struct stat> status = status_of(path);
      if (is_inner_name(name) && status && S_ISREG(status->st_mode)) ::unlink(path.c_str());
    }
    for (const std::string& name : earlier)
      if (is_inner_name(name)) ::rmdir((root_ + '/' + name).c_str());
    if (::rmdir(root_.c_str()) != 0)
      refuse(target_, "is replaced; files that are not of the earlier output are kept in " + root_);
    return true;
  }

  std::string target_, root_;
  std::set<std::string> files_, folders_;
  bool is_committed_ = false;
};

}  // namespace

void check_output_folder(const std::string& output, const EarlierFiles& earlier) {
  if (output.empty()) throw Error(ErrorKind::Usage, "no output: give -o DIR");
  const std::string path = without_slashes(output);
  if (status_of(path))
    check_replaceable(path, earlier);
  else if (errno != ENOENT && errno != ENOTDIR)
    refuse(path, std::string("cannot be made: ") + std::strerror(errno));
  check_parent(path);
}

void save_folder(const std::string& output, std::span<const OutputFile> files, const EarlierFiles& earlier) {
  const HeldSignals signals;
  StagedFolder staged(without_slashes(output));
  for (const OutputFile& file : files) {
    if (signals.has_one()) refuse(output, "is not made: a signal ended the run");
    staged.write(file);
  }
  staged.commit(earlier);
}

}  // namespace zoneplate
