// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/geometry/fragments.h"

#include <gtest/gtest.h>

#include <map>

#include "zoneplate/math/random.h"
#include "zoneplate/raster/coverage/coverage.h"

namespace zoneplate {
namespace {

struct Owner {
  float depth;
  std::int32_t id;
  bool operator==(const Owner&) const = default;
};
using OwnersById = std::map<std::uint32_t, Owner>;

void take(OwnersById& owners, std::uint32_t at, Owner found) {
  const auto [it, is_new] = owners.try_emplace(at, found);
  Owner& owner = it->second;
  if (found.depth > owner.depth || (found.depth == owner.depth && found.id < owner.id)) owner = found;
}

struct Filled {
  Arena arena;
  TileSampleBins fragments;
  OwnersById owners;
  std::size_t max_parts = 0;
  std::size_t parts() const {
    std::size_t count = 0;
    for (const SampleBin* p = fragments[1]; p; p = p->previous) ++count;
    return count;
  }
};

/// A million fragments on 300 samples, of ids far apart.
void fill(Filled& to, bool keeps_hidden) {
  constexpr int samples = 4;
  to.fragments.clear(3, samples, keeps_hidden);
  for (std::uint32_t i = 0; i < 1000000; ++i) {
    const auto id = static_cast<std::int32_t>(i * 1500 + hash(i, 1) % 700);
    const std::uint32_t at = hash(i, 2) % 300 * 51;
    const float depth = static_cast<float>(hash(i, 3) % 5000) / 5000;
    SampleBin* part = to.fragments.last()[1];
    if (!part || part->count == SampleBin::capacity || id - part->first_id > SampleBin::max_ids)
      part = to.fragments.grow(1, id, to.arena);
    part->depth[part->count] = depth;
    part->packed[part->count++] = (static_cast<std::uint32_t>(id - part->first_id) << 16) + at;
    take(to.owners, at, {depth, id});
    if (i % 1000 == 0) to.max_parts = std::max(to.max_parts, to.parts());
  }
}

TEST(TileSampleBins, TheNearestStayAndListsStayShort) {
  Filled short_lists, all;
  fill(short_lists, false);
  fill(all, true);
  EXPECT_GT(all.parts(), 20000u);
  EXPECT_LE(short_lists.max_parts, 700u);  // 300 fragments, all in different parts at worst, twice
  for (const Filled* f : {&short_lists, &all}) {
    OwnersById found;
    for (const SampleBin* p = f->fragments[1]; p; p = p->previous)
      for (std::int32_t i = 0; i < p->count; ++i)
        take(found, SampleBin::at(p->packed[i]), {p->depth[i], p->id(p->packed[i])});
    EXPECT_EQ(found, f->owners);
  }
}

}  // namespace
}  // namespace zoneplate
