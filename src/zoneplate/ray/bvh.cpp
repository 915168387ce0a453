// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/ray/bvh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/large_array.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/ray/placement_lanes.h"

namespace zoneplate {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// A box in four lanes, of which the last one is unused; compilers turn its loops into single instructions.
struct alignas(16) WideBox {
  float low[4] = {infinity, infinity, infinity, infinity};
  float high[4] = {-infinity, -infinity, -infinity, -infinity};

  void add(const WideBox& b) {
    for (int c = 0; c < 4; ++c) low[c] = b.low[c] < low[c] ? b.low[c] : low[c];
    for (int c = 0; c < 4; ++c) high[c] = b.high[c] > high[c] ? b.high[c] : high[c];
  }
  /// Half of the surface area; 0 of an empty box.
  float area() const {
    const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x >= 0 ? x * y + y * z + z * x : 0;
  }
};

/// A triangle in the build, or a placement: its box, with the caster or placement in the unused lane of `low` and the
/// triangle in that of `high`.
struct Reference {
  WideBox box;
  std::uint32_t caster() const { return std::bit_cast<std::uint32_t>(box.low[3]); }
  std::uint32_t triangle() const { return std::bit_cast<std::uint32_t>(box.high[3]); }
  /// Twice the centroid of the box.
  float centre(int axis) const { return box.low[axis] + box.high[axis]; }
};

/// A range of references with their boxes.
struct Range {
  std::size_t begin = 0, end = 0;
  WideBox box;
  WideBox centres;  ///< of twice the centroids
  std::size_t size() const { return end - begin; }
};

std::uint32_t number(std::size_t x) { return static_cast<std::uint32_t>(x); }

void add_centre(const Reference& r, WideBox& centres) {
  WideBox c;
  for (int i = 0; i < 4; ++i) c.low[i] = c.high[i] = r.box.low[i] + r.box.high[i];
  centres.add(c);
}

constexpr int bins = 16;
/// Nodes at this depth and below split their ranges in halves, so that no tree exceeds Bvh::max_depth.
constexpr int halving_depth = 28;

/// The cost of the triangles of a leaf, which are tested four at a time.
float blocks(std::size_t triangles) { return static_cast<float>((triangles + BvhLeaf::width - 1) / BvhLeaf::width); }

struct Split {
  int axis = -1;
  int bin = 0;  ///< the first on the right
  float first = 0, scale = 0;
  float cost = infinity;
  bool is_left(const Reference& r) const { return bin_of(r) < bin; }
  int bin_of(const Reference& r) const {
    return std::min(static_cast<int>((r.centre(axis) - first) * scale), bins - 1);
  }
};

/// The best division of the range by bins along one of the axes; none where all centroids are the same.
Split find_split(std::span<const Reference> references, const Range& range) {
  Split plan[3];
  for (int a = 0; a < 3; ++a) {
    const float extent = range.centres.high[a] - range.centres.low[a];
    const float scale = static_cast<float>(bins) * 0.9999f / extent;
    if (extent > 0 && scale < infinity) plan[a] = {.axis = a, .first = range.centres.low[a], .scale = scale};
  }
  std::array<std::array<WideBox, bins>, 3> box;
  std::array<std::array<std::uint32_t, bins>, 3> count{};
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const Reference& r = references[i];
    for (std::size_t a = 0; a < 3; ++a) {
      if (plan[a].axis < 0) continue;
      const auto b = static_cast<std::size_t>(plan[a].bin_of(r));
      ++count[a][b];
      box[a][b].add(r.box);
    }
  }

  Split best;
  for (std::size_t a = 0; a < 3; ++a) {
    if (plan[a].axis < 0) continue;
    float right_area[bins];
    WideBox right;
    for (std::size_t b = bins - 1; b > 0; --b) right.add(box[a][b]), right_area[b] = right.area();
    WideBox left;
    std::size_t on_left = 0;
    for (std::size_t b = 1; b < bins; ++b) {
      left.add(box[a][b - 1]), on_left += count[a][b - 1];
      if (on_left == 0 || on_left == range.size()) continue;
      const float cost = left.area() * blocks(on_left) + right_area[b] * blocks(range.size() - on_left);
      if (cost < best.cost) best = plan[a], best.bin = static_cast<int>(b), best.cost = cost;
    }
  }
  return best;
}

