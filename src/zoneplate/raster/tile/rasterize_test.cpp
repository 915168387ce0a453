// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/raster/tile/rasterize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/random.h"
#include "zoneplate/math/transform.h"

namespace zoneplate {
namespace {

/// Colours points by their instance; alpha from a table. Keeps what interpolation gave it, for the tests of it.
class Flat : public FragmentShader {
 public:
  explicit Flat(std::vector<Linear> colors) : colors_(std::move(colors)) {}
  void shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const override {
    for (int i = 0; i < batch.count; ++i) {
      const Linear& c = colors_[batch.instance[batch.leader(static_cast<std::size_t>(i))]];
      out.r[i] = c.r * c.a, out.g[i] = c.g * c.a, out.b[i] = c.b * c.a, out.a[i] = c.a;
      if (outputs.uv) out.uv[0][i] = batch.b[0][i], out.uv[1][i] = batch.b[1][i];
      for (int k = 0; k < 2; ++k) {
        if (outputs.normal) out.normal[k][i] = batch.dbdx[k][i], out.normal[2][i] = 0;
        if (outputs.albedo) out.albedo[k][i] = batch.dbdy[k][i], out.albedo[2][i] = 0;
      }
    }
  }
  float alpha(const FragmentBatch& batch, float* out) const override {
    for (int i = 0; i < batch.count; ++i) out[i] = colors_[batch.instance[batch.leader(static_cast<std::size_t>(i))]].a;
    return 0.5f;
  }

