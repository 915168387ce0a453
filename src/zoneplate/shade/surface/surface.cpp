// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "zoneplate/math/elementary.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/shade/shadow/receivers.h"
#include "zoneplate/shade/surface/brightness.h"
#include "zoneplate/shade/surface/corners.h"
#include "zoneplate/shade/surface/geometry_lanes.h"
#include "zoneplate/shade/surface/layered_plan.h"
#include "zoneplate/shade/surface/lighting.h"
#include "zoneplate/shade/surface/material_plan.h"
#include "zoneplate/shade/surface/shading.h"
#include "zoneplate/shade/surface/vertices.h"
#include "zoneplate/shade/texture/area_filters.h"
#include "zoneplate/shade/texture/filtering.h"
#include "zoneplate/shade/texture/solid_texture.h"
#include "zoneplate/shade/texture/texture_view.h"

namespace zoneplate {
namespace {

Viewpoint make_viewpoint(const ViewUniforms& s) {
  const float3 back = normalize(-s.view_direction, {0, 0, 1});
  Viewpoint v{{s.eye.x, s.eye.y, s.eye.z}, {back.x, back.y, back.z}, s.is_orthographic, s.rays.has_value()};
  if (!s.rays) return v;
  const auto store = [](float3 from, float(&to)[3]) { to[0] = from.x, to[1] = from.y, to[2] = from.z; };
  store(s.rays->first, v.ray), store(s.rays->dx, v.ray_dx), store(s.rays->dy, v.ray_dy);
  return v;
}

std::vector<PreparedLight> prepare_all(const std::vector<Light>& lights) {
  std::vector<PreparedLight> prepared;
  for (const Light& light : lights) prepared.push_back(prepare(light));
  return prepared;
}

bool has_traced_occlusion(const ViewUniforms& view) {
  return view.visibility != nullptr && view.visibility->has_occlusion();
}

/// The constants of a material under the scene's lights; `lights` and `view` must outlive them.
ShadingUniforms make_shading_uniforms(const MaterialPlan& plan, const std::vector<PreparedLight>& lights,
                                      const Viewpoint& viewpoint, const ViewUniforms& view) {
  const auto copy = [](const float(&from)[3], float(&to)[3]) { std::copy_n(from, 3, to); };
  ShadingUniforms s;
  s.light = lights.data(), s.lights = static_cast<int>(lights.size());
  s.viewpoint = viewpoint, s.needs_viewer = plan.needs_viewer;
  s.has_occlusion = plan.slot(TextureSlotIndex::Occlusion).texture != nullptr || has_traced_occlusion(view);
  s.has_emissive_texture = plan.slot(TextureSlotIndex::Emissive).texture != nullptr || plan.has_own_ambient;
  s.has_emissive = plan.has_emissive || plan.has_own_ambient;
  s.has_bare_meshes = plan.has_bare_meshes, s.is_blended = plan.alpha_mode == AlphaMode::Blend;
  copy(plan.emissive_factor, s.emissive);
  s.has_specular = plan.has_specular, s.is_phong = plan.model == ShadingModel::Phong;
  s.has_specular_texture = plan.has_specular && plan.slot(TextureSlotIndex::Specular).texture != nullptr;
  s.has_exponent_texture = plan.has_specular && plan.slot(TextureSlotIndex::Exponent).texture != nullptr;
  copy(plan.ambient_factor, s.ambient), copy(plan.specular, s.specular);
  s.exponent = plan.exponent;
  s.has_material_texture = plan.slot(TextureSlotIndex::MetallicRoughness).texture != nullptr || plan.widens();
  s.metallic = plan.metallic, s.roughness = plan.roughness;
  s.backdrop = view.backdrop ? &*view.backdrop : nullptr;
  s.has_pixels = view.shading_frequency == ShadingFrequency::Fragment;
  const float3 environment = view.environment;
  s.map = view.map ? &*view.map : nullptr;
  s.has_environment = environment.x > 0 || environment.y > 0 || environment.z > 0;
  s.environment[0] = environment.x, s.environment[1] = environment.y, s.environment[2] = environment.z;
  return s;
}

}  // namespace

struct SurfaceShader::Data {
  Data(const Scene& scene_in, const ViewUniforms& view_in, const TextureSet& textures_in,
       const InterleavedVertices& records_in)
      : scene(scene_in),
        view(view_in),
        records(records_in),
        plans(make_plans(scene_in, view_in, textures_in)),
        transforms(make_instance_transforms(scene_in.instances)),
        lights(prepare_all(view_in.lights)),
        viewpoint(make_viewpoint(view_in)),
        kernels(SurfaceKernels::of()),
        filtering(FilteringKernels::of()),
        solid(SolidTextureKernels::of()) {
    for (std::size_t m = 0; m < plans.size(); ++m) {
      shading_uniforms.push_back(make_shading_uniforms(plans[m], lights, viewpoint, view));
      needs_of_color.push_back(make_needs(static_cast<int>(m), plans[m].attributes, plans[m].needs_viewer));
    }
  }

