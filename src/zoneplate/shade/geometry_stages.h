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

/// A channel's values at the three corners of each point.
template <class F>
[[gnu::always_inline]] inline Vector<F> corner_values(const Corners& corners, int channel, int i) {
  const int group = i / Batch::group;
  const float* block = corners.block[group];
  if (corners.one_triangle[group] != 0) {
    const float* a = block + 3 * channel;
    return {F(a[0]), F(a[1]), F(a[2])};
  }
  const float* a = block + 3 * Batch::group * channel + i % Batch::group;
  return {F::load(a), F::load(a + Batch::group), F::load(a + 2 * Batch::group)};
}

template <class F>
void interpolate(const Batch& batch, const Corners& corners, const Interpolation& what, int count) {
  for (int i = 0; i < count; i += F::lanes) {
    const auto b = Vector<F>::load(batch.b, i);
    for (int c = 0; c < what.channels; ++c) {
      const auto a = corner_values<F>(corners, c, i);
      dot(b, a).store(what.value[c] + i);
      if (what.dx[c] == nullptr) continue;
      dot(Vector<F>::load(batch.dbdx, i), a).store(what.dx[c] + i);
      dot(Vector<F>::load(batch.dbdy, i), a).store(what.dy[c] + i);
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
  if (corners.one_instance[i / Batch::group] != 0) {
    return F(first[std::ptrdiff_t{stride} * static_cast<std::ptrdiff_t>(batch.instance[i])]);
  }
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

template <class F>
void look_back(const Viewpoint& viewpoint, Points& p) {
  const auto eye = Vector<F>::all(viewpoint.eye), towards = Vector<F>::all(viewpoint.towards);
  for (int i = 0; i < p.count; i += F::lanes) {
    if (viewpoint.is_orthographic) {
      towards.store(p.to_viewer, i);
    } else {
      normalize(eye - Vector<F>::load(p.position, i)).store(p.to_viewer, i);
    }
  }
}

/// 1 for front faces, -1 for back faces.
template <class F>
[[gnu::always_inline]] inline F facing(const Batch& batch, int i) {
  using Int = typename F::Int;
  return select(Int::load(batch.is_front + i) > Int(0), F(1.0f), F(-1.0f));
}

template <class F>
void face_normals(const Batch& batch, Points& p) {
  for (int i = 0; i < p.count; i += F::lanes)
    (normalize(Vector<F>::load(p.normal, i)) * facing<F>(batch, i)).store(p.normal, i);
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

template <class F>
void default_normals(Points& p) {
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i);
    select(dot(n, n) > F(0.5f), n, Vector<F>::load(p.to_viewer, i)).store(p.normal, i);
  }
}

}  // namespace zoneplate::stages
