// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/cache_folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <memory>
#include <system_error>
#include <tuple>
#include <vector>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

constexpr std::string_view temporary_end = ".tmp";

bool is_of_user(const struct stat& status) { return status.st_uid == ::geteuid(); }

struct CachedFile {
  timespec used;
  std::uint64_t size;
  std::string name;

  auto key() const { return std::tuple(used.tv_sec, used.tv_nsec, name); }
};

/// The time of the last reading, or that of writing where the file system records no reading.
timespec time_of_use(const struct stat& status) {
  const auto key = [](const timespec& t) { return std::pair(t.tv_sec, t.tv_nsec); };
  return key(status.st_atim) < key(status.st_mtim) ? status.st_mtim : status.st_atim;
}

/// The regular files of the user.
std::vector<CachedFile> files_of(int folder) {
  std::vector<CachedFile> files;
  const int again = ::openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (again < 0) return files;
  const std::unique_ptr<DIR, int (*)(DIR*)> entries(::fdopendir(again), &::closedir);
  if (!entries) {
    ::close(again);
    return files;
  }
  while (const dirent* const entry = ::readdir(entries.get())) {
    struct stat status {};
    if (::fstatat(folder, entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0) continue;
    if (S_ISREG(status.st_mode) && is_of_user(status))
      files.push_back({time_of_use(status), static_cast<std::uint64_t>(status.st_size), entry->d_name});
  }
  return files;
}

}  // namespace

std::optional<CacheFolder> CacheFolder::open(const std::string& path) {
  const int folder = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (folder < 0) return std::nullopt;
  CacheFolder out(folder);
  struct stat status {};
  if (::fstat(folder, &status) != 0 || !is_of_user(status)) return std::nullopt;
  return out;
}

std::optional<CacheFolder> CacheFolder::make(const std::string& path) {
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  ::mkdir(path.c_str(), 0700);
  return open(path);
}

CacheFolder::~CacheFolder() {
  if (folder_ >= 0) ::close(folder_);
}

std::optional<FileBytes> CacheFolder::read(const std::string& name, std::uint64_t limit) const {
  // A pipe without a writer is opened at once, and then left.
  const int file = ::openat(folder_, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  std::optional<FileBytes> bytes;
  struct stat status {};
  if (::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && is_of_user(status)) {
    try {
      bytes.emplace(file, name, limit);
    } catch (const Error&) {  // it is too large, or cannot be read
    }
  }
  ::close(file);
  return bytes;
}

void CacheFolder::store(const std::string& name, std::span<const std::uint8_t> bytes) const {
  const std::string temporary = "." + name + "." + std::to_string(::getpid()) + std::string(temporary_end);
  // The name may be taken by a process of another container with this number, or left by one: then trim removes it.
  const int file = ::openat(folder_, temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) return;
  const bool is_written = write_fully(file, bytes) == 0;
  if (::close(file) != 0 || !is_written || ::renameat(folder_, temporary.c_str(), folder_, name.c_str()) != 0)
    ::unlinkat(folder_, temporary.c_str(), 0);
}

void CacheFolder::trim(std::string_view end, std::uint64_t most) const {
  constexpr std::time_t seconds_of_writing = 3600;  // no process takes so long to write a file
  std::vector<CachedFile> files = files_of(folder_);
  std::sort(files.begin(), files.end(), [](const CachedFile& a, const CachedFile& b) { return a.key() < b.key(); });
  std::uint64_t total = 0;
  for (const CachedFile& file : files)
    if (file.name.ends_with(end)) total += file.size;
  for (const CachedFile& file : files) {
    const bool is_old = file.used.tv_sec < std::time(nullptr) - seconds_of_writing;
    // Another process may have removed it; one that reads it keeps its bytes.
    if (file.name.ends_with(end) && total > most) {
      ::unlinkat(folder_, file.name.c_str(), 0);
      total -= file.size;
    } else if (file.name.starts_with('.') && file.name.ends_with(temporary_end) && is_old) {
      ::unlinkat(folder_, file.name.c_str(), 0);
    }
  }
}

}  // namespace zoneplate
