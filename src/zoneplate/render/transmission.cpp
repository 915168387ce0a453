// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/transmission.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "zoneplate/render/environment_background.h"
#include "zoneplate/render/scene_fragments.h"
#include "zoneplate/shade/surface/layered_plan.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {
namespace {

/// How far a draw extends along the view direction.
struct DepthRange {
  float near = std::numeric_limits<float>::infinity(), far = -near;
};
DepthRange depth_range(const Scene& scene, const Draw& draw, const ViewUniforms& view) {
  DepthRange range;
  const Instance& instance = scene.instances[draw.instance];
  for (const float3& p : scene.meshes[static_cast<std::size_t>(instance.mesh)].position) {
    const float3 at = xyz(instance.world_from_object * float4{p.x, p.y, p.z, 1});
    const float depth = dot(at - view.eye, view.view_direction);
    range.near = std::min(range.near, depth), range.far = std::max(range.far, depth);
  }
  return range;
}

/// Transmissive draws that share an image of what is behind them.
struct Layer {
  DepthRange range;
  std::vector<Draw> draws;
};

/// Appends the draws of a layer that is nearer.
void join(Layer& layer, const Layer& nearer) {
  layer.range = {std::min(layer.range.near, nearer.range.near), std::max(layer.range.far, nearer.range.far)};
  layer.draws.insert(layer.draws.end(), nearer.draws.begin(), nearer.draws.end());
}

/// The layers of draws with the extents `ranges`, from back to front. Equal extents keep the order of the draws.
std::vector<Layer> layers_of(std::span<const Draw> draws, std::span<const DepthRange> ranges, std::size_t most) {
  std::vector<Layer> single;
  for (std::size_t i = 0; i < draws.size(); ++i) single.push_back({ranges[i], {draws[i]}});
  std::stable_sort(single.begin(), single.end(),
                   [](const Layer& a, const Layer& b) { return a.range.far > b.range.far; });
  std::vector<Layer> layers;
  for (const Layer& next : single) {
    if (!layers.empty() && next.range.far >= layers.back().range.near)
      join(layers.back(), next);
    else
      layers.push_back(next);
  }
  while (layers.size() > most) {
    const auto gap = [&](std::size_t i) { return layers[i].range.near - layers[i + 1].range.far; };
    std::size_t least = 0;
    for (std::size_t i = 1; i + 1 < layers.size(); ++i)
      if (gap(i) < gap(least)) least = i;
    join(layers[least], layers[least + 1]);
    layers.erase(layers.begin() + static_cast<std::ptrdiff_t>(least) + 1);
  }
  return layers;
}

}  // namespace

std::optional<Backdrop> make_backdrop(const PreparedScene& prepared, ViewUniforms view, std::span<const Draw> draws,
                                      const Ground* ground, const Camera& camera, const float4x4& clip_from_world,
                                      const RasterRules& rules, const RenderOptions& options, RasterMemory& memory) {
  const Scene& scene = prepared.scene();
  const std::vector<Material>& materials = scene.materials;
  const auto is_ground = [&](const Draw& draw) { return static_cast<std::size_t>(draw.material) == materials.size(); };
  const auto transmits = [&](const Draw& draw) {
    return !is_ground(draw) && is_transmissive(materials[static_cast<std::size_t>(draw.material)]);
  };
  const auto is_opaque = [&](const Draw& draw) {
    return is_ground(draw) || (draw.alpha_mode != AlphaMode::Blend && !transmits(draw));
  };
  if (std::ranges::none_of(draws, transmits)) return std::nullopt;

  std::vector<DepthRange> range(draws.size());  // of blended and transmissive draws
  std::vector<Draw> transmissive;
  std::vector<DepthRange> range_of_transmissive;
  for (std::size_t i = 0; i < draws.size(); ++i) {
    if (is_opaque(draws[i])) continue;
    range[i] = depth_range(scene, draws[i], view);
    if (!transmits(draws[i])) continue;
    transmissive.push_back(draws[i]);
    range_of_transmissive.push_back(range[i]);
  }
  // Texels are indexed by 31 bits; the levels of an image add less than its own size.
  const std::int64_t texels = 2 * std::int64_t{options.width} * options.height;
  const std::int64_t fitting = std::max(std::int64_t{1}, std::numeric_limits<std::int32_t>::max() / texels);
  const auto most = static_cast<std::size_t>(std::min<std::int64_t>(max_transmissive_layers, fitting));

  LinearImage image(options.width, options.height);
  Target target;
  target.viewport = {options.width, options.height};
  target.width = options.width, target.height = options.height;
  target.samples = standard_pattern(4);
  target.color = &image;

  std::optional<Backdrop> backdrop;
  std::vector<Draw> behind;
  for (const Layer& layer : layers_of(transmissive, range_of_transmissive, most)) {
    behind.clear();
    for (std::size_t i = 0; i < draws.size(); ++i) {
      const bool is_far = transmits(draws[i]) ? range[i].near > layer.range.far : range[i].near >= layer.range.far;
      if (is_opaque(draws[i]) || is_far) behind.push_back(draws[i]);
    }
    std::ranges::fill(image.values(), Linear{0, 0, 0, 0});
    rasterize(behind, SceneFragmentShader(prepared, view, ground), rules, target, &memory);
    if (options.background) {
      RenderOptions whole = options;
      whole.crop.reset();
      draw_environment(prepared.lighting().environment, scene.up, camera, whole, image);
    }
    if (!backdrop) {
      backdrop.emplace(image, clip_from_world);
    } else {
      std::vector<std::uint32_t> instances;
      for (const Draw& draw : layer.draws) instances.push_back(draw.instance);
      backdrop->add(image, instances, scene.instances.size());
    }
    view.backdrop = backdrop->view();
  }
  return backdrop;
}

}  // namespace zoneplate
