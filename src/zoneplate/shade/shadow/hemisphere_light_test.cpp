// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/hemisphere_light.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>

#include "zoneplate/math/basis.h"
#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

constexpr int map_side = HemisphereKernels::side;

float random_unit(std::uint32_t a, std::uint32_t b) { return unit_float(hash(a, b, 4)); }

struct Receiver {
  std::array<float, std::size_t{map_side} * map_side> octahedron;
  alignas(64) float middle[3][HemisphereCells::count];
  float3 frame[3];
  HemispherePlaces places{};

  /// Some cells of the octahedron have no light.
  explicit Receiver(std::uint32_t seed) {
    for (std::size_t i = 0; i < octahedron.size(); ++i) {
      const float light = random_unit(static_cast<std::uint32_t>(i), seed);
      octahedron[i] = light < 0.3f ? 0 : light * light * 50;
    }
    for (int c = 0; c < HemisphereCells::count; ++c) {
      const auto n = static_cast<std::uint32_t>(c);
      const float z = random_unit(n, 1), angle = 6.28318f * random_unit(n, 2), across = std::sqrt(1 - z * z);
      middle[0][c] = across * std::cos(angle), middle[1][c] = across * std::sin(angle), middle[2][c] = z;
    }
    float3 normal =
        normalize({random_unit(seed, 3) - 0.5f, random_unit(seed, 4) - 0.5f, random_unit(seed, 5) - 0.5f}, {0, 0, 1});
    if (seed % 4 == 0) normal = {0, 0, seed % 8 == 0 ? 1.0f : -1.0f};
    frame[0] = Basis(normal).first, frame[1] = Basis(normal).second, frame[2] = normal;
    places.count = 1 + static_cast<int>(seed % HemispherePlaces::capacity);
  }
  void place(const HemisphereLight& light, std::uint32_t seed) {
    for (int i = 0; i < places.count; ++i) {
      const auto n = static_cast<std::uint32_t>(i) + 64 * seed;
      places.ring[i] = static_cast<std::int32_t>(hash(n) % HemisphereCells::rings);
      places.across[i] = random_unit(n, 6) * light.sum[places.ring[i]];
      places.turn[i] = i % 9 == 0 ? 0 : random_unit(n, 7);
    }
  }
};

TEST(HemisphereLightBits, AreTheSameForAllInstructionSets) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    Receiver surface(seed);
    HemisphereLight light;
    HemisphereKernels::scalar.look_up(surface.octahedron.data(), surface.middle, surface.frame, light);
    surface.place(light, seed);
    float first[3][HemispherePlaces::capacity];
    HemisphereKernels::scalar.directions(light, surface.places, surface.frame, first);
    for (const Isa isa : supported_isas()) {
      HemisphereLight same;
      HemisphereKernels::of(isa).look_up(surface.octahedron.data(), surface.middle, surface.frame, same);
      for (int c = 0; c < HemisphereCells::count; ++c) ASSERT_EQ(same.light[c], light.light[c]);
      for (int r = 0; r < HemisphereCells::rings; ++r) ASSERT_EQ(same.sum[r], light.sum[r]);
      float found[3][HemispherePlaces::capacity];
      HemisphereKernels::of(isa).directions(light, surface.places, surface.frame, found);
      for (int i = 0; i < surface.places.count; ++i)
        for (int c = 0; c < 3; ++c) ASSERT_EQ(found[c][i], first[c][i]) << seed << ' ' << i;
    }
  }
}

// One cell has all of the light: all directions lie in it, above the surface.
TEST(HemisphereLight, DirectionsLieWhereLightIs) {
  Receiver surface(7);
  HemisphereLight light{};
  constexpr int ring = 5, sector = 9;
  const float brightness = 3;
  light.light[sector * HemisphereCells::rings + ring] = std::bit_cast<std::int32_t>(brightness);
  light.sum[ring] = brightness;
  surface.places.count = HemispherePlaces::capacity;
  for (int i = 0; i < surface.places.count; ++i) {
    surface.places.ring[i] = ring, surface.places.turn[i] = random_unit(static_cast<std::uint32_t>(i), 8);
    surface.places.across[i] = brightness * random_unit(static_cast<std::uint32_t>(i), 9);
  }
  float found[3][HemispherePlaces::capacity];
  HemisphereKernels::of().directions(light, surface.places, surface.frame, found);
  for (int i = 0; i < surface.places.count; ++i) {
    const float3 d{found[0][i], found[1][i], found[2][i]};
    EXPECT_NEAR(length(d), 1, 1e-6f);
    const float cosine = dot(d, surface.frame[2]), square = 1 - cosine * cosine;
    EXPECT_GT(square, (ring - 1e-4f) / HemisphereCells::rings);
    EXPECT_LT(square, (ring + 1 + 1e-4f) / HemisphereCells::rings);
    const float angle = std::atan2(dot(d, surface.frame[1]), dot(d, surface.frame[0]));
    const float turn = angle / 6.2831853f * HemisphereCells::sectors;
    EXPECT_GT(turn, sector - 1e-3f);
    EXPECT_LT(turn, sector + 1 + 1e-3f);
  }
}

}  // namespace
}  // namespace zoneplate
