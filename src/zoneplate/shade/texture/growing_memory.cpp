// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/texture/growing_memory.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <new>

namespace zoneplate {
namespace {

constexpr std::size_t large_page = std::size_t{1} << 21;

std::size_t rounded_up(std::size_t size, std::size_t to) { return (size + to - 1) / to * to; }

}  // namespace

GrowingMemory::GrowingMemory(std::size_t size) {
  const bool is_large = size >= large_page;
  mapped_size_ = is_large ? rounded_up(size, large_page) + large_page : size;
  mapped_ = ::mmap(nullptr, mapped_size_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapped_ == MAP_FAILED) {
    mapped_ = nullptr;
    throw std::bad_alloc();
  }
  const std::size_t at = reinterpret_cast<std::uintptr_t>(mapped_);
  data_ = static_cast<std::byte*>(mapped_) + (is_large ? rounded_up(at, large_page) - at : 0);
  // Large pages are optional: without them the memory works as well.
  if (is_large) ::madvise(data_, rounded_up(size, large_page), MADV_HUGEPAGE);
}

GrowingMemory& GrowingMemory::operator=(GrowingMemory&& other) noexcept {
  std::swap(mapped_, other.mapped_);
  std::swap(mapped_size_, other.mapped_size_);
  std::swap(data_, other.data_);
  std::swap(taken_, other.taken_);
  return *this;
}

GrowingMemory::~GrowingMemory() {
  if (mapped_ != nullptr) ::munmap(mapped_, mapped_size_);
}

void GrowingMemory::grow(std::size_t size) {
  const std::size_t end = rounded_up(size, static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)));
  if (end <= taken_) return;
  if (::mprotect(data_ + taken_, end - taken_, PROT_READ | PROT_WRITE) != 0) throw std::bad_alloc();
  taken_ = end;
}

}  // namespace zoneplate
