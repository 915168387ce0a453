// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/ray/trace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "zoneplate/ray/casters_for_test.h"

namespace zoneplate {
namespace {

std::vector<Ray> random_rays(std::uint32_t count) {
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < count; ++i) rays.push_back(random_ray(i));
  return rays;
}

std::vector<RayHit> nearest(const Bvh& bvh, const std::vector<Ray>& rays,
                            const RayKernels& kernels = RayKernels::of()) {
  std::vector<RayHit> hits(rays.size());
  kernels.nearest(view_of(bvh), rays.data(), rays.size(), hits.data());
  return hits;
}

std::vector<float> visibility(const Bvh& bvh, const std::vector<Ray>& rays, const OpacityOfHits& opacity = {},
                              const RayKernels& kernels = RayKernels::of()) {
  std::vector<float> out(rays.size());
  kernels.visibility(view_of(bvh), rays.data(), rays.size(), opacity, out.data());
  return out;
}

/// The t of the intersection in double precision; infinite where the ray misses.
double exact_t(const TestMesh& mesh, std::size_t triangle, const Ray& ray) {
  const auto at = [&](std::size_t k, std::size_t axis) {
    const float3 p = mesh.position[mesh.index[3 * triangle + k]];
    return static_cast<double>(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
  };
  double a[3] = {}, b[3] = {}, o[3] = {}, d[3] = {};
  for (std::size_t c = 0; c < 3; ++c)
    a[c] = at(1, c) - at(0, c), b[c] = at(2, c) - at(0, c), o[c] = ray.origin[c] - at(0, c), d[c] = ray.direction[c];
  const auto det = [](const double(&x)[3], const double(&y)[3], const double(&z)[3]) {
    return x[0] * (y[1] * z[2] - y[2] * z[1]) + x[1] * (y[2] * z[0] - y[0] * z[2]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
  };
  // o + t d = u a + v b
  const double whole = det(a, b, d);
  const double u = det(o, b, d) / whole, v = det(a, o, d) / whole, t = -det(a, b, o) / whole;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : INFINITY;
}

TEST(Trace, FindsTheNearestOfAllTriangles) {
  const TestMesh soup = triangle_soup(500, 0.5f);
  const Bvh bvh(std::vector{soup.caster()});
  const std::vector<Ray> rays = random_rays(2000);
  const std::vector<RayHit> hits = nearest(bvh, rays);
  const std::vector<float> visible = visibility(bvh, rays);
  int hit_count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    double least = INFINITY;
    for (std::size_t t = 0; t < 500; ++t) least = std::min(least, exact_t(soup, t, rays[i]));
    ASSERT_EQ(std::isinf(least), std::isinf(hits[i].t)) << i;
    ASSERT_EQ(visible[i], std::isinf(least) ? 1 : 0);
    if (std::isinf(least)) continue;
    ++hit_count;
    ASSERT_NEAR(hits[i].t, least, 1e-5 * least);
    const RayHit& h = hits[i];
    const auto p = [&](std::size_t k) { return soup.position[soup.index[3 * h.primitive + k]]; };
    const float3 on_triangle = p(0) * (1 - h.b1 - h.b2) + p(1) * h.b1 + p(2) * h.b2;
    const float* const o = rays[i].origin;
    const float* const d = rays[i].direction;
    const float3 on_ray{o[0] + h.t * d[0], o[1] + h.t * d[1], o[2] + h.t * d[2]};
    ASSERT_LT(length(on_triangle - on_ray), 1e-5f);
  }
  EXPECT_GT(hit_count, 300);
}

// From inside of a closed mesh every ray meets it: through the middles of triangles, and exactly at vertices and edges.
TEST(Trace, NoRayLeavesAClosedMesh) {
  const TestMesh sphere = bumpy_sphere(48);
  const Bvh bvh(std::vector{sphere.caster()});
  std::vector<Ray> rays;
  const auto add = [&](float3 from, float3 to) {
    const float3 d = to - from;
    rays.push_back({{from.x, from.y, from.z}, {d.x, d.y, d.z}});
  };
  for (std::uint32_t i = 0; i < 20; ++i) {
    const float4 r = random_numbers(i, 5);
    const float3 from = i == 0 ? float3{} : float3{r.x - 0.5f, r.y - 0.5f, r.z - 0.5f};
    for (const float3 vertex : sphere.position) add(from, vertex);
    for (std::size_t t = 0; t < sphere.index.size() / 3; ++t) {
      const float3 a = sphere.position[sphere.index[3 * t]], b = sphere.position[sphere.index[3 * t + 1]];
      const float4 along = random_numbers(static_cast<std::uint32_t>(t), i);
      add(from, a + (b - a) * along.x);
    }
  }
  for (const float3 axis : {float3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}) add({}, axis);
  for (const float v : visibility(bvh, rays)) ASSERT_EQ(v, 0);
  for (const RayHit& hit : nearest(bvh, rays)) ASSERT_NE(hit.primitive, RayHit::none);
}

// The plane's boxes are flat, and the rays lie in them.
TEST(Trace, RaysAlongAnAxisMeetWhatTheyTouch) {
  const TestMesh wall{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 2, 1, 3}};
  const Bvh bvh(std::vector{wall.caster()});
  std::vector<Ray> rays;
  for (const float x : {0.0f, 0.25f, 0.5f, 1.0f})
    for (const float y : {0.0f, 0.25f, 0.5f, 1.0f}) rays.push_back({{x, y, -1}, {0, 0, 1}});
  for (const float v : visibility(bvh, rays)) EXPECT_EQ(v, 0);
  for (Ray& ray : rays) ray.end = 1;  // excluded
  for (const float v : visibility(bvh, rays)) EXPECT_EQ(v, 1);
  EXPECT_EQ(visibility(Bvh({}), rays)[0], 1);
}

TEST(Trace, TranslucentCastersAttenuate) {
  const TestMesh wall{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}};
  ShadowCaster near = wall.caster(), far = wall.caster();
  near.is_translucent = true;
  near.world_from_object.column[3].z = -0.5f;
  const std::vector<Ray> rays = {{{0.25f, 0.25f, -1}, {0, 0, 1}}};
  const auto quarter = [](const void* factor, const RayHit& hit) {
    return hit.b1 * *static_cast<const float*>(factor);
  };
  const float one = 1;
  const OpacityOfHits opacity{quarter, &one};
  EXPECT_EQ(visibility(Bvh(std::vector{near}), rays, opacity)[0], 0.75f);
  EXPECT_EQ(visibility(Bvh(std::vector{near, near}), rays, opacity)[0], 0.75f * 0.75f);
  EXPECT_EQ(visibility(Bvh(std::vector{near, far}), rays, opacity)[0], 0);
}

