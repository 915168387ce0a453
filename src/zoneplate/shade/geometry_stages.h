#pragma once

#include <cstdint>

#include "zoneplate/shade/surface_kernels.h"
#include "zoneplate/shade/vector.h"

/// The stages of shade/surface_kernels.h up to the shading normal, over the lane types of shade/lanes.h.
namespace zoneplate::stages {

template <class F>
void scale(float* out, const float* in, float factor, float offset, int count) {
  for (int i = 0; i < count; i += F::lanes) (F::load(in + i) * F(factor) + F(offset)).store(out + i);
}

template <class F>
void multiply(float* values, const float* by, int count) {
  for (int i = 0; i < count; i += F::lanes) (F::load(values + i) * F::load(by + i)).store(values + i);
}

template <class F>
void fill(float* out, float value, int count) {
  for (int i = 0; i < count; i += F::lanes) F(value).store(out + i);
}

template <class F>
void saturate(float* values, int count) {
  for (int i = 0; i < count; i += F::lanes) min(max(F::load(values + i), F(0.0f)), F(1.0f)).store(values + i);
}

/// Four floats of the records of the points' corners, as the first one and the way to the two others.
template <class F>
struct CornerQuad {
  F first[4], second[4], third[4];
};

template <class F>
[[gnu::always_inline]] inline CornerQuad<F> corner_quad(const Batch& batch, const Corners& corners, int place, int i) {
  CornerQuad<F> q;
  const int group = i / Batch::group;
  if (batch.one_triangle[group]) {
    const float* const a = corners.record[0][group * Batch::group] + place;
    const float* const b = corners.record[1][group * Batch::group] + place;
    const float* const c = corners.record[2][group * Batch::group] + place;
    for (int k = 0; k < 4; ++k) q.first[k] = F(a[k]), q.second[k] = F(b[k] - a[k]), q.third[k] = F(c[k] - a[k]);
    return q;
  }
  F::load_quads(corners.record[0] + i, place, q.first);
  F::load_quads(corners.record[1] + i, place, q.second);
  F::load_quads(corners.record[2] + i, place, q.third);
  for (int k = 0; k < 4; ++k) q.second[k] = q.second[k] - q.first[k], q.third[k] = q.third[k] - q.first[k];
  return q;
}

template <class F>
void interpolate(const Batch& batch, const Corners& corners, const Interpolation& what, int count) {
  for (int n = 0; n < what.quads; ++n) {
    const Interpolation::Quad& quad = what.quad[n];
    for (int i = 0; i < count; i += F::lanes) {
      const F b1 = F::load(batch.b[0] + i), b2 = F::load(batch.b[1] + i);
      const CornerQuad<F> a = corner_quad<F>(batch, corners, quad.place, i);
      for (int c = 0; c < 4; ++c) {
        if (quad.value[c] == nullptr) continue;
        (a.first[c] + (a.second[c] * b1 + a.third[c] * b2)).store(quad.value[c] + i);
        if (quad.dx[c] == nullptr) continue;
        const auto slope = [&](const float(&db)[2][Batch::capacity]) [[gnu::always_inline]] {
          return a.second[c] * F::load(db[0] + i) + a.third[c] * F::load(db[1] + i);
        };
        slope(batch.dbdx).store(quad.dx[c] + i);
        slope(batch.dbdy).store(quad.dy[c] + i);
      }
    }
  }
}

template <class F>
void map_coordinates(const CoordinateMap& map, const Points& p, int set, Coordinates& out) {
  const F m0(map.m[0]), m1(map.m[1]), m2(map.m[2]), m3(map.m[3]), m4(map.m[4]), m5(map.m[5]);
  for (int i = 0; i < p.count; i += F::lanes) {
    const F u = F::load(p.uv[set][0] + i), v = F::load(p.uv[set][1] + i);
    (u * m0 + v * m1 + m2).store(out.uv[0] + i);
    (u * m3 + v * m4 + m5).store(out.uv[1] + i);
    const F ux = F::load(p.uv_dx[set][0] + i), vx = F::load(p.uv_dx[set][1] + i);
    (ux * m0 + vx * m1).store(out.dx[0] + i);
    (ux * m3 + vx * m4).store(out.dx[1] + i);
    const F uy = F::load(p.uv_dy[set][0] + i), vy = F::load(p.uv_dy[set][1] + i);
    (uy * m0 + vy * m1).store(out.dy[0] + i);
    (uy * m3 + vy * m4).store(out.dy[1] + i);
  }
}

/// One number of each point's placement: `first` is that of placement 0.
template <class F>
[[gnu::always_inline]] inline F placed(const Batch& batch, const Corners& corners, const float* first, int i) {
  using Int = typename F::Int;
  constexpr std::int32_t stride = sizeof(Placement) / sizeof(float);
  const int group = i / Batch::group;
  if (corners.one_instance[group])
    return F(first[std::ptrdiff_t{stride} * static_cast<std::ptrdiff_t>(batch.instance[group * Batch::group])]);
  const auto* instance = reinterpret_cast<const std::int32_t*>(batch.instance);
  return F::gather(first, Int::load(instance + i) * Int(stride));
}

/// x column 0 + y column 1 + z column 2 of the 3 × 3 matrices that begin at `first`.
template <class F>
[[gnu::always_inline]] inline Vector<F> turned(const Batch& batch, const Corners& corners, const float* first,
                                               Vector<F> v, int i) {
  const auto element = [&](int e) { return placed<F>(batch, corners, first + e, i); };
  const Vector<F> x{element(0), element(1), element(2)};
  const Vector<F> y{element(3), element(4), element(5)};
  const Vector<F> z{element(6), element(7), element(8)};
  return x * v.x + y * v.y + z * v.z;
}

template <class F>
void place_positions(const Batch& batch, const Corners& corners, const Placement* placements, Points& p) {
  const float* world = placements->world_from_object;
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto element = [&](int e) { return placed<F>(batch, corners, world + e, i); };
    const Vector<F> origin{element(9), element(10), element(11)};
    (turned(batch, corners, world, Vector<F>::load(p.position, i), i) + origin).store(p.position, i);
  }
}

