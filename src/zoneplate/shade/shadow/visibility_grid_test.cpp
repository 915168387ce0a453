// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/visibility_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "zoneplate/math/random.h"

namespace zoneplate {
namespace {

using Value = VisibilityGrid::Value;
constexpr int side = 96, rays = 64;

/// What pixels show, by their coordinates.
using Surface = std::function<Value(float x, float y)>;

/// A plane across the view with this visibility.
Surface plane_with(std::function<float(float x, float y)> visible) {
  return [=](float x, float y) { return Value{{x, y, 0}, {0, 0, 1}, 0, visible(x, y)}; };
}

struct Asked {
  std::vector<float> values;  ///< by receiver
  std::vector<PixelPosition> evaluated;
};

/// The values at these places, in pixels, requested in batches of this size.
Asked ask(VisibilityGrid& grid, const Surface& surface, const std::vector<float2>& places, std::size_t batch = 100) {
  Asked out;
  const auto evaluate = [&](std::span<const PixelPosition> pixels, Value* values) {
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      values[i] = surface(static_cast<float>(pixels[i].x) + 0.5f, static_cast<float>(pixels[i].y) + 0.5f);
      out.evaluated.push_back(pixels[i]);
    }
  };
  for (std::size_t first = 0; first < places.size(); first += batch) {
    Receivers r{};
    r.count = static_cast<int>(std::min(batch, places.size() - first));
    for (int i = 0; i < r.count; ++i) {
      const float2 p = places[first + static_cast<std::size_t>(i)];
      const Value shown = surface(p.x, p.y);
      r.x[i] = static_cast<std::int32_t>(256 * p.x), r.y[i] = static_cast<std::int32_t>(256 * p.y);
      r.position[0][i] = shown.position.x, r.position[1][i] = shown.position.y, r.position[2][i] = shown.position.z;
      r.surface[i] = shown.surface;
      r.face[0][i] = shown.normal.x, r.face[1][i] = shown.normal.y, r.face[2][i] = shown.normal.z;
      r.normal[0][i] = shown.normal.x, r.normal[1][i] = shown.normal.y, r.normal[2][i] = shown.normal.z;
    }
    std::vector<int> which(static_cast<std::size_t>(r.count));
    std::iota(which.begin(), which.end(), 0);
    std::vector<float> values(which.size());
    grid.interpolate(r, which, evaluate, values.data());
    out.values.insert(out.values.end(), values.begin(), values.end());
  }
  return out;
}

/// Places in the image, in 1/256 pixel.
std::vector<float2> random_places(std::uint32_t count) {
  std::vector<float2> places;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto place = [&](std::uint32_t k) { return std::floor(unit_float(hash(i, k, 5)) * 256 * side) / 256; };
    places.push_back({place(0), place(1)});
  }
  return places;
}

TEST(VisibilityGrid, ReproducesWhatIsLinear) {
  const auto visible = [](float x, float y) { return 0.2f + 0.004f * x + 0.003f * y; };
  for (const int step : {1, 2, 4, 8}) {
    VisibilityGrid grid(step, side, side, rays);
    const std::vector<float2> places = random_places(2000);
    const Asked asked = ask(grid, plane_with(visible), places);
    for (std::size_t i = 0; i < places.size(); ++i)
      ASSERT_NEAR(asked.values[i], visible(places[i].x, places[i].y), 1e-3f) << step;
  }
}

// The error of a smooth function falls with the square of the step.
TEST(VisibilityGrid, IsNearWhatIsSmooth) {
  const auto visible = [](float x, float y) { return 0.5f + 0.4f * std::sin(0.06f * x) * std::cos(0.05f * y); };
  const std::vector<float2> places = random_places(2000);
  float last = 1;
  for (const int step : {8, 4, 2}) {
    VisibilityGrid grid(step, side, side, rays);
    const Asked asked = ask(grid, plane_with(visible), places);
    float worst = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      ASSERT_NE(asked.values[i], Value::nothing);
      worst = std::max(worst, std::abs(asked.values[i] - visible(places[i].x, places[i].y)));
    }
    EXPECT_LT(worst, last / 2.5f);
    last = worst;
  }
  EXPECT_LT(last, 0.01f);
}

