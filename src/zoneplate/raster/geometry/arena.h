// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace zoneplate {

/// Uninitialised memory for plain data, aligned to cache lines. Large blocks are advised to use large pages, since the
/// first access to a page costs more than filling it.
class RawMemory {
 public:
  /// Returns at least `size` bytes. A block that is large enough is reused; its contents are undefined.
  std::byte* reserve(std::size_t size);

 private:
  struct Free {
    std::size_t alignment;
    void operator()(std::byte* data) const;
  };
  std::unique_ptr<std::byte[], Free> data_;
  std::size_t size_ = 0;
};

/// Memory for one frame's lists on one thread: allocated in order, freed all at once, kept for the next frame.
class Arena {
 public:
  /// Allocates `size` bytes, aligned to a cache line, uninitialised. Requires: size <= largest.
  std::byte* take(std::size_t size) {
    const std::size_t rounded = (size + 63) / 64 * 64;
    if (rounded > static_cast<std::size_t>(end_ - at_)) next_block();
    std::byte* taken = at_;
    at_ += rounded;
    return taken;
  }
  /// Frees all allocations, which must not be used any more.
  void clear();

  static constexpr std::size_t largest = std::size_t{1} << 17;

 private:
  void next_block();

  std::vector<RawMemory> blocks_;
  std::size_t used_ = 0;  ///< blocks in use
  std::byte *at_ = nullptr, *end_ = nullptr;
};

/// An array of plain data whose elements never move.
template <class T>
class ArenaArray {
 public:
  static constexpr std::size_t chunk_size = 1024;

  /// Uninitialised contiguous memory for `count` more elements; add() makes them elements.
  /// Requires: count <= chunk_size.
  T* reserve(std::size_t count, Arena& arena) {
    static_assert(chunk_size * sizeof(T) <= Arena::largest);
    if (count > chunks_.size() * chunk_size - end_) {
      end_ = chunks_.size() * chunk_size;
      chunks_.push_back(reinterpret_cast<T*>(arena.take(chunk_size * sizeof(T))));
    }
    return chunks_.back() + end_ % chunk_size;
  }
  /// Adds the `count` elements that were written; returns the index of the first.
  std::size_t add(std::size_t count) {
    const std::size_t first = end_;
    end_ += count, size_ += count;
    return first;
  }
  /// Indices may have gaps.
  const T& operator[](std::size_t i) const { return chunks_[i / chunk_size][i % chunk_size]; }
  std::size_t size() const { return size_; }
  void clear() { chunks_.clear(), size_ = end_ = 0; }

 private:
  std::vector<T*> chunks_;
  std::size_t size_ = 0, end_ = 0;
};

/// A list of plain data that is appended to and read from the start.
template <class T>
class ArenaList {
 public:
  void push_back(T value, Arena& arena) {
    if (at_ == end_) grow(arena);
    *at_++ = value;
  }
  bool empty() const { return !first_; }
  void clear() { *this = {}; }

 private:
  struct Chunk {
    static constexpr std::size_t capacity = (256 - sizeof(void*)) / sizeof(T);
    Chunk* next;
    T value[capacity];
  };
  void grow(Arena& arena) {
    auto* chunk = reinterpret_cast<Chunk*>(arena.take(sizeof(Chunk)));
    chunk->next = nullptr;
    (last_ ? last_->next : first_) = chunk;
    last_ = chunk;
    at_ = chunk->value;
    end_ = at_ + Chunk::capacity;
  }

  Chunk *first_ = nullptr, *last_ = nullptr;
  T *at_ = nullptr, *end_ = nullptr;  ///< in the last chunk

 public:
  class Iterator {
   public:
    Iterator(const Chunk* chunk, const T* at) : chunk_(chunk), at_(at) {}
    const T& operator*() const { return *at_; }
    Iterator& operator++() {
      if (++at_ == chunk_->value + Chunk::capacity && chunk_->next) chunk_ = chunk_->next, at_ = chunk_->value;
      return *this;
    }
    bool operator!=(const Iterator& o) const { return at_ != o.at_; }

   private:
    const Chunk* chunk_;
    const T* at_;
  };
  Iterator begin() const { return {first_, first_ ? first_->value : nullptr}; }
  Iterator end() const { return {last_, at_}; }
};

}  // namespace zoneplate