template <class F>
void place_normals(const Batch& batch, const Corners& corners, const Placement* placements, Points& p) {
  for (int i = 0; i < p.count; i += F::lanes)
    turned(batch, corners, placements->normal, Vector<F>::load(p.normal, i), i).store(p.normal, i);
}

template <class F>
void place_tangents(const Batch& batch, const Corners& corners, const Placement* placements, Points& p) {
  for (int i = 0; i < p.count; i += F::lanes) {
    turned(batch, corners, placements->world_from_object, Vector<F>::load(p.tangent, i), i).store(p.tangent, i);
    const F handedness = placed<F>(batch, corners, &placements->handedness, i);
    (F::load(p.tangent[3] + i) * handedness).store(p.tangent[3] + i);
  }
}

/// 1 for front faces, -1 for back faces.
template <class F>
[[gnu::always_inline]] inline F facing(const Batch& batch, int i) {
  using Int = typename F::Int;
  const int group = i / Batch::group;
  if (batch.one_triangle[group]) return F(batch.is_front[group * Batch::group] > 0 ? 1.0f : -1.0f);
  return select(Int::load(batch.is_front + i) > Int(0), F(1.0f), F(-1.0f));
}

template <class F>
void find_normals(const Batch& batch, const Corners& corners, const Placement* placements, Points& p) {
  for (int i = 0; i < p.count; i += F::lanes) {
    const int group = i / Batch::group;
    Vector<F> n = Vector<F>::load(p.normal, i);
    const bool keeps =
        corners.one_instance[group] && placements[batch.instance[group * Batch::group]].keeps_normals != 0;
    if (!keeps) n = turned(batch, corners, placements->normal, n, i);
    // Adding +0 leaves no trace of which way was taken.
    (normalize(n + Vector<F>{F(0.0f), F(0.0f), F(0.0f)}) * facing<F>(batch, i)).store(p.normal, i);
  }
}

template <class F>
void bend_normals(const Batch& batch, const float* const texel[4], float scale, Points& p) {
  const F two(2.0f), one(1.0f);
  for (int i = 0; i < p.count; i += F::lanes) {
    const Vector<F> n = normalize(Vector<F>::load(p.normal, i));
    const Vector<F> t = normalize(Vector<F>::load(p.tangent, i));
    const F sign = select(F::load(p.tangent[3] + i) < F(0.0f), F(-1.0f), one);
    const Vector<F> b = cross(n, t) * sign;
    const F x = (F::load(texel[0] + i) * two - one) * F(scale);
    const F y = (F::load(texel[1] + i) * two - one) * F(scale);
    const F z = F::load(texel[2] + i) * two - one;
    const Vector<F> bent = normalize(t * x + b * y + n * z);
    const auto is_bent = dot(t, t) * dot(bent, bent) > F(0.5f);
    (select(is_bent, bent, n) * facing<F>(batch, i)).store(p.normal, i);
  }
}

/// The direction to the viewer.
template <class F>
[[gnu::always_inline]] inline Vector<F> towards_viewer(const Viewpoint& v, const Batch& batch, const Points& p, int i) {
  using Int = typename F::Int;
  if (v.is_orthographic) return Vector<F>::all(v.towards);
  if (!v.has_rays) return normalize(Vector<F>::all(v.eye) - Vector<F>::load(p.position, i));
  const F x = F::from(Int::load(batch.x + i)), y = F::from(Int::load(batch.y + i));
  return normalize(Vector<F>::all(v.ray) + Vector<F>::all(v.ray_dx) * x + Vector<F>::all(v.ray_dy) * y);
}

template <class F>
void default_normals(const Viewpoint& viewpoint, const Batch& batch, Points& p) {
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i);
    select(dot(n, n) > F(0.5f), n, towards_viewer<F>(viewpoint, batch, p, i)).store(p.normal, i);
  }
}

}  // namespace zoneplate::stages
