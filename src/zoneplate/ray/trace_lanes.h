// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "zoneplate/ray/placement_lanes.h"
#include "zoneplate/ray/trace.h"

/// The queries of ray/trace.h over the lane types of math/lanes.h: `F` for the children of a node, `G` for the
/// triangles of a leaf.
namespace zoneplate::stages {

/// Rays that are traced together, with what their tests derive from them once.
template <class F>
struct PreparedRays {
  static constexpr int capacity = 32;
  using Int = typename F::Int;

  // Boxes. The inverse of a zero component is infinite; a coordinate within a slab of that direction then gives
  // -inf and inf, one on its boundary NaN, which min and max drop.
  alignas(32) float origin[3][capacity], inverse[3][capacity], end[capacity];
  alignas(32) std::int32_t near[3][capacity];  ///< the place in BvhNode::bound of the bound that the ray meets first

  // Triangles: the axes are permuted so that the direction is longest along z, and z is sheared onto the direction.
  alignas(32) std::int32_t axis[3][capacity];  ///< the place in a vertex of BvhLeaf
  alignas(32) float from[3][capacity];         ///< the origin along `axis`
  alignas(32) float shear[3][capacity];

  PreparedRays(const Ray* rays, int count) {
    alignas(32) float direction[3][capacity];
    for (int r = 0; r < count; ++r) {
      for (int a = 0; a < 3; ++a) origin[a][r] = rays[r].origin[a], direction[a][r] = rays[r].direction[a];
      end[r] = rays[r].end;
    }
    for (int r = count; r % F::lanes != 0; ++r)
      for (int a = 0; a < 3; ++a) origin[a][r] = 0, direction[a][r] = 1;
    for (int r = 0; r < count; r += F::lanes) {
      F d[3], inverted[3];
      for (int a = 0; a < 3; ++a) {
        d[a] = F::load(direction[a] + r), inverted[a] = F(1.0f) / d[a];
        inverted[a].store(inverse[a] + r);
        (where(inverted[a] < F(0.0f), Int(3 * BvhNode::width)) + Int(a * BvhNode::width)).store(near[a] + r);
      }
      const auto is_y = abs(d[1]) > abs(d[0]), is_z = abs(d[2]) > select(is_y, abs(d[1]), abs(d[0]));
      const F o[3] = {F::load(origin[0] + r), F::load(origin[1] + r), F::load(origin[2] + r)};
      const auto along = [&](const F(&v)[3], int after) {
        return select(is_z, v[(2 + after) % 3], select(is_y, v[(1 + after) % 3], v[after]));
      };
      for (int a = 0; a < 3; ++a) {
        const int after = (a + 1) % 3;  // z
        const auto place = [&](int z) { return Int((z + after) % 3 * BvhLeaf::width); };
        select(is_z, place(2), select(is_y, place(1), place(0))).store(axis[a] + r);
        along(o, after).store(from[a] + r);
        (a < 2 ? along(d, after) / along(d, 0) : along(inverted, 0)).store(shear[a] + r);
      }
    }
  }
};

/// Which children of a node, i and on, ray r meets before `end`; `entry` becomes the least t within each.
///
/// The margin of the far side covers the rounding of both sides, at most 3 ulp each, and that of the shear in the test
/// of a triangle, at most 4 ulp (1 ulp = 2^-24 of t).
template <class F>
[[gnu::always_inline]] inline auto meets(const BvhNode& node, int i, const PreparedRays<F>& rays, int r, float end,
                                         F& entry) {
  F far(std::numeric_limits<float>::infinity());
  entry = F(0.0f);
  const float* const bound = node.bound[0][0] + i;
  for (int a = 0; a < 3; ++a) {
    const F origin(rays.origin[a][r]), inverse(rays.inverse[a][r]);
    const int near = rays.near[a][r], opposite = (3 + 2 * a) * BvhNode::width - near;
    entry = max((F::load(bound + near) - origin) * inverse, entry);
    far = min((F::load(bound + opposite) - origin) * inverse, far);
  }
  return min(far * F(1 + 0x1p-20f), F(end)) >= entry;
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

/// Which triangles i and on of a leaf ray r meets in 0 < t < end, as bits.
///
/// Rounding is monotonic, so that an edge function that is not zero has the sign of the exact one.
template <class F, class G>
[[gnu::always_inline]] inline unsigned meets(const BvhLeaf& leaf, int i, const PreparedRays<F>& rays, int r,
                                             EdgeFunctions<G>& e) {
  const int ax = rays.axis[0][r], ay = rays.axis[1][r], az = rays.axis[2][r];
  const G from_x(rays.from[0][r]), from_y(rays.from[1][r]), from_z(rays.from[2][r]);
  const G shear_x(rays.shear[0][r]), shear_y(rays.shear[1][r]), shear_z(rays.shear[2][r]);
  G x[3], y[3], height[3];
  for (int k = 0; k < 3; ++k) {
    const float* const vertex = leaf.vertex[k][0] + i;
    height[k] = G::load(vertex + az) - from_z;
    x[k] = G::load(vertex + ax) - from_x - shear_x * height[k];
    y[k] = G::load(vertex + ay) - from_y - shear_y * height[k];
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
  e.t = e.u * (shear_z * height[0]) + e.v * (shear_z * height[1]) + e.w * (shear_z * height[2]);
  const auto is_reversed = e.sum < zero;
  const G size = abs(e.sum), t = select(is_reversed, -e.t, e.t);
  return bits_of(is_inside & (t > zero) & (t < size * G(rays.end[r])));
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
  static constexpr int capacity = 2 * Bvh::max_depth * BvhNode::width;
};

/// A node, leaf or placement that is visited, and the placement that it is in; null: in none.
struct BvhVisit {
  std::uint32_t child;
  const BvhPlacement* placement;

  bool is_leaf() const { return child & BvhNode::leaf; }

  /// Goes from a placement to the root of its tree.
  [[gnu::always_inline]] void enter(const BvhView& bvh) {
    if (!is_leaf() && (child & BvhNode::placement))
      placement = bvh.placements + (child - BvhNode::placement), child = placement->root;
  }
  /// The node or leaf in world space: itself, or `placed`, which is set.
  template <class F>
  [[gnu::always_inline]] const BvhNode& node(const BvhView& bvh, BvhNode& placed) const {
    const BvhNode& own = bvh.nodes[child];
    if (placement == nullptr) return own;
    place<F>(own, *placement, placed);
    return placed;
  }
  template <class G>
  [[gnu::always_inline]] const BvhLeaf& leaf(const BvhView& bvh, BvhLeaf& placed) const {
    const BvhLeaf& own = bvh.leaves[child - BvhNode::leaf];
    if (placement == nullptr) return own;
    place<G>(own, *placement, placed);
    return placed;
  }
};

/// Fetches a child that is visited later: most of a node, or the vertices of a leaf.
[[gnu::always_inline]] inline void prefetch(const BvhView& bvh, std::uint32_t child) {
  const char* const at = child & BvhNode::leaf ? reinterpret_cast<const char*>(bvh.leaves + (child - BvhNode::leaf))
                         : child & BvhNode::placement
                             ? reinterpret_cast<const char*>(bvh.placements + (child - BvhNode::placement))
                             : reinterpret_cast<const char*>(bvh.nodes + child);
  constexpr int line = 64;
  for (int i = 0; i < 3; ++i) __builtin_prefetch(at + i * line);
}

/// Rays of a PreparedRays, as bits.
using RayBits = std::uint32_t;

/// What is to be visited, with the rays that meet its box.
struct StreamEntry : BvhVisit {
  RayBits rays;
};

/// Stores the visibility of these rays from some nodes on, the last one first, each node and leaf being visited once by
/// all that meet it. Returns those that meet several translucent triangles, whose product is to be rounded in the order
/// of a ray that is traced alone.
///
/// The tests are those of each ray by itself, which wait for each other less than those of one ray after the other. The
/// first child is the largest, where any hit is found soonest.
template <class F, class G>
RayBits trace_visibility(const BvhView& bvh, const BvhNode* tops, int top_count, const PreparedRays<F>& rays,
                         const RayBits which, const OpacityOfHits& opacity, float* visible) {
  using Int = typename F::Int;
  for (RayBits left = which; left != 0; left &= left - 1) visible[lowest_bit(left)] = 1;
  const bool is_single = (which & (which - 1)) == 0;
  RayBits open = which;            // have met nothing opaque
  RayBits veiled = 0, unsure = 0;  // meet a translucent triangle; meet several
  StreamEntry stack[RayStack::capacity];
  int height = 0;
  StreamEntry at{{0, nullptr}, which};
  const BvhNode* top = tops + --top_count;  // null: `at` is to be visited
  while (true) {
    if (top == nullptr) at.enter(bvh);
    if (top == nullptr && at.is_leaf()) {
      BvhLeaf placed;
      const BvhLeaf& leaf = at.leaf<G>(bvh, placed);
      for (RayBits left = at.rays; left != 0; left &= left - 1) {
        const int r = lowest_bit(left);
        const RayBits bit = left & -left;
        for (int i = 0; i < BvhLeaf::width; i += G::lanes) {
          EdgeFunctions<G> e;
          unsigned bits = meets(leaf, i, rays, r, e);
          if (bits == 0) continue;
          if (bits & ~(leaf.translucent >> i)) visible[r] = 0;
          for (bits &= leaf.translucent >> i; bits != 0 && visible[r] != 0; bits &= bits - 1) {
            if (!is_single && (veiled & bit)) unsure |= bit;
            veiled |= bit;
            visible[r] = visible[r] * (1 - opacity.opacity(opacity.context, hit_of(leaf, i, lowest_bit(bits), e)));
          }
          if (visible[r] == 0) open &= ~bit;
        }
      }
    } else {
      BvhNode placed;
      const BvhNode& node = top != nullptr ? *top : at.node<F>(bvh, placed);
      top = nullptr;
      alignas(32) std::int32_t met[BvhNode::width];
      unsigned children = 0;
      for (int i = 0; i < BvhNode::width; i += F::lanes) {
        Int by(0);
        for (RayBits left = at.rays; left != 0; left &= left - 1) {
          const int r = lowest_bit(left);
          F entry;
          const auto is_met = meets(node, i, rays, r, rays.end[r], entry);
          by = by | where(is_met, Int(static_cast<std::int32_t>(left & -left)));
        }
        by.store(met + i);
        children |= (~bits_of(by == Int(0)) & ((1u << F::lanes) - 1)) << i;
      }
      if (children != 0) {
        const auto push = [&](unsigned bits) {
          const int c = lowest_bit(bits);
          prefetch(bvh, node.child[c]);
          stack[height++] = {{node.child[c], at.placement}, static_cast<RayBits>(met[c])};
        };
        for (unsigned rest = children & (children - 1); rest != 0; rest &= rest - 1) push(rest);
        push(children);
      }
    }
    do {
      if (height > 0) {
        at = stack[--height];
      } else {
        if (top_count == 0) return unsure & open;
        top = tops + --top_count, at = {{0, nullptr}, which};
      }
      at.rays &= open;
      if (open == 0) return 0;
    } while (at.rays == 0);
  }
}

template <class F, class G>
[[gnu::always_inline]] inline void visibility_from(const BvhView& bvh, const BvhNode* tops, int top_count,
                                                   const Ray* rays, std::size_t count, const OpacityOfHits& opacity,
                                                   float* visible) {
  constexpr std::size_t most = PreparedRays<F>::capacity;
  for (std::size_t first = 0; first < count; first += most) {
    const int n = static_cast<int>(count - first < most ? count - first : most);
    if (top_count == 0) {
      for (int r = 0; r < n; ++r) visible[first + static_cast<std::size_t>(r)] = 1;
      continue;
    }
    const PreparedRays<F> prepared(rays + first, n);
    const RayBits all = ~RayBits{0} >> (PreparedRays<F>::capacity - n);
    RayBits unsure = trace_visibility<F, G>(bvh, tops, top_count, prepared, all, opacity, visible + first);
    for (; unsure != 0; unsure &= unsure - 1)
      trace_visibility<F, G>(bvh, bvh.nodes + bvh.root, 1, prepared, unsure & -unsure, opacity, visible + first);
  }
}

template <class F, class G>
void visibility(const BvhView& bvh, const Ray* rays, std::size_t count, const OpacityOfHits& opacity, float* visible) {
  visibility_from<F, G>(bvh, bvh.nodes + bvh.root, bvh.nodes == nullptr ? 0 : 1, rays, count, opacity, visible);
}

template <class F, class G>
void visibility_below(const BvhView& bvh, const BvhTop& top, const Ray* rays, std::size_t count,
                      const OpacityOfHits& opacity, float* visible) {
  visibility_from<F, G>(bvh, top.nodes, top.count, rays, count, opacity, visible);
}

/// How far a ray of a half ball comes to lie below its plane, relative to the distance: by the rounding of its
/// direction and of the tests of triangles, less than 2^-20.
inline constexpr float below_plane = 0x1p-18f;

/// Whether all of these triangles lie below the plane.
template <class G>
[[gnu::always_inline]] inline bool is_below(const BvhLeaf& leaf, const HalfBall& within) {
  for (int i = 0; i < BvhLeaf::width; i += G::lanes)
    for (int k = 0; k < 3; ++k) {
      G height(0.0f), size(0.0f);
      for (int a = 0; a < 3; ++a) {
        const G from = G::load(leaf.vertex[k][a] + i) - G(within.origin[a]);
        height = height + from * G(within.normal[a]), size = size + abs(from);
      }
      if (!none(height + size * G(below_plane) >= G(0.0f))) return false;
    }
  return true;
}

template <class F, class G>
void collect_top(const BvhView& bvh, const HalfBall& within, BvhTop& top) {
  const auto set_child = [&](int place, const BvhNode& from, int c) {
    BvhNode& to = top.nodes[place / BvhNode::width];
    const int i = place % BvhNode::width;
    for (int a = 0; a < 3; ++a) to.bound[0][a][i] = from.bound[0][a][c], to.bound[1][a][i] = from.bound[1][a][c];
    to.child[i] = from.child[c];
  };
  BvhNode nothing;
  for (int a = 0; a < 3; ++a)
    nothing.bound[0][a][0] = std::numeric_limits<float>::infinity(),
    nothing.bound[1][a][0] = -std::numeric_limits<float>::infinity();
  nothing.child[0] = 0;
  std::uint32_t open[BvhTop::capacity * BvhNode::width] = {bvh.root};
  int height = bvh.nodes == nullptr ? 0 : 1, places = 0;
  while (height > 0) {
    const BvhNode& node = bvh.nodes[open[--height]];
    alignas(32) float square[BvhNode::width];
    unsigned reached = 0;
    for (int i = 0; i < BvhNode::width; i += F::lanes) {
      F top_height(0.0f), size(0.0f), distance(0.0f);
      for (int a = 0; a < 3; ++a) {
        const F low = F::load(node.bound[0][a] + i) - F(within.origin[a]);
        const F high = F::load(node.bound[1][a] + i) - F(within.origin[a]);
        const F outside = max(max(low, -high), F(0.0f));
        top_height = top_height + (within.normal[a] > 0 ? high : low) * F(within.normal[a]);
        size = size + max(abs(low), abs(high)), distance = distance + outside * outside;
      }
      distance.store(square + i);
      constexpr float margin = 1 + 0x1p-12f;
      const auto is_near = F(within.radius * within.radius * margin) >= distance;
      reached |= bits_of((top_height + size * F(below_plane) >= F(0.0f)) & is_near) << i;
    }
    for (; reached != 0; reached &= reached - 1) {
      const int c = lowest_bit(reached);
      const std::uint32_t child = node.child[c];
      const bool is_about_origin = square[c] == 0;
      if (is_about_origin && (child & BvhNode::leaf) && is_below<G>(bvh.leaves[child - BvhNode::leaf], within))
        continue;
      // A node that is opened has eight children, as have those that wait and the rest of this one.
      const bool has_room = places + (height + 2) * BvhNode::width <= BvhTop::capacity * BvhNode::width;
      if (is_about_origin && !(child & (BvhNode::leaf | BvhNode::placement)) && has_room)
        open[height++] = child;
      else
        set_child(places++, node, c);
    }
  }
  top.count = (places + BvhNode::width - 1) / BvhNode::width;
  for (; places % BvhNode::width != 0; ++places) set_child(places, nothing, 0);
}

/// What is to be visited, with the t at which the ray enters its box.
struct RayEntry : BvhVisit {
  float t;
};

/// The nearest hit of ray r.
template <class F, class G>
[[gnu::always_inline]] inline RayHit nearest(const BvhView& bvh, const PreparedRays<F>& rays, int r) {
  RayEntry stack[RayStack::capacity];
  int height = 0;
  RayHit best;
  BvhVisit at{bvh.root, nullptr};
  // Boxes that begin within rounding of the nearest hit may contain a nearer one.
  float end = rays.end[r];
  while (true) {
    at.enter(bvh);
    if (at.is_leaf()) {
      BvhLeaf placed;
      const BvhLeaf& leaf = at.leaf<G>(bvh, placed);
      for (int i = 0; i < BvhLeaf::width; i += G::lanes) {
        EdgeFunctions<G> e;
        for (unsigned bits = meets(leaf, i, rays, r, e); bits != 0; bits &= bits - 1) {
          const RayHit hit = hit_of(leaf, i, lowest_bit(bits), e);
          const bool is_first =
              hit.instance < best.instance || (hit.instance == best.instance && hit.primitive < best.primitive);
          if (hit.t < best.t || (hit.t == best.t && is_first)) best = hit, end = hit.t * (1 + 0x1p-20f);
        }
      }
    } else {
      BvhNode placed;
      const BvhNode& node = at.node<F>(bvh, placed);
      alignas(32) float entry[BvhNode::width];
      unsigned children = 0;
      for (int i = 0; i < BvhNode::width; i += F::lanes) {
        F t;
        children |= bits_of(meets(node, i, rays, r, end, t)) << i;
        t.store(entry + i);
      }
      // The children go onto the stack with the farthest first, of equal ones the last.
      const int bottom = height;
      for (; children != 0; children &= children - 1) {
        const int i = lowest_bit(children);
        int k = height++;
        for (; k > bottom && stack[k - 1].t <= entry[i]; --k) stack[k] = stack[k - 1];
        stack[k] = {{node.child[i], at.placement}, entry[i]};
      }
    }
    do {
      if (height == 0) return best;
      --height;
    } while (stack[height].t > end);
    at = stack[height];
  }
}

template <class F, class G>
void nearest(const BvhView& bvh, const Ray* rays, std::size_t count, RayHit* hits) {
  constexpr std::size_t most = PreparedRays<F>::capacity;
  for (std::size_t first = 0; first < count; first += most) {
    const int n = static_cast<int>(count - first < most ? count - first : most);
    const PreparedRays<F> prepared(rays + first, n);
    for (int r = 0; r < n; ++r)
      hits[first + static_cast<std::size_t>(r)] = bvh.nodes == nullptr ? RayHit() : nearest<F, G>(bvh, prepared, r);
  }
}

template <class F, class G>
constexpr RayKernels ray_kernels() {
  return {.visibility = &visibility<F, G>,
          .collect_top = &collect_top<F, G>,
          .visibility_below = &visibility_below<F, G>,
          .nearest = &nearest<F, G>};
}

}  // namespace zoneplate::stages