/// Divides the range in two, and reorders its references.
std::pair<Range, Range> divide(std::span<Reference> references, const Range& range, bool halves) {
  const Split split = halves ? Split() : find_split(references, range);
  Range left{.begin = range.begin}, right{.end = range.end};
  const auto add = [](const Reference& r, Range& to) { to.box.add(r.box), add_centre(r, to.centres); };
  if (split.axis < 0) {
    left.end = right.begin = range.begin + range.size() / 2;
    for (std::size_t i = range.begin; i < range.end; ++i) add(references[i], i < left.end ? left : right);
    return {left, right};
  }
  std::size_t i = range.begin, j = range.end;
  while (true) {
    for (; i < j && split.is_left(references[i]); ++i) add(references[i], left);
    for (; i < j && !split.is_left(references[j - 1]); --j) add(references[j - 1], right);
    if (i >= j) break;
    std::swap(references[i], references[j - 1]);
  }
  left.end = right.begin = i;
  return {left, right};
}

/// The children of a node: at most eight ranges, each of which is small enough for a leaf or worth a node.
std::vector<Range> children_of(std::span<Reference> references, const Range& range, std::size_t leaf_size, int depth) {
  std::vector<Range> parts{range};
  while (parts.size() < BvhNode::width) {
    // The child that a ray is most likely to enter is divided next.
    std::size_t widest = parts.size();
    std::pair<float, std::size_t> greatest;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::pair weight{depth >= halving_depth ? 0 : parts[i].box.area(), parts[i].size()};
      if (parts[i].size() > leaf_size && weight > greatest) widest = i, greatest = weight;
    }
    if (widest == parts.size()) break;
    auto [left, right] = divide(references, parts[widest], depth >= halving_depth);
    parts[widest] = left;
    parts.push_back(right);
  }
  // Rays that search for any hit visit the largest children first.
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Range& a, const Range& b) { return a.box.area() > b.box.area(); });
  return parts;
}

void set_box(BvhNode& node, std::size_t child, const WideBox& box) {
  for (int a = 0; a < 3; ++a) node.bound[0][a][child] = box.low[a], node.bound[1][a][child] = box.high[a];
}

BvhNode empty_node() {
  BvhNode node;
  for (std::size_t i = 0; i < BvhNode::width; ++i) set_box(node, i, WideBox()), node.child[i] = 0;
  return node;
}

float3 vertex(const ShadowCaster& caster, std::size_t triangle, std::size_t k) {
  return transform_point(caster.world_from_object, caster.position[caster.index[3 * triangle + k]]);
}

/// A part of the tree. Its references to nodes and leaves count from its own first ones.
struct Tree {
  std::vector<BvhNode> nodes;
  std::vector<BvhLeaf> leaves;
};

/// Builds a tree of the triangles of casters, or one of placements if there are no casters.
struct Builder {
  std::span<const ShadowCaster> casters;
  std::span<Reference> references;

  std::size_t leaf_size() const { return casters.empty() ? 1 : BvhLeaf::width; }

  std::uint32_t add_leaf(const Range& range, Tree& tree) const {
    if (casters.empty()) return BvhNode::placement + references[range.begin].caster();
    BvhLeaf leaf;
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < BvhLeaf::width; ++i) {
      const bool is_used = i < range.size();
      const Reference& r = references[range.begin + (is_used ? i : 0)];
      const ShadowCaster& caster = casters[r.caster()];
      for (std::size_t k = 0; k < 3; ++k) {
        const float3 p = is_used ? vertex(caster, r.triangle(), k) : float3{nan, nan, nan};
        leaf.vertex[k][0][i] = p.x, leaf.vertex[k][1][i] = p.y, leaf.vertex[k][2][i] = p.z;
      }
      leaf.instance[i] = r.caster(), leaf.primitive[i] = r.triangle();
      if (caster.is_translucent) leaf.translucent |= 1u << i;
    }
    tree.leaves.push_back(leaf);
    return BvhNode::leaf + number(tree.leaves.size() - 1);
  }

  /// Appends the tree of a range, depth first; returns the reference to it.
  std::uint32_t build(const Range& range, int depth, Tree& tree) const {
    if (range.size() <= leaf_size()) return add_leaf(range, tree);
    const std::uint32_t at = number(tree.nodes.size());
    tree.nodes.push_back(empty_node());
    const std::vector<Range> parts = children_of(references, range, leaf_size(), depth);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::uint32_t child = build(parts[i], depth + 1, tree);
      tree.nodes[at].child[i] = child;
      set_box(tree.nodes[at], i, parts[i].box);
    }
    return at;
  }
};