/// Receivers with rays of three kinds in turn: into a hemisphere, into a narrow cone, and from places to anywhere.
std::vector<Ray> rays_of_receivers(std::uint32_t first, std::uint32_t count) {
  std::vector<Ray> rays;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Ray central = random_ray(i / 64);
    Ray ray = i / 64 % 3 == 2 ? random_ray(i) : central;
    const float4 d = random_numbers(i, 13);
    const float spread = i / 64 % 3 == 0 ? 2.0f : 0.05f;
    for (std::size_t a = 0; a < 3; ++a) {
      if (i / 64 % 3 == 1) ray.origin[a] += 0.01f * (d.w - 0.5f);
      if (i / 64 % 3 < 2) ray.direction[a] += spread * ((a == 0 ? d.x : a == 1 ? d.y : d.z) - 0.5f);
      if (i % 97 == 0) ray.direction[a] = a == i % 3 ? 1.0f : 0.0f;
    }
    if (i % 2 == 0) ray.end = 0.5f;
    rays.push_back(ray);
  }
  return rays;
}

/// Compares rays in batches of any size with each of them alone.
void compare_with_single_rays(std::uint32_t count) {
  const TestMesh sphere = bumpy_sphere(100), soup = triangle_soup(20000, 0.05f);
  ShadowCaster casters[] = {sphere.caster(), soup.caster()};
  const OpacityOfHits weights{[](const void*, const RayHit& hit) { return hit.primitive % 5 == 0 ? 1 : 0.7f * hit.b1; },
                              nullptr};
  for (const int translucent : {0, 1, 2}) {
    for (int k = 0; k < translucent; ++k) casters[k].is_translucent = true;
    const Bvh bvh(casters);
    double parts = 0;
    constexpr std::uint32_t step = 6400;
    for (std::uint32_t first = 0; first < count; first += step) {
      const std::vector<Ray> rays = rays_of_receivers(first, std::min(step, count - first));
      const std::size_t batch = 1 + hash(first) % 100;
      std::vector<float> together(rays.size());
      for (std::size_t i = 0; i < rays.size(); i += batch)
        RayKernels::of().visibility(view_of(bvh), rays.data() + i, std::min(batch, rays.size() - i), weights,
                                    together.data() + i);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        float alone = -1;
        RayKernels::of().visibility(view_of(bvh), &rays[i], 1, weights, &alone);
        ASSERT_EQ(together[i], alone) << first + i;
        parts += alone > 0 && alone < 1;
      }
    }
    if (translucent == 0)
      EXPECT_EQ(parts, 0);
    else
      EXPECT_GT(parts, translucent == 1 ? count / 100 : count / 4);
  }
}

