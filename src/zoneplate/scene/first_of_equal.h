// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace zoneplate {

/// Gives equal keys the number of the first of them.
///
/// A key is `words` words, which are equal where the keys are. The table is open, and a key looks at a few slots only;
/// one that finds neither itself nor a free slot there goes into an ordered map. The answers depend on neither hash
/// nor table, so that keys which were made to collide cost a logarithm and change nothing.
/// Cost      8 to 16 bytes a key that is expected; some 100 bytes for each that finds no slot, of which files that mean
///           well have a handful.
template <std::size_t words>
class FirstOfEqual {
 public:
  using Key = std::array<std::uint32_t, words>;

  explicit FirstOfEqual(std::size_t expected) : slots_(std::bit_ceil(2 * expected + 1), none) {}

  /// The number that was inserted before with an equal key, otherwise `number` itself, which is inserted.
  ///
  /// Requires  `is_equal(other)` returns whether the key of an inserted number is equal to this one's; `make_key()`
  ///           returns this key.
  template <class Equal, class MakeKey>
  std::uint32_t put(std::uint32_t number, std::size_t hash, const Equal& is_equal, const MakeKey& make_key) {
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = 0; i < most_probes; ++i) {
      std::uint32_t& slot = slots_[(hash + i) & mask];
      if (slot == none) return slot = number;
      if (is_equal(slot)) return slot;
    }
    // Slots are never freed: an equal key finds all of these taken by others, too.
    return crowded_.try_emplace(make_key(), number).first->second;
  }

  /// How many keys found no slot.
  std::size_t crowded() const { return crowded_.size(); }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  static constexpr std::size_t most_probes = 64;

  std::vector<std::uint32_t> slots_;
  std::map<Key, std::uint32_t> crowded_;
};

}  // namespace zoneplate
