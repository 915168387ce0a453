#include "zoneplate/scene/import_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <exception>

#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/sandbox.h"

namespace zoneplate {
namespace {

/// Beyond the limit of decoded data: what readers need on the way, and the stacks of threads.
constexpr std::uint64_t spare_bytes = std::uint64_t{512} << 20;

/// A fact of the process, as its number is: written once, before the child has a second thread.
bool is_child = false;

/// The first byte of an answer: this, or the kind of trouble that the rest, a text, tells of.
constexpr std::uint8_t good = 255;

void write_whole(int pipe, const void* data, std::size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(pipe, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);
    at += n, size -= static_cast<std::size_t>(n);
  }
}

[[noreturn]] void tell(int pipe, Trouble trouble, const std::string& cause) {
  const auto kind = static_cast<std::uint8_t>(trouble);
  write_whole(pipe, &kind, 1);
  write_whole(pipe, cause.data(), cause.size());
  ::_exit(0);
}

struct Task {
  const std::string& place;
  const std::function<void()>& prepare;
  const std::function<void(ImportAnswer&)>& work;
};

[[noreturn]] void be_child(int pipe, pid_t parent, int threads, const LoadLimits& limits, std::uint64_t memory,
                           const Task& task) {
  is_child = true;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  ImportAnswer answer(pipe);
  try {
    if (task.prepare) task.prepare();
    limit_resources(2 * memory + spare_bytes, limits.seconds * threads);
    if (!enter_sandbox()) throw Error(Trouble::Failed, task.place + ": the system has no filter for system calls");
    with_threads(threads, [&] { task.work(answer); });
    ::_exit(0);
  } catch (const Error& error) {
    if (!answer.is_begun()) tell(pipe, error.trouble(), error.what());
  } catch (const std::exception&) {
    if (!answer.is_begun())
      tell(pipe, Trouble::Input, task.place + ": needs more memory than the limit (--max-memory)");
  }
  ::_exit(1);
}

std::string cause_of(int status) {
  if (WIFEXITED(status)) return "its reader gave no answer";
  switch (WTERMSIG(status)) {
    case SIGSYS:
      return "its reader asked the system for what no reader needs, and was ended";
    case SIGXCPU:
    case SIGKILL:
      return "its reader ran out of time or memory (--max-import-seconds, --max-memory)";
    default:
      return "its reader crashed (signal " + std::to_string(WTERMSIG(status)) + ")";
  }
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

}  // namespace

bool is_import_child() { return is_child; }

void ImportAnswer::write(const void* data, std::size_t size) {
  if (!is_begun_) write_whole(pipe_, &good, 1);
  is_begun_ = true;
  write_whole(pipe_, data, size);
}

ImportChild::ImportChild(const std::string& place, ImportBudget& budget, const std::function<void(ImportAnswer&)>& work,
                         const std::function<void()>& prepare)
    : place_(place), budget_(budget) {
  const auto no = [&](int error) {
    throw Error(Trouble::Failed, place_ + ": no process for it: " + std::strerror(error));
  };
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) no(errno);
  constexpr int pipe_bytes = 1 << 20;
  ::fcntl(ends[1], F_SETPIPE_SZ, pipe_bytes);
  const pid_t parent = ::getpid();
  const int threads = thread_limit();
  id_ = ::fork();
  if (id_ == 0) {
    ::close(ends[0]);
    be_child(ends[1], parent, threads, budget.limits(), budget.memory_left(), {place_, prepare, work});
  }
  const int error = errno;
  ::close(ends[1]);
  pipe_ = ends[0];
  if (id_ < 0) ::close(pipe_), no(error);
}

ImportChild::~ImportChild() {
  ::close(pipe_);
  if (id_ < 0) return;
  ::kill(id_, SIGKILL);
  while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) continue;
}

std::size_t ImportChild::read_some(void* out, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    budget_.check_time();
    pollfd waiting{pipe_, POLLIN, 0};
    if (::poll(&waiting, 1, 50) <= 0) continue;
    const ssize_t n = ::read(pipe_, static_cast<char*>(out) + done, size - done);
    if (n == 0) break;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  return done;
}

/// The child has closed its end of the pipe: it has ended, is about to, or means harm.
void ImportChild::fail() {
  int status = 0;
  const Stopwatch patience;
  while (::waitpid(id_, &status, WNOHANG) != id_) {
    ::usleep(500);
    if (patience.ms() > 1000) ::kill(id_, SIGKILL);
  }
  id_ = -1;
  throw Error(Trouble::Input, place_ + ": " + cause_of(status));
}

void ImportChild::begin() {
  is_begun_ = true;
  std::uint8_t kind = 0;
  if (read_some(&kind, 1) == 0) fail();
  if (kind == good) return;
  std::string cause(4000, ' ');
  cause.resize(read_some(cause.data(), cause.size()));
  throw Error(kind == 0 || kind == 1 || kind == 3 ? static_cast<Trouble>(kind) : Trouble::Input, one_line(cause));
}

void ImportChild::read(void* out, std::size_t size) {
  if (!is_begun_) begin();
  if (read_some(out, size) < size) fail();
}

}  // namespace zoneplate