  /// The vertex attributes that fragments need, and their interpolation.
  struct Needs {
    Attributes attributes;
    Interpolation interpolation;
  };

  /// The direction to the viewer may require the fragments' positions.
  Needs make_needs(int material, Attributes attributes, bool needs_viewer) const {
    if (needs_viewer && !viewpoint.is_orthographic && !viewpoint.has_rays) attributes.position = true;
    return {attributes, interpolation(records.layout(material), attributes)};
  }

  const Scene& scene;
  const ViewUniforms view;
  const InterleavedVertices& records;
  const std::vector<MaterialPlan> plans;
  const std::vector<InstanceTransform> transforms;
  const std::vector<PreparedLight> lights;
  const Viewpoint viewpoint;
  const SurfaceKernels& kernels;
  const FilteringKernels& filtering;
  const SolidTextureKernels& solid;
  std::vector<ShadingUniforms> shading_uniforms;  ///< by material
  std::vector<Needs> needs_of_color;              ///< by material

  struct BatchShading;
};

/// One batch between the stages of its material's plan.
struct SurfaceShader::Data::BatchShading {
  const Data& d;
  const MaterialPlan& plan;
  const FragmentBatch& batch;
  const SurfaceKernels& kernels = d.kernels;
  ShadingState p;
  TriangleVertices vertices;
  Coordinates coordinates;
  Taps taps;
  const TextureSlot* taps_of = nullptr;  ///< the slot whose texture look-up made `taps`
  std::unique_ptr<float[]> random;       ///< for stochastic filtering: three numbers of each fragment
  std::unique_ptr<float[]> light_visibility;
  LayerState q;
  bool is_corner = false;  ///< a corner of a triangle, whose fragments sample the textures of the base colour
  alignas(64) float texel_values[4][FragmentBatch::padded_capacity];
  float* const texel[4] = {texel_values[0], texel_values[1], texel_values[2], texel_values[3]};

  BatchShading(const Data& data, const FragmentBatch& of)
      : d(data), plan(data.plans[static_cast<std::size_t>(of.material)]), batch(of) {
    p.count = batch.padded();
  }

  void interpolate(const Needs& needs);
  Footprint footprint(const TextureSlot& slot);
  void find_random();
  void sample(const TextureSlot& slot, float* const out[4]);
  void sample(const TextureSlot& slot, Footprint at, float* const out[4]);
  void displace_coordinates();
  void tilt_normals();
  void widen_roughness();
  void shade_color(FragmentOutputs& out);
  void find_base();
  void apply_solid_texture();
  void find_normals();
  void find_emissive();
  void add_own_ambient();
  void find_occlusion();
  void find_metallic();
  void find_visibility();
  void find_highlight();
  void find_thickness();
  void light_layered(FragmentOutputs& out);
  void light(FragmentOutputs& out);