 private:
  std::vector<Linear> colors_;
};

constexpr std::array<std::uint32_t, 3> triangle_index = {0, 1, 2};

/// Triangles in normalized device coordinates, one draw each.
std::vector<Draw> draws_of(const std::vector<std::array<float4, 3>>& triangles, std::span<const std::size_t> order,
                           AlphaMode alpha_mode) {
  std::vector<Draw> out;
  for (const std::size_t t : order) {
    Draw d;
    d.clip = triangles[t];
    d.index = triangle_index;
    d.alpha_mode = alpha_mode;
    d.instance = static_cast<std::uint32_t>(t);
    out.push_back(d);
  }
  return out;
}

LinearImage picture(std::span<const Draw> draws, const FragmentShader& shader, const SamplePattern& samples,
                    const RasterRules& rules = {}, int size = 96, bool is_per_sample = false) {
  LinearImage out(size, size, Linear{0, 0, 0, 0});
  Target target;
  target.viewport = {size, size};
  target.width = target.height = size;
  target.samples = samples;
  target.is_per_sample = is_per_sample;
  target.color = &out;
  rasterize(draws, shader, rules, target);
  return out;
}

const std::vector<Linear> four_colors = {{1, 0, 0, 0.5f}, {0, 1, 0, 0.7f}, {0, 0, 1, 0.3f}, {1, 1, 0, 0.9f}};

std::vector<std::array<float4, 3>> four_triangles() {
  // They cut through each other and share no depth where they overlap.
  return {{{{-0.9f, -0.8f, 0.2f, 1}, {0.9f, -0.7f, 0.31f, 1}, {0.1f, 0.9f, 0.72f, 1}}},
          {{{-0.8f, 0.8f, 0.3f, 1}, {-0.1f, -0.9f, 0.6f, 1}, {0.9f, 0.75f, 0.23f, 1}}},
          {{{-0.95f, 0.1f, 0.71f, 1}, {0.7f, -0.95f, 0.15f, 1}, {0.8f, 0.85f, 0.4f, 1}}},
          {{{-0.5f, -0.95f, 0.45f, 1}, {0.95f, 0.2f, 0.55f, 1}, {-0.6f, 0.95f, 0.35f, 1}}}};
}

/// Red is 1, green the coverage.
class ByCoverage : public Flat {
 public:
  ByCoverage() : Flat({}) {}
  void shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const override {
    for (int i = 0; i < batch.count; ++i) out.r[i] = out.a[i] = 1, out.g[i] = batch.coverage[i], out.b[i] = 0;
  }
  bool needs_coverage() const override { return true; }
};

TEST(Rasterize, CoverageIsThePartOfThePixelThatAFragmentColours) {
  // A triangle that covers blocks of the image, and small ones of two materials, no two of which share a pixel.
  std::vector<std::array<float4, 3>> apart = {
      {{{-0.97f, -0.9f, 0.2f, 1}, {0.9f, -0.95f, 0.3f, 1}, {-0.1f, 0.2f, 0.4f, 1}}}};
  for (int i = 0; i < 40; ++i) {
    const float x = -0.95f + 0.047f * static_cast<float>(i), y = 0.3f + 0.013f * static_cast<float>(i);
    apart.push_back({{{x, y, 0.3f, 1}, {x + 0.025f, y + 0.005f, 0.3f, 1}, {x + 0.01f, y + 0.03f, 0.3f, 1}}});
  }
  std::vector<std::size_t> order(apart.size());
  std::iota(order.begin(), order.end(), 0);
  for (const AlphaMode alpha_mode : {AlphaMode::Opaque, AlphaMode::Blend})
    for (const bool is_per_sample : {false, true})
      for (const int samples : {1, 4, 8, 16}) {
        std::vector<Draw> draws = draws_of(apart, order, alpha_mode);
        for (std::size_t k = 0; k < draws.size(); ++k) draws[k].material = static_cast<int>(k % 2);
        const LinearImage found = picture(draws, ByCoverage(), standard_pattern(samples), {}, 96, is_per_sample);
        int parts = 0;
        for (const Linear& c : found.values()) {
          const float of_fragment = is_per_sample ? 1 / static_cast<float>(samples) : c.r;
          ASSERT_NEAR(c.g, c.r * of_fragment, 1e-6f) << samples << ' ' << is_per_sample;
          parts += c.r > 0 && c.r < 1 ? 1 : 0;
        }
        EXPECT_GT(parts, samples == 1 ? -1 : 200);
      }
}

TEST(Rasterize, OrderOfDrawingDoesNotMatter) {
  const auto triangles = four_triangles();
  const Flat shader(four_colors);
  for (const AlphaMode alpha_mode : {AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend})
    for (const SamplePattern& pattern : {standard_pattern(1), standard_pattern(4), grid_pattern(4)}) {
      std::vector<std::size_t> order = {0, 1, 2, 3};
      const LinearImage first = picture(draws_of(triangles, order, alpha_mode), shader, pattern);
      while (std::next_permutation(order.begin(), order.end()))
        ASSERT_EQ(picture(draws_of(triangles, order, alpha_mode), shader, pattern), first);
    }
}

TEST(Rasterize, LayersOfFullSquaresBlendByHand) {
  // Three full layers from far to near over an opaque one, given in a wrong order.
  const std::vector<Linear> colors = {{1, 1, 1, 1}, {1, 0, 0, 0.5f}, {0, 1, 0, 0.25f}, {0, 0, 1, 0.75f}};
  const float depth[] = {0.1f, 0.2f, 0.3f, 0.4f};
  std::vector<std::array<float4, 3>> triangles;
  for (const float z : depth) triangles.push_back({{{-4, -4, z, 1}, {4, -4, z, 1}, {0, 8, z, 1}}});
  for (const std::array<std::size_t, 4>& order : {std::array<std::size_t, 4>{3, 1, 0, 2}, {0, 1, 2, 3}, {2, 3, 1, 0}}) {
    std::vector<Draw> draws = draws_of(triangles, order, AlphaMode::Blend);
    for (Draw& d : draws)
      if (d.instance == 0) d.alpha_mode = AlphaMode::Opaque;
    const LinearImage image = picture(draws, Flat(colors), standard_pattern(4));
    // ((1·½ + ½·(1,0,0))·¾ + ¼·(0,1,0))·¼ + ¾·(0,0,1), every step exact in binary.
    for (const Linear& c : image.values()) ASSERT_EQ(c, (Linear{0.1875f, 0.15625f, 0.84375f, 1}));
  }
}

TEST(Rasterize, NoBlackEdgeWhereTwoSurfacesMeet) {
  // Two triangles share an edge; with them the whole image is covered, so alpha is 1 everywhere.
  const std::array<float4, 4> corner = {
      {{-3, -2, 0.5f, 1}, {2.7f, -3, 0.4f, 1}, {3, 2.2f, 0.6f, 1}, {-2.4f, 3, 0.3f, 1}}};
  const std::array<std::uint32_t, 3> lower = {0, 1, 2}, upper = {0, 2, 3};
  std::vector<Draw> draws(2);
  draws[0].clip = draws[1].clip = corner;
  draws[0].index = lower, draws[1].index = upper;
  draws[1].instance = 1;
  const Flat shader({{0.8f, 0.2f, 0.4f, 1}, {0.3f, 0.9f, 0.1f, 1}});
  const LinearImage image = picture(draws, shader, grid_pattern(4));
  bool has_mixed = false;
  for (const Linear& c : image.values()) {
    ASSERT_EQ(c.a, 1);
    ASSERT_TRUE(c.r >= 0.3f - 1e-6f && c.r <= 0.8f + 1e-6f && c.g >= 0.2f - 1e-6f && c.g <= 0.9f + 1e-6f);
    has_mixed = has_mixed || (c.r > 0.31f && c.r < 0.79f);
  }
  EXPECT_TRUE(has_mixed);
}

/// A crowd of triangles in perspective, some across the eye, in draws of all three surfaces.
struct Crowd {
  std::vector<float3> position;
  std::vector<std::uint32_t> index;
  std::vector<Draw> draws;
  std::vector<Linear> colors;
  explicit Crowd(std::uint32_t seed) {
    for (std::uint32_t i = 0; i < 600; ++i)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto at = [&](std::uint32_t axis, float spread) {
          return (unit_float(hash(seed, i, axis)) - 0.5f) * spread;
        };
        const auto by = [&](std::uint32_t axis) {
          return (unit_float(hash(seed, i, 3 + axis, k)) - 0.5f) * (i % 7 ? 0.6f : 9.0f);
        };
        position.push_back({at(0, 4) + by(0), at(1, 4) + by(1), at(2, 6) - 2 + by(2)});
        index.push_back(3 * i + k);
      }
    const float4x4 projection = perspective(1.0f, 1.0f, 0.1f, 50.0f);
    for (std::uint32_t d = 0; d < 6; ++d) {
      Draw draw;
      draw.position = position;
      draw.clip_from_object = projection;
      draw.index = std::span<const std::uint32_t>(index).subspan(d * 300, 300);
      draw.alpha_mode = static_cast<AlphaMode>(d % 3);
      draw.culls_back_faces = d % 2;
      draw.instance = d;
      draw.material = static_cast<int>(d);
      draws.push_back(draw);
      colors.push_back({unit_float(hash(d, 1)), unit_float(hash(d, 2)), unit_float(hash(d, 3)),
                        d % 3 == 0 ? 1 : 0.4f + 0.1f * static_cast<float>(d)});
    }
  }
};

TEST(Rasterize, ThreadsAndInstructionSetsLeaveNoTrace) {
  const Crowd crowd(1);
  const Flat shader(crowd.colors);
  for (const bool is_per_sample : {false, true})
    for (const SamplePattern& pattern : {standard_pattern(1), named_pattern("halton", 24)}) {
      LinearImage expected;
      with_isa(Isa::Scalar, [&] {
        with_threads(1, [&] { expected = picture(crowd.draws, shader, pattern, {}, 130, is_per_sample); });
      });
      for (const Isa isa : supported_isas())
        for (const int threads : {1, 2, 3, 7})
          with_isa(isa, [&] {
            with_threads(threads, [&] {
              EXPECT_EQ(picture(crowd.draws, shader, pattern, {}, 130, is_per_sample), expected)
                  << name_of(isa) << ", " << threads << " threads";
            });
          });
    }
}

TEST(Rasterize, CropHasTheWholePicturesBits) {
  const Crowd crowd(2);
  const Flat shader(crowd.colors);
  const LinearImage whole = picture(crowd.draws, shader, standard_pattern(4), {}, 200);
  for (const std::array<int, 4>& c : {std::array<int, 4>{13, 70, 101, 67}, {63, 64, 2, 1}, {199, 199, 1, 1}}) {
    LinearImage part(c[2], c[3]);
    Target target;
    target.viewport = {200, 200};
    target.x = c[0], target.y = c[1], target.width = c[2], target.height = c[3];
    target.samples = standard_pattern(4);
    target.color = &part;
    rasterize(crowd.draws, shader, {}, target);
    for (int y = 0; y < c[3]; ++y)
      for (int x = 0; x < c[2]; ++x) ASSERT_EQ(part(x, y), whole(c[0] + x, c[1] + y)) << x << "," << y;
  }
}

TEST(Rasterize, PresentedSpansHaveTheBitsOfStoredColours) {
  const Crowd crowd(3);
  const Flat shader(crowd.colors);
  const DisplayTransform transform({.exposure = 0.9f, .background = {0.1f, 0.3f, 0.2f, 1}});
  // All draws, and the opaque ones alone, so that some tiles have no transparent surface. The weights of three samples
  // add up to no power of two.
  for (const std::size_t draws : {std::size_t{6}, std::size_t{1}})
    for (const int samples : {1, 3, 4})
      for (const std::array<int, 4>& c : {std::array<int, 4>{0, 0, 200, 200}, {13, 70, 101, 67}}) {
        const auto draw = [&](LinearImage* color) {
          Rgba8Image shown(c[2], c[3]);
          Target target;
          target.viewport = {200, 200};
          target.x = c[0], target.y = c[1], target.width = c[2], target.height = c[3];
          target.samples = samples == 3 ? grid_pattern(2) : standard_pattern(samples);
          target.samples.resize(static_cast<std::size_t>(samples));
          target.display8 = &shown, target.display_transform = &transform;
          target.color = color;
          rasterize(std::span(crowd.draws).first(draws), shader, {}, target);
          return shown;
        };
        LinearImage color(c[2], c[3]);
        EXPECT_EQ(draw(nullptr), draw(&color)) << draws << " draws, " << samples << " samples";
      }
}

TEST(Rasterize, ClosedSurfaceHasAsManyFrontAsBackFacesAtEverySample) {
  // A displaced octahedral sphere; layers of alpha 1/2 count the faces: n of them leave 2^-n of what is behind.
  std::vector<float3> position;
  std::vector<std::uint32_t> index;
  const int rings = 12, sectors = 17;
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i < sectors; ++i) {
      const double a = 3.14159265358979 * j / rings, b = 6.28318530717959 * i / sectors;
      const double r = j == 0 || j == rings ? 1.0 : 1 + 0.2 * std::sin(5 * b) * std::sin(3 * a);
      const bool pole = j == 0 || j == rings;
      position.push_back({static_cast<float>(pole ? 0 : r * std::sin(a) * std::cos(b)),
                          static_cast<float>(pole ? (j ? -r : r) : r * std::cos(a)),
                          static_cast<float>((pole ? 0 : r * std::sin(a) * std::sin(b)) - 3.2)});
    }
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < sectors; ++i) {
      const auto at = [&](int jj, int ii) {
        return static_cast<std::uint32_t>(jj == 0 ? 0 : jj == rings ? rings * sectors : jj * sectors + ii % sectors);
      };
      const std::uint32_t q[4] = {at(j, i), at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)};
      for (const std::uint32_t v : {q[0], q[1], q[2], q[0], q[2], q[3]}) index.push_back(v);
    }
  const auto layers = [&](bool mirrored) {
    Draw d;
    d.position = position;
    d.index = index;
    d.clip_from_object = perspective(0.9f, 1, 0.1f, 10);
    d.alpha_mode = AlphaMode::Blend;
    d.culls_back_faces = true;
    d.is_mirrored = mirrored;
    return picture(std::span(&d, 1), Flat({{1, 1, 1, 0.5f}}), standard_pattern(8), {}, 160, true);
  };
  const LinearImage front = layers(false), back = layers(true);
  EXPECT_EQ(front, back);
  EXPECT_GT(std::count_if(front.values().begin(), front.values().end(), [](const Linear& c) { return c.a > 0; }), 5000);
}

