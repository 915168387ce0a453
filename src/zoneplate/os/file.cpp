// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/file.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/size_text.h"
#include "zoneplate/os/mapped_file_guard.h"

namespace zoneplate {
namespace {

std::string cause_of(int error) { return std::system_category().message(error); }

Error read_error(const std::string& path, const std::string& cause) {
  return Error(ErrorKind::Input, (path == "-" ? "standard input" : path) + ": cannot be read: " + cause);
}

Error write_error(const std::string& path, const std::string& cause) {
  return Error(ErrorKind::Output, (path == "-" ? "standard output" : path) + ": cannot be written: " + cause);
}

/// Owns a file descriptor and closes it; -1 means none.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int fd() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

int open_retrying(const char* path, int flags, mode_t mode = 0) {
  int fd = -1;
  do fd = ::open(path, flags | O_CLOEXEC, mode);
  while (fd < 0 && errno == EINTR);
  return fd;
}

/// Reads up to `count` bytes; fewer only at the end of the file.
std::size_t read_some(int fd, std::uint8_t* out, std::size_t count, const std::string& path) {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t n = ::read(fd, out + done, std::min(count - done, std::size_t{1} << 30));
    if (n == 0) break;
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (errno == EAGAIN) {
      pollfd wait{fd, POLLIN, 0};
      ::poll(&wait, 1, -1);
    } else if (errno != EINTR) {
      throw read_error(path, cause_of(errno));
    }
  }
  return done;
}

Error too_large(const std::string& path, std::uint64_t limit) {
  return read_error(path, "larger than the limit of " + size_text(limit));
}

/// Reads to the end of the file into a buffer whose capacity doubles.
std::span<const std::uint8_t> read_all(int fd, const std::string& path, std::uint64_t limit) {
  std::size_t capacity = std::size_t{1} << 16, size = 0;
  auto buffer = std::make_unique<std::uint8_t[]>(capacity);
  while (true) {
    check_deadline();
    size += read_some(fd, buffer.get() + size, capacity - size, path);
    if (size > limit) throw too_large(path, limit);
    if (size < capacity) return {buffer.release(), size};
    auto larger = std::make_unique<std::uint8_t[]>(2 * capacity);
    std::memcpy(larger.get(), buffer.get(), size);
    buffer = std::move(larger);
    capacity *= 2;
  }
}

/// Whether the name is that of an open descriptor, from which the user has data read that are in no file: standard
/// input, or a shell's process substitution.
bool is_open_descriptor(const std::string& path) {
  return path == "-" || path == "/dev/stdin" || path.starts_with("/dev/fd/") || path.starts_with("/proc/self/fd/");
}

void check_kind(const std::string& path, const struct stat& status) {
  const auto refuse = [&](const char* what) {
    throw Error(ErrorKind::Input, (path == "-" ? "standard input" : path) + ": is " + what + ", not a file");
  };
  if (S_ISDIR(status.st_mode)) refuse("a directory");
  if (is_open_descriptor(path)) return;
  if (S_ISFIFO(status.st_mode)) refuse("a FIFO");
  if (S_ISSOCK(status.st_mode)) refuse("a socket");
  if (S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode)) refuse("a device");
}

/// Throws if an open file is the text that Git LFS keeps in its place until it is fetched.
void check_is_fetched(int fd, const std::string& path, const struct stat& status) {
  constexpr std::string_view pointer = "version https://git-lfs.github.com/spec/";
  constexpr off_t size_limit = 1024;  // of Git LFS's specification
  if (!S_ISREG(status.st_mode) || status.st_size >= size_limit) return;
  std::array<char, pointer.size()> begin{};
  if (::pread(fd, begin.data(), begin.size(), 0) == ssize_t{begin.size()} &&
      std::string_view(begin.data(), begin.size()) == pointer)
    throw Error(ErrorKind::Input, path + ": is a pointer of Git LFS to a file that is not fetched: see `git lfs pull`");
}

}  // namespace

