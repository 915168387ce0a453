// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/run_program.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/run_on_file.h"

namespace zoneplate {
namespace {

constexpr std::string_view default_folders = "/usr/local/bin:/usr/bin:/bin";

/// The folders of PATH, followed by the default ones. Relative folders are ignored, because the found program must not
/// depend on the working directory.
std::string search_path() {
  const char* const variable = std::getenv("PATH");
  std::string out;
  std::istringstream folders((variable ? variable : "") + std::string(":") + std::string(default_folders));
  for (std::string folder; std::getline(folders, folder, ':');)
    if (folder.starts_with('/')) out += (out.empty() ? "" : ":") + folder;
  return out;
}

/// Owns a file descriptor and closes it.
class File {
 public:
  explicit File(int number = -1) : number_(number) {}
  ~File() { close(); }
  File(File&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  File(const File&) = delete;
  File& operator=(File&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  int number() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

[[noreturn]] void fail(const std::string& program, const std::string& what) {
  throw Error(ErrorKind::Failed, program + ": " + what);
}

/// An empty file in memory.
File new_file(const std::string& program) {
  File file(::memfd_create("zoneplate", MFD_CLOEXEC));
  if (file.number() < 0) fail(program, std::strerror(errno));
  return file;
}

std::string first_line_of(const File& file) {
  std::array<char, 2048> part{};
  const ssize_t n = ::pread(file.number(), part.data(), part.size(), 0);
  const std::string text(part.data(), n > 0 ? static_cast<std::size_t>(n) : 0);
  const std::size_t start = std::min(text.size(), text.find_first_not_of(" \t\r\n"));
  return text.substr(start, text.find('\n', start) - start);
}

std::string path_of(const std::string& program) {
  std::istringstream folders(search_path());
  std::error_code ignored;
  for (std::string folder; std::getline(folders, folder, ':');)
    if (const std::string path = folder + '/' + program;
        ::access(path.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(path, ignored))
      return path;
  fail(program, "is not installed");
}

/// The process groups of running programs, for end_programs: a signal handler has no parameter for them. A program
/// beyond their number is not killed by a signal; it then finds its stdin closed.
static_assert(std::atomic<pid_t>::is_always_lock_free);
constinit std::array<std::atomic<pid_t>, 8> groups;

/// A child process. The destructor kills it unless it has ended.
class Child {
 public:
  Child(const std::string& program, const std::vector<std::string>& arguments, int in, int out, int complaints) {
    const std::string path = path_of(program);
    std::vector<char*> words{const_cast<char*>(path.c_str())};
    for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
    words.push_back(nullptr);
    std::vector<char*> variables;
    std::string folders = "PATH=" + search_path(), locale = "LC_ALL=C.UTF-8";
    for (std::string* variable : {&folders, &locale}) variables.push_back(variable->data());
    variables.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    for (const auto& [from, to] : {std::pair{in, 0}, {out, 1}, {complaints, 2}})
      ::posix_spawn_file_actions_adddup2(&actions, from, to);
    // A process group of its own, so that the programs that it starts are killed with it.
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    // SIGTERM is for this process alone, which may finish its work first (process/grace_period.h): an engine sends
    // it to all. The program is ended by SIGKILL.
    sigset_t blocked;
    ::sigemptyset(&blocked), ::sigaddset(&blocked, SIGTERM);
    ::posix_spawnattr_setsigmask(&attributes, &blocked);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
    const int error = ::posix_spawn(&id_, path.c_str(), &actions, &attributes, words.data(), variables.data());
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) fail(program, std::strerror(error));
    for (std::atomic<pid_t>& group : groups) {
      pid_t none = 0;
      if (group.compare_exchange_strong(none, id_)) break;
    }
  }
  ~Child() {
    if (id_ <= 0) return;
    ::kill(-id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
    forget();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// True if the child has ended; `code` is then its exit code.
  bool has_ended(int& code) {
    int status = 0;
    if (::waitpid(id_, &status, WNOHANG) == 0) return false;
    forget();
    id_ = 0;
    code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return true;
  }

 private:
  void forget() {
    for (std::atomic<pid_t>& group : groups) {
      pid_t own = id_;
      group.compare_exchange_strong(own, 0);
    }
  }

  pid_t id_ = 0;
};

/// A program that is running, and what it has printed.
class Running {
 public:
  /// `write` is its stdin.
  Running(const std::string& program, const std::vector<std::string>& arguments, const ProgramLimits& limits)
      : program_(program), limits_(limits), complaints_(new_file(program)) {
    int in[2] = {-1, -1};
    // A socket, unlike a pipe, can be written without SIGPIPE if the program has ended.
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in) != 0) fail(program, std::strerror(errno));
    in_ = File(in[0]);
    start(arguments, File(in[1]));
  }
  /// The contents of `file` are its stdin, which it may open again as /dev/stdin, and in which it may seek.
  Running(const std::string& program, const std::vector<std::string>& arguments, std::span<const std::uint8_t> file,
          const ProgramLimits& limits)
      : program_(program), limits_(limits), complaints_(new_file(program)) {
    File in_of_child = new_file(program);
    if (const int error = write_fully(in_of_child.number(), file); error != 0) fail(program, std::strerror(error));
    ::lseek(in_of_child.number(), 0, SEEK_SET);
    start(arguments, std::move(in_of_child));
  }

  void write(std::span<const std::uint8_t> bytes) {
    const Stopwatch watch;
    while (!bytes.empty() && in_.number() >= 0) {
      check_time(watch);
      if (const short events = wait(); (events & (POLLOUT | POLLERR)) == 0) continue;
      const ssize_t n = ::send(in_.number(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
      if (n >= 0)
        bytes = bytes.subspan(static_cast<std::size_t>(n));
      else if (errno != EINTR && errno != EAGAIN)
        in_.close();
    }
  }

  ProgramResult finish() {
    const Stopwatch watch;
    in_.close();
    while (out_.number() >= 0) check_time(watch), wait();
    while (!child_->has_ended(result_.code)) {
      check_time(watch);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    result_.complaint = first_line_of(complaints_);
    return std::move(result_);
  }

 private:
  void start(const std::vector<std::string>& arguments, File in_of_child) {
    int out[2];
    if (::pipe2(out, O_CLOEXEC) != 0) fail(program_, std::strerror(errno));
    out_ = File(out[0]);
    const File out_of_child(out[1]);
    child_.emplace(program_, arguments, in_of_child.number(), out_of_child.number(), complaints_.number());
  }

  void check_time(const Stopwatch& watch) const {
    if (limits_.check_time) limits_.check_time();
    if (watch.ms() > limits_.milliseconds) fail(program_, "did not answer in time");
  }

  /// Waits for at most 50 ms and reads what there is to read; the events of the program's stdin.
  short wait() {
    pollfd files[] = {{in_.number(), POLLOUT, 0}, {out_.number(), POLLIN, 0}};  // poll ignores negative numbers
    if (::poll(files, 2, 50) <= 0) return 0;
    if (files[1].revents != 0) read_some();
    return files[0].revents;
  }

  void read_some() {
    std::array<std::uint8_t, 65536> part;
    const ssize_t n = ::read(out_.number(), part.data(), part.size());
    if (n < 0 && errno == EINTR) return;
    if (n <= 0) return out_.close();
    result_.out.insert(result_.out.end(), part.begin(), part.begin() + n);
    if (result_.out.size() > limits_.bytes) fail(program_, "answers without end");
  }

  const std::string program_;
  const ProgramLimits limits_;
  const File complaints_;
  File in_, out_;
  std::optional<Child> child_;
  ProgramResult result_;
};

}  // namespace

class RunningProgram::Process : public Running {
  using Running::Running;
};

RunningProgram::RunningProgram(const std::string& program, const std::vector<std::string>& arguments,
                               const ProgramLimits& limits)
    : process_(std::make_unique<Process>(program, arguments, limits)) {}

RunningProgram::~RunningProgram() = default;

void RunningProgram::write(std::span<const std::uint8_t> bytes) { process_->write(bytes); }

ProgramResult RunningProgram::finish() { return process_->finish(); }

void end_programs() {
  for (const std::atomic<pid_t>& group : groups)
    if (const pid_t id = group.load(); id > 0) ::kill(-id, SIGKILL);
}

ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments, const std::string& input,
                        const ProgramLimits& limits) {
  RunningProgram running(program, arguments, limits);
  running.write({reinterpret_cast<const std::uint8_t*>(input.data()), input.size()});
  return running.finish();
}

ProgramResult run_on_file(const std::string& program, const std::vector<std::string>& arguments,
                          std::span<const std::uint8_t> file, const ProgramLimits& limits) {
  return Running(program, arguments, file, limits).finish();
}

}  // namespace zoneplate
