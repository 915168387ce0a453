// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/receivers.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "zoneplate/math/random.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {
namespace {

/// A fragment's triangle in world space. Its normals are on the viewer's side.
struct ReceivingTriangle {
  float3 position[3], normal[3];
  float3 face;
  float margin = 0;
  bool is_smooth = false;  ///< the normals differ
};

float greatest(float3 p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

/// Rounding of positions and of the intersection is some ulp (2^-24) of the greatest coordinate.
constexpr float margin_of_coordinates = 0x1p-18f;

ReceivingTriangle triangle_of(const float4x4& world, const float4x4& normals, const float* const (&record)[3],
                              const ReceiversViewer& viewer) {
  ReceivingTriangle t;
  float largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const float* const r = record[k];
    t.position[k] = transform_point(world, {r[3], r[4], r[5]});
    t.normal[k] = normalize(transform_vector(normals, {r[0], r[1], r[2]}));
    largest = std::max(largest, greatest(t.position[k]));
  }
  t.margin = largest * margin_of_coordinates;
  t.is_smooth = t.normal[0] != t.normal[1] || t.normal[1] != t.normal[2];

  // Lines have no face of their own.
  const float3 sum = t.normal[0] + t.normal[1] + t.normal[2];
  t.face = normalize(cross(t.position[1] - t.position[0], t.position[2] - t.position[0]), normalize(sum, {0, 0, 1}));
  if (dot(t.face, viewer.is_orthographic ? viewer.towards : viewer.position - t.position[0]) < 0) t.face = -t.face;
  if (dot(sum, t.face) < 0)
    for (float3& n : t.normal) n = -n;
  return t;
}

/// The point with weights b1 and b2, moved out of the triangle where the surface is smooth.
float3 position_on(const ReceivingTriangle& t, float b1, float b2) {
  const auto mix = [&](const float3(&v)[3]) { return v[0] + ((v[1] - v[0]) * b1 + (v[2] - v[0]) * b2); };
  const float3 p = mix(t.position);
  if (!t.is_smooth) return p;
  float3 moved[3];
  for (std::size_t k = 0; k < 3; ++k) moved[k] = t.normal[k] * -std::min(0.0f, dot(p - t.position[k], t.normal[k]));
  return p + mix(moved);
}

void store(float3 from, float (&to)[3][Receivers::capacity], std::size_t i) {
  to[0][i] = from.x, to[1][i] = from.y, to[2][i] = from.z;
}

/// The point of the triangle with these weights.
void store(const ReceivingTriangle& t, float b1, float b2, Receivers& out, std::size_t i) {
  store(position_on(t, b1, b2), out.position, i);
  store(t.face, out.face, i);
  store(normalize(t.normal[0] + ((t.normal[1] - t.normal[0]) * b1 + (t.normal[2] - t.normal[0]) * b2), t.face),
        out.normal, i);
  out.margin[i] = t.margin;
}

}  // namespace

void store_footprint(const FragmentBatch& batch, std::size_t i, float3 edge1, float3 edge2, Receivers& out) {
  const float x[3] = {-(batch.dbdx[0][i] + batch.dbdx[1][i]), batch.dbdx[0][i], batch.dbdx[1][i]};
  const float y[3] = {-(batch.dbdy[0][i] + batch.dbdy[1][i]), batch.dbdy[0][i], batch.dbdy[1][i]};
  const float b[3] = {1 - batch.b[0][i] - batch.b[1][i], batch.b[0][i], batch.b[1][i]};
  // No weight falls below 0 within half a pixel.
  float half = 0.5f;
  for (int k = 0; k < 3; ++k) {
    const float change = std::abs(x[k]) + std::abs(y[k]);
    if (half * change > b[k]) half = std::max(b[k], 0.0f) / change;
  }
  const float3 along = (edge1 * x[1] + edge2 * x[2]) * half, down = (edge1 * y[1] + edge2 * y[2]) * half;
  store(is_finite(along) ? along : float3{}, out.dx, i);
  store(is_finite(down) ? down : float3{}, out.dy, i);
}

void store_image_position(std::int32_t x, std::int32_t y, Receivers& out, std::size_t i) {
  out.x[i] = x, out.y[i] = y;
  out.seed[i] = hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
}

void make_receiver(const Scene& scene, const RayHit& hit, const float* const (&corner)[3],
                   const ReceiversViewer& viewer, PixelPosition pixel, Receivers& out, std::size_t i) {
  const float4x4& world = scene.instances[hit.instance].world_from_object;
  store(triangle_of(world, normal_matrix(world), corner, viewer), hit.b1, hit.b2, out, i);
  store({}, out.dx, i), store({}, out.dy, i);
  store_image_position(256 * pixel.x + 128, 256 * pixel.y + 128, out, i);
  out.surface[i] = hit.instance;
}

void make_receivers(const Scene& scene, const FragmentBatch& batch, const ReceiverRecord& record,
                    const ReceiversViewer& viewer, bool has_footprint, Receivers& out) {
  out.count = batch.count;
  out.coverage = batch.coverage;
  if (!has_footprint) std::memset(out.dx, 0, sizeof out.dx), std::memset(out.dy, 0, sizeof out.dy);
  ReceivingTriangle triangle;
  float4x4 normals;
  std::size_t known_leader = 0;
  std::uint32_t known_instance = ~0u;
  for (std::size_t i = 0; i < static_cast<std::size_t>(out.count); ++i) {
    const std::size_t leader = batch.leader(i);
    if (i == 0 || leader != known_leader) {
      const float* const corner[3] = {record(0, leader), record(1, leader), record(2, leader)};
      const float4x4& world = scene.instances[batch.instance[leader]].world_from_object;
      if (batch.instance[leader] != known_instance) normals = normal_matrix(world);
      triangle = triangle_of(world, normals, corner, viewer);
      known_leader = leader, known_instance = batch.instance[leader];
    }
    store(triangle, batch.b[0][i], batch.b[1][i], out, i);
    if (has_footprint)
      store_footprint(batch, i, triangle.position[1] - triangle.position[0],
                      triangle.position[2] - triangle.position[0], out);
    store_image_position(batch.x[i], batch.y[i], out, i);
    out.surface[i] = known_instance;
  }
}

}  // namespace zoneplate
