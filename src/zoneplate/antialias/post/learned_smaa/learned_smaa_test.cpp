// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/post/learned_smaa/learned_smaa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "zoneplate/antialias/charts_for_test.h"
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

TEST(LearnedSmaa, OutputsHaveTheirBits) {
  EXPECT_EQ(hash_of(apply_learned_smaa(random_shapes(200, 150, 1))), 0xd4211d0a821142deu);
  EXPECT_EQ(hash_of(apply_learned_smaa(chart64())), 0xae5d1f263e3b6ef0u);
}

TEST(LearnedSmaa, InstructionSetsAndThreadsLeaveNoTrace) {
  const Rgba8Image image = random_shapes(203, 77, 2);
  const Rgba8Image expected = with_isa(Isa::Scalar, [&] { return apply_learned_smaa(image); });
  for (const Isa isa : supported_isas())
    with_isa(isa, [&] { with_threads(3, [&] { EXPECT_EQ(apply_learned_smaa(image), expected) << name_of(isa); }); });
}

TEST(LearnedSmaa, APartHasTheBitsOfTheWhole) {
  const Rgba8Image image = random_shapes(190, 150, 3), whole = apply_learned_smaa(image);
  const int halo = learned_smaa_radius();
  for (const auto& [left, top] : {std::pair(60, 50), std::pair(61, 50), std::pair(60, 51), std::pair(61, 51)}) {
    const int x = left - halo, y = top - halo;
    Rgba8Image part(20 + 2 * halo, 20 + 2 * halo);
    for (int v = 0; v < part.height(); ++v)
      for (int u = 0; u < part.width(); ++u) part(u, v) = image(x + u, y + v);
    const Rgba8Image out = apply_learned_smaa(part, x, y);
    for (int v = 0; v < 20; ++v)
      for (int u = 0; u < 20; ++u)
        ASSERT_EQ(out(halo + u, halo + v), whole(left + u, top + v)) << left << ',' << top << ": " << u << ',' << v;
  }
}

// Rows are made in bands, which another origin moves.
TEST(LearnedSmaa, BandsLeaveNoTrace) {
  constexpr int cut = 200;
  const Rgba8Image image = random_shapes(40, 3 * StillCorrections::band, 4), whole = apply_learned_smaa(image);
  Rgba8Image part(image.width(), image.height() - cut);
  for (int y = 0; y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x) part(x, y) = image(x, cut + y);
  const Rgba8Image out = apply_learned_smaa(part, 0, cut);
  for (int y = learned_smaa_radius(); y < part.height(); ++y)
    for (int x = 0; x < part.width(); ++x) ASSERT_EQ(out(x, y), whole(x, cut + y)) << x << ',' << y;
}

/// Discs and bars of random colours.
class Shapes {
 public:
  explicit Shapes(std::uint32_t seed) : seed_(seed) {}
  Rgba8 at(double x, double y) const {
    Rgba8 out{40, 44, 52, 255};
    for (std::uint32_t i = 0; i < 7; ++i) {
      const auto random = [&](std::uint32_t k) { return double{unit_float(hash(seed_, i, k))}; };
      const double dx = x - 64 * random(0), dy = y - 64 * random(1), angle = 6.283185307 * random(2);
      const double across = dx * std::cos(angle) + dy * std::sin(angle), size = 4 + 14 * random(3);
      if (random(4) < 0.5 ? dx * dx + dy * dy < size * size : std::abs(across) < size / 3)
        out = {code(random(5)), code(random(6)), code(random(7)), 255};
    }
    return out;
  }

 private:
  static std::uint8_t code(double v) { return static_cast<std::uint8_t>(255 * v); }
  std::uint32_t seed_;
};

/// The squared error of codes against the mean light of 64 samples per pixel.
double error_of(const std::function<Rgba8Image(const Rgba8Image&)>& filter) {
  constexpr int size = 64, side = 8;
  double sum = 0;
  for (std::uint32_t seed = 0; seed < 12; ++seed) {
    const Shapes shapes(seed);
    const Rgba8Image out = filter(make_codes(size, size, [&](int x, int y) { return shapes.at(x + 0.5, y + 0.5); }));
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        Linear mean{0, 0, 0, 0};
        for (int k = 0; k < side * side; ++k)
          mean = mean + decode_pixel(shapes.at(x + (k % side + 0.5) / side, y + (k / side + 0.5) / side)) *
                            (1.0f / (side * side));
        sum += std::pow(out(x, y).g - encode_pixel(mean).g, 2);
      }
  }
  return sum;
}

TEST(LearnedSmaa, EdgesHaveLessErrorThanThoseOfSmaa) {
  const double smaa = error_of([](const Rgba8Image& i) { return apply_smaa(i, nullptr, {}); });
  const double learned = error_of([](const Rgba8Image& i) { return apply_learned_smaa(i); });
  EXPECT_LT(10 * std::log10(learned / smaa), -0.8);
}

TEST(LearnedSmaa, BandLimitedTexturesStay) {
  double sum = 0;
  for (int direction = 0; direction < 8; ++direction) {
    // Waves of eight pixels and more.
    const double angle = direction * 0.39, step = 6.283185307 / (8 + direction);
    const Rgba8Image image = make_codes(64, 64, [&](int x, int y) {
      const double wave = std::sin(step * (x * std::cos(angle) + y * std::sin(angle)));
      const auto code = [&](double size) { return static_cast<std::uint8_t>(std::lround(128 + size * wave)); };
      return Rgba8{code(60), code(45), code(-50), 255};
    });
    const Rgba8Image out = apply_learned_smaa(image);
    double of_one = 0;
    for (std::size_t i = 0; i < out.values().size(); ++i)
      of_one += std::pow(out.values()[i].g - image.values()[i].g, 2) / static_cast<double>(out.values().size());
    sum += of_one / 8;
  }
  EXPECT_LE(std::sqrt(sum), 1.0);
}

}  // namespace
}  // namespace zoneplate::antialias