TEST(Trace, RaysTogetherAreRaysAlone) { compare_with_single_rays(400000); }

TEST(Trace, DISABLED_OneHundredMillionRaysTogetherAreRaysAlone) { compare_with_single_rays(34000000); }

/// Compares rays over the surfaces of a mesh and of its neighbours by collect_top with those by the whole tree.
void compare_with_whole_tree(std::uint32_t receivers, std::size_t max_expanded = Bvh::max_expanded) {
  const TestMesh sphere = bumpy_sphere(100), soup = triangle_soup(20000, 0.05f);
  std::vector<ShadowCaster> casters{sphere.caster(), soup.caster()};
  casters[1].is_translucent = true;
  for (int i = 0; max_expanded == 0 && i < 4; ++i) casters.push_back(casters[0]);  // enough for a tree that is placed
  const OpacityOfHits weights{[](const void*, const RayHit& hit) { return 0.7f * hit.b1; }, nullptr};
  const Bvh bvh(casters, max_expanded);
  const RayKernels& kernels = RayKernels::of();
  std::uint32_t free = 0, hit_count = 0;
  for (std::uint32_t k = 0; k < receivers; ++k) {
    const std::size_t triangle = hash(k, 21) % (sphere.index.size() / 3);
    const auto p = [&](std::size_t v) { return sphere.position[sphere.index[3 * triangle + v]]; };
    float3 normal = normalize(cross(p(1) - p(0), p(2) - p(0)), {0, 1, 0});
    const float4 r = random_numbers(k, 22);
    // On the surface, and anywhere at a slant to it.
    float3 origin = p(0) + (p(1) - p(0)) * (0.5f * r.x) + (p(2) - p(0)) * (0.5f * r.y);
    if (dot(normal, origin) < 0) normal = -normal;
    origin = origin + normal * 4e-6f;
    if (k % 3 == 1) origin = {4 * r.x - 2, 4 * r.y - 2, 4 * r.z - 2};
    if (k % 3 == 2) normal = normalize(normal + float3{r.x - 0.5f, r.y - 0.5f, r.z - 0.5f}, normal);
    const float radius = k % 5 == 0 ? 1e6f : 0.1f + r.w;
    BvhTop top;
    kernels.collect_top(view_of(bvh), {{origin.x, origin.y, origin.z}, {normal.x, normal.y, normal.z}, radius}, top);
    free += top.count == 0;
    std::vector<Ray> rays;
    for (std::uint32_t s = 0; s < 64; ++s) {
      const float4 random = random_numbers(64 * k + s, 23);
      float3 d = normalize(float3{random.x - 0.5f, random.y - 0.5f, random.z - 0.5f}, normal);
      const float below = std::min(0.0f, dot(d, normal));
      d = normalize(d - normal * ((s % 2 == 0 ? 2 : 1) * below), normal);  // every other one of those along the plane
      rays.push_back({{origin.x, origin.y, origin.z}, {d.x, d.y, d.z}, radius});
    }
    float whole[64], part[64];
    kernels.visibility(view_of(bvh), rays.data(), rays.size(), weights, whole);
    kernels.visibility_below(view_of(bvh), top, rays.data(), rays.size(), weights, part);
    for (std::size_t s = 0; s < 64; ++s) {
      ASSERT_EQ(part[s], whole[s]) << k << ' ' << s;
      hit_count += whole[s] < 1;
    }
  }
  EXPECT_GT(free, receivers / 20);
  EXPECT_GT(hit_count, receivers);
}

