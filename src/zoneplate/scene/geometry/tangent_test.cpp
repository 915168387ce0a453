// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/geometry/tangent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace zoneplate {
namespace {

using Index = std::vector<std::uint32_t>;

void expect_near(float4 a, float4 b, float tolerance = 1e-6f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
  EXPECT_EQ(a.w, b.w);
}

/// A mesh in the plane z = 0 that faces +Z.
Mesh flat_mesh(const std::vector<float2>& position, const std::vector<float2>& uv, const Index& index) {
  Mesh m;
  for (const float2 p : position) m.position.push_back({p.x, p.y, 0});
  m.normal.assign(position.size(), {0, 0, 1});
  m.uv0 = uv;
  m.index = index;
  return m;
}

/// A unit square of two triangles: corners (0,0) (1,0) (1,1) (0,1).
Mesh square(const std::vector<float2>& uv) {
  return flat_mesh({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, uv, {0, 1, 2, 0, 2, 3});
}

/// An upright image on the square: u to the right, v downwards. Its top is +Y = cross(normal, tangent).
TEST(Tangents, UprightImageHasAPositiveSign) {
  Mesh m = square({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  make_tangents(m, 0);
  EXPECT_EQ(m.position.size(), 4u);
  for (const float4 t : m.tangent) expect_near(t, {1, 0, 0, 1});
}

TEST(Tangents, MirroredAndTurnedImages) {
  Mesh mirrored = square({{1, 1}, {0, 1}, {0, 0}, {1, 0}});
  make_tangents(mirrored, 0);
  for (const float4 t : mirrored.tangent) expect_near(t, {-1, 0, 0, -1});

  Mesh turned = square({{0, 0}, {0, 1}, {1, 1}, {1, 0}});  // the image's right is +Y, its top -X
  make_tangents(turned, 0);
  for (const float4 t : turned.tangent) expect_near(t, {0, 1, 0, 1});
}

TEST(Tangents, TheUvSetIsTheOneAskedFor) {
  Mesh m = square({{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  m.uv1 = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  make_tangents(m, 1);
  for (const float4 t : m.tangent) expect_near(t, {0, 1, 0, 1});
}

/// Two adjacent squares with mirrored uv and shared vertices at the seam.
TEST(Tangents, AMirroredSeamSplitsItsVertices) {
  Mesh m = flat_mesh({{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}}, {{0, 1}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {0, 0}},
                     {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4});
  m.color.assign(6, {1, 2, 3, 4});
  make_tangents(m, 0);
  ASSERT_EQ(m.position.size(), 8u);
  ASSERT_EQ(m.color.size(), 8u);
  for (std::size_t k = 0; k < 6; ++k) expect_near(m.tangent[m.index[k]], {1, 0, 0, 1});
  for (std::size_t k = 6; k < 12; ++k) expect_near(m.tangent[m.index[k]], {-1, 0, 0, -1});
  EXPECT_EQ(m.position[m.index[6]], (float3{1, 0, 0}));
  EXPECT_EQ(m.position[m.index[11]], (float3{1, 1, 0}));
  EXPECT_EQ(m.uv0[m.index[11]], (float2{1, 0}));
}

/// Three triangles around the origin with angles of 90, 60 and 30 degrees, each with its own direction of u.
TEST(Tangents, TheMeanIsWeightedByTheAngle) {
  const auto on_circle = [](double deg) {
    return float2{static_cast<float>(std::cos(deg * std::numbers::pi / 180)),
                  static_cast<float>(std::sin(deg * std::numbers::pi / 180))};
  };
  // Irregular uv, which adjacent triangles share and which give each triangle its own direction of u.
  const std::vector<float2> position{{0, 0}, on_circle(0), on_circle(90), on_circle(150), on_circle(180)};
  const std::vector<float2> uv{{0, 0}, {1, 0}, {0.2f, -1}, {-1, -0.5f}, {-1, 0.3f}};
  Mesh m = flat_mesh(position, uv, {0, 1, 2, 0, 2, 3, 0, 3, 4});
  make_tangents(m, 0);
  ASSERT_EQ(m.position.size(), 5u);

  // The direction d along which uv changes by (1, 0): solves [p1 p2] a = d, [t1 t2] a = (1, 0) in doubles.
  double x = 0, y = 0;
  const double angle[] = {90, 60, 30};
  for (std::size_t f = 0; f < 3; ++f) {
    const float2 p1 = position[f + 1], p2 = position[f + 2], t1 = uv[f + 1], t2 = uv[f + 2];
    const double det = double{t1.x} * t2.y - double{t1.y} * t2.x, a = t2.y / det, b = -t1.y / det;
    const double dx = a * p1.x + b * p2.x, dy = a * p1.y + b * p2.y, n = std::hypot(dx, dy);
    x += angle[f] * dx / n, y += angle[f] * dy / n;
  }
  const double n = std::hypot(x, y);
  expect_near(m.tangent[0], {static_cast<float>(x / n), static_cast<float>(y / n), 0, 1}, 1e-5f);
}

/// A bent sheet of 3 × 3 vertices and 8 triangles with irregular uv. If mirrored, u reverses at the middle column, and
/// the last triangle has no area in uv.
Mesh bent_sheet(bool is_mirrored) {
  Mesh m;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      const auto quarters = [](int i) { return 0.25f * static_cast<float>(i % 4); };
      const auto sixteenths = [](int i) { return 0.0625f * static_cast<float>(i % 3); };
      m.position.push_back({static_cast<float>(x), static_cast<float>(y), quarters(7 * x + 5 * y)});
      m.normal.push_back(normalize(float3{quarters(3 * x + y) - 0.5f, quarters(x + 2 * y) - 0.25f, 1}));
      const float u = is_mirrored ? static_cast<float>(x == 1) : 0.5f * static_cast<float>(x);
      m.uv0.push_back({u + sixteenths(2 * x + y), 0.5f * static_cast<float>(y) + sixteenths(x + 2 * y)});
    }
  m.index = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 3, 4, 7, 3, 7, 6, 4, 5, 8, 4, 8, 7};
  if (is_mirrored) m.uv0[8] = m.uv0[7];
  return m;
}

/// Output of mikktspace.c (github.com/mmikk/MikkTSpace, revision 3e895b4) for the corners of both sheets, at its
/// default angular threshold. Its sign is for v upwards, the opposite of ours.
constexpr float4 plain_sheet_tangents[24] = {
    {0.893744946f, 0.00661737658f, 0.44852671f, 1},  {0.955684185f, -0.172001272f, -0.238921165f, 1},
    {0.911598861f, 0.135118946f, 0.38823998f, 1},    {0.893744946f, 0.00661737658f, 0.44852671f, 1},
    {0.911598861f, 0.135118946f, 0.38823998f, 1},    {0.955907345f, 0.231099769f, 0.18120192f, 1},
    {0.955684185f, -0.172001272f, -0.238921165f, 1}, {0.997607589f, -0.0670660585f, 0.0167665258f, 1},
    {0.971599758f, 0.0780540332f, -0.223386616f, 1}, {0.955684185f, -0.172001272f, -0.238921165f, 1},
    {0.971599758f, 0.0780540332f, -0.223386616f, 1}, {0.911598861f, 0.135118946f, 0.38823998f, 1},
    {0.955907345f, 0.231099769f, 0.18120192f, 1},    {0.911598861f, 0.135118946f, 0.38823998f, 1},
    {0.96317029f, 0.119673729f, 0.240792632f, 1},    {0.955907345f, 0.231099769f, 0.18120192f, 1},
    {0.96317029f, 0.119673729f, 0.240792632f, 1},    {0.979067445f, -0.197458997f, -0.0493647344f, 1},
    {0.911598861f, 0.135118946f, 0.38823998f, 1},    {0.971599758f, 0.0780540332f, -0.223386616f, 1},
    {0.898863614f, 0.063051112f, 0.433668941f, 1},   {0.911598861f, 0.135118946f, 0.38823998f, 1},
    {0.898863614f, 0.063051112f, 0.433668941f, 1},   {0.96317029f, 0.119673729f, 0.240792632f, 1}};
constexpr float4 mirrored_sheet_tangents[24] = {{0.893744946f, 0.00661737658f, 0.44852671f, 1},
                                                {0.953540921f, -0.184206784f, -0.238385364f, 1},
                                                {0.907016575f, 0.28253758f, 0.312239438f, 1},
                                                {0.893744946f, 0.00661737658f, 0.44852671f, 1},
                                                {0.907016575f, 0.28253758f, 0.312239438f, 1},
                                                {0.955907345f, 0.231099769f, 0.18120192f, 1},
                                                {-0.958173692f, 0.156595603f, 0.239543468f, -1},
                                                {-0.997607589f, 0.0670660585f, -0.0167665258f, -1},
                                                {-0.97102809f, -0.0964079127f, 0.218655184f, -1},
                                                {-0.958173692f, 0.156595603f, 0.239543468f, -1},
                                                {-0.97102809f, -0.0964079127f, 0.218655184f, -1},
                                                {-0.8440395f, 0.171916947f, -0.507978261f, -1},
                                                {0.955907345f, 0.231099769f, 0.18120192f, 1},
                                                {0.907016575f, 0.28253758f, 0.312239438f, 1},
                                                {0.970003605f, 0.0169203617f, 0.242500931f, 1},
                                                {0.955907345f, 0.231099769f, 0.18120192f, 1},
                                                {0.970003605f, 0.0169203617f, 0.242500931f, 1},
                                                {0.979067445f, -0.197458997f, -0.0493647344f, 1},
                                                {-0.8440395f, 0.171916947f, -0.507978261f, -1},
                                                {-0.97102809f, -0.0964079127f, 0.218655184f, -1},
                                                {-0.872920573f, 0.132386029f, -0.469556779f, -1},
                                                {0.907016575f, 0.28253758f, 0.312239438f, 1},
                                                {1, 0, 0, -1},
                                                {0.970003605f, 0.0169203617f, 0.242500931f, 1}};

TEST(Tangents, AreThoseOfTheReferenceImplementation) {
  for (const bool is_mirrored : {false, true}) {
    Mesh m = bent_sheet(is_mirrored);
    make_tangents(m, 0);
    for (std::size_t k = 0; k < m.index.size(); ++k) {
      // The reference has no tangent for this corner of the triangle without area: its default is (1, 0, 0).
      if (is_mirrored && k == 22) continue;
      const float4 reference = is_mirrored ? mirrored_sheet_tangents[k] : plain_sheet_tangents[k];
      SCOPED_TRACE(k);
      expect_near(m.tangent[m.index[k]], {reference.x, reference.y, reference.z, -reference.w}, 0x1p-22f);
    }
  }
}

TEST(Tangents, EqualVerticesCountAsOne) {
  Mesh shared =
      flat_mesh({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1}, {1, 1}, {1, 0.5f}, {0.25f, 0}}, {0, 1, 2, 0, 2, 3});
  Mesh split = flat_mesh({{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}},
                         {{0, 1}, {1, 1}, {1, 0.5f}, {-0.0f, 1}, {1, 0.5f}, {0.25f, 0}}, {0, 1, 2, 3, 4, 5});
  make_tangents(shared, 0);
  make_tangents(split, 0);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(split.tangent[split.index[k]], shared.tangent[shared.index[k]]);
}

TEST(Tangents, AnotherNormalIsAnotherVertex) {
  Mesh m = square({{0, 1}, {1, 1}, {1, 0.5f}, {0.25f, 0}});
  Mesh hard;
  for (const std::uint32_t i : m.index) hard.position.push_back(m.position[i]), hard.uv0.push_back(m.uv0[i]);
  hard.normal = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0.6f, 0.8f}, {0, 0.6f, 0.8f}, {0, 0.6f, 0.8f}};
  hard.index = {0, 1, 2, 3, 4, 5};
  make_tangents(hard, 0);
  for (std::size_t i = 0; i < 3; ++i) expect_near(hard.tangent[i], hard.tangent[0]);  // one triangle has one tangent
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(dot(xyz(hard.tangent[i]), hard.normal[i]), 0, 1e-6f);
}

TEST(Tangents, DegenerateTrianglesTakeTheirVerticesTangent) {
  Mesh m = square({{0, 0}, {0, 1}, {1, 1}, {1, 0}});
  m.index.insert(m.index.begin(), {0, 1, 1});  // no area
  make_tangents(m, 0);
  EXPECT_EQ(m.position.size(), 4u);
  for (const float4 t : m.tangent) expect_near(t, {0, 1, 0, 1});
}

TEST(Tangents, TrianglesWithoutAreaInUvJoinTheirNeighbours) {
  // The corners of the second triangle have collinear uv: u along the shared edge, no area.
  Mesh m = flat_mesh({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{0, 1}, {1, 1}, {1, 0}, {0.5f, 0.5f}}, {0, 1, 2, 0, 2, 3});
  make_tangents(m, 0);
  EXPECT_EQ(m.position.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) expect_near(m.tangent[i], {1, 0, 0, 1});
}

TEST(Tangents, WithoutAnyUvAreaAnyDirectionAcrossTheNormal) {
  for (const float3 normal : {float3{0, 0, 1}, float3{1, 0, 0}, float3{0, -1, 0}}) {
    Mesh m = square(std::vector<float2>(4, {0.5f, 0.5f}));
    m.normal.assign(4, normal);
    make_tangents(m, 0);
    for (const float4 t : m.tangent) {
      EXPECT_NEAR(length(xyz(t)), 1, 1e-6f);
      EXPECT_NEAR(dot(xyz(t), normal), 0, 1e-6f);
    }
  }
}

/// A bumpy grid with randomly distorted uv, some cells mirrored.
Mesh bumpy(int n) {
  Mesh m;
  const auto noise = [](int i, int j, int d) {
    return static_cast<float>((i * 7919 + j * 104729 + d * 1299709) % 1000) / 1000.0f - 0.5f;
  };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      m.position.push_back({static_cast<float>(i), static_cast<float>(j), noise(i, j, 1)});
      m.normal.push_back(normalize(float3{noise(i, j, 2), noise(i, j, 3), 1}));
      const int fold = i < n / 2 ? i : n - i;
      m.uv0.push_back(
          {static_cast<float>(fold) + 0.6f * noise(i, j, 4), static_cast<float>(j) + 0.6f * noise(i, j, 5)});
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (const std::uint32_t v : {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)})
        m.index.push_back(v);
  return m;
}

/// A reference implementation: for each corner, all corners reached over shared edges with the same orientation.
std::vector<float4> brute_force(const Mesh& m) {
  const std::size_t corners = m.index.size();
  const auto face_uv = [&](std::size_t f) {
    const float2 a = m.uv0[m.index[3 * f]], t1 = m.uv0[m.index[3 * f + 1]] - a, t2 = m.uv0[m.index[3 * f + 2]] - a;
    return std::array<double, 4>{t1.x, t1.y, t2.x, t2.y};
  };
  const auto is_positive = [&](std::size_t f) {
    const auto t = face_uv(f);
    return t[0] * t[3] - t[1] * t[2] > 0;
  };
  std::vector<float4> out(corners);
  for (std::size_t k = 0; k < corners; ++k) {
    const std::uint32_t v = m.index[k];
    std::vector<std::size_t> reached{k};
    for (std::size_t r = 0; r < reached.size(); ++r)
      for (std::size_t c = 0; c < corners; ++c) {
        if (m.index[c] != v || is_positive(c / 3) != is_positive(k / 3)) continue;
        if (std::find(reached.begin(), reached.end(), c) != reached.end()) continue;
        const auto others = [&](std::size_t x) {
          const std::size_t f = x / 3 * 3;
          return std::array{m.index[f + (x + 1 - f) % 3], m.index[f + (x + 2 - f) % 3]};
        };
        const auto a = others(reached[r]), b = others(c);
        if (a[0] == b[1] || a[1] == b[0]) reached.push_back(c);
      }
    double sum[3] = {0, 0, 0};
    for (const std::size_t c : reached) {
      const std::size_t f = c / 3;
      const float3 p = m.position[m.index[3 * f]], d1 = m.position[m.index[3 * f + 1]] - p,
                   d2 = m.position[m.index[3 * f + 2]] - p, n = m.normal[v], here = m.position[v];
      const auto t = face_uv(f);
      const double det = t[0] * t[3] - t[1] * t[2];
      const auto flat = [&](double x, double y, double z) {
        const double h = x * n.x + y * n.y + z * n.z;
        x -= h * n.x, y -= h * n.y, z -= h * n.z;
        const double l = std::sqrt(x * x + y * y + z * z);
        return std::array{x / l, y / l, z / l};
      };
      const auto u =
          flat((d1.x * t[3] - d2.x * t[1]) / det, (d1.y * t[3] - d2.y * t[1]) / det, (d1.z * t[3] - d2.z * t[1]) / det);
      const float3 q = m.position[m.index[3 * f + (c + 1) % 3]] - here,
                   r = m.position[m.index[3 * f + (c + 2) % 3]] - here;
      const auto e = flat(q.x, q.y, q.z), g = flat(r.x, r.y, r.z);
      const double angle = std::acos(e[0] * g[0] + e[1] * g[1] + e[2] * g[2]);
      for (std::size_t i = 0; i < 3; ++i) sum[i] += angle * u[i];
    }
    const double l = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    out[k] = {static_cast<float>(sum[0] / l), static_cast<float>(sum[1] / l), static_cast<float>(sum[2] / l),
              is_positive(k / 3) ? -1.0f : 1.0f};
  }
  return out;
}

TEST(Tangents, AgreeWithTheDefinition) {
  Mesh m = bumpy(8);
  const std::vector<float4> expected = brute_force(m);
  make_tangents(m, 0);
  ASSERT_GT(m.position.size(), 81u);  // the fold splits vertices
  for (std::size_t k = 0; k < m.index.size(); ++k) expect_near(m.tangent[m.index[k]], expected[k], 2e-5f);
}

/// The order of the triangles must not affect the tangents beyond rounding, except where the definition depends on it.
TEST(Tangents, DoNotDependOnTheOrderOfTriangles) {
  Mesh a = bumpy(8), b = a;
  const std::size_t faces = a.index.size() / 3;
  for (std::size_t f = 0; f < faces; ++f)
    for (std::size_t c = 0; c < 3; ++c) b.index[3 * f + c] = a.index[3 * ((f * 37 + 5) % faces) + (c + f) % 3];
  make_tangents(a, 0);
  make_tangents(b, 0);
  for (std::size_t f = 0; f < faces; ++f)
    for (std::size_t c = 0; c < 3; ++c)
      expect_near(b.tangent[b.index[3 * f + c]], a.tangent[a.index[3 * ((f * 37 + 5) % faces) + (c + f) % 3]], 2e-5f);
}

TEST(Tangents, KeepEveryTriangle) {
  const Mesh before = bumpy(8);
  Mesh after = before;
  make_tangents(after, 0);
  ASSERT_EQ(after.index.size(), before.index.size());
  ASSERT_EQ(after.tangent.size(), after.position.size());
  for (std::size_t k = 0; k < after.index.size(); ++k) {
    EXPECT_EQ(after.position[after.index[k]], before.position[before.index[k]]);
    EXPECT_EQ(after.normal[after.index[k]], before.normal[before.index[k]]);
    EXPECT_EQ(after.uv0[after.index[k]], before.uv0[before.index[k]]);
    const float4 t = after.tangent[after.index[k]];
    EXPECT_NEAR(length(xyz(t)), 1, 1e-6f);
    EXPECT_NEAR(dot(xyz(t), after.normal[after.index[k]]), 0, 1e-6f);
  }
}

/// Many triangles at one edge or vertex take linear time (quadratic time would not end for this number).
TEST(Tangents, CrowdedEdgesAndVerticesAreQuick) {
  constexpr std::uint32_t n = 100000;
  Mesh m;
  m.position = {{0, 0, 0}, {1, 0, 0}};
  m.uv0 = {{0, 1}, {1, 1}};
  for (std::uint32_t i = 0; i < n; ++i) {
    m.position.push_back({static_cast<float>(i), 1, 0});
    m.uv0.push_back({static_cast<float>(i % 1000), 0});
    for (const std::uint32_t v : {std::uint32_t{0}, std::uint32_t{1}, i + 2}) m.index.push_back(v);
  }
  m.normal.assign(m.position.size(), {0, 0, 1});
  make_tangents(m, 0);
  EXPECT_EQ(m.tangent.size(), m.position.size());
  EXPECT_EQ(m.index.size(), 3 * n);
}

}  // namespace
}  // namespace zoneplate
