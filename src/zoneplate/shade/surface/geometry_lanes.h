// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "zoneplate/math/lanes_vector.h"
#include "zoneplate/shade/surface/shading.h"

/// The stages of shade/surface/shading.h up to the shading normal, over the lane types of math/lanes.h.
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

/// Fills the derivatives that interpolation leaves out: they are those of the fragment before.
inline void fill_repeated(const FragmentBatch& batch, int count, float* derivative) {
  for (int i = FragmentBatch::group; i < count; i += FragmentBatch::group)
    if (batch.has_uniform_derivatives[i / FragmentBatch::group])
      std::fill_n(derivative + i, FragmentBatch::group, derivative[i - 1]);
}

/// Calls step<Lanes>(i) for the vectors of the fragments [first, end), of whole groups, with vectors of two groups
/// where they begin at every second one. The last vector may reach into the group after `end`, whose values are to be
/// stored afterwards: runs are interpolated in their order.
template <class F, class Wide, class Step>
[[gnu::always_inline]] inline void for_vectors(int first, int end, Step step) {
  int i = first;
  if constexpr (Wide::lanes > FragmentBatch::group) {
    static_assert(F::lanes == FragmentBatch::group);
    if (i % Wide::lanes != 0 || end - i <= FragmentBatch::group) step.template operator()<F>(i), i += F::lanes;
  }
  for (; i < end; i += Wide::lanes) step.template operator()<Wide>(i);
}

/// One float of the vertices, for several fragments: its value at the first vertex, and the differences of the second
/// and third from it.
template <class F>
struct Linear {
  F first, second, third;

  [[gnu::always_inline]] F at(const FragmentBatch& batch, int i) const { return first + along(batch.b, i); }
  /// Its change, from the change of the weights.
  [[gnu::always_inline]] F along(const float (&change)[2][FragmentBatch::padded_capacity], int i) const {
    return second * F::load(change[0] + i) + third * F::load(change[1] + i);
  }
};

/// The same for one triangle.
struct UniformLinear {
  float first, second, third;

  template <class F>
  [[gnu::always_inline]] Linear<F> lanes() const {
    return {F(first), F(second), F(third)};
  }
};

/// Interpolates float c of a quad at a vector of fragments.
template <class F>
[[gnu::always_inline]] inline void store_float(const FragmentBatch& batch, const Linear<F>& a,
                                               const Interpolation::Quad& quad, int c, int i, ShadingState& p) {
  a.at(batch, i).store(quad.value[c].of(p) + i);
  if (quad.dx[c].is_none()) return;
  a.along(batch.dbdx, i).store(quad.dx[c].of(p) + i);
  a.along(batch.dbdy, i).store(quad.dy[c].of(p) + i);
}

/// Interpolates float c of a quad at fragments [i, end) of one triangle.
template <class F, class Wide>
[[gnu::always_inline]] inline void store_floats(const FragmentBatch& batch, const UniformLinear& a,
                                                const Interpolation::Quad& quad, int c, int i, int end,
                                                ShadingState& p) {
  float* const value = quad.value[c].of(p);
  if (quad.dx[c].is_none()) {
    for_vectors<F, Wide>(i, end, [&]<class V>(int k) { a.lanes<V>().at(batch, k).store(value + k); });
    return;
  }
  float *const dx = quad.dx[c].of(p), *const dy = quad.dy[c].of(p);
  for_vectors<F, Wide>(i, end, [&]<class V>(int k) {
    const Linear<V> line = a.lanes<V>();
    line.at(batch, k).store(value + k);
    line.along(batch.dbdx, k).store(dx + k);
    line.along(batch.dbdy, k).store(dy + k);
  });
}

/// The same for fragments that all have the derivatives of fragment i; only the group of fragment i stores them.
template <class F, class Wide>
[[gnu::always_inline]] inline void store_affine_floats(const FragmentBatch& batch, const UniformLinear& a,
                                                       const Interpolation::Quad& quad, int c, int i, int end,
                                                       ShadingState& p) {
  store_floats<F, F>(batch, a, quad, c, i, i + FragmentBatch::group, p);
  float* const value = quad.value[c].of(p);
  for_vectors<F, Wide>(i + FragmentBatch::group, end,
                       [&]<class V>(int k) { a.lanes<V>().at(batch, k).store(value + k); });
}