void check_is_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) check_kind(path, status);
}

namespace {

/// Opens a file whose kind the caller checks: another one may be there by then.
int open_to_read(const std::string& path) {
  check_is_file(path);  // a socket, which cannot be opened
  // Without O_NONBLOCK, opening a FIFO waits for its writer.
  return open_retrying(path.c_str(), O_RDONLY | (is_open_descriptor(path) ? 0 : O_NONBLOCK));
}

/// The status of an input that was opened, `fd` >= 0, and is a file, or what a user may have given in place of one.
struct stat checked_status(int fd, const std::string& path) {
  struct stat status {};
  if (fd < 0 || ::fstat(fd, &status) != 0) throw read_error(path, cause_of(errno));
  check_kind(path, status);
  check_is_fetched(fd, path, status);
  return status;
}

}  // namespace

FileBytes::FileBytes(const std::string& path, std::uint64_t limit) {
  const bool is_stdin = path == "-";
  const Descriptor file(is_stdin ? -1 : open_to_read(path));
  *this = FileBytes(is_stdin ? STDIN_FILENO : file.fd(), path, limit);
}

FileBytes::FileBytes(int fd, const std::string& path, std::uint64_t limit) {
  const struct stat status = checked_status(fd, path);

  // A file of known size is mapped; other inputs are read.
  if (S_ISREG(status.st_mode) && status.st_size > 0 && path != "-") {
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (size > limit) throw too_large(path, limit);
    // The mapping is writable and private although it is never written, because the kernel then counts it as data of
    // the process (RLIMIT_DATA).
    void* place = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_NORESERVE, fd, 0);
    if (place != MAP_FAILED) {
      bytes_ = {static_cast<const std::uint8_t*>(place), size};
      mapped_ = true;
      enter_mapping(place, size);
      return;
    }
  }
  bytes_ = read_all(fd, path, limit);
}

FileBytes FileBytes::reclaimable(const std::string& path) {
  const Descriptor file(open_to_read(path));
  return reclaimable(file.fd(), path);
}

FileBytes FileBytes::reclaimable(int fd, const std::string& path) {
  const struct stat status = checked_status(fd, path);
  if (!S_ISREG(status.st_mode) || status.st_size <= 0) throw read_error(path, "not a file with contents");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  // A mapping that is only read is no data of the process (RLIMIT_DATA).
  void* place = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  if (place == MAP_FAILED) throw read_error(path, cause_of(errno));
  FileBytes out;
  out.bytes_ = {static_cast<const std::uint8_t*>(place), size};
  out.mapped_ = true;
  enter_mapping(place, size);
  return out;
}

void read_parts(const std::string& path, const std::function<bool(std::span<const std::uint8_t>)>& take) {
  const bool is_stdin = path == "-";
  const Descriptor file(is_stdin ? -1 : open_to_read(path));
  const int fd = is_stdin ? STDIN_FILENO : file.fd();
  static_cast<void>(checked_status(fd, path));
  std::vector<std::uint8_t> part(std::size_t{1} << 20);
  for (bool wants_more = true; wants_more;) {
    const std::size_t size = read_some(fd, part.data(), part.size(), path);
    wants_more = take(std::span(part).first(size)) && size == part.size();
  }
}

FileBytes::~FileBytes() {
  if (mapped_) {
    leave_mapping(bytes_.data());
    ::munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size());
  } else {
    delete[] bytes_.data();
  }
}

void FileBytes::advise(const void* part, std::size_t size, int advice) const {
  constexpr std::uintptr_t page = 4096;
  const auto begin = (reinterpret_cast<std::uintptr_t>(part) + page - 1) / page * page;
  const auto end = (reinterpret_cast<std::uintptr_t>(part) + size) / page * page;
  if (mapped_ && begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, advice);
}

