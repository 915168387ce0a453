// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/ray/bvh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/large_array.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/ray/bvh_build.h"
#include "zoneplate/ray/placement_lanes.h"

namespace zoneplate {
namespace {

/// A range of references with their bounds.
struct Range {
  std::size_t begin = 0, end = 0;
  BuildBounds bounds;
  std::size_t size() const { return end - begin; }
  const BuildBox& box() const { return bounds.box; }
};

std::uint32_t number(std::size_t x) { return static_cast<std::uint32_t>(x); }

/// Nodes at this depth and below split their ranges in halves, so that no tree exceeds Bvh::max_depth.
constexpr int halving_depth = 28;

/// Divides the range in two, and reorders its references.
std::pair<Range, Range> divide(std::span<BuildReference> references, const Range& range, bool halves) {
  const BuildBins bins(range.bounds.centres, range.size());
  BuildSplit split;
  if (!halves) split = BuildKernels::of().split(&references[range.begin], range.size(), bins);
  Range left{.begin = range.begin}, right{.end = range.end};
  if (split.axis < 0) {
    left.end = right.begin = range.begin + range.size() / 2;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      BuildBounds& side = i < left.end ? left.bounds : right.bounds;
      side.box.add(references[i].box), side.add_centre(references[i]);
    }
    return {left, right};
  }
  const auto is_left = [&](const BuildReference& r) { return bins.bin_of(r, split.axis) < split.bin; };
  std::size_t i = range.begin, j = range.end;
  while (true) {
    for (; i < j && is_left(references[i]); ++i) left.bounds.add_centre(references[i]);
    for (; i < j && !is_left(references[j - 1]); --j) right.bounds.add_centre(references[j - 1]);
    if (i >= j) break;
    std::swap(references[i], references[j - 1]);
  }
  left.end = right.begin = i;
  left.bounds.box = split.left, right.bounds.box = split.right;
  return {left, right};
}

/// At most eight ranges, each of which is small enough for a leaf or worth a node.
struct Children {
  std::array<Range, BvhNode::width> range;
  std::size_t size = 0;
};

Children children_of(std::span<BuildReference> references, const Range& range, std::size_t leaf_size, int depth) {
  Children out{.range = {range}, .size = 1};
  while (out.size < BvhNode::width) {
    // The child that a ray is most likely to enter is divided next.
    std::size_t widest = out.size;
    std::pair<float, std::size_t> greatest;
    for (std::size_t i = 0; i < out.size; ++i) {
      const Range& child = out.range[i];
      const std::pair weight{depth >= halving_depth ? 0 : child.box().area(), child.size()};
      if (child.size() > leaf_size && weight > greatest) widest = i, greatest = weight;
    }
    if (widest == out.size) break;
    std::tie(out.range[widest], out.range[out.size]) = divide(references, out.range[widest], depth >= halving_depth);
    ++out.size;
  }
  // Rays that search for any hit visit the largest children first.
  std::stable_sort(out.range.begin(), out.range.begin() + out.size,
                   [](const Range& a, const Range& b) { return a.box().area() > b.box().area(); });
  return out;
}

void set_box(BvhNode& node, std::size_t child, const BuildBox& box) {
  for (int a = 0; a < 3; ++a) node.bound[0][a][child] = box.low(a), node.bound[1][a][child] = box.high(a);
}

BvhNode empty_node() {
  BvhNode node;
  for (std::size_t i = 0; i < BvhNode::width; ++i) set_box(node, i, BuildBox::empty()), node.child[i] = 0;
  return node;
}

std::size_t triangles_of(std::span<const ShadowCaster> casters) {
  std::size_t all = 0;
  for (const ShadowCaster& caster : casters) all += caster.index.size() / 3;
  return all;
}

float3 vertex(const ShadowCaster& caster, std::size_t triangle, std::size_t k) {
  return transform_point(caster.world_from_object, caster.position[caster.index[3 * triangle + k]]);
}

/// The references of a leaf.
struct LeafRange {
  std::uint32_t begin, size;
};

/// A part of the tree. Its references to nodes and leaves count from its own first ones.
struct Part {
  std::vector<BvhNode> nodes;
  std::vector<LeafRange> leaves;
};

/// Builds a tree of the triangles of casters, or one of placements if there are no casters.
struct Builder {
  std::span<const ShadowCaster> casters;
  std::span<BuildReference> references;

  std::size_t leaf_size() const { return casters.empty() ? 1 : BvhLeaf::width; }

