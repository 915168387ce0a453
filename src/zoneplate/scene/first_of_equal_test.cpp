// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/first_of_equal.h"

#include <gtest/gtest.h>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Table = FirstOfEqual<1>;

/// For each key, the number of the first equal one, computed by a table with this hash.
template <class Hash>
std::vector<std::uint32_t> first_by(const std::vector<std::uint32_t>& keys, Hash hash_of, std::size_t& crowded) {
  Table table(keys.size());
  std::vector<std::uint32_t> first;
  for (std::uint32_t i = 0; i < keys.size(); ++i)
    first.push_back(table.put(
        i, hash_of(keys[i]), [&](std::uint32_t k) { return keys[k] == keys[i]; }, [&] { return Table::Key{keys[i]}; }));
  crowded = table.crowded();
  return first;
}

TEST(FirstOfEqual, GivesTheSameNumbersWhateverTheHash) {
  std::vector<std::uint32_t> keys, expected;
  std::map<std::uint32_t, std::uint32_t> first;
  for (std::uint32_t i = 0; i < 20000; ++i) {
    keys.push_back(hash(i) % 12000);
    expected.push_back(first.try_emplace(keys.back(), i).first->second);
  }
  std::size_t crowded = 0;
  EXPECT_EQ(first_by(
                keys, [](std::uint32_t k) { return std::size_t{hash(k)}; }, crowded),
            expected);
  EXPECT_LT(crowded, 20u);
  EXPECT_EQ(first_by(
                keys, [](std::uint32_t k) { return std::size_t{k % 3}; }, crowded),
            expected);
  EXPECT_EQ(first_by(
                keys, [](std::uint32_t) { return std::size_t{7}; }, crowded),
            expected);
  EXPECT_EQ(crowded, first.size() - 64);  // all keys except those with a slot
}

/// An open-addressing table without the limit would take 2 * 10^10 probes.
TEST(FirstOfEqual, KeysThatAllCollideTakeLittleMore) {
  std::vector<std::uint32_t> keys(200000);
  for (std::uint32_t i = 0; i < keys.size(); ++i) keys[i] = i;
  std::size_t crowded = 0;
  EXPECT_EQ(first_by(
                keys, [](std::uint32_t) { return std::size_t{0}; }, crowded),
            keys);
  EXPECT_EQ(crowded, keys.size() - 64);
}

}  // namespace
}  // namespace zoneplate