 private:
  void find_normals(const TextureSlot& normal_map, float scale);
  void find_coat_normals();
  void flatten_normals();
};

/// From vertices to fragments: positions and tangents in world space, normals in the mesh's space.
void SurfaceShader::Data::BatchShading::interpolate(const Needs& needs) {
  const Attributes& attributes = needs.attributes;
  find_vertex_records(d.records, batch, vertices);
  if (needs.interpolation.quads > 0) kernels.interpolate(batch, vertices, needs.interpolation, p);
  if (attributes.object_position)
    for (int c = 0; c < 3; ++c) std::copy_n(p.position[c], p.count, p.object_position[c]);
  if (attributes.position) kernels.transform_positions(batch, vertices, d.transforms.data(), p);
  if (!attributes.tangent) return;
  if (plan.has_meshes_without_tangents) make_missing_tangents(d.scene, batch, attributes.tangent_uv_set, p);
  kernels.transform_tangents(batch, vertices, d.transforms.data(), p);
}

/// The coordinates at which a slot's texture is looked up.
Footprint SurfaceShader::Data::BatchShading::footprint(const TextureSlot& slot) {
  const auto s = slot.uv_set;
  if (!slot.is_mapped) {
    return {p.uv[s][0],
            p.uv[s][1],
            p.uv_dx[s][0],
            p.uv_dx[s][1],
            p.uv_dy[s][0],
            p.uv_dy[s][1],
            batch.has_uniform_derivatives};
  }
  kernels.map_coordinates(slot.map, batch, p, s, coordinates);
  const Coordinates& c = coordinates;
  return {c.uv[0], c.uv[1], c.dx[0], c.dx[1], c.dy[0], c.dy[1], batch.has_uniform_derivatives};
}

/// The random numbers of a fragment depend on its position, in 1/256 pixel: all textures of a fragment share them, and
/// the samples of a pixel, or frames whose samples move, have others.
void SurfaceShader::Data::BatchShading::find_random() {
  random = std::make_unique<float[]>(3 * FragmentBatch::padded_capacity);
  for (int i = 0; i < p.count; ++i) {
    const std::uint32_t key = hash(static_cast<std::uint32_t>(batch.x[i]), static_cast<std::uint32_t>(batch.y[i]));
    for (std::uint32_t n = 0; n < 3; ++n)
      random[n * FragmentBatch::padded_capacity + static_cast<std::size_t>(i)] = unit_float(hash(key, n));
  }
}

/// Samples the slot's texture at the fragments. Slots with the same size and sampler share their taps.
void SurfaceShader::Data::BatchShading::sample(const TextureSlot& slot, float* const out[4]) {
  const bool has_taps = slot.filtering.kind == TextureFilter::Kind::BySampler && slot.filtering.anisotropy == 1;
  if (!has_taps || taps_of == nullptr || !share_taps(*taps_of, slot)) return sample(slot, footprint(slot), out);
  d.filtering.mix_taps(slot.texture->view(), taps, out, p.count);
}

/// Samples the slot's texture at these coordinates.
void SurfaceShader::Data::BatchShading::sample(const TextureSlot& slot, Footprint at, float* const out[4]) {
  if (slot.filtering.kind != TextureFilter::Kind::BySampler) {
    if (slot.filtering.kind == TextureFilter::Kind::Stochastic) {
      if (random == nullptr) find_random();
      for (int n = 0; n < 3; ++n) at.random[n] = random.get() + n * FragmentBatch::padded_capacity;
    }
    return sample_area(*slot.texture, slot.filtering, at, out, p.count);
  }
  if (slot.filtering.anisotropy > 1)
    return d.filtering.sample_anisotropic(slot.texture->view(), slot.filtering, at, out, p.count);
  d.filtering.find_taps(slot.texture->view(), slot.filtering, at, taps, p.count);
  taps_of = &slot;
  d.filtering.mix_taps(slot.texture->view(), taps, out, p.count);
}

/// base = factor × texture × vertex colour.
void SurfaceShader::Data::BatchShading::find_base() {
  const bool is_textured = !is_corner && plan.slot(TextureSlotIndex::BaseColor).texture != nullptr;
  float* const base[4] = {p.base[0], p.base[1], p.base[2], p.base[3]};
  if (is_textured) sample(plan.slot(TextureSlotIndex::BaseColor), base);
  for (int c = 0; c < 4; ++c) {
    if (!is_textured) {
      kernels.fill(p.base[c], plan.factor[c], p.count);
    } else if (plan.factor[c] != 1) {
      kernels.scale(p.base[c], p.base[c], plan.factor[c], 0, p.count);
    }
    if (plan.attributes.color) kernels.multiply(p.base[c], p.color[c], p.count);
  }
  // The alpha of a texture lies in [0, 1] already.
  const bool may_leave = plan.attributes.color || !(plan.factor[3] >= 0 && plan.factor[3] <= 1);
  if (plan.alpha_mode != AlphaMode::Opaque && may_leave) kernels.saturate(p.base[3], p.count);
}

/// Multiplies the base colour by the solid texture at the fragments' positions in object space.
void SurfaceShader::Data::BatchShading::apply_solid_texture() {
  SolidPoints points;
  for (int c = 0; c < 3; ++c) {
    stages::fill_repeated(batch, p.count, p.object_dx[c]);
    stages::fill_repeated(batch, p.count, p.object_dy[c]);
    points.position[c] = p.object_position[c];
    points.dx[c] = p.object_dx[c], points.dy[c] = p.object_dy[c];
  }
  d.solid.evaluate(plan.solid_texture, points, texel, p.count);
  for (int c = 0; c < 3; ++c) kernels.multiply(p.base[c], texel[c], p.count);
}

void SurfaceShader::Data::BatchShading::find_normals(const TextureSlot& normal_map, float scale) {
  if (normal_map.texture == nullptr) return kernels.find_normals(batch, vertices, d.transforms.data(), p);
  kernels.transform_normals(batch, vertices, d.transforms.data(), p);
  sample(normal_map, texel);
  kernels.bend_normals(batch, texel, scale, p);
}

/// The clear coat has its own normal map, or none. The interpolated normals stay in `p` for the surface's own.
void SurfaceShader::Data::BatchShading::find_coat_normals() {
  alignas(64) ShadingState::Array interpolated[3];
  const auto copy = [&](const float* from, float* to) { std::copy_n(from, p.count, to); };
  for (int c = 0; c < 3; ++c) copy(p.normal[c], interpolated[c]);
  find_normals(plan.layers->slot(LayerSlotIndex::ClearcoatNormal), plan.layers->layers.clearcoat_normal_scale);
  for (int c = 0; c < 3; ++c) copy(p.normal[c], q.clearcoat_normal[c]), copy(interpolated[c], p.normal[c]);
}

/// The normals of the triangles' planes, in the mesh's space; those of lines and points stay.
void SurfaceShader::Data::BatchShading::flatten_normals() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(p.count); ++i) {
    float3 corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const float* const record =
          vertices.first != nullptr ? vertices.first + vertices.stride * batch.vertex[k][i] : vertices.record[k][i];
      corner[k] = {record[3], record[4], record[5]};
    }
    const float3 normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
    // Of any scale: the normals of tiny and huge triangles stay in range.
    const float greatest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    if (!(greatest > 0 && greatest <= std::numeric_limits<float>::max())) continue;
    p.normal[0][i] = normal.x / greatest, p.normal[1][i] = normal.y / greatest, p.normal[2][i] = normal.z / greatest;
  }
}

