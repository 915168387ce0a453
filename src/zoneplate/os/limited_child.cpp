// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/limited_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/os/library.h"
#include "zoneplate/os/sandbox.h"

namespace zoneplate {
namespace {

/// Whether this process is a LimitedChild; written once, before the child starts a second thread.
bool is_child = false;

/// The first byte of an answer: this value, or the kind of the error whose message follows.
constexpr std::uint8_t good = 255;

constexpr int pipe_bytes = 1 << 20;
constexpr int poll_ms = 50;

void write_whole(int pipe, const void* data, std::size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(pipe, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);
    at += n, size -= static_cast<std::size_t>(n);
  }
}

[[noreturn]] void send_error(int pipe, ErrorKind kind, const std::string& cause) {
  const auto first = static_cast<std::uint8_t>(kind);
  write_whole(pipe, &first, 1);
  write_whole(pipe, cause.data(), cause.size());
  ::_exit(0);
}

struct Task {
  const std::string& place;
  const LimitedChild::Limits& limits;
  const std::function<void(ChildAnswer&)>& work;
  const std::function<void()>& open;
};

std::string with_options(const std::string& text, const LimitedChild::Limits& limits) {
  return text + (limits.options.empty() ? "" : " (" + limits.options + ")");
}

void confine(const Task& task) {
  try {
    enter_sandbox(task.limits.readable);
  } catch (const Error& error) {
    throw Error(error.kind(), task.place + ": the sandbox of its process cannot be entered: " + error.what());
  }
}

[[noreturn]] void be_child(int pipe, pid_t parent, int threads, const Task& task) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    std::signal(signal, signal == SIGTERM && task.limits.ignores_termination ? SIG_IGN : SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  ChildAnswer answer(pipe);
  try {
    if (task.open) task.open();
    is_child = true;
    limit_resources(task.limits.memory, task.limits.seconds * threads);
    if (task.limits.is_sandboxed) confine(task);
    with_threads(threads, [&] {
      task.work(answer);
      ::_exit(0);  // _exit ends the other threads faster than they could be joined
    });
  } catch (const Error& error) {
    if (!answer.is_begun()) send_error(pipe, error.kind(), error.what());
  } catch (const LibraryNeeded& needed) {
    if (!answer.is_begun()) send_error(pipe, ErrorKind::Input, needed.what());
  } catch (const std::exception&) {
    if (!answer.is_begun())
      send_error(pipe, ErrorKind::Input, with_options(task.place + ": needs more memory than the limit", task.limits));
  }
  ::_exit(1);
}

std::string cause_of(int status, const LimitedChild::Limits& limits) {
  if (WIFEXITED(status)) return limits.worker + " gave no answer";
  switch (WTERMSIG(status)) {
    case SIGSYS:
      return limits.worker + " made a system call that it has no right to, and was ended";
    case SIGXCPU:
    case SIGKILL: {
      // A child without a limit of processor time has that of this process.
      rlimit time{};
      const bool has_limit_of_session =
          std::isinf(limits.seconds) && ::getrlimit(RLIMIT_CPU, &time) == 0 && time.rlim_cur != RLIM_INFINITY;
      if (has_limit_of_session) return limits.worker + " ran out of processor time or memory (ulimit -t)";
      return with_options(limits.worker + " ran out of time or memory", limits);
    }
    default:
      return limits.worker + " crashed (signal " + std::to_string(WTERMSIG(status)) + ")";
  }
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

}  // namespace

bool is_limited_child() { return is_child; }

void ChildAnswer::write(const void* data, std::size_t size) {
  if (!is_begun_) write_whole(pipe_, &good, 1);
  is_begun_ = true;
  write_whole(pipe_, data, size);
}

LimitedChild::LimitedChild(std::string place, Limits limits, const std::function<void(ChildAnswer&)>& work,
                           const std::function<void()>& open)
    : place_(std::move(place)), limits_(std::move(limits)) {
  const auto no = [&](int error) {
    throw Error(ErrorKind::Failed, place_ + ": no process for it: " + std::strerror(error));
  };
  if (limits_.is_sandboxed) sandbox_lacks();
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) no(errno);
  ::fcntl(ends[1], F_SETPIPE_SZ, pipe_bytes);
  const pid_t parent = ::getpid();
  const int threads = thread_limit();
  id_ = ::fork();
  if (id_ == 0) {
    ::close(ends[0]);
    // The answers of its siblings are not accessible to it.
    if (limits_.siblings)
      for (const LimitedChild* sibling : limits_.siblings->all_) ::close(sibling->pipe_);
    be_child(ends[1], parent, threads, {place_, limits_, work, open});
  }
  const int error = errno;
  ::close(ends[1]);
  pipe_ = ends[0];
  if (id_ < 0) ::close(pipe_), no(error);
  if (limits_.siblings) limits_.siblings->all_.push_back(this);
}

