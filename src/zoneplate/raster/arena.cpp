#include "zoneplate/raster/arena.h"

#include <new>

namespace zoneplate {

void Arena::Free::operator()(std::byte* block) const { ::operator delete[](block, std::align_val_t{64}); }

void Arena::next_block() {
  if (used_ == blocks_.size())
    blocks_.emplace_back(static_cast<std::byte*>(::operator new[](block_size, std::align_val_t{64})));
  at_ = blocks_[used_++].get();
  end_ = at_ + block_size;
}

void Arena::clear() {
  used_ = 0;
  at_ = end_ = nullptr;
}

}  // namespace zoneplate