void SurfaceShader::Data::BatchShading::find_normals() {
  if (is_corner && d.view.shading_frequency == ShadingFrequency::Triangle) flatten_normals();
  if (plan.widens_by_curvature && !is_corner) kernels.find_normal_variance(batch, vertices, d.transforms.data(), p);
  if (plan.layers != nullptr && plan.layers->uniforms.has_clearcoat) find_coat_normals();
  find_normals(plan.slot(TextureSlotIndex::Normal), plan.normal_scale);
  if (plan.has_bumps) tilt_normals();
}

/// Central differences of the heights over a texel of the mip level that is read on each side. The heights' filter
/// makes them the gradient of a surface without detail below a pixel.
void SurfaceShader::Data::BatchShading::tilt_normals() {
  struct Scratch {
    SurfaceGradients surface;
    alignas(64) ShadingState::Array level, ratio, shifted, low, unused[3], gradient[3];
  };
  const auto scratch = std::make_unique<Scratch>();
  const TextureSlot& slot = plan.slot(TextureSlotIndex::Height);
  const TextureView& heights = slot.texture->view();
  find_surface_gradients(d.scene, batch, slot.uv_set, scratch->surface);
  const Footprint at = footprint(slot);
  measure_footprints(heights, at, scratch->level, scratch->ratio, p.count);
  for (auto& axis : scratch->gradient) std::fill_n(axis, p.count, 0.0f);
  for (int axis = 0; axis < 2; ++axis) {
    const float* const coordinate = axis == 0 ? at.u : at.v;
    const float spacing = 1 / static_cast<float>(axis == 0 ? heights.width[0] : heights.height[0]);
    const auto step = [&](int i) { return spacing * exp2(std::max(scratch->level[i], 0.0f)); };
    const auto heights_at = [&](float sign, float* out) {
      for (int i = 0; i < p.count; ++i) scratch->shifted[i] = coordinate[i] + sign * step(i);
      Footprint moved = at;
      (axis == 0 ? moved.u : moved.v) = scratch->shifted;
      float* const channels[4] = {out, scratch->unused[0], scratch->unused[1], scratch->unused[2]};
      sample(slot, moved, channels);
    };
    heights_at(-1, scratch->low), heights_at(1, texel_values[0]);
    for (int i = 0; i < p.count; ++i) {
      const float slope = plan.height_scale * (texel_values[0][i] - scratch->low[i]) / (2 * step(i));
      const float along_u = slope * slot.map.m[3 * axis], along_v = slope * slot.map.m[3 * axis + 1];
      for (int c = 0; c < 3; ++c)
        scratch->gradient[c][i] += along_u * scratch->surface.u[c][i] + along_v * scratch->surface.v[c][i];
    }
  }
  taps_of = nullptr;
  const float* const gradient[3] = {scratch->gradient[0], scratch->gradient[1], scratch->gradient[2]};
  kernels.tilt_normals(batch, gradient, p);
}

