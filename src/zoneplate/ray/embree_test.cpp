// SPDX-License-Identifier: Apache-2.0
// The judge of rays: Embree in its robust mode, where it is installed.
#include <gtest/gtest.h>

#ifdef ZONEPLATE_EMBREE
#include <algorithm>
#include <vector>

#include "zoneplate/ray/embree_for_test.h"

namespace zoneplate {
namespace {

/// The distance of a hit from the nearest edge of its triangle, as a barycentric weight.
float from_edge(const RayHit& hit) {
  return hit.primitive == RayHit::none ? 1 : std::min({hit.b1, hit.b2, 1 - hit.b1 - hit.b2});
}

void compare(const TestMesh& mesh, std::uint32_t count) {
  const Bvh bvh(std::vector{mesh.caster()});
  const EmbreeScene embree(mesh);
  constexpr std::uint32_t step = 4096;
  std::uint32_t differences = 0, hit_count = 0;
  for (std::uint32_t first = 0; first < count; first += step) {
    std::vector<Ray> rays;
    for (std::uint32_t i = first; i < std::min(first + step, count); ++i) rays.push_back(random_ray(i));
    std::vector<RayHit> hits(rays.size());
    std::vector<float> visible(rays.size());
    RayKernels::of().nearest(view_of(bvh), rays.data(), rays.size(), hits.data());
    RayKernels::of().visibility(view_of(bvh), rays.data(), rays.size(), {}, visible.data());
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const RayHit other = embree.nearest(rays[i]);
      hit_count += other.primitive != RayHit::none;
      EXPECT_EQ(visible[i] == 0, hits[i].primitive != RayHit::none);
      if (other.primitive == hits[i].primitive && (visible[i] == 1) == embree.is_visible(rays[i])) continue;
      ++differences;
      EXPECT_LE(std::min(from_edge(hits[i]), from_edge(other)), 1e-5f) << first + i;
    }
  }
  EXPECT_GT(hit_count, count / 10);
  EXPECT_LE(differences, count / 10000);
}

TEST(Embree, AgreesAboutRays) {
  compare(bumpy_sphere(100), 50000);
  compare(triangle_soup(20000, 0.1f), 50000);
}

TEST(Embree, DISABLED_AgreesAboutTenMillionRays) {
  compare(bumpy_sphere(400), 5000000);
  compare(triangle_soup(300000, 0.05f), 5000000);
}

}  // namespace
}  // namespace zoneplate
#else
TEST(Embree, AgreesAboutRays) { GTEST_SKIP() << "Embree (libembree-dev) is not installed"; }
#endif
