// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/edge_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/base/parallel.h"
#include "zoneplate/image/half.h"
#include "zoneplate/raster/fragment/interpolate.h"
#include "zoneplate/raster/geometry/triangle_facing.h"

namespace zoneplate {
namespace {

float to_half(float value) { return half_value(half_bits(value)); }

}  // namespace

EdgeDistances::EdgeDistances(const Scene& scene, std::span<const Draw> draws, Viewport viewport,
                             const FragmentShader& surfaces)
    : scene_(scene), draws_(draws), viewport_(viewport), surfaces_(surfaces) {
  std::uint32_t first = 0;
  for (const Draw& draw : draws) {
    first_triangle_.push_back(first);
    first += static_cast<std::uint32_t>(draw.triangles());
  }
}

EdgeDistances::Edges EdgeDistances::edges_of(std::uint32_t triangle) const {
  const auto after = std::upper_bound(first_triangle_.begin(), first_triangle_.end(), triangle);
  const auto number = static_cast<std::size_t>(after - first_triangle_.begin()) - 1;
  const Draw& draw = draws_[number];
  const std::size_t first = 3 * static_cast<std::size_t>(triangle - first_triangle_[number]);
  float4 clip[3];
  ScreenVertex screen[3];
  for (std::size_t k = 0; k < 3; ++k) {
    clip[k] = draw.clip_position(draw.index[first + k]);
    screen[k] = project(clip[k], viewport_);
  }
  Edges out;
  if (std::ranges::any_of(screen, &ScreenVertex::needs_clipping)) {
    // Plane k is 0 on the edge opposite to vertex k.
    const BarycentricPlanes planes = barycentric_planes(clip[0], clip[1], clip[2], viewport_);
    for (const std::size_t k : {0u, 1u, 2u}) out.line[(k + 1) % 3] = {planes.x[k], planes.y[k], planes.one[k]};
    return out;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const ScreenVertex &from = screen[k], &to = screen[(k + 1) % 3];
    const double dx = to.x - from.x, dy = to.y - from.y;
    out.line[k] = {-dy, dx, dy * from.x - dx * from.y};
  }
  return out;
}

EdgeDistances::Distance EdgeDistances::nearest(const Edges& edges, double x, double y) {
  Distance out{std::numeric_limits<float>::infinity(), false};
  for (const Line& line : edges.line) {
    if (line.a == 0 && line.b == 0) continue;
    const bool is_along_row = std::abs(line.a) > std::abs(line.b);
    const double value = (line.a * x + line.b * y) + line.c;
    const auto distance = static_cast<float>(-value / (is_along_row ? line.a : line.b) / 256);
    if (std::abs(distance) < std::abs(out.value)) out = {distance, is_along_row};
  }
  return out;
}

void EdgeDistances::shade(const FragmentBatch& batch, OutputMask, FragmentOutputs& out) const {
  Edges edges;
  std::uint32_t known = 0;
  for (int i = 0; i < batch.count; ++i) {
    const std::size_t leader = batch.leader(static_cast<std::size_t>(i));
    if (i == 0 || batch.triangle[leader] != known) edges = edges_of(batch.triangle[leader]);
    known = batch.triangle[leader];
    const Distance d = nearest(edges, batch.x[i] - 128.0 * viewport_.width, batch.y[i] - 128.0 * viewport_.height);
    out.r[i] = d.is_along_row ? d.value : Frame::no_edge;
    out.g[i] = d.is_along_row ? Frame::no_edge : d.value;
    out.b[i] = 0, out.a[i] = 1;
  }
  if (is_masked(batch.material)) take_alpha_edges(batch, out);
}

/// The differences of alpha at the fragment and one pixel to the right and below are its derivatives; the axis with the
/// greater one is used.
void EdgeDistances::take_alpha_edges(const FragmentBatch& batch, FragmentOutputs& out) const {
  float here[FragmentBatch::padded_capacity], right[FragmentBatch::padded_capacity],
      below[FragmentBatch::padded_capacity];
  const float cutoff = surfaces_.alpha(batch, here);
  const auto alpha_beside = [&](const float(&step)[2][FragmentBatch::padded_capacity],
                                float(&alpha)[FragmentBatch::padded_capacity]) {
    FragmentBatch beside = batch;
    for (std::size_t k = 0; k < 2; ++k)
      for (int i = 0; i < batch.padded(); ++i) beside.b[k][i] = batch.b[k][i] + step[k][i];
    surfaces_.alpha(beside, alpha);
  };
  alpha_beside(batch.dbdx, right);
  alpha_beside(batch.dbdy, below);
  for (int i = 0; i < batch.count; ++i) {
    const float dx = right[i] - here[i], dy = below[i] - here[i];
    const bool is_along_row = std::abs(dx) > std::abs(dy);
    const float derivative = is_along_row ? dx : dy, distance = (cutoff - here[i]) / derivative;
    const float edge = out.r[i] == Frame::no_edge ? out.g[i] : out.r[i];
    if (derivative == 0 || !(std::abs(distance) < std::abs(edge))) continue;
    out.r[i] = is_along_row ? distance : Frame::no_edge;
    out.g[i] = is_along_row ? Frame::no_edge : distance;
  }
}

Plane<float2> edge_distances_of(const LinearImage& picture) {
  Plane<float2> out(picture.width(), picture.height());
  parallel_for(static_cast<std::size_t>(picture.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < picture.width(); ++x) {
      const Linear& p = picture(x, y);
      out(x, y) = p.a > 0 ? float2{to_half(p.r), to_half(p.g)} : float2{Frame::no_edge, Frame::no_edge};
    }
  });
  return out;
}

}  // namespace zoneplate
