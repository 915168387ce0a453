// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "zoneplate/antialias/shots_for_test.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::antialias {
namespace {

LinearImage shot_by(const char* name, const char* method) { return antialias::shot(*make_builtin_scene(name), method); }

TEST(IdSraa, WithOneColourATriangleItIsMultisampling) {
  for (const char* name : {"triangles", "cyclic"})
    for (const auto& [own, multi] :
         {std::pair{"idsraa:n=4", "msaa:n=4"}, {"idsraa", "msaa:n=8"}, {"idsraa:n=16", "msaa:n=16"}}) {
      const LinearImage a = shot_by(name, own), b = shot_by(name, multi);
      int differing = 0, partial = 0;
      for (std::size_t i = 0; i < a.values().size(); ++i) {
        const Linear p = a.values()[i], q = b.values()[i];
        partial += q.a > 0 && q.a < 1;
        differing += std::abs(p.r - q.r) > 1e-5f || std::abs(p.g - q.g) > 1e-5f || std::abs(p.b - q.b) > 1e-5f ||
                     std::abs(p.a - q.a) > 1e-5f;
      }
      EXPECT_GT(partial, 100) << name;
      // Only the samples of corners thinner than a pixel may find no shaded neighbour of their triangle.
      EXPECT_LE(differing, 8) << name << " " << own;
    }
}

TEST(IdSraa, PicturesWithinASurfaceKeepTheirBits) {
  const Scene scene = *make_builtin_scene("checkerboard");
  const LinearImage a = antialias::shot(scene, "idsraa"), b = antialias::shot(scene, "none");
  Request request;
  request.content = Content::Visibility;
  request.planes.sample_triangles = true;
  for (const SamplePosition p : standard_pattern(8)) request.samples.push_back(p);
  const Frame seen = render(PreparedScene(scene), scene.cameras.at(0), request, {.width = 160, .height = 120});
  std::size_t within = 0, mixed = 0, changed = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    const bool is_one = std::ranges::all_of(seen.sample_triangle, [&](const Plane<std::uint32_t>& triangle) {
      return triangle.values()[i] == seen.sample_triangle[0].values()[i];
    });
    (is_one ? within : mixed) += 1;
    changed += a.values()[i] != b.values()[i];
    if (is_one) {
      ASSERT_EQ(a.values()[i], b.values()[i]) << i;
    }
  }
  // Colours change only on shared edges: the diagonals and the border of the board.
  EXPECT_GT(mixed, 100u);
  EXPECT_GT(within, 18000u);
  EXPECT_GT(changed, 200u);
  EXPECT_LE(changed, mixed);
}

TEST(IdSraa, ThreadsLeaveNoTrace) {
  LinearImage one, many;
  with_threads(1, [&] { one = shot_by("cyclic", "idsraa"); });
  with_threads(5, [&] { many = shot_by("cyclic", "idsraa"); });
  EXPECT_EQ(one, many);
}

}  // namespace
}  // namespace zoneplate::antialias
