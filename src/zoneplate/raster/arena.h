#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace zoneplate {

/// Memory for one frame's lists on one thread: taken in order, given back all at once, kept for the next frame.
class Arena {
 public:
  /// `size` bytes on a cache line's start, uninitialised. Requires: size <= block_size.
  void* take(std::size_t size) {
    const std::size_t rounded = (size + 63) / 64 * 64;
    if (rounded > static_cast<std::size_t>(end_ - at_)) next_block();
    std::byte* taken = at_;
    at_ += rounded;
    return taken;
  }
  template <class T>
  T* take() {
    return ::new (take(sizeof(T))) T;
  }
  /// Gives everything back; what was taken may not be used any more.
  void clear();

  static constexpr std::size_t block_size = std::size_t{1} << 18;

 private:
  struct Free {
    void operator()(std::byte* block) const;
  };
  void next_block();

  std::vector<std::unique_ptr<std::byte[], Free>> blocks_;
  std::size_t used_ = 0;  ///< blocks in use
  std::byte *at_ = nullptr, *end_ = nullptr;
};

/// A list that grows by chunks from an arena, so that what is in it never moves. Holds plain data.
template <class T, std::size_t chunk_size>
class ChunkedList {
 public:
  void push_back(const T& value, Arena& arena) {
    if (size_ == chunks_.size() * chunk_size) chunks_.push_back(static_cast<T*>(arena.take(chunk_size * sizeof(T))));
    chunks_.back()[size_++ % chunk_size] = value;
  }
  const T& operator[](std::size_t i) const { return chunks_[i / chunk_size][i % chunk_size]; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Requires  the arena was cleared, or is about to be.
  void clear() { chunks_.clear(), size_ = 0; }

  class Iterator {
   public:
    Iterator(const ChunkedList* list, std::size_t at) : list_(list), at_(at) {}
    const T& operator*() const { return (*list_)[at_]; }
    Iterator& operator++() { return ++at_, *this; }
    bool operator!=(const Iterator& o) const { return at_ != o.at_; }

   private:
    const ChunkedList* list_;
    std::size_t at_;
  };
  Iterator begin() const { return {this, 0}; }
  Iterator end() const { return {this, size_}; }

 private:
  std::vector<T*> chunks_;
  std::size_t size_ = 0;
};

}  // namespace zoneplate
