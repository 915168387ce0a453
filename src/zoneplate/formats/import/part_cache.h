// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace zoneplate {

/// The parts of a file that were read last. Several threads may use it. `Part` has bytes(), what it takes in memory.
template <class Part>
class PartCache {
 public:
  /// `read` reads one of `count` parts; parts are kept up to `capacity` bytes.
  PartCache(std::size_t count, std::uint64_t capacity, std::function<Part(std::size_t)> read)
      : read_(std::move(read)), capacity_(capacity), slots_(count) {}

  std::size_t size() const { return slots_.size(); }

  /// Whether parts have been read so often that reading them in this order takes hours, since none is kept for long.
  bool is_scattered() const {
    constexpr std::uint64_t most = 50, few = 1000;  // of each part, and of all parts of a small file
    return reads_ > most * size() + few;
  }

  /// Errors    those of `read`.
  std::shared_ptr<const Part> part(std::size_t i) const {
    {
      const std::lock_guard lock(mutex_);
      if (slots_[i].part) {
        kept_.splice(kept_.begin(), kept_, slots_[i].place);
        return slots_[i].part;
      }
    }
    ++reads_;
    const auto found = std::make_shared<const Part>(read_(i));
    const std::lock_guard lock(mutex_);
    if (slots_[i].part) return slots_[i].part;
    slots_[i] = {found, kept_.insert(kept_.begin(), i)};
    bytes_ += found->bytes();
    while (bytes_ > capacity_ && kept_.size() > 1) {
      Slot& oldest = slots_[kept_.back()];
      bytes_ -= oldest.part->bytes();
      oldest.part.reset();
      kept_.pop_back();
    }
    return found;
  }

 private:
  struct Slot {
    std::shared_ptr<const Part> part;  ///< null: it is not kept
    std::list<std::size_t>::iterator place;
  };

  std::function<Part(std::size_t)> read_;
  std::uint64_t capacity_;
  mutable std::mutex mutex_;
  mutable std::vector<Slot> slots_;
  mutable std::list<std::size_t> kept_;  ///< parts, the one that was used last first
  mutable std::uint64_t bytes_ = 0;      ///< of those
  mutable std::atomic<std::uint64_t> reads_ = 0;
};

/// Holds the parts that one thread has used last.
template <class Part>
class HeldParts {
 public:
  explicit HeldParts(const PartCache<Part>& parts) : parts_(parts) {}

  const Part& operator[](std::size_t number) {
    Held& held = held_[number % held_.size()];
    if (held.number != number) held = {number, parts_.part(number)};
    return *held.part;
  }

 private:
  struct Held {
    std::size_t number = ~std::size_t{0};
    std::shared_ptr<const Part> part;
  };

  const PartCache<Part>& parts_;
  std::array<Held, 8> held_;  ///< by the last bits of their numbers
};

}  // namespace zoneplate
