// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/resolve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

float number(std::uint32_t i) { return unit_float(hash(i, 3)) * 3 - 0.5f; }

TEST(Resolve, KernelsGiveTheScalarTwinsBits) {
  static FragmentOutputs color;
  for (std::uint32_t i = 0; i < FragmentBatch::capacity; ++i)
    color.r[i] = number(i), color.g[i] = number(i + 500), color.b[i] = number(i + 1000), color.a[i] = number(i + 1500);
  static Linear8 points;
  for (std::uint32_t i = 0; i < 8; ++i)
    points.set(i, {number(i + 2000), number(i + 2100), number(i + 2200), number(i + 2300)});
  const float weights[] = {0.3f, -0.1f, 0.7f}, least = transmittance_cutoff(3);
  for (const Isa isa : supported_isas()) {
    const ResolveKernels &one = ResolveKernels::scalar, &other = ResolveKernels::of(isa);
    Linear8 a{}, b{}, c{}, d{};
    Linear8 *const first[] = {&a, &c}, *const second[] = {&b, &d};
    for (const float weight : {1.0f, 0.7f, 4.0f, 6.0f}) {
      one.resolve(color, 24, 2, weight, first), other.resolve(color, 24, 2, weight, second);
      EXPECT_EQ(a, b) << name_of(isa) << " " << weight;
      EXPECT_EQ(c, d) << name_of(isa) << " " << weight;
      EXPECT_FALSE(a == c);
    }
    one.add(color, 64, 0.3f, a), other.add(color, 64, 0.3f, b);
    EXPECT_EQ(a, b) << name_of(isa);
    one.divide(a, 3, a), other.divide(b, 3, b);
    EXPECT_EQ(a, b) << name_of(isa);
    one.resolve_samples(points, weights, 3, 0.9f, a), other.resolve_samples(points, weights, 3, 0.9f, b);
    EXPECT_EQ(a, b) << name_of(isa);
    const auto make = [&](std::uint32_t seed) {
      TransparentStack8 l;
      l.clear();
      for (std::uint32_t i = 0; i < 8; ++i) {
        l.r[i] = number(seed + i), l.g[i] = number(seed + i + 10), l.b[i] = number(seed + i + 20);
        l.transmittance[i] = i == 2   ? 0
                             : i == 3 ? least
                             : i == 4 ? least / 2
                             : i == 5 ? least * 1.5f
                                      : unit_float(hash(seed + i, 4));
      }
      return l;
    };
    const auto expect_same = [&](const TransparentStack8& l, const TransparentStack8& m) {
      EXPECT_EQ(std::memcmp(&l, &m, offsetof(TransparentStack8, is_open)), 0) << name_of(isa);
      EXPECT_EQ(l.is_open, m.is_open) << name_of(isa);
    };
    TransparentStack8 l = make(3000), m = make(3000);
    one.over(l, a), other.over(m, b);
    EXPECT_EQ(a, b) << name_of(isa);
    one.composite_under(color, 40, least, l), other.composite_under(color, 40, least, m);
    expect_same(l, m);
    std::fill_n(l.transmittance, 8, 2 * least), std::fill_n(m.transmittance, 8, 2 * least);
    for (int p = 0; p < 8; ++p) color.a[40 + p] = 0.5f;
    one.composite_under(color, 40, least, l), other.composite_under(color, 40, least, m);
    expect_same(l, m);
    EXPECT_FALSE(m.is_open);
    TransparentStack8 rows[3] = {make(1), make(2), make(3)}, layered[3] = {make(1), make(2), make(3)};
    TransparentStack8* const each[] = {&rows[2], &rows[0], &rows[1]};
    TransparentStack8* const expected[] = {&layered[2], &layered[0], &layered[1]};
    other.composite_spans_under(color, 3, least, each);
    for (int i = 0; i < 3; ++i) one.composite_under(color, i * FragmentBatch::group, least, *expected[i]);
    for (int i = 0; i < 3; ++i) expect_same(rows[i], layered[i]);
    Linear p[8], q[8];
    one.store(a, p), other.store(b, q);
    EXPECT_TRUE(std::equal(p, p + 8, q)) << name_of(isa);
  }
}

TEST(Resolve, MeansAndLayersAreTheDefinitions) {
  static FragmentOutputs color;
  color.r[8] = 0.5f, color.a[8] = 1;
  Linear8 out;
  Linear8* const row = &out;
  ResolveKernels::scalar.resolve(color, 8, 1, 4, &row);
  EXPECT_EQ(out.get(0), (Linear{0.5f, 0, 0, 1}));
  color.r[16] = 0.25f, color.a[16] = 0.5f;
  TransparentStack8 layers;
  layers.clear();
  ResolveKernels::scalar.composite_under(color, 16, 0, layers);
  out.set(0, {1, 0, 0, 1});
  ResolveKernels::scalar.over(layers, out);
  EXPECT_EQ(out.get(0), (Linear{0.75f, 0, 0, 1}));
}

TEST(Resolve, LayersFromTheFrontAreLayersFromBehind) {
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    TransparentStack layers;
    std::vector<Linear> all;
    for (std::uint32_t i = 0; i < 12; ++i) {
      const auto at = [&](std::uint32_t k) { return unit_float(hash(seed, i * 4 + k)); };
      all.push_back({at(0), at(1), at(2), at(3)});
      layers.composite_under(all.back(), 0);
    }
    Linear expected{0.5f, 1, 2, 1};
    for (std::size_t i = all.size(); i-- > 0;) expected = all[i] + expected * (1 - all[i].a);
    const Linear found = layers.over({0.5f, 1, 2, 1});
    EXPECT_NEAR(found.r, expected.r, 1e-6);
    EXPECT_NEAR(found.g, expected.g, 1e-6);
    EXPECT_NEAR(found.b, expected.b, 1e-6);
    EXPECT_EQ(found.a, 1);
  }
}

// Behind an opaque layer is nothing, however bright.
TEST(Resolve, LayersEndBehindAnOpaqueOne) {
  const float bright = std::numeric_limits<float>::infinity();
  TransparentStack opaque;
  opaque.composite_under({0.25f, 0, 0, 1}, 0);
  opaque.composite_under({bright, 0, 0, 0.5f}, 0);
  EXPECT_EQ(opaque.over({bright, 1, 1, 1}), (Linear{0.25f, 0, 0, 1}));
}

// TransparentStack stop to count where nothing that may follow adds more than half of the least half float.
TEST(Resolve, LayersThatNoHalfFloatShowsAreLeftOut) {
  for (const float bright : {0.5f, 1.0f, 64.0f, 1e9f}) {
    const float least = transmittance_cutoff(bright);
    EXPECT_EQ(least, 0x1p-25f / std::max(bright, 1.0f));
    TransparentStack layers;
    int count = 0;
    for (; layers.transmittance > least; ++count) layers.composite_under({0, 0, 0, 0.5f}, least);
    EXPECT_LE(layers.transmittance * bright, 0x1p-25f);
    EXPECT_GT(layers.transmittance * bright * 2, bright < 1 ? 0x1p-26f : 0x1p-25f) << count;
    layers.composite_under({bright, 0, 0, 0.5f}, least);
    EXPECT_EQ(layers.r, 0);
    EXPECT_LE(layers.over({bright, 0, 0, 1}).r, 0x1p-25f);
  }
  EXPECT_EQ(transmittance_cutoff(std::numeric_limits<float>::infinity()), 0);
}

}  // namespace
}  // namespace zoneplate
