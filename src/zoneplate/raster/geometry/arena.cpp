// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/arena.h"

#include <sys/mman.h>

#include <new>

namespace zoneplate {
namespace {

constexpr std::size_t large_page = std::size_t{1} << 21;

}  // namespace

void RawMemory::Free::operator()(std::byte* data) const { ::operator delete[](data, std::align_val_t{alignment}); }

std::byte* RawMemory::reserve(std::size_t size) {
  if (data_ && size <= size_) return data_.get();
  data_.reset();
  const bool is_large = size >= large_page;
  size_ = is_large ? (size + large_page - 1) / large_page * large_page : size;
  const std::size_t alignment = is_large ? large_page : 64;
  data_ = {static_cast<std::byte*>(::operator new[](size_, std::align_val_t{alignment})), Free{alignment}};
  // Large pages are optional: without them the memory works as well.
  if (is_large) ::madvise(data_.get(), size_, MADV_HUGEPAGE);
  return data_.get();
}

void Arena::next_block() {
  // Small frames use small blocks; large frames use large pages.
  const std::size_t size = used_ < 8 ? 2 * largest : large_page;
  if (used_ == blocks_.size()) blocks_.emplace_back();
  at_ = blocks_[used_++].reserve(size);
  end_ = at_ + size;
}

void Arena::clear() {
  used_ = 0;
  at_ = end_ = nullptr;
}

}  // namespace zoneplate
