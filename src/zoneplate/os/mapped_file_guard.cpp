// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/mapped_file_guard.h"

#include <signal.h>
#include <sys/mman.h>

#include <array>
#include <atomic>
#include <cerrno>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

/// The mappings, which are global because the signal handler has no parameter for them. An entry of size 0 is free or
/// being filled.
struct Mapping {
  std::atomic<std::uintptr_t> begin{0};
  std::atomic<std::size_t> size{0};
};
static_assert(std::atomic<std::size_t>::is_always_lock_free);
constinit std::array<Mapping, 256> mappings;
constinit std::atomic<std::uint32_t> losses{0};

struct sigaction before {};

// Replaces the pages from the lost one to the end of the mapping by zeros, if the file was truncated or its disk
// failed.
void replace_lost(int, siginfo_t* info, void*) {
  constexpr std::uintptr_t page = 4096;
  const int error = errno;
  const auto at = reinterpret_cast<std::uintptr_t>(info->si_addr);
  for (const Mapping& mapping : mappings) {
    const std::uintptr_t begin = mapping.begin;
    const std::size_t size = mapping.size;
    if (at < begin || at - begin >= size) continue;
    const std::uintptr_t from = at / page * page;
    void* const zeros = ::mmap(reinterpret_cast<void*>(from), begin + size - from, PROT_READ,
                               MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0);
    if (zeros == MAP_FAILED) break;
    ++losses;
    errno = error;
    return;
  }
  ::sigaction(SIGBUS, &before, nullptr);  // the fault is repeated and handled by the previous action
  errno = error;
}

}  // namespace

void survive_truncated_mappings() {
  [[maybe_unused]] static const bool is_installed = [] {
    struct sigaction action {};
    action.sa_sigaction = replace_lost;
    action.sa_flags = SA_SIGINFO;
    return ::sigaction(SIGBUS, &action, &before) == 0;
  }();
}

MappedFileWatch::MappedFileWatch() : before_(losses) {}

void MappedFileWatch::check(const std::string& file) const {
  if (losses != before_)
    throw Error(ErrorKind::Input,
                (file == "-" ? "standard input" : file) + ": cannot be read: bytes were lost meanwhile");
}

void enter_mapping(const void* begin, std::size_t size) {
  for (Mapping& mapping : mappings) {
    std::uintptr_t expected = 0;
    if (!mapping.begin.compare_exchange_strong(expected, reinterpret_cast<std::uintptr_t>(begin))) continue;
    mapping.size = size;
    return;
  }
}

void leave_mapping(const void* begin) {
  for (Mapping& mapping : mappings) {
    if (mapping.begin != reinterpret_cast<std::uintptr_t>(begin)) continue;
    mapping.size = 0;
    mapping.begin = 0;
    return;
  }
}

}  // namespace zoneplate