void add_reference(Reference r, std::size_t caster, std::size_t triangle, std::vector<Reference>& to, Range& all) {
  r.box.low[3] = std::bit_cast<float>(number(caster));
  r.box.high[3] = std::bit_cast<float>(number(triangle));
  all.box.add(r.box), add_centre(r, all.centres);
  to.push_back(r);
  all.end = to.size();
}

/// The boxes of all triangles with finite vertices, in order.
std::vector<Reference> make_references(std::span<const ShadowCaster> casters, Range& all) {
  std::size_t most = 0;
  for (const ShadowCaster& caster : casters) most += caster.index.size() / 3;
  std::vector<Reference> references;
  reserve_large(references, most);
  for (std::size_t c = 0; c < casters.size(); ++c) {
    for (std::size_t t = 0; t < casters[c].index.size() / 3; ++t) {
      if (t % 4096 == 0) check_deadline();
      Reference r;
      bool is_usable = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const float3 p = vertex(casters[c], t, k);
        is_usable = is_usable && is_finite(p);
        r.box.add({{p.x, p.y, p.z, 0}, {p.x, p.y, p.z, 0}});
      }
      if (is_usable) add_reference(r, c, t, references, all);
    }
  }
  return references;
}

/// Nodes above this size are divided one after the other, the parts below in parallel.
constexpr std::size_t serial_size = std::size_t{1} << 15;

/// The child of a node at the top whose tree is built in parallel.
struct Job {
  Range range;
  int depth = 0;
  std::uint32_t node = 0;
  std::size_t child = 0;
};

void build_top(const Builder& builder, const Range& range, int depth, Tree& tree, std::vector<Job>& jobs) {
  const std::uint32_t at = number(tree.nodes.size());
  tree.nodes.push_back(empty_node());
  check_deadline();
  const std::vector<Range> parts = children_of(builder.references, range, builder.leaf_size(), depth);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    set_box(tree.nodes[at], i, parts[i].box);
    if (parts[i].size() <= serial_size) {
      jobs.push_back({parts[i], depth + 1, at, i});
    } else {
      tree.nodes[at].child[i] = number(tree.nodes.size());
      build_top(builder, parts[i], depth + 1, tree, jobs);
    }
  }
}

/// Appends a part to the tree and frees it; returns the reference to its root.
std::uint32_t append(Tree& part, std::uint32_t root, Tree& tree) {
  const std::uint32_t nodes = number(tree.nodes.size()), leaves = number(tree.leaves.size());
  const auto moved = [&](std::uint32_t child) {
    return child + (child & BvhNode::leaf ? leaves : child & BvhNode::placement ? 0 : nodes);
  };
  for (BvhNode& node : part.nodes) {
    for (std::size_t i = 0; i < BvhNode::width; ++i)
      if (node.bound[0][0][i] <= node.bound[1][0][i]) node.child[i] = moved(node.child[i]);
    tree.nodes.push_back(node);
  }
  tree.leaves.insert(tree.leaves.end(), part.leaves.begin(), part.leaves.end());
  part = Tree();
  return moved(root);
}

/// Appends the tree of these references, and frees them; returns its root, a node.
std::uint32_t append_tree(std::span<const ShadowCaster> casters, std::vector<Reference> references, const Range& all,
                          Tree& tree) {
  const std::uint32_t root = number(tree.nodes.size());
  const Builder builder{casters, references};
  std::vector<Job> jobs;
  build_top(builder, all, 0, tree, jobs);

  std::vector<Tree> parts(jobs.size());
  std::vector<std::uint32_t> roots(jobs.size());
  parallel_for(jobs.size(), [&](std::size_t i) {
    growing("shadow rays' triangles", [&] { roots[i] = builder.build(jobs[i].range, jobs[i].depth, parts[i]); });
  });
  references = {};
  std::size_t nodes = tree.nodes.size(), leaves = tree.leaves.size();
  for (const Tree& part : parts) nodes += part.nodes.size(), leaves += part.leaves.size();
  reserve_large(tree.nodes, nodes), reserve_large(tree.leaves, leaves);
  for (std::size_t i = 0; i < jobs.size(); ++i)
    tree.nodes[jobs[i].node].child[jobs[i].child] = append(parts[i], roots[i], tree);
  return root;
}

/// The greatest sum of magnitudes in a coordinate of a placed tree: below it, nothing overflows.
constexpr float max_placed = 1e30f;
/// A mesh has a tree of its own if more triangles than these need not be stored.
constexpr std::size_t min_saved = std::size_t{1} << 16;