TEST(Trace, TopsLeaveOutNothingThatRaysMeet) { compare_with_whole_tree(16000); }
TEST(Trace, TopsOfPlacedTreesLeaveOutNothingThatRaysMeet) { compare_with_whole_tree(4000, 0); }

TEST(Trace, DISABLED_TopsLeaveOutNothingThatOneHundredMillionRaysMeet) { compare_with_whole_tree(1600000); }

/// Placements of a mesh at random, mirrored, flat and so far away that nothing is hit among them, and a soup.
std::vector<ShadowCaster> repeated_casters(const TestMesh& mesh, const TestMesh& soup, int count) {
  std::vector<ShadowCaster> casters{soup.caster()};
  for (int i = 0; i < count; ++i) {
    ShadowCaster caster = mesh.caster();
    const auto k = static_cast<std::uint32_t>(i);
    for (std::uint32_t c = 0; c < 4; ++c) {
      const float4 r = random_numbers(k, 31 + c);
      caster.world_from_object.column[c] = {r.x - 0.5f, r.y - 0.5f, r.z - 0.5f, c == 3 ? 1.0f : 0.0f};
    }
    if (i == 1) caster.world_from_object.column[1] = {0, 0, 0, 0};
    if (i == 2) caster.world_from_object.column[3] = {1e34f, 0, 0, 1};
    if (i == 3) caster.world_from_object.column[3] = {1e5f, 2e5f, 0, 1};
    casters.push_back(caster);
  }
  return casters;
}

TEST(Trace, PlacedTreesAreHitAsExpandedOnes) {
  const TestMesh sphere = bumpy_sphere(75), soup = triangle_soup(2000, 0.1f);
  std::vector<ShadowCaster> casters = repeated_casters(sphere, soup, 12);
  std::vector<Ray> rays = random_rays(8000);
  for (std::uint32_t i = 0; i < 1000; ++i) {  // to the one far away, past the edges of its triangles too
    const float4 r = random_numbers(i, 41);
    rays.push_back({{1e5f, 2e5f, 3}, {r.x - 0.5f, r.y - 0.5f, -3}});
  }
  const std::vector<Ray> related = rays_of_receivers(0, 6400);
  rays.insert(rays.end(), related.begin(), related.end());
  const Bvh expanded(casters), placed(casters, 0);
  EXPECT_TRUE(expanded.placements().empty());
  EXPECT_EQ(placed.placements().size(), 11u);
  EXPECT_EQ(placed.triangles(), expanded.triangles());
  EXPECT_LT(placed.leaves().size(), expanded.leaves().size() / 5);
  const std::vector<RayHit> expected = nearest(expanded, rays);
  std::set<std::uint32_t> instances;
  for (const Isa isa : supported_isas()) {
    const std::vector<RayHit> hits = nearest(placed, rays, RayKernels::of(isa));
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(hits[i].instance, expected[i].instance) << i;
      ASSERT_EQ(hits[i].primitive, expected[i].primitive) << i;
      ASSERT_EQ(hits[i].t, expected[i].t);
      ASSERT_EQ(hits[i].b1, expected[i].b1);
      ASSERT_EQ(hits[i].b2, expected[i].b2);
      instances.insert(hits[i].instance);
    }
    EXPECT_EQ(visibility(placed, rays, {}, RayKernels::of(isa)), visibility(expanded, rays));
  }
  EXPECT_GE(instances.size(), 12u);
  // Light through several surfaces is multiplied in the order of the tree.
  for (ShadowCaster& caster : casters) caster.is_translucent = true;
  const OpacityOfHits weights{[](const void*, const RayHit& hit) { return 0.5f * hit.b1; }, nullptr};
  const Bvh placed_veil(casters, 0);
  const std::vector<float> veil = visibility(Bvh(casters), rays, weights),
                           same = visibility(placed_veil, rays, weights);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_NEAR(same[i], veil[i], 1e-6f);
  for (const Isa isa : supported_isas()) EXPECT_EQ(visibility(placed_veil, rays, weights, RayKernels::of(isa)), same);
}