LimitedChild::~LimitedChild() {
  if (limits_.siblings) std::erase(limits_.siblings->all_, this);
  ::close(pipe_);
  if (id_ < 0) return;
  ::kill(id_, SIGKILL);
  while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) continue;
}

bool LimitedChildren::wait_for(const LimitedChild& child) {
  constexpr std::size_t max_kept = std::size_t{256} << 20;
  std::size_t kept = 0;
  for (const LimitedChild* other : all_) kept += other->kept_.size() - other->taken_;
  std::vector<LimitedChild*> others;
  std::vector<pollfd> pipes{{child.pipe_, POLLIN, 0}};
  for (LimitedChild* other : all_)
    if (other != &child && !other->has_ended_ && kept < max_kept)
      others.push_back(other), pipes.push_back({other->pipe_, POLLIN, 0});
  if (::poll(pipes.data(), pipes.size(), poll_ms) <= 0) return false;
  bool is_one_at_its_end = false;
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (pipes[i + 1].revents == 0) continue;
    others[i]->keep_some();
    is_one_at_its_end = is_one_at_its_end || others[i]->has_ended_;
  }
  if (is_one_at_its_end) has_ended_();
  return pipes[0].revents != 0;
}

void LimitedChild::keep_some() {
  std::array<std::uint8_t, 65536> part;
  const ssize_t n = ::read(pipe_, part.data(), part.size());
  if (n > 0) kept_.insert(kept_.end(), part.begin(), part.begin() + n);
  has_ended_ = n == 0;
}

std::size_t LimitedChild::take_kept(void* out, std::size_t size) {
  const std::size_t n = std::min(size, kept_.size() - taken_);
  if (n > 0) std::memcpy(out, kept_.data() + taken_, n);
  taken_ += n;
  if (taken_ == kept_.size()) kept_.clear(), taken_ = 0;
  return n;
}

bool LimitedChild::wait() const {
  if (limits_.siblings) return limits_.siblings->wait_for(*this);
  pollfd waiting{pipe_, POLLIN, 0};
  return ::poll(&waiting, 1, poll_ms) > 0;
}

std::size_t LimitedChild::read_some(void* out, std::size_t size) {
  std::size_t done = take_kept(out, size);
  while (done < size) {
    if (limits_.check_time) limits_.check_time();
    if (!wait()) continue;
    const ssize_t n = ::read(pipe_, static_cast<char*>(out) + done, size - done);
    if (n == 0) break;
    if (n > 0) done += static_cast<std::size_t>(n);
  }
  return done;
}

/// Called when the child has closed its end of the pipe: waits for its end, kills it after a second, and throws.
void LimitedChild::fail() {
  int status = 0;
  const Stopwatch patience;
  while (::waitpid(id_, &status, WNOHANG) != id_) {
    ::usleep(500);
    if (patience.ms() > 1000) ::kill(id_, SIGKILL);
  }
  id_ = -1;
  throw ChildEnded(ErrorKind::Input, place_ + ": " + cause_of(status, limits_));
}

void LimitedChild::begin() {
  is_begun_ = true;
  std::uint8_t kind = 0;
  if (read_some(&kind, 1) == 0) fail();
  if (kind == good) return;
  std::string cause(4000, ' ');
  cause.resize(read_some(cause.data(), cause.size()));
  throw Error(kind == 0 || kind == 1 || kind == 3 ? static_cast<ErrorKind>(kind) : ErrorKind::Input, one_line(cause));
}

void LimitedChild::read(void* out, std::size_t size) {
  if (!is_begun_) begin();
  if (read_some(out, size) < size) fail();
}

}  // namespace zoneplate
