#include "zoneplate/base/limited_child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

/// Writes to the parent; a parent that is gone ends the child.
void write_all(int pipe, const void* data, std::size_t size) {
  const auto* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = ::write(pipe, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(1);
    at += n, size -= static_cast<std::size_t>(n);
  }
}

/// So much more memory than the process has now, and so much time.
void set_limits(const LimitedChild::Limits& limits) {
  unsigned long pages = 0;
  if (std::FILE* statm = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(statm, "%lu", &pages) != 1) pages = 0;
    std::fclose(statm);
  }
  constexpr rlim_t of_the_library = rlim_t{64} << 20;
  const rlim_t memory = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + limits.memory + of_the_library;
  const auto time = static_cast<rlim_t>(limits.seconds) + 1;
  const auto limit = [](auto what, rlim_t most) {
    const rlimit both{most, most};
    ::setrlimit(what, &both);
  };
  limit(RLIMIT_AS, memory);
  limit(RLIMIT_CPU, time);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
}

[[noreturn]] void be_child(int answer, int refusal, const LimitedChild::Limits& limits,
                           const std::function<void(const LimitedChild::Send&)>& work) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  set_limits(limits);
  std::string cause;
  try {
    work([answer](std::span<const std::uint8_t> bytes) { write_all(answer, bytes.data(), bytes.size()); });
    ::_exit(0);
  } catch (const LimitedChild::Refusal& refused) {
    cause = refused.cause;
  } catch (const std::exception&) {
    cause = "needs more memory than the limit";
  }
  write_all(refusal, cause.data(), cause.size());
  ::_exit(0);
}

}  // namespace

LimitedChild::LimitedChild(const Limits& limits, const std::function<void(const Send&)>& work)
    : deadline_ms_(limits.seconds * 1000) {
  int answer[2], refusal[2];
  const auto fail = [] { throw Error(Trouble::Failed, std::string("a child process: ") + std::strerror(errno)); };
  if (::pipe2(answer, O_CLOEXEC) != 0) fail();
  if (::pipe2(refusal, O_CLOEXEC) != 0) ::close(answer[0]), ::close(answer[1]), fail();
  id_ = ::fork();
  if (id_ == 0) {
    ::close(answer[0]), ::close(refusal[0]);
    be_child(answer[1], refusal[1], limits, work);
  }
  ::close(answer[1]), ::close(refusal[1]);
  if (id_ < 0) ::close(answer[0]), ::close(refusal[0]), fail();
  answer_ = answer[0], refusal_ = refusal[0];
}

LimitedChild::~LimitedChild() {
  ::close(answer_), ::close(refusal_);
  ::kill(id_, SIGKILL);
  ::waitpid(id_, nullptr, 0);
}

bool LimitedChild::wait_for_more(int pipe) {
  pollfd waiting{pipe, POLLIN, 0};
  while (clock_.ms() < deadline_ms_)
    if (::poll(&waiting, 1, 50) > 0) return true;
  is_late_ = true;
  return false;
}

bool LimitedChild::read(std::span<std::uint8_t> out) {
  while (!out.empty()) {
    if (!wait_for_more(answer_)) return false;
    const ssize_t n = ::read(answer_, out.data(), out.size());
    if (n == 0) return false;
    if (n > 0) out = out.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

std::string LimitedChild::cause() {
  std::string text;
  char part[200];
  while (!is_late_ && text.size() < sizeof part && wait_for_more(refusal_)) {
    const ssize_t n = ::read(refusal_, part, sizeof part - text.size());
    if (n <= 0) break;
    text.append(part, static_cast<std::size_t>(n));
  }
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return is_late_ ? "takes longer than the limit" : text.empty() ? "crashed its reader" : text;
}

}  // namespace zoneplate