/// Moves the texture coordinates to where the ray to the viewer meets the heights: the first of equally deep layers
/// below the heights, and from there back to where a line between both layers meets them.
/// Source    Policarpo et al. 2005, Tatarchuk, Dynamic Parallax Occlusion Mapping, I3D 2006.
void SurfaceShader::Data::BatchShading::displace_coordinates() {
  struct Scratch {
    SurfaceGradients surface;
    alignas(64) ShadingState::Array start[2], slope[2], above, depth, unused[3];
    bool is_found[FragmentBatch::padded_capacity] = {};
  };
  constexpr float least_cosine = 0.05f;  // of the angle at which a ray enters: beyond, it runs along the layers
  const auto scratch = std::make_unique<Scratch>();
  Scratch& s = *scratch;
  const TextureSlot& slot = plan.slot(TextureSlotIndex::Height);
  float *const u = p.uv[slot.uv_set][0], *const v = p.uv[slot.uv_set][1];
  find_surface_gradients(d.scene, batch, slot.uv_set, s.surface);
  const stages::Viewer<scalar::Float> viewer(d.viewpoint);
  for (int i = 0; i < p.count; ++i) {
    const auto at = [&](const float(&of)[3][FragmentBatch::padded_capacity]) {
      return Vector<scalar::Float>{of[0][i], of[1][i], of[2][i]};
    };
    const auto to_viewer = viewer.direction(batch, p, i);
    const float into = -1 / std::max(dot(to_viewer, at(s.surface.normal)).v, least_cosine);
    s.slope[0][i] = into * dot(to_viewer, at(s.surface.u)).v, s.slope[1][i] = into * dot(to_viewer, at(s.surface.v)).v;
    s.start[0][i] = u[i], s.start[1][i] = v[i], s.above[i] = s.depth[i] = 0;
  }
  const int layers = plan.parallax_layers;
  const float scale = std::abs(plan.height_scale), layer = scale / static_cast<float>(layers);
  for (int n = 0; n <= layers; ++n) {
    const float depth = layer * static_cast<float>(n);
    for (int i = 0; i < p.count; ++i)
      u[i] = s.start[0][i] + depth * s.slope[0][i], v[i] = s.start[1][i] + depth * s.slope[1][i];
    float* const channels[4] = {texel_values[0], s.unused[0], s.unused[1], s.unused[2]};
    sample(slot, footprint(slot), channels);
    bool are_all_found = true;
    for (int i = 0; i < p.count; ++i) {
      if (s.is_found[i]) continue;
      // How far the heights lie below the layer; `above` is that of the layer before.
      const float below = (1 - texel_values[0][i]) * scale - depth;
      if (below <= 0) {
        s.is_found[i] = true;
        const float change = s.above[i] - below;
        s.depth[i] = n == 0 ? 0.0f : depth - layer * (change > 0 ? -below / change : 0.0f);
      } else {
        s.above[i] = below, s.depth[i] = depth;
        are_all_found = false;
      }
    }
    if (are_all_found) break;
  }
  for (int i = 0; i < p.count; ++i) {
    u[i] = s.start[0][i] + s.depth[i] * s.slope[0][i];
    v[i] = s.start[1][i] + s.depth[i] * s.slope[1][i];
  }
  taps_of = nullptr;
}

/// Adds the variance of the normals that the pixel covers to the roughness.
void SurfaceShader::Data::BatchShading::widen_roughness() {
  if (plan.layers == nullptr && plan.slot(TextureSlotIndex::MetallicRoughness).texture == nullptr) {
    kernels.fill(p.roughness, plan.roughness, p.count);
    kernels.fill(p.metallic, plan.metallic, p.count);
  }
  if (!plan.widens_by_curvature || is_corner) kernels.fill(p.normal_variance, 0, p.count);
  if (plan.normal_spread != nullptr) {
    const TextureSlot& slot = plan.slot(TextureSlotIndex::Normal);
    SamplerState sampler = slot.filtering;
    if (sampler.kind != TextureFilter::Kind::BySampler)
      sampler.kind = TextureFilter::Kind::BySampler, sampler.anisotropy = 1;
    if (sampler.anisotropy > 1) {
      d.filtering.sample_anisotropic(*plan.normal_spread, sampler, footprint(slot), texel, p.count);
    } else {
      d.filtering.find_taps(*plan.normal_spread, sampler, footprint(slot), taps, p.count);
      d.filtering.mix_taps(*plan.normal_spread, taps, texel, p.count);
      taps_of = nullptr;
    }
    const float scale2 = plan.normal_scale * plan.normal_scale;
    for (int i = 0; i < p.count; ++i) {
      const float toksvig = 2 * (1 - texel_values[0][i]) / std::max(texel_values[0][i], 0x1p-10f);
      p.normal_variance[i] += scale2 * (plan.has_slope_variance ? texel_values[1][i] : toksvig);
    }
  }
  kernels.widen_roughness(p);
}

void SurfaceShader::Data::BatchShading::find_emissive() {
  if (plan.slot(TextureSlotIndex::Emissive).texture == nullptr) return;
  sample(plan.slot(TextureSlotIndex::Emissive), texel);
  for (int c = 0; c < 3; ++c) kernels.scale(p.emissive[c], texel[c], plan.emissive_factor[c], 0, p.count);
}