void FileBytes::forget(const void* part, std::size_t size) const { advise(part, size, MADV_DONTNEED); }
void FileBytes::read_ahead(const void* part, std::size_t size) const { advise(part, size, MADV_WILLNEED); }

FileBytes::FileBytes(FileBytes&& other) noexcept
    : bytes_(std::exchange(other.bytes_, {})), mapped_(std::exchange(other.mapped_, false)) {}

FileBytes& FileBytes::operator=(FileBytes&& other) noexcept {
  std::swap(bytes_, other.bytes_);
  std::swap(mapped_, other.mapped_);
  return *this;
}

namespace {

/// The names of the temporary files that are being written, for remove_temporaries.
///
/// A signal handler has no parameter for them, so that this is the library's only global state: a fixed table whose
/// entries change owners by one atomic variable each. A file whose name finds no free entry, or is too long for one, is
/// written without an entry; then a fatal signal leaves it behind.
enum class Entry { Free, Filling, Live, Removing };
struct Slot {
  std::atomic<Entry> entry{Entry::Free};
  std::array<char, PATH_MAX> path{};
};
static_assert(std::atomic<Entry>::is_always_lock_free);
constinit std::array<Slot, 8> slots;

Slot* enter(const std::string& path) {
  if (path.size() >= PATH_MAX) return nullptr;
  for (Slot& slot : slots) {
    Entry expected = Entry::Free;
    if (!slot.entry.compare_exchange_strong(expected, Entry::Filling)) continue;
    std::memcpy(slot.path.data(), path.c_str(), path.size() + 1);
    slot.entry = Entry::Live;
    return &slot;
  }
  return nullptr;
}

void leave(Slot* slot) {
  // An entry whose file is being removed by a signal handler is freed by the handler.
  Entry expected = Entry::Live;
  if (slot) slot->entry.compare_exchange_strong(expected, Entry::Free);
}

}  // namespace

/// A new file in the folder of `target`, which `commit` gives that name; otherwise the destructor removes it.
///
/// Until then it has no name where the file system supports that (O_TMPFILE), so that even SIGKILL leaves nothing
/// behind; else, as on NFS, and for the moment in which it replaces a file, it has a hidden one.
class FileWriter::Temporary {
 public:
  Temporary(const std::filesystem::path& target, const std::string& name) : target_(target) {
    const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
    fd_ = open_retrying(folder.c_str(), O_RDWR | O_TMPFILE, 0666);
    if (fd_ < 0) take_hidden_name(name, [&] { return (fd_ = open_new(path_)) >= 0; });
  }

  ~Temporary() {
    if (fd_ >= 0) ::close(fd_);
    if (path_.empty()) return;
    if (!is_committed_) ::unlink(path_.c_str());
    leave(slot_);
  }

  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  int fd() const { return fd_; }

  void commit(const std::string& name) {
    if (path_.empty()) {
      // Closing a copy of the descriptor reports what closing the file would, and keeps it.
      if (const int copy = ::dup(fd_); copy >= 0 && ::close(copy) != 0 && errno != EINTR)
        throw write_error(name, cause_of(errno));
      if (link_as(target_)) return;
      take_hidden_name(name, [&] { return link_as(path_) || (errno != EEXIST && copy_to(path_)); });
    }
    if (::close(std::exchange(fd_, -1)) != 0 && errno != EINTR) throw write_error(name, cause_of(errno));
    if (::rename(path_.c_str(), target_.c_str()) != 0) throw write_error(name, cause_of(errno));
    is_committed_ = true;
  }

