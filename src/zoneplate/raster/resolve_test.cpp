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
  alignas(64) float points[32];
  for (std::uint32_t i = 0; i < 32; ++i) points[i] = number(i + 2000);
  const float weights[] = {0.3f, -0.1f, 0.7f};
  for (const Isa isa : supported_isas()) {
    const ResolveKernels &one = scalar::resolve_kernels, &other = resolve_kernels(isa);
    Linear a[8], b[8];
    one.resolve(color, 24, 0.7f, a), other.resolve(color, 24, 0.7f, b);
    EXPECT_TRUE(std::equal(a, a + 8, b)) << name_of(isa);
    one.add(color, 64, 0.3f, a), other.add(color, 64, 0.3f, b);
    EXPECT_TRUE(std::equal(a, a + 8, b)) << name_of(isa);
    one.divide(a, 3, 8, a), other.divide(b, 3, 8, b);
    EXPECT_TRUE(std::equal(a, a + 8, b)) << name_of(isa);
    one.resolve_samples(points, weights, 3, 0.9f, a), other.resolve_samples(points, weights, 3, 0.9f, b);
    EXPECT_TRUE(std::equal(a, a + 8, b)) << name_of(isa);
    alignas(64) float p[32] = {}, q[32] = {};
    one.over(points, p), one.over(points, p), other.over(points, q), other.over(points, q);
    EXPECT_TRUE(std::equal(p, p + 32, q)) << name_of(isa);
  }
}

TEST(Resolve, MeansAndLayersAreTheDefinitions) {
  static Shaded color;
  color.r[8] = 0.5f, color.a[8] = 1;
  Linear out[8];
  scalar::resolve_kernels.resolve(color, 8, 4, out);
  EXPECT_EQ(out[0], (Linear{0.5f, 0, 0, 1}));
  alignas(64) float over[32] = {}, behind[32] = {};
  over[0] = 0.25f, over[24] = 0.5f, behind[0] = 1, behind[24] = 1;
  scalar::resolve_kernels.over(over, behind);
  EXPECT_EQ(behind[0], 0.75f);
  EXPECT_EQ(behind[24], 1.0f);
}

}  // namespace
}  // namespace zoneplate
