#include "zoneplate/scene/used_vertices.h"

#include <atomic>

#include "zoneplate/base/parallel.h"

namespace zoneplate {

std::span<const std::uint8_t> UsedVertices::of(int mesh) {
  const Mesh& m = scene_.meshes[static_cast<std::size_t>(mesh)];
  std::vector<std::uint8_t>& is_used = is_used_[static_cast<std::size_t>(mesh)];
  if (!is_used.empty() || m.position.empty()) return is_used;
  is_used.resize(m.position.size());
  constexpr std::size_t block = 1 << 16;
  // Threads may mark the same vertex, with the same value.
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
  Box all;
  for (const Instance& instance : scene_.instances) all.add(bounds(instance));
  return all;
}

}  // namespace zoneplate