 private:
  static int open_new(const std::string& path) { return open_retrying(path.c_str(), O_RDWR | O_CREAT | O_EXCL, 0666); }
  bool link_as(const std::string& path) const {
    const std::string unnamed = "/proc/self/fd/" + std::to_string(fd_);
    return ::linkat(AT_FDCWD, unnamed.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0;
  }
  /// Goes on with a copy, where there is no /proc or a policy forbids links.
  bool copy_to(const std::string& path) {
    const int copy = open_new(path);
    if (copy < 0) return false;
    off_t at = 0;
    ssize_t sent = 1;
    while (sent > 0) sent = ::sendfile(copy, fd_, &at, std::size_t{1} << 30);
    struct stat status {};
    if (sent == 0 && ::fstat(fd_, &status) == 0) static_cast<void>(::fchmod(copy, status.st_mode & 07777));
    const int error = errno;
    ::close(std::exchange(fd_, copy));
    if (sent < 0) ::unlink(path.c_str());
    errno = error;
    return sent == 0;
  }

  /// Sets `path_` to a name in the target's folder under which `make` makes the file.
  void take_hidden_name(const std::string& name, const std::function<bool()>& make) {
    const std::filesystem::path target = target_, folder = target.parent_path();
    // Only part of a very long name is used, so that the temporary name does not exceed the limit.
    const std::string stem = "." + target.filename().string().substr(0, 200) + "." + std::to_string(::getpid());
    for (int attempt = 0; attempt < 100; ++attempt) {
      const std::string suffix = attempt == 0 ? ".tmp" : "." + std::to_string(attempt) + ".tmp";
      path_ = (folder / (stem + suffix)).string();
      slot_ = enter(path_);
      if (make()) return;
      const int error = errno;
      leave(slot_);
      const std::string taken = std::exchange(path_, {});
      std::error_code ignored;
      if (error == ENOENT && !std::filesystem::is_directory(folder.empty() ? "." : folder, ignored))
        throw write_error(name, "no directory " + folder.string());
      if (error != EEXIST) throw write_error(name, cause_of(error));
      if (attempt == 99) throw write_error(name, "its temporary names are taken, as " + taken);
    }
  }

  const std::string target_;
  std::string path_;  ///< empty while the file has no name
  Slot* slot_ = nullptr;
  int fd_ = -1;
  bool is_committed_ = false;
};

namespace {

/// During its lifetime, a write to a closed pipe is an error of the call and not a signal.
class PipeSignalBlocked {
 public:
  PipeSignalBlocked() {
    sigset_t pending;
    ::sigpending(&pending);
    was_pending_ = ::sigismember(&pending, SIGPIPE) == 1;
    ::sigemptyset(&pipe_);
    ::sigaddset(&pipe_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~PipeSignalBlocked() {
    const timespec at_once{};
    if (!was_pending_) ::sigtimedwait(&pipe_, nullptr, &at_once);
    ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  PipeSignalBlocked(const PipeSignalBlocked&) = delete;
  PipeSignalBlocked& operator=(const PipeSignalBlocked&) = delete;

 private:
  sigset_t pipe_{}, before_{};
  bool was_pending_ = false;
};

void write_all(int fd, std::span<const std::uint8_t> bytes, const std::string& name) {
  if (const int error = write_fully(fd, bytes); error != 0) throw write_error(name, cause_of(error));
}

/// Opens an existing device or pipe and writes to it.
void write_in_place(const std::string& path, std::span<const std::uint8_t> bytes) {
  Descriptor file(open_retrying(path.c_str(), O_WRONLY | O_TRUNC));
  if (file.fd() < 0) throw write_error(path, cause_of(errno));
  write_all(file.fd(), bytes, path);
  if (::close(file.release()) != 0 && errno != EINTR) throw write_error(path, cause_of(errno));
}

/// True for descriptors of the process and for devices, which are never replaced by a new file, even if they refer to a
/// regular one.
bool is_process_or_device(const std::filesystem::path& path) {
  const std::string name = path.string();
  return name.starts_with("/proc/") || (name.starts_with("/dev/") && !name.starts_with("/dev/shm/"));
}

/// The target of a chain of symbolic links, which need not exist.
std::filesystem::path follow_links(const std::string& name) {
  std::filesystem::path path = name;
  for (int links = 0; links < 40; ++links) {
    std::error_code none;
    if (is_process_or_device(path)) return path;
    const std::filesystem::path next = std::filesystem::read_symlink(path, none);
    if (none) return path;
    path = path.parent_path() / next;
  }
  throw write_error(name, cause_of(ELOOP));
}

void check_name(const std::string& path) {
  if (path.empty() || path.find('\0') != std::string::npos) throw write_error(path, "not a file name");
}

/// Throws if `target` cannot be replaced. `status` is that of the existing file, or null if there is none.
void check_target(const std::string& path, const std::filesystem::path& target, const struct stat* status) {
  if (status && S_ISDIR(status->st_mode)) throw write_error(path, "it is a directory");
  if (status && ::access(path.c_str(), W_OK) != 0) throw write_error(path, cause_of(errno));
  if (target.filename().empty()) throw write_error(path, "it names a directory");
}

bool is_written_in_place(const std::filesystem::path& target, const struct stat* status) {
  return target == "/dev/stdout" || (status && (!S_ISREG(status->st_mode) || is_process_or_device(target)));
}

}  // namespace

int write_fully(int file, std::span<const std::uint8_t> bytes) {
  const PipeSignalBlocked guard;
  while (!bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), std::min(bytes.size(), std::size_t{1} << 30));
    if (n > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    } else if (n < 0 && errno == EAGAIN) {
      pollfd wait{file, POLLOUT, 0};
      ::poll(&wait, 1, -1);
    } else if (n == 0 || errno != EINTR) {
      return n == 0 ? EIO : errno;
    }
  }
  return 0;
}

std::string link_target(const std::string& path) { return follow_links(path).string(); }

FileWriter::FileWriter(std::string path) : path_(std::move(path)) {
  if (path_ == "-") return;
  check_name(path_);
  const std::filesystem::path target = follow_links(path_);
  struct stat status {};
  const bool is_there = ::stat(path_.c_str(), &status) == 0;
  check_target(path_, target, is_there ? &status : nullptr);
  if (is_written_in_place(target, is_there ? &status : nullptr)) return;

  // The new file takes over the permissions of the replaced one, if the file system supports that.
  file_ = std::make_unique<Temporary>(target, path_);
  if (is_there) static_cast<void>(::fchmod(file_->fd(), status.st_mode & 07777));
}

FileWriter::~FileWriter() = default;

void FileWriter::write(std::span<const std::uint8_t> bytes) {
  if (file_)
    write_all(file_->fd(), bytes, path_);
  else
    kept_.insert(kept_.end(), bytes.begin(), bytes.end());
}

void FileWriter::commit() {
  if (file_) return file_->commit(path_);
  if (path_ == "-" || follow_links(path_) == "/dev/stdout") return write_all(STDOUT_FILENO, kept_, path_);
  write_in_place(path_, kept_);
}

void save_bytes(const std::string& path, std::span<const std::uint8_t> bytes) {
  FileWriter file(path);
  file.write(bytes);
  file.commit();
}

void check_savable(const std::string& path) {
  if (path == "-") return;
  check_name(path);
  const std::filesystem::path target = follow_links(path);
  struct stat status {};
  const bool is_there = ::stat(path.c_str(), &status) == 0;
  if (!is_there && errno != ENOENT) throw write_error(path, cause_of(errno));
  check_target(path, target, is_there ? &status : nullptr);
  if (is_written_in_place(target, is_there ? &status : nullptr)) return;
  const std::string folder = target.has_parent_path() ? target.parent_path().string() : ".";
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw write_error(path, errno == ENOENT ? "no directory " + folder : folder + ": " + cause_of(errno));
}

void remove_temporaries() {
  const int error = errno;
  for (Slot& slot : slots) {
    Entry expected = Entry::Live;
    if (!slot.entry.compare_exchange_strong(expected, Entry::Removing)) continue;
    ::unlink(slot.path.data());
    slot.entry = Entry::Free;
  }
  errno = error;
}

}  // namespace zoneplate
