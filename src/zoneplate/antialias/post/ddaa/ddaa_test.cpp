// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/ddaa/ddaa.h"

#include <gtest/gtest.h>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/post/fxaa/fxaa.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

TEST(Ddaa, OutputsHaveTheirBits) {
  const Rgba8Image image = random_shapes(200, 150, 1);
  const auto hash = [&](const DdaaOptions& o) { return hash_of(apply_ddaa(image, o)); };
  EXPECT_EQ(hash({.strength = 3}), 0x580497c4ee85d7d2u);
  EXPECT_EQ(hash({.threshold = 0.031f, .least = 0.0078f, .strength = 1}), 0x43b01bc2f3a76555u);
}

TEST(Ddaa, InstructionSetsAndThreadsLeaveNoTrace) {
  for (const int width : {1, 5, 64, 203}) {
    const Rgba8Image image = random_shapes(width, 177, 2);
    for (const DdaaOptions& options : {DdaaOptions{}, DdaaOptions{.threshold = 0.031f, .least = 0.0078f}}) {
      const Rgba8Image expected = with_isa(Isa::Scalar, [&] { return apply_ddaa(image, options); });
      for (const Isa isa : supported_isas())
        for (const int threads : {1, 2, 7})
          with_isa(isa, [&] {
            with_threads(threads, [&] { EXPECT_EQ(apply_ddaa(image, options), expected) << name_of(isa) << threads; });
          });
    }
  }
}

TEST(Ddaa, DiagonalsAreSmoothedAndThinLinesSpared) {
  const Rgba8Image diagonal = make_codes(40, 40, [](int x, int y) {
    return x > y ? Rgba8{230, 230, 230} : Rgba8{20, 20, 20};
  });
  const Rgba8Image out = apply_ddaa(diagonal, {});
  EXPECT_GT(out(20, 20).g, 40);
  EXPECT_LT(out(21, 20).g, 210);
  EXPECT_EQ(out(20, 10), diagonal(20, 10));
  const Rgba8Image line = make_codes(40, 40, [](int, int y) {
    return y == 20 ? Rgba8{230, 230, 230} : Rgba8{20, 20, 20};
  });
  EXPECT_EQ(apply_ddaa(line, {}), line);
}

TEST(Ddaa, ComesNearerToTheAreaThanFxaa) {
  // Edges from diagonal to horizontal: root mean square error in 8-bit values relative to the exact area.
  double mean = 0, mean_fxaa = 0;
  for (const double run : {1.0, 1.1, 1.2, 1.5, 2.0, 2.6, 3.4, 5.1, 8.2, 12.3, 20.1}) {
    const Band plane{run, 1000};
    const auto codes_error = [&](const Rgba8Image& image) {
      double sum = 0;
      int count = 0;
      for (int y = 4; y < plane.height - 4; ++y)
        for (int x = 4; x < 40; ++x) {
          const double area = plane.area(x, y), off = image(x, y).g / 255.0 - area;
          if (area > 0 && area < 1) sum += off * off, ++count;
        }
      return std::sqrt(sum / count);
    };
    const Rgba8Image image = plane.codes(0.5, 0.5);
    mean += codes_error(apply_ddaa(image, {}));
    mean_fxaa += codes_error(apply_fxaa(image, {}));
    // Near the diagonal, an edge search alone has no effect.
    if (run < 1.5) {
      EXPECT_LT(codes_error(apply_ddaa(image, {})), 0.85 * codes_error(apply_fxaa(image, {.subpixel = 0}))) << run;
    }
  }
  EXPECT_LT(mean, 0.9 * mean_fxaa);
}

}  // namespace
}  // namespace zoneplate::antialias