/// Adds the ambient term of channels whose base colour factor is too small to divide by: it counts as emission.
void SurfaceShader::Data::BatchShading::add_own_ambient() {
  if (!plan.has_own_ambient) return;
  const bool is_textured = !is_corner && plan.slot(TextureSlotIndex::BaseColor).texture != nullptr,
             is_occluded = d.shading_uniforms[static_cast<std::size_t>(batch.material)].has_occlusion;
  if (is_textured) sample(plan.slot(TextureSlotIndex::BaseColor), texel);
  for (int c = 0; c < 3; ++c) {
    if (plan.slot(TextureSlotIndex::Emissive).texture == nullptr)
      kernels.fill(p.emissive[c], plan.emissive_factor[c], p.count);
    if (is_textured)
      kernels.scale(texel[c], texel[c], plan.own_ambient[c], 0, p.count);
    else
      kernels.fill(texel[c], plan.own_ambient[c], p.count);
    if (plan.attributes.color) kernels.multiply(texel[c], p.color[c], p.count);
    if (is_occluded) kernels.multiply(texel[c], p.occlusion, p.count);
    for (int i = 0; i < p.count; ++i) p.emissive[c][i] += texel[c][i];
  }
}

/// occlusion = 1 + strength (texture - 1).
void SurfaceShader::Data::BatchShading::find_occlusion() {
  if (plan.slot(TextureSlotIndex::Occlusion).texture == nullptr) return;
  sample(plan.slot(TextureSlotIndex::Occlusion), texel);
  kernels.scale(p.occlusion, texel[0], plan.occlusion_strength, 1 - plan.occlusion_strength, p.count);
}

void SurfaceShader::Data::BatchShading::find_metallic() {
  if (plan.slot(TextureSlotIndex::MetallicRoughness).texture == nullptr) return;
  sample(plan.slot(TextureSlotIndex::MetallicRoughness), texel);
  kernels.scale(p.roughness, texel[1], plan.roughness, 0, p.count);
  kernels.scale(p.metallic, texel[2], plan.metallic, 0, p.count);
}

/// The part of each light, and of the environment, that reaches the fragments.
void SurfaceShader::Data::BatchShading::find_visibility() {
  const LightVisibility& visibility = *d.view.visibility;
  Receivers receivers;
  const auto record = [this](std::size_t k, std::size_t i) {
    return vertices.first != nullptr ? vertices.first + vertices.stride * batch.vertex[k][i] : vertices.record[k][i];
  };
  const float(&towards)[3] = d.viewpoint.towards;
  make_receivers(d.scene, batch, record, {d.view.eye, {towards[0], towards[1], towards[2]}, d.view.is_orthographic},
                 visibility.needs_footprint(), receivers);
  receivers.is_transmissive = plan.layers != nullptr && (plan.layers->uniforms.has_transmission ||
                                                         plan.layers->uniforms.has_diffuse_transmission);
  constexpr std::size_t stride = FragmentBatch::padded_capacity;
  light_visibility = std::make_unique<float[]>(d.lights.size() * stride);
  for (std::size_t k = 0; k < d.lights.size(); ++k)
    visibility.of_light(static_cast<int>(k), receivers, &light_visibility[k * stride]);
  if (!d.lights.empty()) p.light_visibility = light_visibility.get();
  if (!visibility.has_occlusion()) return;
  visibility.of_environment(receivers, texel[0]);
  if (plan.slot(TextureSlotIndex::Occlusion).texture == nullptr)
    std::copy_n(texel[0], p.count, p.occlusion);
  else
    kernels.multiply(p.occlusion, texel[0], p.count);
}

/// specular = factor × texture, exponent = factor × texture, at least 1.
void SurfaceShader::Data::BatchShading::find_highlight() {
  if (!plan.has_specular) return;
  if (plan.slot(TextureSlotIndex::Specular).texture != nullptr) {
    sample(plan.slot(TextureSlotIndex::Specular), texel);
    for (int c = 0; c < 3; ++c) kernels.scale(p.specular[c], texel[c], plan.specular[c], 0, p.count);
  }
  if (plan.slot(TextureSlotIndex::Exponent).texture == nullptr) return;
  sample(plan.slot(TextureSlotIndex::Exponent), texel);
  for (int i = 0; i < p.count; ++i) p.exponent[i] = std::max(texel[0][i] * plan.exponent.value, 1.0f);
}

/// The thickness of the volume in the world: scaled as its instance is.
void SurfaceShader::Data::BatchShading::find_thickness() {
  for (std::size_t i = 0; i < static_cast<std::size_t>(p.count); ++i) {
    const std::size_t group = i / FragmentBatch::group;
    const std::size_t at = vertices.one_instance[group] ? batch.leader(group * FragmentBatch::group) : i;
    q.thickness[i] *= d.transforms[batch.instance[at]].scale;
  }
}