  BvhLeaf leaf_of(const LeafRange& range) const {
    BvhLeaf leaf;
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = 0; i < BvhLeaf::width; ++i) {
      const bool is_used = i < range.size;
      const BuildReference& r = references[range.begin + (is_used ? i : 0)];
      const ShadowCaster& caster = casters[r.caster()];
      for (std::size_t k = 0; k < 3; ++k) {
        const float3 p = is_used ? vertex(caster, r.triangle(), k) : float3{nan, nan, nan};
        leaf.vertex[k][0][i] = p.x, leaf.vertex[k][1][i] = p.y, leaf.vertex[k][2][i] = p.z;
      }
      leaf.instance[i] = r.caster(), leaf.primitive[i] = r.triangle();
      if (caster.is_translucent) leaf.translucent |= 1u << i;
    }
    return leaf;
  }

  /// Appends the tree of a range, depth first; returns the reference to it.
  std::uint32_t build(const Range& range, int depth, Part& part) const {
    if (range.size() <= leaf_size()) {
      if (casters.empty()) return BvhNode::placement + references[range.begin].caster();
      part.leaves.push_back({number(range.begin), number(range.size())});
      return BvhNode::leaf + number(part.leaves.size() - 1);
    }
    const std::uint32_t at = number(part.nodes.size());
    part.nodes.push_back(empty_node());
    const Children children = children_of(references, range, leaf_size(), depth);
    for (std::size_t i = 0; i < children.size; ++i) {
      const std::uint32_t child = build(children.range[i], depth + 1, part);
      part.nodes[at].child[i] = child;
      set_box(part.nodes[at], i, children.range[i].box());
    }
    return at;
  }
};

/// The references of a tree.
struct References {
  std::unique_ptr<BuildReference[]> memory;
  Range all;

  /// No references yet, and memory for `capacity` of them.
  explicit References(std::size_t capacity) : memory(new BuildReference[capacity]) {
    prefault(memory.get(), capacity * sizeof(BuildReference));
  }
  /// Those of all triangles with finite vertices, in order.
  explicit References(std::span<const ShadowCaster> casters) : References(triangles_of(casters)) {
    for (std::size_t c = 0; c < casters.size(); ++c) {
      constexpr std::size_t chunk = 4096;
      const std::size_t triangles = casters[c].index.size() / 3;
      for (std::size_t t = 0; t < triangles; t += chunk) {
        check_deadline();
        all.end += BuildKernels::of().refer(casters[c], number(c), t, std::min(t + chunk, triangles),
                                            memory.get() + all.end, all.bounds);
      }
    }
  }
  void add(const BuildBox& box, std::size_t placement) {
    BuildReference& r = memory[all.end++];
    r.box = box, r.set(number(placement), 0);
    all.bounds.box.add(box), all.bounds.add_centre(r);
  }
  std::span<BuildReference> span() const { return {memory.get(), all.end}; }
};

/// Nodes above this size are divided one after the other, the parts below in parallel.
constexpr std::size_t serial_size = std::size_t{1} << 15;

/// The child of a node at the top whose tree is built in parallel.
struct Job {
  Range range;
  int depth = 0;
  std::uint32_t node = 0;
  std::size_t child = 0;
};

void build_top(const Builder& builder, const Range& range, int depth, std::vector<BvhNode>& nodes,
               std::vector<Job>& jobs) {
  const std::uint32_t at = number(nodes.size());
  nodes.push_back(empty_node());
  check_deadline();
  const Children children = children_of(builder.references, range, builder.leaf_size(), depth);
  for (std::size_t i = 0; i < children.size; ++i) {
    const Range& child = children.range[i];
    set_box(nodes[at], i, child.box());
    if (child.size() <= serial_size) {
      jobs.push_back({child, depth + 1, at, i});
    } else {
      nodes[at].child[i] = number(nodes.size());
      build_top(builder, child, depth + 1, nodes, jobs);
    }
  }
}

struct Tree {
  std::vector<BvhNode> nodes;
  std::vector<BvhLeaf> leaves;
};

