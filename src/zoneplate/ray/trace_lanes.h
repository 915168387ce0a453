// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "zoneplate/ray/trace.h"

/// The queries of ray/trace.h over the lane types of math/lanes.h: `F` for the children of a node, `G` for the
/// triangles of a leaf.
namespace zoneplate::stages {

/// A ray with what its tests derive from it once.
template <class F, class G>
struct PreparedRay {
  // Boxes. The inverse of a zero component is infinite; a coordinate within a slab of that direction then gives
  // -inf and inf, one on its boundary NaN, which min and max drop.
  F origin[3], inverse[3];
  int near[3];  ///< 1 where the ray meets the high bound first

  // Triangles: the axes are permuted so that the direction is longest along z, and z is sheared onto the direction.
  int axis[3];
  G from[3];  ///< the origin along `axis`
  G shear[3];

  [[gnu::always_inline]] explicit PreparedRay(const Ray& ray) {
    for (int a = 0; a < 3; ++a) {
      origin[a] = F(ray.origin[a]);
      const float inverted = 1 / ray.direction[a];
      inverse[a] = F(inverted);
      near[a] = inverted < 0;
    }
    const auto size = [&](int a) { return ray.direction[a] < 0 ? -ray.direction[a] : ray.direction[a]; };
    int z = size(1) > size(0) ? 1 : 0;
    if (size(2) > size(z)) z = 2;
    axis[0] = (z + 1) % 3, axis[1] = (z + 2) % 3, axis[2] = z;
    for (int a = 0; a < 3; ++a) from[a] = G(ray.origin[axis[a]]);
    shear[0] = G(ray.direction[axis[0]] / ray.direction[z]);
    shear[1] = G(ray.direction[axis[1]] / ray.direction[z]);
    shear[2] = G(1 / ray.direction[z]);
  }
};

/// The children of a node that a ray meets before `end`, as bits; `entry` is the least t within each.
///
/// The margin of the far side covers the rounding of both sides, at most 3 ulp each, and that of the shear in the test
/// of a triangle, at most 4 ulp (1 ulp = 2^-24 of t).
template <class F, class G>
[[gnu::always_inline]] inline unsigned meets(const BvhNode& node, const PreparedRay<F, G>& ray, float end,
                                             float* entry) {
  unsigned bits = 0;
  for (int i = 0; i < BvhNode::width; i += F::lanes) {
    F first(0.0f), last(end);
    F far(std::numeric_limits<float>::infinity());
    for (int a = 0; a < 3; ++a) {
      const F enter = (F::load(node.bound[ray.near[a]][a] + i) - ray.origin[a]) * ray.inverse[a];
      const F leave = (F::load(node.bound[1 - ray.near[a]][a] + i) - ray.origin[a]) * ray.inverse[a];
      first = max(enter, first), far = min(leave, far);
    }
    far = far * F(1 + 0x1p-20f);
    last = min(far, last);
    if (entry != nullptr) first.store(entry + i);
    bits |= bits_of(last >= first) << i;
  }
  return bits;
}

/// The edge functions of the triangles that contain the origin of the sheared plane, and t times their sum.
template <class G>
struct EdgeFunctions {
  G u, v, w, sum, t;
};

/// An edge function in double precision, where products of floats are exact: for those that are zero in single
/// precision.
template <class G>
[[gnu::always_inline]] inline G exact_edge(G px, G py, G qx, G qy) {
  alignas(16) float x0[4], y0[4], x1[4], y1[4], out[4];
  px.store(x0), py.store(y0), qx.store(x1), qy.store(y1);
  for (int i = 0; i < G::lanes; ++i)
    out[i] = static_cast<float>(static_cast<double>(x0[i]) * y1[i] - static_cast<double>(y0[i]) * x1[i]);
  return G::load(out);
}

/// Which triangles i and on of a leaf a ray meets in 0 < t < end, as bits.
///
/// Rounding is monotonic, so that an edge function that is not zero has the sign of the exact one.
template <class F, class G>
[[gnu::always_inline]] inline unsigned meets(const BvhLeaf& leaf, int i, const PreparedRay<F, G>& ray, float end,
                                             EdgeFunctions<G>& e) {
  G x[3], y[3], z[3];
  for (int k = 0; k < 3; ++k) {
    const G height = G::load(leaf.vertex[k][ray.axis[2]] + i) - ray.from[2];
    x[k] = G::load(leaf.vertex[k][ray.axis[0]] + i) - ray.from[0] - ray.shear[0] * height;
    y[k] = G::load(leaf.vertex[k][ray.axis[1]] + i) - ray.from[1] - ray.shear[1] * height;
    z[k] = ray.shear[2] * height;
  }
  e.u = x[2] * y[1] - y[2] * x[1];
  e.v = x[0] * y[2] - y[0] * x[2];
  e.w = x[1] * y[0] - y[1] * x[0];
  const G zero(0.0f);
  const auto is_lost = (e.u == zero) | (e.v == zero) | (e.w == zero);
  if (!none(is_lost)) {
    e.u = select(is_lost, exact_edge(x[2], y[2], x[1], y[1]), e.u);
    e.v = select(is_lost, exact_edge(x[0], y[0], x[2], y[2]), e.v);
    e.w = select(is_lost, exact_edge(x[1], y[1], x[0], y[0]), e.w);
  }
  const auto is_inside =
      ((e.u >= zero) & (e.v >= zero) & (e.w >= zero)) | ((zero >= e.u) & (zero >= e.v) & (zero >= e.w));
  if (none(is_inside)) return 0;
  e.sum = e.u + e.v + e.w;
  e.t = e.u * z[0] + e.v * z[1] + e.w * z[2];
  const auto is_reversed = e.sum < zero;
  const G size = abs(e.sum), t = select(is_reversed, -e.t, e.t);
  return bits_of(is_inside & (t > zero) & (t < size * G(end)));
}

template <class G>
[[gnu::always_inline]] inline RayHit hit_of(const BvhLeaf& leaf, int i, int lane, const EdgeFunctions<G>& e) {
  alignas(16) float t[4], b1[4], b2[4];
  (e.t / e.sum).store(t), (e.v / e.sum).store(b1), (e.w / e.sum).store(b2);
  return {leaf.instance[i + lane], leaf.primitive[i + lane], t[lane], b1[lane], b2[lane]};
}

[[gnu::always_inline]] inline int lowest_bit(unsigned bits) { return __builtin_ctz(bits); }

/// The nodes and leaves that are still to be visited: at most the children of each node on the path.
struct RayStack {
  static constexpr int capacity = Bvh::max_depth * BvhNode::width;
};

template <class F, class G>
[[gnu::always_inline]] inline float visibility(const BvhView& bvh, const Ray& of, const OpacityOfHits& opacity) {
  const PreparedRay<F, G> ray(of);
  std::uint32_t stack[RayStack::capacity];
  int height = 0;
  std::uint32_t at = 0;
  float visible = 1;
  while (true) {
    if (at & BvhNode::leaf) {
      const BvhLeaf& leaf = bvh.leaves[at - BvhNode::leaf];
      for (int i = 0; i < BvhLeaf::width; i += G::lanes) {
        EdgeFunctions<G> e;
        unsigned bits = meets(leaf, i, ray, of.end, e);
        if (bits & ~(leaf.translucent >> i)) return 0;
        for (; bits != 0; bits &= bits - 1)
          visible = visible * (1 - opacity.opacity(opacity.context, hit_of(leaf, i, lowest_bit(bits), e)));
      }
      if (visible == 0) return 0;
    } else {
      const BvhNode& node = bvh.nodes[at];
      unsigned bits = meets(node, ray, of.end, nullptr);
      if (bits != 0) {
        const int first = lowest_bit(bits);
        for (bits &= bits - 1; bits != 0; bits &= bits - 1) stack[height++] = node.child[lowest_bit(bits)];
        at = node.child[first];
        continue;
      }
    }
    if (height == 0) return visible;
    at = stack[--height];
  }
}

template <class F, class G>
void visibility(const BvhView& bvh, const Ray* rays, std::size_t count, const OpacityOfHits& opacity, float* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = bvh.nodes == nullptr ? 1 : visibility<F, G>(bvh, rays[i], opacity);
}

/// A child with the t at which the ray enters its box.
struct RayEntry {
  float t;
  std::uint32_t child;
};

template <class F, class G>
[[gnu::always_inline]] inline RayHit nearest(const BvhView& bvh, const Ray& of) {
  const PreparedRay<F, G> ray(of);
  RayEntry stack[RayStack::capacity];
  int height = 0;
  RayHit best;
  std::uint32_t at = 0;
  // Boxes that begin within rounding of the nearest hit may contain a nearer one.
  float end = of.end;
  while (true) {
    if (at & BvhNode::leaf) {
      const BvhLeaf& leaf = bvh.leaves[at - BvhNode::leaf];
      for (int i = 0; i < BvhLeaf::width; i += G::lanes) {
        EdgeFunctions<G> e;
        for (unsigned bits = meets(leaf, i, ray, of.end, e); bits != 0; bits &= bits - 1) {
          const RayHit hit = hit_of(leaf, i, lowest_bit(bits), e);
          const bool is_first =
              hit.instance < best.instance || (hit.instance == best.instance && hit.primitive < best.primitive);
          if (hit.t < best.t || (hit.t == best.t && is_first)) best = hit, end = hit.t * (1 + 0x1p-20f);
        }
      }
    } else {
      const BvhNode& node = bvh.nodes[at];
      alignas(32) float entry[BvhNode::width];
      // The children go onto the stack with the farthest first, of equal ones the last.
      const int bottom = height;
      for (unsigned bits = meets(node, ray, end, entry); bits != 0; bits &= bits - 1) {
        const int i = lowest_bit(bits);
        int k = height++;
        for (; k > bottom && stack[k - 1].t <= entry[i]; --k) stack[k] = stack[k - 1];
        stack[k] = {entry[i], node.child[i]};
      }
    }
    do {
      if (height == 0) return best;
      --height;
    } while (stack[height].t > end);
    at = stack[height].child;
  }
}

template <class F, class G>
void nearest(const BvhView& bvh, const Ray* rays, std::size_t count, RayHit* hits) {
  for (std::size_t i = 0; i < count; ++i) hits[i] = bvh.nodes == nullptr ? RayHit() : nearest<F, G>(bvh, rays[i]);
}

template <class F, class G>
constexpr RayKernels ray_kernels() {
  return {.visibility = &visibility<F, G>, .nearest = &nearest<F, G>};
}

}  // namespace zoneplate::stages
