// SPDX-License-Identifier: Apache-2.0
// The judge of rays: Embree in its robust mode, where it is installed.
#include <gtest/gtest.h>

#ifdef ZONEPLATE_EMBREE
#include <algorithm>
#include <cmath>
#include <vector>

#include "zoneplate/ray/embree_for_test.h"

namespace zoneplate {
namespace {

/// The distance of a hit from the nearest edge of its triangle; the scenes have a size of about 1.
float from_edge(const TestMesh& mesh, const RayHit& hit) {
  if (hit.primitive == RayHit::none) return 1;
  const auto p = [&](std::size_t k) { return mesh.position[mesh.index[std::size_t{3} * hit.primitive + k % 3]]; };
  const float twice_area = length(cross(p(1) - p(0), p(2) - p(0)));
  const float weight[3] = {1 - hit.b1 - hit.b2, hit.b1, hit.b2};
  float nearest = 1;
  for (std::size_t k = 0; k < 3; ++k) nearest = std::min(nearest, weight[k] * twice_area / length(p(k + 2) - p(k + 1)));
  return nearest;
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
      // At an edge, or where two triangles intersect.
      const bool is_tie = std::abs(hits[i].t - other.t) <= 1e-6f * other.t;
      EXPECT_TRUE(is_tie || std::min(from_edge(mesh, hits[i]), from_edge(mesh, other)) <= 1e-5f)
          << first + i << ": " << hits[i].t << ", " << other.t;
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
