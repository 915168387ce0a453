// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/used_vertices.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/serial_ranges.h"

namespace zoneplate {
namespace {

constexpr std::size_t instances_per_range = 4096;
/// The number of vertices whose transformation costs as much as that of a box.
constexpr std::size_t few_vertices = 64;

/// An upper bound of dot(axis, transform_point(m, p)), computed in floats, for all points p of the box.
double max_along(const float4x4& m, const Box& box, float3 axis) {
  const std::array<double, 3> low{box.low.x, box.low.y, box.low.z}, high{box.high.x, box.high.y, box.high.z};
  double most = 0, magnitude = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const float4 c = m.column[i];
    const double along = double{axis.x} * c.x + double{axis.y} * c.y + double{axis.z} * c.z;
    const double amount =
        std::abs(double{axis.x} * c.x) + std::abs(double{axis.y} * c.y) + std::abs(double{axis.z} * c.z);
    most += i == 3 ? along : std::max(along * low[i], along * high[i]);
    magnitude += i == 3 ? amount : amount * std::max(std::abs(low[i]), std::abs(high[i]));
  }
  // At most eight terms are rounded successively to float, each with an error of 2^-24 of the sum of magnitudes.
  constexpr double rounding = 0x1p-20, least = 1e-36;
  return most + rounding * magnitude + least;
}

}  // namespace

std::span<const std::uint8_t> UsedVertices::of(int mesh) {
  const Mesh& m = scene_.meshes[static_cast<std::size_t>(mesh)];
  std::vector<std::uint8_t>& is_used = is_used_[static_cast<std::size_t>(mesh)];
  if (!is_used.empty() || m.position.empty()) return is_used;
  is_used.resize(m.position.size());
  constexpr std::size_t block = 1 << 16;
  // Several threads may mark the same vertex, with the same value.
  parallel_ranges(m.index.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) std::atomic_ref(is_used[m.index[i]]).store(1, std::memory_order_relaxed);
  });
  return is_used;
}

Box UsedVertices::bounds(const Instance& instance) {
  constexpr std::size_t block = 1 << 14;
  const std::vector<float3>& position = scene_.meshes[static_cast<std::size_t>(instance.mesh)].position;
  const std::span<const std::uint8_t> is_used = of(instance.mesh);
  std::vector<Box> part((position.size() + block - 1) / block);
  parallel_ranges(position.size(), block, [&](std::size_t begin, std::size_t end) {
    Box mine;
    for (std::size_t v = begin; v < end; ++v)
      if (is_used[v] != 0) mine.add(transform_point(instance.world_from_object, position[v]));
    part[begin / block] = mine;
  });
  Box all;
  for (const Box& box : part) all.add(box);
  return all;
}

Box UsedVertices::bounds() {
  constexpr std::array axes = {float3{1, 0, 0},  float3{0, 1, 0},  float3{0, 0, 1},
                               float3{-1, 0, 0}, float3{0, -1, 0}, float3{0, 0, -1}};
  Box all;
  for (const std::size_t i : reaching(axes)) all.add(bounds(scene_.instances[i]));
  return all;
}

const Box& UsedVertices::local(int mesh) {
  std::optional<Box>& box = local_[static_cast<std::size_t>(mesh)];
  if (!box) box = bounds({.mesh = mesh});
  return *box;
}

float UsedVertices::reach(const Instance& instance, float3 axis) {
  const std::vector<float3>& position = scene_.meshes[static_cast<std::size_t>(instance.mesh)].position;
  const std::span<const std::uint8_t> is_used = of(instance.mesh);
  float most = -std::numeric_limits<float>::infinity();
  serial_ranges(position.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (is_used[v] != 0) most = std::max(most, dot(axis, transform_point(instance.world_from_object, position[v])));
  });
  return most;
}

/// For each axis, the instance whose box has the greatest extent along it. Requires the boxes of all meshes.
std::vector<std::size_t> UsedVertices::farthest_by_box(std::span<const float3> axes) const {
  struct Best {
    double most = -std::numeric_limits<double>::infinity();
    std::size_t instance = 0;
  };
  const std::size_t count = scene_.instances.size(), ranges = (count + instances_per_range - 1) / instances_per_range;
  std::vector<Best> found(ranges * axes.size());
  parallel_ranges(count, instances_per_range, [&](std::size_t begin, std::size_t end) {
    Best* const best = &found[begin / instances_per_range * axes.size()];
    for (std::size_t i = begin; i < end; ++i) {
      const Instance& instance = scene_.instances[i];
      const Box& box = *local_[static_cast<std::size_t>(instance.mesh)];
      for (std::size_t a = 0; a < axes.size() && !box.empty(); ++a)
        if (const double most = max_along(instance.world_from_object, box, axes[a]); most > best[a].most)
          best[a] = {most, i};
    }
  });
  std::vector<std::size_t> out;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    Best best;
    for (std::size_t r = 0; r < ranges; ++r)
      if (found[r * axes.size() + a].most > best.most) best = found[r * axes.size() + a];
    out.push_back(best.instance);
  }
  return out;
}

std::vector<std::size_t> UsedVertices::reaching(std::span<const float3> axes) {
  const std::vector<Instance>& instances = scene_.instances;
  std::vector<std::size_t> out;
  const bool are_small = std::all_of(scene_.meshes.begin(), scene_.meshes.end(),
                                     [](const Mesh& m) { return m.position.size() <= few_vertices; });
  if (are_small || instances.size() <= 2 * scene_.meshes.size()) {
    for (std::size_t i = 0; i < instances.size(); ++i) out.push_back(i);
    return out;
  }
  for (const Instance& instance : instances) local(instance.mesh);
  std::vector<float> least;  // for each axis, the extent of some vertex
  const std::vector<std::size_t> farthest = farthest_by_box(axes);
  for (std::size_t a = 0; a < axes.size(); ++a) least.push_back(reach(instances[farthest[a]], axes[a]));

  const auto is_extreme = [&](std::size_t i) {
    const Instance& instance = instances[i];
    const auto mesh = static_cast<std::size_t>(instance.mesh);
    if (local_[mesh]->empty()) return false;
    if (i > 0 && instance.mesh == instances[i - 1].mesh &&
        instance.world_from_object == instances[i - 1].world_from_object)
      return false;
    if (scene_.meshes[mesh].position.size() <= few_vertices) return true;
    for (std::size_t a = 0; a < axes.size(); ++a)
      if (!(max_along(instance.world_from_object, *local_[mesh], axes[a]) < double{least[a]})) return true;
    return false;
  };
  serial_ranges(instances.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (is_extreme(i)) out.push_back(i);
  });
  return out;
}

}  // namespace zoneplate