TEST(VisibilityGrid, LeavesEdgesToRays) {
  for (const float slope : {0.0f, 0.3f, 1.0f, -2.0f}) {
    const auto from_edge = [=](float x, float y) { return (x - 48 - slope * (y - 48)) / std::sqrt(1 + slope * slope); };
    const auto visible = [=](float x, float y) { return from_edge(x, y) < 0 ? 0.0f : 1.0f; };
    VisibilityGrid grid(4, side, side, rays);
    const std::vector<float2> places = random_places(4000);
    const Asked asked = ask(grid, plane_with(visible), places);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const float distance = std::abs(from_edge(places[i].x, places[i].y));
      if (asked.values[i] == Value::nothing) {
        ASSERT_LT(distance, 12);
        continue;
      }
      // Half a cell from the edge, one point of small weight lies beyond it.
      ASSERT_NEAR(asked.values[i], visible(places[i].x, places[i].y), distance < 2 ? 1 : 0.03f) << distance;
      ASSERT_GT(distance, 1);
    }
  }
}

// Two planes meet, or lie behind each other: neither takes values of the other.
TEST(VisibilityGrid, KeepsSurfacesApart) {
  const Surface corner = [](float x, float y) {
    return x < 48 ? Value{{x, y, 0}, {0, 0, 1}, 0, 0.25f} : Value{{48, y, 48 - x}, {-1, 0, 0}, 0, 0.75f};
  };
  const Surface stairs = [](float x, float y) {
    return x < 48 ? Value{{x, y, 0}, {0, 0, 1}, 0, 0.25f} : Value{{x, y, -9}, {0, 0, 1}, 0, 0.75f};
  };
  const Surface sheets = [](float x, float y) {  // a gap of a pixel
    return x < 48 ? Value{{x, y, 0}, {0, 0, 1}, 0, 0.25f} : Value{{x, y, -1}, {0, 0, 1}, 0, 0.75f};
  };
  const Surface instances = [](float x, float y) {
    return x < 48 ? Value{{x, y, 0}, {0, 0, 1}, 0, 0.25f, 3} : Value{{x, y, 0}, {0, 0, 1}, 0, 0.75f, 4};
  };
  for (const int step : {1, 4})
    for (const Surface& surface : {corner, stairs, sheets, instances}) {
      VisibilityGrid grid(step, side, side, rays);
      const std::vector<float2> places = random_places(4000);
      const Asked asked = ask(grid, surface, places);
      int beside = 0;
      for (std::size_t i = 0; i < places.size(); ++i) {
        if (asked.values[i] == Value::nothing) {
          ASSERT_LT(std::abs(places[i].x - 48), 10);
          continue;
        }
        ASSERT_NEAR(asked.values[i], places[i].x < 48 ? 0.25f : 0.75f, 0.01f);
        beside += std::abs(places[i].x - 48) < static_cast<float>(step);
      }
      EXPECT_GT(beside, step == 1 ? 50 : 100);
    }
}

// Spheres of any size on the screen, to their outline.
TEST(VisibilityGrid, FollowsCurvedSurfaces) {
  for (const float radius : {10.0f, 20.0f, 40.0f}) {
    const Surface sphere = [=](float x, float y) {
      const float3 n{(x - 48) / radius, (y - 48) / radius, 0};
      const float rest = 1 - dot(n, n);
      if (rest <= 0) return Value{};
      const float3 normal{n.x, n.y, std::sqrt(rest)};
      return Value{normal * radius, normal, 0, 0.6f + 0.3f * normal.x + 0.1f * normal.z};
    };
    VisibilityGrid grid(1, side, side, rays);
    std::vector<float2> places;
    for (const float2 p : random_places(6000))
      if (sphere(p.x, p.y).visible >= 0) places.push_back(p);
    const Asked asked = ask(grid, sphere, places);
    int unknown = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (asked.values[i] == Value::nothing)
        ++unknown;
      else
        ASSERT_NEAR(asked.values[i], sphere(places[i].x, places[i].y).visible, 0.03f) << radius;
    }
    EXPECT_LT(unknown, static_cast<int>(places.size()) / 8) << radius;
  }
}