/// True if the triangle of a run has the same normal at all vertices.
inline bool is_flat(const TriangleVertices& vertices, std::size_t leader) {
  const float *const v0 = vertices.record[0][leader], *const v1 = vertices.record[1][leader];
  const float* const v2 = vertices.record[2][leader];
  bool is_same = true;
  for (int c = 0; c < 3; ++c) is_same = is_same && v1[c] == v0[c] && v2[c] == v0[c];
  return is_same;
}

/// Interpolates a quad at fragments [i, end), all of one triangle.
template <class F, class Wide>
[[gnu::always_inline]] inline void interpolate_run(const FragmentBatch& batch, const TriangleVertices& vertices,
                                                   const Interpolation::Quad& quad, int i, int end, ShadingState& p) {
  const std::size_t leader = batch.leader(static_cast<std::size_t>(i));
  const float* const v0 = vertices.record[0][leader] + quad.offset;
  const float* const v1 = vertices.record[1][leader] + quad.offset;
  const float* const v2 = vertices.record[2][leader] + quad.offset;
  const bool has_uniform_derivatives =
      i + FragmentBatch::group < end && batch.has_uniform_derivatives[i / FragmentBatch::group + 1];
  int c = 0;
  if (quad.has_sparse_normals && is_flat(vertices, leader)) {
    for (; c < 3; ++c) {
      float* const value = quad.value[c].of(p);
      for (int k = i; k < i + FragmentBatch::group; k += F::lanes) F(v0[c] + 0.0f).store(value + k);
    }
  }
  for (; c < 4; ++c) {
    if (quad.value[c].is_none()) continue;
    const float second = v1[c] - v0[c], third = v2[c] - v0[c];
    if (second == 0 && third == 0 && quad.dx[c].is_none()) {
      float* const value = quad.value[c].of(p);
      for_vectors<F, Wide>(i, end, [&]<class V>(int k) { V(v0[c] + 0.0f).store(value + k); });
      continue;
    }
    const UniformLinear line{v0[c], second, third};
    if (has_uniform_derivatives && !quad.dx[c].is_none()) {
      store_affine_floats<F, Wide>(batch, line, quad, c, i, end, p);
    } else {
      store_floats<F, Wide>(batch, line, quad, c, i, end, p);
    }
  }
}

/// Interpolates all quads of a vector of fragments of any triangles.
template <class F, class Records>
[[gnu::always_inline]] inline void interpolate_fragments(const FragmentBatch& batch, const Records& records,
                                                         const Interpolation& interpolation, int i, ShadingState& p) {
  for (int n = 0; n < interpolation.quads; ++n) {
    const Interpolation::Quad& quad = interpolation.quad[n];
    F v[3][4];
    for (int k = 0; k < 3; ++k) F::load_quads([&](int lane) { return records(k, i + lane) + quad.offset; }, v[k]);
    for (int c = 0; c < 4; ++c)
      if (!quad.value[c].is_none())
        store_float(batch, Linear<F>{v[0][c], v[1][c] - v[0][c], v[2][c] - v[0][c]}, quad, c, i, p);
  }
}

template <class F, class Wide, class Records>
[[gnu::always_inline]] inline void interpolate_all(const FragmentBatch& batch, const TriangleVertices& vertices,
                                                   const Records& records, const Interpolation& interpolation,
                                                   ShadingState& p) {
  for (int i = 0; i < p.count;) {
    if (batch.is_flat_run[i / FragmentBatch::group]) {
      const int end = batch.run_end[i / FragmentBatch::group] * FragmentBatch::group;
      for (int n = 0; n < interpolation.quads; ++n)
        interpolate_run<F, Wide>(batch, vertices, interpolation.quad[n], i, end, p);
      i = end;
    } else {
      interpolate_fragments<F>(batch, records, interpolation, i, p);
      i += F::lanes;
    }
  }
}

