#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace zoneplate {

/// Uninitialised memory for plain data, on a cache line's start. What is large asks the system for large pages: to
/// touch new pages costs more than to fill them.
class RawMemory {
 public:
  /// At least `size` bytes. Memory that is large enough already is kept, and what was in it is lost.
  std::byte* room(std::size_t size);

 private:
  struct Free {
    std::size_t alignment;
    void operator()(std::byte* data) const;
  };
  std::unique_ptr<std::byte[], Free> data_;
  std::size_t size_ = 0;
};

/// Memory for one frame's lists on one thread: taken in order, given back all at once, kept for the next frame.
class Arena {
 public:
  /// `size` bytes on a cache line's start, uninitialised. Requires: size <= largest.
  std::byte* take(std::size_t size) {
    const std::size_t rounded = (size + 63) / 64 * 64;
    if (rounded > static_cast<std::size_t>(end_ - at_)) next_block();
    std::byte* taken = at_;
    at_ += rounded;
    return taken;
  }
  /// Gives everything back; what was taken may not be used any more.
  void clear();

  static constexpr std::size_t largest = std::size_t{1} << 17;

 private:
  void next_block();

  std::vector<RawMemory> blocks_;
  std::size_t used_ = 0;  ///< blocks in use
  std::byte *at_ = nullptr, *end_ = nullptr;
};

/// A list that grows by chunks from an arena, so that what is in it never moves. Holds plain data.
template <class T, std::size_t chunk_size>
class ChunkedList {
 public:
  void push_back(const T& value, Arena& arena) {
    if (size_ == chunks_.size() * chunk_size)
      chunks_.push_back(reinterpret_cast<T*>(arena.take(chunk_size * sizeof(T))));
    chunks_.back()[size_++ % chunk_size] = value;
  }
  const T& operator[](std::size_t i) const { return chunks_[i / chunk_size][i % chunk_size]; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
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