void SurfaceShader::Data::BatchShading::light_layered(FragmentOutputs& out) {
  const LayeredPlan& layered = *plan.layers;
  const auto values = [&](const TextureSlot& slot) {
    sample(slot, texel);
    return texel;
  };
  find_layers(layered, kernels, p.count, values, q);
  if (layered.uniforms.has_volume) find_thickness();
  if (plan.slot(TextureSlotIndex::MetallicRoughness).texture == nullptr) {
    kernels.fill(p.metallic, plan.metallic, p.count);
    kernels.fill(p.roughness, plan.roughness, p.count);
  }
  if (const std::optional<float> glossiness = layered.layers.glossiness) {
    const bool is_textured = layered.has(LayerSlotIndex::SpecularColor);
    if (is_textured)
      kernels.scale(p.roughness, values(layered.slot(LayerSlotIndex::SpecularColor))[3], -*glossiness, 1, p.count);
    else
      kernels.fill(p.roughness, 1 - *glossiness, p.count);
  }
  if (plan.widens()) widen_roughness();
  kernels.light_layered(d.shading_uniforms[static_cast<std::size_t>(batch.material)], layered.uniforms, batch, p, q,
                        out);
}

/// From base colour and normal to the fragment's colour.
void SurfaceShader::Data::BatchShading::light(FragmentOutputs& out) {
  find_occlusion();
  if (d.view.visibility != nullptr) find_visibility();
  find_emissive();
  add_own_ambient();
  if (plan.has_bare_meshes) mark_lit(d.scene, batch, p.is_lit);
  const bool is_metallic = plan.model == ShadingModel::MetallicRoughness;
  if (is_metallic) find_metallic();
  if (plan.layers != nullptr) return light_layered(out);
  if (is_metallic && plan.widens()) widen_roughness();

  const ShadingUniforms& uniforms = d.shading_uniforms[static_cast<std::size_t>(batch.material)];
  if (is_metallic && uniforms.map != nullptr) {
    kernels.light_metallic_in_map(uniforms, batch, p, out);
  } else if (is_metallic) {
    kernels.light_metallic(uniforms, batch, p, out);
  } else {
    find_highlight();
    kernels.light_phong(uniforms, batch, p, out);
  }
}

void SurfaceShader::Data::BatchShading::shade_color(FragmentOutputs& out) {
  interpolate(d.needs_of_color[static_cast<std::size_t>(batch.material)]);
  find_base();
  if (plan.attributes.normal) find_normals();
  light(out);
}

SurfaceShader::SurfaceShader(const Scene& scene, const ViewUniforms& view, const TextureSet& textures,
                             const InterleavedVertices& records)
    : data_(std::make_unique<Data>(scene, view, textures, records)),
      brightest_(brightest_fragment(data_->plans, data_->lights, view.environment)) {}

SurfaceShader::~SurfaceShader() = default;