template <class F, class Wide>
void interpolate(const FragmentBatch& batch, const TriangleVertices& vertices, const Interpolation& interpolation,
                 ShadingState& p) {
  if (vertices.first != nullptr)
    return interpolate_all<F, Wide>(batch, vertices, RecordsByVertex{batch, vertices.first, vertices.stride},
                                    interpolation, p);
  interpolate_all<F, Wide>(batch, vertices, RecordsByFragment{vertices}, interpolation, p);
}

template <class F>
void map_coordinates(const CoordinateMap& map, const FragmentBatch& batch, const ShadingState& p, int set,
                     Coordinates& out) {
  const F m0(map.m[0]), m1(map.m[1]), m2(map.m[2]), m3(map.m[3]), m4(map.m[4]), m5(map.m[5]);
  for (int i = 0; i < p.count; i += F::lanes) {
    const F u = F::load(p.uv[set][0] + i), v = F::load(p.uv[set][1] + i);
    (u * m0 + v * m1 + m2).store(out.uv[0] + i);
    (u * m3 + v * m4 + m5).store(out.uv[1] + i);
    if (batch.has_uniform_derivatives[i / FragmentBatch::group]) continue;
    const F ux = F::load(p.uv_dx[set][0] + i), vx = F::load(p.uv_dx[set][1] + i);
    (ux * m0 + vx * m1).store(out.dx[0] + i);
    (ux * m3 + vx * m4).store(out.dx[1] + i);
    const F uy = F::load(p.uv_dy[set][0] + i), vy = F::load(p.uv_dy[set][1] + i);
    (uy * m0 + vy * m1).store(out.dy[0] + i);
    (uy * m3 + vy * m4).store(out.dy[1] + i);
  }
}

/// One element of the transform of each fragment's instance; `first` is that element of transform 0.
template <class F>
[[gnu::always_inline]] inline F transform_element(const FragmentBatch& batch, const TriangleVertices& vertices,
                                                  const float* first, int i) {
  using Int = typename F::Int;
  constexpr std::int32_t stride = sizeof(InstanceTransform) / sizeof(float);
  const int group = i / FragmentBatch::group;
  if (vertices.one_instance[group])
    return F(first[std::ptrdiff_t{stride} * static_cast<std::ptrdiff_t>(batch.instance[batch.leader(
                                                static_cast<std::size_t>(group) * FragmentBatch::group)])]);
  const auto* instance = reinterpret_cast<const std::int32_t*>(batch.instance);
  return F::gather(first, Int::load(instance + i) * Int(stride));
}

/// x column 0 + y column 1 + z column 2 of the 3 × 3 matrices that begin at `first`.
template <class F>
[[gnu::always_inline]] inline Vector<F> transformed(const FragmentBatch& batch, const TriangleVertices& vertices,
                                                    const float* first, Vector<F> v, int i) {
  const auto element = [&](int e) { return transform_element<F>(batch, vertices, first + e, i); };
  const Vector<F> x{element(0), element(1), element(2)};
  const Vector<F> y{element(3), element(4), element(5)};
  const Vector<F> z{element(6), element(7), element(8)};
  return x * v.x + y * v.y + z * v.z;
}

template <class F>
void transform_positions(const FragmentBatch& batch, const TriangleVertices& vertices,
                         const InstanceTransform* transforms, ShadingState& p) {
  const float* world = transforms->world_from_object;
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto element = [&](int e) { return transform_element<F>(batch, vertices, world + e, i); };
    const Vector<F> origin{element(9), element(10), element(11)};
    (transformed(batch, vertices, world, Vector<F>::load(p.position, i), i) + origin).store(p.position, i);
  }
}

template <class F>
void transform_normals(const FragmentBatch& batch, const TriangleVertices& vertices,
                       const InstanceTransform* transforms, ShadingState& p) {
  for (int i = 0; i < p.count; i += F::lanes)
    transformed(batch, vertices, transforms->normal, Vector<F>::load(p.normal, i), i).store(p.normal, i);
}

