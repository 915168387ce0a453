// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace zoneplate {

/// Maps each key to the number of the first equal key.
///
/// A key consists of `words` 32-bit words. The table uses open addressing with a limited number of probes; a key that
/// finds neither itself nor a free slot is inserted into an ordered map. The results depend on neither hash nor table;
/// keys chosen to collide cost a logarithm and change nothing.
/// Cost      8 to 16 bytes per expected key; about 100 bytes for each key without a slot, of which ordinary files have
///           only a few.
template <std::size_t words>
class FirstOfEqual {
 public:
  using Key = std::array<std::uint32_t, words>;

  explicit FirstOfEqual(std::size_t expected) : slots_(std::bit_ceil(2 * expected + 1), none) {}

  /// The number that was inserted first with an equal key; otherwise `number`, which is inserted.
  ///
  /// Requires  `is_equal(other)` returns whether the key of an inserted number is equal to this one's; `make_key()`
  ///           returns this key.
  template <class Equal, class MakeKey>
  std::uint32_t put(std::uint32_t number, std::size_t hash, const Equal& is_equal, const MakeKey& make_key) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = 0; i < max_probes; ++i) {
      std::uint32_t& slot = slots_[(hash + i) & mask];
      if (slot == none) return slot = number;
      if (is_equal(slot)) return slot;
    }
    // Slots are never freed, so that an equal key finds all of these slots taken as well.
    return crowded_.try_emplace(make_key(), number).first->second;
  }

  /// The number of keys without a slot.
  std::size_t crowded() const { return crowded_.size(); }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  static constexpr std::size_t max_probes = 64;

  std::vector<std::uint32_t> slots_;
  std::map<Key, std::uint32_t> crowded_;
};

}  // namespace zoneplate