/// Casters of one mesh.
using Casters = std::vector<std::uint32_t>;

/// The casters with common triangles, in the order of their first ones.
std::vector<Casters> repeated(std::span<const ShadowCaster> casters) {
  std::vector<Casters> groups;
  std::map<std::pair<const float3*, const std::uint32_t*>, std::size_t> known;
  for (std::size_t c = 0; c < casters.size(); ++c) {
    if (casters[c].index.empty()) continue;
    const auto [found, is_new] =
        known.try_emplace({casters[c].position.data(), casters[c].index.data()}, groups.size());
    if (is_new) groups.emplace_back();
    groups[found->second].push_back(number(c));
  }
  std::erase_if(groups, [&](const Casters& group) {
    return (group.size() - 1) * (casters[group[0]].index.size() / 3) < min_saved;
  });
  return groups;
}

/// The tree of a caster with the root `root`, and its box in the world.
std::pair<BvhPlacement, WideBox> place(const ShadowCaster& caster, std::size_t instance, const Tree& tree,
                                       std::uint32_t root) {
  BvhPlacement placement{.root = root, .instance = number(instance), .translucent = caster.is_translucent ? 15u : 0u};
  const auto& column = caster.world_from_object.column;
  for (std::size_t c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r)
      placement.world_from_object[r][c] = r == 0 ? column[c].x : r == 1 ? column[c].y : column[c].z;
  BvhNode node;
  stages::place<scalar::Float>(tree.nodes[root], placement, node);
  WideBox box;
  for (std::size_t i = 0; i < BvhNode::width; ++i)
    box.add({{node.bound[0][0][i], node.bound[0][1][i], node.bound[0][2][i], 0},
             {node.bound[1][0][i], node.bound[1][1][i], node.bound[1][2][i], 0}});
  return {placement, box};
}

bool is_within(const WideBox& box, float limit) {
  bool is = true;
  for (int a = 0; a < 3; ++a) is = is && box.low[a] > -limit && box.high[a] < limit;
  return is;
}

}  // namespace

Bvh::Bvh(std::span<const ShadowCaster> casters, std::size_t max_triangles) {
  growing("shadow rays' triangles", [&] {
    std::size_t all_triangles = 0;
    for (const ShadowCaster& caster : casters) all_triangles += caster.index.size() / 3;
    std::vector<ShadowCaster> expanded(casters.begin(), casters.end());
    Tree tree;
    Range placed;
    std::vector<Reference> boxes;
    for (const Casters& group : all_triangles > max_triangles ? repeated(casters) : std::vector<Casters>()) {
      ShadowCaster mesh = casters[group[0]];
      mesh.world_from_object = {};
      Range all;
      std::vector<Reference> references = make_references({&mesh, 1}, all);
      if (references.empty()) continue;
      const std::size_t triangles = references.size();
      const std::uint32_t root = append_tree({&mesh, 1}, std::move(references), all, tree);
      for (const std::uint32_t c : group) {
        const auto [placement, box] = place(casters[c], c, tree, root);
        if (!is_within(box, max_placed)) continue;
        add_reference({box}, placements_.size(), 0, boxes, placed);
        placements_.push_back(placement);
        triangles_ += triangles;
        expanded[c].index = {};
      }
    }
    Range all;
    std::vector<Reference> references = make_references(expanded, all);
    triangles_ += references.size();
    const bool has_triangles = !references.empty();
    if (has_triangles) root_ = append_tree(expanded, std::move(references), all, tree);
    if (!placements_.empty()) {
      const std::uint32_t of_triangles = root_, stand_in = BvhNode::placement + number(placements_.size());
      if (has_triangles) add_reference({all.box}, placements_.size(), 0, boxes, placed);
      root_ = append_tree({}, std::move(boxes), placed, tree);
      for (std::size_t i = root_; has_triangles && i < tree.nodes.size(); ++i)
        std::replace(std::begin(tree.nodes[i].child), std::end(tree.nodes[i].child), stand_in, of_triangles);
    }
    nodes_ = std::move(tree.nodes), leaves_ = std::move(tree.leaves);
  });
}

Box Bvh::bounds() const {
  Box box;
  if (nodes_.empty()) return box;
  const auto& bound = nodes_[root_].bound;
  for (std::size_t i = 0; i < BvhNode::width; ++i)
    box.add(Box{{bound[0][0][i], bound[0][1][i], bound[0][2][i]}, {bound[1][0][i], bound[1][1][i], bound[1][2][i]}});
  return box;
}

}  // namespace zoneplate
