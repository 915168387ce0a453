// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/run_program.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string_view>
#include <thread>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

constexpr std::string_view usual_folders = "/usr/local/bin:/usr/bin:/bin";

/// The folders of PATH, followed by the default ones. Relative folders are ignored, because the found program must not
/// depend on the working directory.
std::string search_path() {
  const char* const variable = std::getenv("PATH");
  std::string out;
  std::istringstream folders((variable ? variable : "") + std::string(":") + std::string(usual_folders));
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
  File& operator=(const File&) = delete;

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

/// An in-memory file that contains `text`, positioned at its start: unlike a pipe it accepts everything at once, and no
/// SIGPIPE is raised if a child ends early.
File file_of(const std::string& program, const std::string& text) {
  File file(::memfd_create("zoneplate", MFD_CLOEXEC));
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = ::write(file.number(), text.data() + at, text.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail(program, std::strerror(errno));
    at += static_cast<std::size_t>(n);
  }
  if (file.number() < 0 || ::lseek(file.number(), 0, SEEK_SET) != 0) fail(program, std::strerror(errno));
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
    const int error = ::posix_spawn(&id_, path.c_str(), &actions, nullptr, words.data(), variables.data());
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) fail(program, std::strerror(error));
  }
  ~Child() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// True if the child has ended; `code` is then its exit code.
  bool has_ended(int& code) {
    int status = 0;
    if (::waitpid(id_, &status, WNOHANG) == 0) return false;
    id_ = 0;
    code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return true;
  }

 private:
  pid_t id_ = 0;
};

ProgramResult run(const std::string& program, const std::vector<std::string>& arguments, int input,
                  const ProgramLimits& limits) {
  const Stopwatch watch;
  const auto check_time = [&] {
    if (watch.ms() > limits.milliseconds) fail(program, "did not answer in time");
  };
  const File complaints = file_of(program, "");
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail(program, std::strerror(errno));
  const File out(ends[0]);
  File out_of_child(ends[1]);
  Child child(program, arguments, input, out_of_child.number(), complaints.number());
  out_of_child.close();

  ProgramResult answer;
  for (std::array<std::uint8_t, 65536> part;;) {
    check_time();
    pollfd waiting{out.number(), POLLIN, 0};
    if (::poll(&waiting, 1, 50) <= 0) continue;
    const ssize_t n = ::read(out.number(), part.data(), part.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    answer.out.insert(answer.out.end(), part.begin(), part.begin() + n);
    if (answer.out.size() > limits.bytes) fail(program, "answers without end");
  }
  while (!child.has_ended(answer.code)) {
    check_time();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  answer.complaint = first_line_of(complaints);
  return answer;
}

}  // namespace

ScratchFile::ScratchFile(std::string owner) : owner_(std::move(owner)) {
  std::string name = (std::filesystem::temp_directory_path() / "zoneplate_XXXXXX").string();
  number_ = ::mkostemp(name.data(), O_CLOEXEC);
  if (number_ < 0) fail(owner_, "no temporary file: " + std::string(std::strerror(errno)));
  ::unlink(name.c_str());
}

ScratchFile::~ScratchFile() { ::close(number_); }

void ScratchFile::append(std::span<const std::uint8_t> bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t n = ::write(number_, bytes.data() + at, bytes.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail(owner_, "its temporary file cannot be written: " + std::string(std::strerror(errno)));
    at += static_cast<std::size_t>(n);
  }
  size_ += bytes.size();
}

ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments, const std::string& input,
                        const ProgramLimits& limits) {
  const File in = file_of(program, input);
  return run(program, arguments, in.number(), limits);
}

ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments, const ScratchFile& input,
                        const ProgramLimits& limits) {
  if (::lseek(input.number(), 0, SEEK_SET) != 0) fail(program, std::strerror(errno));
  return run(program, arguments, input.number(), limits);
}

}  // namespace zoneplate