TEST(Rasterize, PiecesOfAClippedTriangleCountOnce) {
  // A plane through the eye's plane, seen nearly edge on: the pieces that clipping leaves meet along whole rows.
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const auto number = [&](std::uint32_t k) { return 2 * unit_float(hash(i, k, 77)) - 1; };
    std::array<float4, 3> t;
    for (std::uint32_t k = 0; k < 3; ++k)
      t[k] = {number(3 * k) * 40, number(3 * k + 1) * (i % 2 ? 1.0f : 0.05f), 0.05f, number(3 * k + 2) * 2};
    Draw d;
    d.clip = t;
    d.index = triangle_index;
    d.alpha_mode = AlphaMode::Blend;
    const LinearImage once = picture(std::span(&d, 1), Flat({{1, 1, 1, 0.5f}}), standard_pattern(1));
    for (const Linear& c : once.values()) ASSERT_TRUE(c.a == 0 || c.a == 0.5f) << c.a << " of triangle " << i;
  }
}

TEST(Rasterize, AttributesAndTheirSlopesAreThoseOfTheTiltedPlane) {
  // A plane y = -1 seen by a camera at the origin, cut by the eye's plane in one case, in front of it in the other.
  for (const bool crosses_the_eye : {false, true}) {
    const float near_z = crosses_the_eye ? 5.0f : -1.3f;
    const std::array<float3, 3> position = {{{-9, -1, near_z}, {11, -1, near_z}, {0.5f, -1, -40}}};
    Draw d;
    d.position = position;
    d.index = triangle_index;
    d.clip_from_object = perspective(1.2f, 1, 0.1f, 100);
    const int size = 128;
    LinearImage color(size, size, Linear{0, 0, 0, 0});
    Plane<float3> dbdx(size, size), dbdy(size, size);
    Plane<float2> b(size, size);
    Plane<float> coverage(size, size);
    Target target;
    target.viewport = {size, size};
    target.width = target.height = size;
    target.samples = standard_pattern(1);
    target.color = &color, target.uv = &b, target.normal = &dbdx, target.albedo = &dbdy, target.coverage = &coverage;
    rasterize(std::span(&d, 1), Flat({{1, 1, 1, 1}}), {}, target);

    // The ray through a point of the screen meets the plane where its y is -1; barycentrics are affine there.
    const double tangent = std::tan(0.6);
    const auto weights = [&](double px, double py) {
      const double dx = (px / size * 2 - 1) * tangent, dy = (1 - py / size * 2) * tangent;
      const double t = -1 / dy, x = t * dx, z = -t;
      const double b2 = (z - near_z) / (-40.0 - near_z);
      const double b1 = (x - 0.5 * b2 + 9.0 * (1 - b2)) / 20.0;
      return std::array<double, 3>{1 - b1 - b2, b1, b2};
    };
    int checked = 0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        if (coverage(x, y) == 0) continue;
        const auto w = weights(x + 0.5, y + 0.5);
        if (std::min({w[0], w[1], w[2]}) < 0.02) continue;  // the snap of the corners moves the edges
        const double h = 1e-4;
        const auto left = weights(x + 0.5 - h, y + 0.5), right = weights(x + 0.5 + h, y + 0.5);
        const auto above = weights(x + 0.5, y + 0.5 - h), below = weights(x + 0.5, y + 0.5 + h);
        ASSERT_NEAR(b(x, y).x, w[1], 3e-3);
        ASSERT_NEAR(b(x, y).y, w[2], 3e-3);
        const float* gx = &dbdx(x, y).x;
        const float* gy = &dbdy(x, y).x;
        for (std::size_t k = 0; k < 2; ++k) {
          const double dx = (right[k + 1] - left[k + 1]) / (2 * h), dy = (below[k + 1] - above[k + 1]) / (2 * h);
          ASSERT_NEAR(gx[k], dx, 0.02 * std::abs(dx) + 2e-4);
          ASSERT_NEAR(gy[k], dy, 0.02 * std::abs(dy) + 2e-4);
        }
        ++checked;
      }
    EXPECT_GT(checked, 1500);
  }
}