// 10^9 triangles: each has its box in the world, none is stored there.
TEST(Trace, TenThousandPlacementsTakeLittleMemory) {
  const TestMesh sphere = bumpy_sphere(224);
  std::vector<ShadowCaster> casters;
  for (int i = 0; i < 10000; ++i) {
    ShadowCaster caster = sphere.caster();
    caster.world_from_object.column[3] = {3.0f * static_cast<float>(i % 100), 0, 3.0f * static_cast<float>(i / 100), 1};
    casters.push_back(caster);
  }
  const Bvh bvh(casters);
  EXPECT_EQ(bvh.triangles(), 10000 * sphere.index.size() / 3);
  EXPECT_LT(bvh.nodes().size_bytes() + bvh.leaves().size_bytes() + bvh.placements().size_bytes(), 20'000'000u);
  std::vector<Ray> rays;
  for (int i = 0; i < 10000; ++i)
    rays.push_back({{3.0f * static_cast<float>(i % 100), 5, 3.0f * static_cast<float>(i / 100)}, {0.01f, -1, 0.02f}});
  const std::vector<RayHit> hits = nearest(bvh, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) ASSERT_EQ(hits[i].instance, i);
}

TEST(TraceBits, TopsAreTheSameForAllInstructionSets) {
  const TestMesh sphere = bumpy_sphere(60);
  const Bvh bvh(std::vector{sphere.caster()});
  for (std::uint32_t k = 0; k < 2000; ++k) {
    const Ray ray = random_ray(k);
    const float3 normal = normalize(float3{ray.direction[0], ray.direction[1], ray.direction[2]}, {0, 0, 1});
    const HalfBall within{{ray.origin[0], ray.origin[1], ray.origin[2]}, {normal.x, normal.y, normal.z}, 1.5f};
    BvhTop first;
    RayKernels::scalar.collect_top(view_of(bvh), within, first);
    for (const Isa isa : supported_isas()) {
      BvhTop top;
      RayKernels::of(isa).collect_top(view_of(bvh), within, top);
      ASSERT_EQ(top.count, first.count);
      for (int i = 0; i < top.count; ++i)
        for (int c = 0; c < BvhNode::width; ++c) ASSERT_EQ(top.nodes[i].child[c], first.nodes[i].child[c]);
    }
  }
}

TEST(TraceBits, AreTheSameForAllInstructionSets) {
  const TestMesh sphere = bumpy_sphere(40), soup = triangle_soup(2000, 0.3f);
  const ShadowCaster casters[] = {sphere.caster(), soup.caster()};
  std::vector<ShadowCaster> translucent(std::begin(casters), std::end(casters));
  for (ShadowCaster& caster : translucent) caster.is_translucent = true;
  std::vector<Ray> rays = random_rays(5000);
  const std::vector<Ray> related = rays_of_receivers(0, 6400);
  rays.insert(rays.end(), related.begin(), related.end());
  const OpacityOfHits weights{[](const void*, const RayHit& hit) { return 0.5f * hit.b1 + 0.25f * hit.b2; }, nullptr};
  const Bvh opaque(casters), veil(translucent);
  const std::vector<RayHit> hits = nearest(opaque, rays, RayKernels::scalar);
  for (const Isa isa : supported_isas()) {
    const RayKernels& kernels = RayKernels::of(isa);
    EXPECT_EQ(visibility(opaque, rays, {}, kernels), visibility(opaque, rays, {}, RayKernels::scalar));
    EXPECT_EQ(visibility(veil, rays, weights, kernels), visibility(veil, rays, weights, RayKernels::scalar));
    const std::vector<RayHit> same = nearest(opaque, rays, kernels);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(same[i].primitive, hits[i].primitive);
      ASSERT_EQ(same[i].t, hits[i].t);
      ASSERT_EQ(same[i].b1, hits[i].b1);
      ASSERT_EQ(same[i].b2, hits[i].b2);
    }
  }
}

}  // namespace
}  // namespace zoneplate