void SurfaceShader::shade(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const {
  if (batch.count == 0) return;
  const bool is_lit = data_->plans[static_cast<std::size_t>(batch.material)].is_lit;
  if (data_->view.shading_frequency == ShadingFrequency::Fragment || !is_lit || !outputs.color)
    return shade_fragments(batch, outputs, out);
  shade_triangles(batch, out);
  outputs.color = false;
  if (outputs.normal || outputs.uv || outputs.albedo || outputs.footprint) shade_fragments(batch, outputs, out);
}

/// Shades the triangles of a batch at their vertices or middles, interpolates their colours, and multiplies them by the
/// textures of the base colour.
void SurfaceShader::shade_triangles(const FragmentBatch& batch, FragmentOutputs& out) const {
  const bool is_flat = data_->view.shading_frequency == ShadingFrequency::Triangle;
  TriangleCorners corners(is_flat ? 1 : 3);
  FragmentOutputs colors;
  for (int begin = 0, end = 0; begin < batch.count; begin = end) {
    end = corners.collect(batch, begin);
    Data::BatchShading shading(*data_, corners.batch());
    shading.is_corner = true;
    shading.shade_color(colors);
    for (int i = begin; i < end; ++i) {
      out.r[i] = corners.at(batch, i, colors.r), out.g[i] = corners.at(batch, i, colors.g);
      out.b[i] = corners.at(batch, i, colors.b), out.a[i] = corners.at(batch, i, colors.a);
    }
  }
  Data::BatchShading whole(*data_, batch);
  const MaterialPlan& plan = whole.plan;
  const TextureSlot& slot = plan.slot(TextureSlotIndex::BaseColor);
  const bool is_textured = slot.texture != nullptr, is_solid = plan.attributes.object_position;
  if (!is_textured && !is_solid) return;
  Attributes attributes;
  attributes.uv[slot.uv_set] = is_textured, attributes.object_position = is_solid;
  whole.interpolate(data_->make_needs(batch.material, attributes, false));
  auto& color = whole.p.base;
  float* const channels[4] = {color[0], color[1], color[2], color[3]};
  if (is_textured)
    whole.sample(slot, channels);
  else
    for (float* const channel : channels) whole.kernels.fill(channel, 1, whole.p.count);
  if (is_solid) whole.apply_solid_texture();
  const bool is_blended = plan.alpha_mode == AlphaMode::Blend;
  for (int i = 0; i < batch.count; ++i) {
    const float alpha = is_blended ? color[3][i] : 1;
    out.r[i] *= color[0][i] * alpha, out.g[i] *= color[1][i] * alpha;
    out.b[i] *= color[2][i] * alpha, out.a[i] *= alpha;
  }
}

void SurfaceShader::shade_fragments(const FragmentBatch& batch, OutputMask outputs, FragmentOutputs& out) const {
  Data::BatchShading shading(*data_, batch);
  const MaterialPlan& plan = shading.plan;
  ShadingState& p = shading.p;

  // Data besides the colour may need more vertex attributes.
  const Data::Needs* needs = &data_->needs_of_color[static_cast<std::size_t>(batch.material)];
  Data::Needs more;
  const TextureSlot& base = plan.slot(TextureSlotIndex::BaseColor);
  const bool has_footprint = outputs.footprint && base.texture != nullptr;
  if (outputs.normal || outputs.uv || has_footprint) {
    Attributes attributes = plan.attributes;
    if (outputs.normal) attributes.normal = true;
    if (outputs.uv || has_footprint) attributes.uv[base.uv_set] = true;
    more = data_->make_needs(batch.material, attributes, plan.needs_viewer || (outputs.normal && plan.has_bare_meshes));
    needs = &more;
  }

  shading.interpolate(*needs);
  if (plan.parallax_layers > 0) shading.displace_coordinates();
  if (outputs.color || outputs.albedo) {
    shading.find_base();
    if (needs->attributes.object_position) shading.apply_solid_texture();
  }
  if (needs->attributes.normal) shading.find_normals();
  if (outputs.color && plan.is_lit)
    shading.light(out);
  else if (outputs.color)
    shading.kernels.unlit(plan.alpha_mode == AlphaMode::Blend, p, out);

  const auto copy = [&](const float* from, float* to) { std::copy_n(from, p.count, to); };
  if (outputs.normal) {
    if (plan.has_bare_meshes) shading.kernels.default_normals(data_->viewpoint, batch, p);
    for (int c = 0; c < 3; ++c) copy(p.normal[c], out.normal[c]);
  }
  if (outputs.albedo)
    for (int c = 0; c < 3; ++c) copy(p.base[c], out.albedo[c]);
  if (outputs.uv) {
    const Footprint at = shading.footprint(base);
    copy(at.u, out.uv[0]), copy(at.v, out.uv[1]);
  }
  if (has_footprint) {
    measure_footprints(base.texture->view(), shading.footprint(base), out.mip_level, out.anisotropy, p.count);
  } else if (outputs.footprint) {
    std::fill_n(out.mip_level, p.count, FragmentOutputs::no_mip_level);
    std::fill_n(out.anisotropy, p.count, 0.0f);
  }
}

bool SurfaceShader::needs_derivatives(int material) const {
  const Attributes& a = data_->plans[static_cast<std::size_t>(material)].attributes;
  const LightVisibility* const visibility = data_->view.visibility;
  return a.uv[0] || a.uv[1] || a.normal_change || a.object_position ||
         (visibility != nullptr && visibility->needs_footprint());
}

std::span<const float> SurfaceShader::vertex_record(std::uint32_t instance, int material) const {
  return {data_->records.of_instance(instance), static_cast<std::size_t>(data_->records.layout(material).floats)};
}

void SurfaceShader::alpha(const FragmentBatch& batch, float* out) const {
  if (batch.count == 0) return;
  Data::BatchShading shading(*data_, batch);
  Attributes attributes;
  attributes.color = shading.plan.attributes.color;
  if (shading.plan.slot(TextureSlotIndex::BaseColor).texture != nullptr)
    attributes.uv[shading.plan.slot(TextureSlotIndex::BaseColor).uv_set] = true;
  const bool is_displaced = shading.plan.parallax_layers > 0;
  if (is_displaced) attributes.uv[shading.plan.slot(TextureSlotIndex::Height).uv_set] = true;
  shading.interpolate(data_->make_needs(batch.material, attributes, is_displaced));
  if (is_displaced) shading.displace_coordinates();
  shading.find_base();
  std::copy_n(shading.p.base[3], shading.p.count, out);
}

}  // namespace zoneplate
