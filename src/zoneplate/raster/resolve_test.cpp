#include "zoneplate/raster/resolve.h"

#include <gtest/gtest.h>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

float number(std::uint32_t i) { return unit_float(hash(i, 3)) * 3 - 0.5f; }

TEST(Resolve, KernelsGiveTheScalarTwinsBits) {
  static Shaded color;
  for (std::uint32_t i = 0; i < Batch::capacity; ++i)
    color.r[i] = number(i), color.g[i] = number(i + 500), color.b[i] = number(i + 1000), color.a[i] = number(i + 1500);
  static Linear8 points;
  for (std::uint32_t i = 0; i < 8; ++i)
    points.set(i, {number(i + 2000), number(i + 2100), number(i + 2200), number(i + 2300)});
  const float weights[] = {0.3f, -0.1f, 0.7f};
  for (const Isa isa : supported_isas()) {
    const ResolveKernels &one = scalar::resolve_kernels, &other = resolve_kernels(isa);
    Linear8 a{}, b{};
    for (const float weight : {1.0f, 0.7f, 4.0f, 6.0f}) {
      one.resolve(color, 24, weight, a), other.resolve(color, 24, weight, b);
      EXPECT_EQ(a, b) << name_of(isa) << " " << weight;
    }
    one.add(color, 64, 0.3f, a), other.add(color, 64, 0.3f, b);
    EXPECT_EQ(a, b) << name_of(isa);
    one.divide(a, 3, a), other.divide(b, 3, b);
    EXPECT_EQ(a, b) << name_of(isa);
    one.resolve_samples(points, weights, 3, 0.9f, a), other.resolve_samples(points, weights, 3, 0.9f, b);
    EXPECT_EQ(a, b) << name_of(isa);
    one.over(color, 40, a), other.over(color, 40, b);
    EXPECT_EQ(a, b) << name_of(isa);
    Linear8 rows[3] = {a, points, a}, layered[3] = {a, points, a};
    Linear8* const each[] = {&rows[2], &rows[0], &rows[1]};
    Linear8* const expected[] = {&layered[2], &layered[0], &layered[1]};
    other.over_rows(color, 3, each);
    for (int i = 0; i < 3; ++i) one.over(color, i * Batch::group, *expected[i]);
    EXPECT_TRUE(std::equal(rows, rows + 3, layered)) << name_of(isa);
    Linear p[8], q[8];
    one.put(a, p), other.put(b, q);
    EXPECT_TRUE(std::equal(p, p + 8, q)) << name_of(isa);
  }
}

TEST(Resolve, MeansAndLayersAreTheDefinitions) {
  static Shaded color;
  color.r[8] = 0.5f, color.a[8] = 1;
  Linear8 out;
  scalar::resolve_kernels.resolve(color, 8, 4, out);
  EXPECT_EQ(out.get(0), (Linear{0.5f, 0, 0, 1}));
  color.r[16] = 0.25f, color.a[16] = 0.5f;
  out.set(0, {1, 0, 0, 1});
  scalar::resolve_kernels.over(color, 16, out);
  EXPECT_EQ(out.get(0), (Linear{0.75f, 0, 0, 1}));
}

}  // namespace
}  // namespace zoneplate