TEST(Rasterize, PainterFailsOnACircleOfTrianglesThatTheZBufferGetsRight) {
  // Three bars, each over the next: no order of whole triangles is right.
  std::vector<std::array<float4, 3>> triangles;
  for (int k = 0; k < 3; ++k) {
    const double a = 2.0943951 * k;
    const auto turn = [&](double x, double y, float z) {
      return float4{static_cast<float>(x * std::cos(a) - y * std::sin(a)),
                    static_cast<float>(x * std::sin(a) + y * std::cos(a)), z, 1};
    };
    triangles.push_back({turn(-0.8, -0.45, 0.2f), turn(0.9, -0.45, 0.8f), turn(0.9, -0.15, 0.8f)});
  }
  const std::vector<std::size_t> order = {0, 1, 2};
  const Flat shader({{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}});
  const auto draws = draws_of(triangles, order, AlphaMode::Opaque);
  const LinearImage right = picture(draws, shader, standard_pattern(1), {}, 240);
  const LinearImage painted = picture(draws, shader, standard_pattern(1), {.visibility = Visibility::Painter}, 240);
  EXPECT_NE(right, painted);
  // Turning the image by 120 degrees changes the colours' names only, so all three show the same area by Z-buffer.
  std::array<int, 3> by_z{}, by_painter{};
  for (std::size_t i = 0; i < right.values().size(); ++i) {
    const Linear &z = right.values()[i], &p = painted.values()[i];
    by_z[0] += z.r > 0, by_z[1] += z.g > 0, by_z[2] += z.b > 0;
    by_painter[0] += p.r > 0, by_painter[1] += p.g > 0, by_painter[2] += p.b > 0;
  }
  EXPECT_NEAR(by_z[0], by_z[1], 30);
  EXPECT_NEAR(by_z[1], by_z[2], 30);
  EXPECT_GT(
      *std::max_element(by_painter.begin(), by_painter.end()) - *std::min_element(by_painter.begin(), by_painter.end()),
      100);
}

}  // namespace
}  // namespace zoneplate