template <class F>
void transform_tangents(const FragmentBatch& batch, const TriangleVertices& vertices,
                        const InstanceTransform* transforms, ShadingState& p) {
  for (int i = 0; i < p.count; i += F::lanes) {
    transformed(batch, vertices, transforms->world_from_object, Vector<F>::load(p.tangent, i), i).store(p.tangent, i);
    const F handedness = transform_element<F>(batch, vertices, &transforms->handedness, i);
    (F::load(p.tangent[3] + i) * handedness).store(p.tangent[3] + i);
  }
}

/// 1 for front faces, -1 for back faces.
template <class F>
[[gnu::always_inline]] inline F facing(const FragmentBatch& batch, int i) {
  using Int = typename F::Int;
  const int group = i / FragmentBatch::group;
  if (batch.is_flat_run[group]) return F(batch.is_front[batch.leader(static_cast<std::size_t>(i))] > 0 ? 1.0f : -1.0f);
  return select(Int::load(batch.is_front + i) > Int(0), F(1.0f), F(-1.0f));
}

template <class F>
void compute_normals(const FragmentBatch& batch, const TriangleVertices& vertices, const InstanceTransform* transforms,
                     ShadingState& p) {
  for (int i = 0; i < p.count;) {
    const int group = i / FragmentBatch::group;
    Vector<F> n = Vector<F>::load(p.normal, i);
    const bool keeps = vertices.one_instance[group] &&
                       transforms[batch.instance[batch.leader(static_cast<std::size_t>(group) * FragmentBatch::group)]]
                               .keeps_normals != 0;
    if (!keeps) n = transformed(batch, vertices, transforms->normal, n, i);
    // Adding +0 gives the same bits on both ways: -0 becomes +0.
    const Vector<F> normal = normalize(n + Vector<F>{F(0.0f), F(0.0f), F(0.0f)}) * facing<F>(batch, i);
    normal.store(p.normal, i);
    i += F::lanes;
    if (batch.is_flat_run[group] && batch.run_begin[group] == group &&
        is_flat(vertices, static_cast<std::size_t>(group) * FragmentBatch::group))
      for (const int end = batch.run_end[group] * FragmentBatch::group; i < end; i += F::lanes)
        normal.store(p.normal, i);
  }
}

template <class F>
void bend_normals(const FragmentBatch& batch, const float* const texel[4], float scale, ShadingState& p) {
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

/// The viewer as seen from fragments. Values that all fragments share are read once, before the loop.
template <class F>
struct Viewer {
  bool is_orthographic, has_rays;
  Vector<F> towards, eye, ray, ray_dx, ray_dy;

  [[gnu::always_inline]] explicit Viewer(const Viewpoint& v)
      : is_orthographic(v.is_orthographic),
        has_rays(v.has_rays),
        towards(Vector<F>::all(v.towards)),
        eye(Vector<F>::all(v.eye)),
        ray(Vector<F>::all(v.ray)),
        ray_dx(Vector<F>::all(v.ray_dx)),
        ray_dy(Vector<F>::all(v.ray_dy)) {}

  /// The vector to the viewer, of any length.
  [[gnu::always_inline]] Vector<F> way(const FragmentBatch& batch, const ShadingState& p, int i) const {
    using Int = typename F::Int;
    if (is_orthographic) return towards;
    if (!has_rays) return eye - Vector<F>::load(p.position, i);
    const F x = F::from(Int::load(batch.x + i)), y = F::from(Int::load(batch.y + i));
    return ray + ray_dx * x + ray_dy * y;
  }
  /// The direction to the viewer.
  [[gnu::always_inline]] Vector<F> direction(const FragmentBatch& batch, const ShadingState& p, int i) const {
    return is_orthographic ? towards : normalize(way(batch, p, i));
  }
};

template <class F>
void default_normals(const Viewpoint& viewpoint, const FragmentBatch& batch, ShadingState& p) {
  const Viewer<F> viewer(viewpoint);
  for (int i = 0; i < p.count; i += F::lanes) {
    const auto n = Vector<F>::load(p.normal, i);
    select(dot(n, n) > F(0.5f), n, viewer.direction(batch, p, i)).store(p.normal, i);
  }
}

}  // namespace zoneplate::stages
