// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/sandbox.h"

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/os/memory_limit.h"

namespace zoneplate {
namespace {

/// System calls that reading, allocation and threads need, with any arguments.
constexpr int allowed_calls[] = {
    SCMP_SYS(read),
    SCMP_SYS(readv),
    SCMP_SYS(pread64),
    SCMP_SYS(write),
    SCMP_SYS(writev),
    SCMP_SYS(close),
    SCMP_SYS(fstat),
    SCMP_SYS(newfstatat),
    SCMP_SYS(statx),
    SCMP_SYS(stat),
    SCMP_SYS(lstat),
    SCMP_SYS(lseek),
    SCMP_SYS(munmap),
    SCMP_SYS(mremap),
    SCMP_SYS(madvise),
    SCMP_SYS(brk),
    SCMP_SYS(futex),
    SCMP_SYS(rseq),
    SCMP_SYS(set_robust_list),
    SCMP_SYS(rt_sigaction),
    SCMP_SYS(rt_sigprocmask),
    SCMP_SYS(rt_sigreturn),
    SCMP_SYS(sigaltstack),
    SCMP_SYS(sched_yield),
    SCMP_SYS(sched_getaffinity),
    SCMP_SYS(clock_gettime),
    SCMP_SYS(clock_nanosleep),
    SCMP_SYS(nanosleep),
    SCMP_SYS(gettimeofday),
    SCMP_SYS(getrandom),
    SCMP_SYS(getrusage),
    SCMP_SYS(readlink),
    SCMP_SYS(readlinkat),
    SCMP_SYS(access),
    SCMP_SYS(faccessat),
    SCMP_SYS(getcwd),
    SCMP_SYS(getpid),
    SCMP_SYS(geteuid),
    SCMP_SYS(gettid),
    SCMP_SYS(exit),
    SCMP_SYS(exit_group),
    SCMP_SYS(poll),
    SCMP_SYS(ppoll),
    SCMP_SYS(pipe2),  // called by the threads of the address sanitizer
    SCMP_SYS(restart_syscall),
    SCMP_SYS(sysinfo),
    SCMP_SYS(getdents64),
};

/// System calls that fail with an error, because their callers have a fallback.
struct RefusedCall {
  int number, error;
};
constexpr RefusedCall refused_calls[] = {
    {SCMP_SYS(clone3), ENOSYS},  // a filter cannot inspect its arguments; the C library falls back to `clone`
    {SCMP_SYS(openat2), ENOSYS}, {SCMP_SYS(prlimit64), EPERM},  {SCMP_SYS(ioctl), ENOTTY},
    {SCMP_SYS(fcntl), EPERM},    {SCMP_SYS(faccessat2), ENOSYS}};

/// Owns a filter for system calls.
class Filter {
 public:
  Filter() : filter_(::seccomp_init(SCMP_ACT_KILL_PROCESS)) {
    if (!filter_) return;
    is_complete_ = ::seccomp_attr_set(filter_, SCMP_FLTATR_ACT_BADARCH, SCMP_ACT_KILL_PROCESS) == 0;
    for (const int call : allowed_calls) allow(call, {});
    for (const RefusedCall& call : refused_calls)
      note(::seccomp_rule_add(filter_, SCMP_ACT_ERRNO(static_cast<std::uint16_t>(call.error)), call.number, 0));

    constexpr std::uint32_t writing = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY);
    allow(SCMP_SYS(openat), {SCMP_A2_32(SCMP_CMP_MASKED_EQ, writing, O_RDONLY)});
    allow(SCMP_SYS(mmap),
          {SCMP_A2_32(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0), SCMP_A3_32(SCMP_CMP_MASKED_EQ, MAP_SHARED, 0)});
    allow(SCMP_SYS(mprotect), {SCMP_A2_32(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0)});
    allow(SCMP_SYS(clone), {SCMP_A0_32(SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD)});
    allow(SCMP_SYS(tgkill), {SCMP_A0_32(SCMP_CMP_EQ, any_process)});
  }
  ~Filter() { ::seccomp_release(filter_); }
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;

  /// The kernel's form of the filter, in which `any_process` stands for the process that it is installed in.
  ///
  /// Errors    std::system_error if it cannot be made.
  std::vector<sock_filter> program() const {
    const auto fail = [](int error) { throw std::system_error(error, std::system_category()); };
    if (!is_complete_) fail(ENOMEM);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) fail(errno);
    // A pipe takes 64 KB, and the kernel no program that is longer.
    std::vector<sock_filter> program(BPF_MAXINSNS);
    const int error = ::seccomp_export_bpf(filter_, ends[1]);
    const ssize_t size = ::read(ends[0], program.data(), program.size() * sizeof(sock_filter));
    ::close(ends[0]), ::close(ends[1]);
    if (error != 0 || size <= 0) fail(error != 0 ? -error : EIO);
    program.resize(static_cast<std::size_t>(size) / sizeof(sock_filter));
    return program;
  }