// Stripes of every period and direction: no patch takes one of their values, as it would if they lay between the
// points.
TEST(VisibilityGrid, DoesNotLosePeriodicShadows) {
  const std::vector<float2> places = random_places(1000);
  for (const int step : {2, 4, 8})
    for (float period = 2; period <= 24; period += 0.5f)
      for (const float2 along : {float2{1, 0}, {0, 1}, {0.7071f, 0.7071f}, {0.9923f, 0.1240f}}) {
        const auto visible = [=](float x, float y) {
          const float phase = (x * along.x + y * along.y) / period;
          return phase - std::floor(phase) < 0.5f ? 0.0f : 1.0f;
        };
        VisibilityGrid grid(step, side, side, rays);
        const Asked asked = ask(grid, plane_with(visible), places);
        int wrong = 0;
        for (std::size_t i = 0; i < places.size(); ++i)
          wrong +=
              asked.values[i] != Value::nothing && std::abs(asked.values[i] - visible(places[i].x, places[i].y)) > 0.1f;
        EXPECT_LT(wrong, 20) << step << ' ' << period << ' ' << along.x;
      }
}

// Samples lie anywhere in the outer pixels of images of any size.
TEST(VisibilityGrid, ReachesTheBordersOfEverySize) {
  for (const int step : {1, 2, 3, 4, 8, 64})
    for (int width = 1; width <= 70; ++width) {
      const int height = 1 + (width * 37) % 70;
      VisibilityGrid grid(step, width, height, rays);
      std::vector<float2> places;
      for (const int x : {0, 256 * width - 1})
        for (const int y : {0, 256 * height - 1})
          places.push_back({static_cast<float>(x) / 256, static_cast<float>(y) / 256});
      const Asked asked = ask(grid, plane_with([](float, float) { return 0.5f; }), places);
      for (const float value : asked.values) ASSERT_TRUE(value == 0.5f || value == Value::nothing);
    }
}

// Whoever requests first, and whatever else is requested.
TEST(VisibilityGridBits, DoNotDependOnTheOrder) {
  const Surface surface = plane_with([](float x, float y) {
    const auto noise = unit_float(hash(std::bit_cast<std::uint32_t>(x), std::bit_cast<std::uint32_t>(y), 9));
    return std::clamp(0.4f + 0.2f * std::sin(0.1f * x) + 0.02f * noise, 0.0f, 1.0f);
  });
  std::vector<float2> places = random_places(3000);
  VisibilityGrid grid(4, side, side, rays), other(4, side, side, rays);
  const Asked asked = ask(grid, surface, places);
  std::reverse(places.begin(), places.end());
  Asked reversed = ask(other, surface, places, 7);
  std::reverse(reversed.values.begin(), reversed.values.end());
  EXPECT_EQ(asked.values, reversed.values);

  // All pixels, with those beside the image, once.
  VisibilityGrid all(1, side, side, rays);
  const std::size_t pixels = ask(all, surface, places).evaluated.size();
  EXPECT_GT(pixels, side * side * 9 / 10u);
  EXPECT_LE(pixels, (side + 4) * (side + 4));

  // A receiver at its pixel's centre needs the values of nine pixels, any other of sixteen; its own value does not
  // depend on the receivers with it.
  const auto pixels_of = [&](float2 place) {
    VisibilityGrid one(1, side, side, rays);
    return ask(one, surface, {place}).evaluated.size();
  };
  EXPECT_EQ(pixels_of({20.5f, 30.5f}), 9u);
  EXPECT_EQ(pixels_of({20.75f, 30.5f}), 16u);
  const std::vector<float2> centres = {{20.5f, 30.5f}, {23.75f, 30.5f}, {21.5f, 30.5f}};
  VisibilityGrid together(1, side, side, rays);
  const std::vector<float> values = ask(together, surface, centres).values;
  for (std::size_t i = 0; i < centres.size(); ++i) {
    VisibilityGrid one(1, side, side, rays);
    EXPECT_EQ(ask(one, surface, {centres[i]}).values[0], values[i]);
  }

  // Two pixels of a cell of 17 are evaluated, once.
  EXPECT_EQ(asked.evaluated.size(), reversed.evaluated.size());
  EXPECT_LT(asked.evaluated.size(), 2 * (side + 24) * (side + 24) / 17u);
  EXPECT_TRUE(ask(grid, surface, places).evaluated.empty());
}

}  // namespace
}  // namespace zoneplate