/// Appends the tree of these references; returns its root, a node.
std::uint32_t append_tree(std::span<const ShadowCaster> casters, References references, Tree& tree) {
  const std::uint32_t root = number(tree.nodes.size());
  const Builder builder{casters, references.span()};
  std::vector<Job> jobs;
  build_top(builder, references.all, 0, tree.nodes, jobs);

  std::vector<Part> parts(jobs.size());
  std::vector<std::uint32_t> roots(jobs.size()), first_leaf(jobs.size());
  parallel_for(jobs.size(), [&](std::size_t i) {
    growing("shadow rays' triangles", [&] {
      // There are about 12 triangles per node and 4 per leaf.
      parts[i].nodes.reserve(jobs[i].range.size() / 10), parts[i].leaves.reserve(jobs[i].range.size() / 3);
      roots[i] = builder.build(jobs[i].range, jobs[i].depth, parts[i]);
    });
  });
  std::size_t nodes = tree.nodes.size(), leaves = tree.leaves.size();
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    first_leaf[i] = number(leaves);
    nodes += parts[i].nodes.size(), leaves += parts[i].leaves.size();
  }
  reserve_large(tree.nodes, nodes), reserve_large(tree.leaves, leaves);
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const std::uint32_t first_node = number(tree.nodes.size());
    const auto moved = [&](std::uint32_t child) {
      return child + (child & BvhNode::leaf ? first_leaf[i] : child & BvhNode::placement ? 0 : first_node);
    };
    tree.nodes[jobs[i].node].child[jobs[i].child] = moved(roots[i]);
    for (BvhNode& node : parts[i].nodes) {
      for (std::size_t k = 0; k < BvhNode::width; ++k)
        if (node.bound[0][0][k] <= node.bound[1][0][k]) node.child[k] = moved(node.child[k]);
      tree.nodes.push_back(node);
    }
    parts[i].nodes = {};
  }
  tree.leaves.resize(leaves);
  parallel_for(jobs.size(), [&](std::size_t i) {
    for (std::size_t k = 0; k < parts[i].leaves.size(); ++k)
      tree.leaves[first_leaf[i] + k] = builder.leaf_of(parts[i].leaves[k]);
  });
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
std::pair<BvhPlacement, BuildBox> place(const ShadowCaster& caster, std::size_t instance, const Tree& tree,
                                        std::uint32_t root) {
  BvhPlacement placement{.root = root, .instance = number(instance), .translucent = caster.is_translucent ? 15u : 0u};
  const auto& column = caster.world_from_object.column;
  for (std::size_t c = 0; c < 4; ++c)
    for (int r = 0; r < 3; ++r)
      placement.world_from_object[r][c] = r == 0 ? column[c].x : r == 1 ? column[c].y : column[c].z;
  BvhNode node;
  stages::place<scalar::Float>(tree.nodes[root], placement, node);
  BuildBox box = BuildBox::empty();
  for (std::size_t i = 0; i < BvhNode::width; ++i)
    box.add({{node.bound[0][0][i], node.bound[0][1][i], node.bound[0][2][i], 0, -node.bound[1][0][i],
              -node.bound[1][1][i], -node.bound[1][2][i], 0}});
  return {placement, box};
}

bool is_within(const BuildBox& box, float limit) {
  bool is = true;
  for (int a = 0; a < 3; ++a) is = is && box.low(a) > -limit && box.high(a) < limit;
  return is;
}

}  // namespace

Bvh::Bvh(std::span<const ShadowCaster> casters, std::size_t max_triangles) {
  growing("shadow rays' triangles", [&] {
    std::vector<ShadowCaster> expanded(casters.begin(), casters.end());
    Tree tree;
    References boxes(casters.size() + 1);
    for (const Casters& group : triangles_of(casters) > max_triangles ? repeated(casters) : std::vector<Casters>()) {
      ShadowCaster mesh = casters[group[0]];
      mesh.world_from_object = {};
      References references(std::span(&mesh, 1));
      if (references.all.end == 0) continue;
      const std::size_t triangles = references.all.end;
      const std::uint32_t root = append_tree({&mesh, 1}, std::move(references), tree);
      for (const std::uint32_t c : group) {
        const auto [placement, box] = place(casters[c], c, tree, root);
        if (!is_within(box, max_placed)) continue;
        boxes.add(box, placements_.size());
        placements_.push_back(placement);
        triangles_ += triangles;
        expanded[c].index = {};
      }
    }
    References references(expanded);
    const BuildBox all = references.all.box();
    triangles_ += references.all.end;
    const bool has_triangles = references.all.end > 0;
    if (has_triangles) root_ = append_tree(expanded, std::move(references), tree);
    if (!placements_.empty()) {
      const std::uint32_t of_triangles = root_, stand_in = BvhNode::placement + number(placements_.size());
      if (has_triangles) boxes.add(all, placements_.size());
      root_ = append_tree({}, std::move(boxes), tree);
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
