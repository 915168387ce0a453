#include "zoneplate/base/sandbox.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <vector>

namespace zoneplate {
namespace {

#if defined(__x86_64__)
constexpr std::uint32_t machine = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t machine = AUDIT_ARCH_AARCH64;
#else
constexpr std::uint32_t machine = 0;
#endif

/// Calls that reading, allocating and threads need, whatever their arguments.
constexpr int free_calls[] = {
    __NR_read,
    __NR_readv,
    __NR_pread64,
    __NR_write,
    __NR_writev,
    __NR_close,
    __NR_fstat,
    __NR_newfstatat,
    __NR_statx,
    __NR_lseek,
    __NR_munmap,
    __NR_mremap,
    __NR_madvise,
    __NR_brk,
    __NR_futex,
    __NR_rseq,
    __NR_set_robust_list,
    __NR_rt_sigaction,
    __NR_rt_sigprocmask,
    __NR_rt_sigreturn,
    __NR_sigaltstack,
    __NR_sched_yield,
    __NR_sched_getaffinity,
    __NR_clock_gettime,
    __NR_clock_nanosleep,
    __NR_nanosleep,
    __NR_gettimeofday,
    __NR_getrandom,
    __NR_readlinkat,
    __NR_faccessat,
    __NR_getcwd,
    __NR_getpid,
    __NR_gettid,
    __NR_exit,
    __NR_exit_group,
    __NR_ppoll,
    __NR_pipe2,  // asked by the threads of the address sanitizer
    __NR_restart_syscall,
    __NR_sysinfo,
    __NR_getdents64,
#if defined(__x86_64__)
    __NR_stat,
    __NR_lstat,
    __NR_readlink,
    __NR_access,
    __NR_poll,
#endif
};

/// A call that is free if its argument has these bits so.
struct Condition {
  unsigned argument;
  std::uint32_t mask, value;
};
struct CheckedCall {
  int number;
  std::vector<Condition> all;
};

std::vector<CheckedCall> checked_calls() {
  constexpr std::uint32_t writing = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY);
  const auto self = static_cast<std::uint32_t>(::getpid());
  return {{__NR_openat, {{2, writing, O_RDONLY}}},
          {__NR_mmap, {{2, PROT_EXEC, 0}, {3, MAP_SHARED, 0}}},
          {__NR_mprotect, {{2, PROT_EXEC, 0}}},
          {__NR_clone, {{0, CLONE_THREAD, CLONE_THREAD}}},
          {__NR_tgkill, {{0, ~0u, self}}}};
}

/// Calls that are answered with an error, since whoever asks can do without.
struct RefusedCall {
  int number, error;
};
constexpr RefusedCall refused_calls[] = {
    {__NR_clone3, ENOSYS},  // whose arguments cannot be seen; `clone` is asked next
    {__NR_prlimit64, EPERM},
    {__NR_ioctl, ENOTTY},
    {__NR_fcntl, EPERM},
    {__NR_faccessat2, ENOSYS}};

/// The rules as a program for the kernel.
class Filter {
 public:
  Filter() {
    load(offsetof(seccomp_data, arch));
    skip_if_equal(machine, 1), answer(SECCOMP_RET_KILL_PROCESS);
    load(offsetof(seccomp_data, nr));
    for (const int call : free_calls) skip_unless_equal(static_cast<std::uint32_t>(call), 1), answer(SECCOMP_RET_ALLOW);
    for (const RefusedCall& call : refused_calls) {
      skip_unless_equal(static_cast<std::uint32_t>(call.number), 1);
      answer(SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(call.error));
    }
    for (const CheckedCall& call : checked_calls()) {
      skip_unless_equal(static_cast<std::uint32_t>(call.number), static_cast<std::uint8_t>(4 * call.all.size() + 1));
      for (const Condition& c : call.all) {
        load(offsetof(seccomp_data, args) + 8 * c.argument);  // the low half, on machines that store it first
        code_.push_back(BPF_STMT(BPF_ALU | BPF_AND | BPF_K, c.mask));
        skip_if_equal(c.value, 1), answer(SECCOMP_RET_KILL_PROCESS);
      }
      answer(SECCOMP_RET_ALLOW);
    }
    answer(SECCOMP_RET_KILL_PROCESS);
  }

  bool install() {
    const sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  }

 private:
  void load(std::size_t offset) {
    code_.push_back(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)));
  }
  void skip_if_equal(std::uint32_t value, std::uint8_t count) {
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, count, 0));
  }
  void skip_unless_equal(std::uint32_t value, std::uint8_t count) {
    code_.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, count));
  }
  void answer(std::uint32_t action) { code_.push_back(BPF_STMT(BPF_RET | BPF_K, action)); }

  std::vector<sock_filter> code_;
};

}  // namespace

bool enter_sandbox() { return machine != 0 && Filter().install(); }

void limit_resources(std::uint64_t bytes, double seconds) {
  // Of the seven numbers of /proc/self/statm the sixth counts the pages of data and stack that there are already.
  unsigned long pages = 0;
  if (std::FILE* statm = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(statm, "%*u %*u %*u %*u %*u %lu", &pages) != 1) pages = 0;
    std::fclose(statm);
  }
  const rlim_t memory = pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + bytes;
  const auto time = static_cast<rlim_t>(seconds) + 1;
  const rlimit data{memory, memory}, processor{time, time}, none{0, 0};
  ::setrlimit(RLIMIT_DATA, &data);
  ::setrlimit(RLIMIT_CPU, &processor);
  ::setrlimit(RLIMIT_CORE, &none);
  ::setrlimit(RLIMIT_FSIZE, &none);
}

}  // namespace zoneplate