  static constexpr std::uint32_t any_process = 0x7ffffffe;  ///< more than the greatest process id, 2^22

 private:
  void allow(int call, const std::vector<scmp_arg_cmp>& conditions) {
    note(::seccomp_rule_add_array(filter_, SCMP_ACT_ALLOW, call, static_cast<unsigned>(conditions.size()),
                                  conditions.data()));
  }
  void note(int error) { is_complete_ = is_complete_ && error == 0; }

  scmp_filter_ctx filter_;
  bool is_complete_ = false;
};

const std::vector<sock_filter>& filter_program() {
  static const std::vector<sock_filter> program = Filter().program();
  return program;
}

std::string refusal_of(int error) { return std::system_category().message(error); }

/// Installs the filter on this thread; the cause if that fails.
std::string install_filter() {
  // Without a program, the call fails because of its address where it is permitted.
  const auto install = [](const sock_fprog* program) {
    return ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, program) == 0 ? 0 : errno;
  };
  if (const int error = install(nullptr); error != EFAULT) return refusal_of(error);
  std::vector<sock_filter> program;
  try {
    program = filter_program();
  } catch (const std::system_error& error) {
    return error.code().message();
  }
  for (sock_filter& instruction : program)
    if (BPF_CLASS(instruction.code) == BPF_JMP && instruction.k == Filter::any_process)
      instruction.k = static_cast<std::uint32_t>(::getpid());
  const sock_fprog whole{static_cast<unsigned short>(program.size()), program.data()};
  const int error = install(&whole);
  return error == 0 ? "" : refusal_of(error);
}

/// The file-system rights that the first version of Landlock supports.
constexpr std::uint64_t first_rights = (std::uint64_t{1} << 13) - 1;

/// Confines this thread to reading these files and folders; the cause if that fails. A path that does not exist is
/// ignored.
std::string limit_files(const std::vector<std::string>& readable) {
  constexpr std::uint64_t reading = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
  landlock_ruleset_attr all{};
  all.handled_access_fs = first_rights;
  const int rules = static_cast<int>(::syscall(SYS_landlock_create_ruleset, &all, sizeof all.handled_access_fs, 0));
  if (rules < 0) return refusal_of(errno);
  int error = 0;
  for (const std::string& path : readable) {
    const int file = ::open(path.c_str(), O_PATH | O_CLOEXEC);
    if (file < 0 && (errno == EMFILE || errno == ENFILE)) error = errno;
    if (file < 0) continue;
    landlock_path_beneath_attr rule{.allowed_access = reading, .parent_fd = file};
    if (::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0) {
      rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;  // the only one of these rights that is valid for a file
      ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    }
    ::close(file);
  }
  if (error == 0 && ::syscall(SYS_landlock_restrict_self, rules, 0) != 0) error = errno;
  ::close(rules);
  return error == 0 ? "" : refusal_of(error);
}

/// Enters the sandbox on a new thread, as a process that this one forks would on its only one: a thread's restrictions
/// end with it.
SandboxLacks try_sandbox() {
  SandboxLacks lacks;
  // As many descriptors as a forked process needs beside those of this one: for its pipe, and for the model.
  const int more[] = {::open("/", O_PATH | O_CLOEXEC), ::open("/", O_PATH | O_CLOEXEC)};
  try {
    std::thread([&] {
      if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) lacks.filter = lacks.files = refusal_of(errno);
      if (lacks.files.empty()) lacks.files = limit_files({"/"});
      if (lacks.filter.empty()) lacks.filter = install_filter();
    }).join();
  } catch (const std::system_error& error) {
    lacks.filter = lacks.files = error.code().message();
  }
  for (const int file : more)
    if (file >= 0) ::close(file);
  return lacks;
}

}  // namespace

const SandboxLacks& sandbox_lacks() {
  static const SandboxLacks lacks = try_sandbox();
  return lacks;
}

void enter_sandbox(const std::optional<std::vector<std::string>>& readable) {
  const SandboxLacks& lacks = sandbox_lacks();
  const auto check = [](const char* part, const std::string& cause) {
    if (!cause.empty()) throw Error(ErrorKind::Failed, std::string(part) + " is refused: " + cause);
  };
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 && lacks.filter.empty()) check("the sandbox", refusal_of(errno));
  if (readable && lacks.files.empty()) check("Landlock", limit_files(*readable));
  if (lacks.filter.empty()) check("seccomp", install_filter());
}

void limit_resources(std::uint64_t bytes, double seconds) {
  limit_memory(bytes);
  rlimit data{};
  ::getrlimit(RLIMIT_DATA, &data);
  data.rlim_max = data.rlim_cur;
  constexpr double max_seconds = 1e9;
  const rlim_t time = seconds < max_seconds ? static_cast<rlim_t>(seconds) + 1 : RLIM_INFINITY;
  const rlimit processor{time, time}, none{0, 0};
  ::setrlimit(RLIMIT_DATA, &data);
  ::setrlimit(RLIMIT_CPU, &processor);
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_FSIZE, &none);
}

}  // namespace zoneplate
