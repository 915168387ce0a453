#include "zoneplate/shade/surface.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "zoneplate/shade/fetch.h"
#include "zoneplate/shade/filtering.h"
#include "zoneplate/shade/lighting.h"
#include "zoneplate/shade/material_plan.h"
#include "zoneplate/shade/surface_kernels.h"

namespace zoneplate {
namespace {

Viewpoint make_viewpoint(const Surroundings& s) {
  const float3 back = normalize(-s.view_direction, {0, 0, 1});
  return {{s.eye.x, s.eye.y, s.eye.z}, {back.x, back.y, back.z}, s.is_orthographic};
}

std::vector<PreparedLight> prepare_all(const std::vector<Light>& lights) {
  std::vector<PreparedLight> prepared;
  for (const Light& light : lights) prepared.push_back(prepare(light));
  return prepared;
}

}  // namespace

struct SurfaceShader::Data {
  Data(const Scene& scene_in, const Surroundings& surroundings_in, const TextureSet* textures_in)
      : scene(scene_in),
        surroundings(surroundings_in),
        own_textures(textures_in ? nullptr : std::make_unique<TextureSet>(scene_in, surroundings_in.raw_colors)),
        plans(make_plans(scene_in, surroundings_in, textures_in ? *textures_in : *own_textures)),
        placements(make_placements(scene_in.instances)),
        lights(prepare_all(scene_in.lights)),
        viewpoint(make_viewpoint(surroundings_in)),
        kernels(pick(surroundings_in.isa, scalar::surface_kernels, N_SSE4::surface_kernels, N_AVX2::surface_kernels)),
        filtering(pick(surroundings_in.isa, scalar::filtering_kernels, N_SSE4::filtering_kernels,
                       N_AVX2::filtering_kernels)) {}

  const Scene& scene;
  const Surroundings surroundings;
  const std::unique_ptr<TextureSet> own_textures;
  const std::vector<MaterialPlan> plans;
  const std::vector<Placement> placements;
  const std::vector<PreparedLight> lights;
  const Viewpoint viewpoint;
  const SurfaceKernels& kernels;
  const FilteringKernels& filtering;

  struct Walk;
};

/// One batch on its way through the stages of its material's plan.
struct SurfaceShader::Data::Walk {
  const Data& d;
  const MaterialPlan& plan;
  const Batch& batch;
  const SurfaceKernels& kernels = d.kernels;
  Points p;
  Corners corners;
  Coordinates coordinates;
  Taps taps;
  const TextureSlot* taps_of = nullptr;  ///< the slot for which `taps` stands
  alignas(64) float texel_values[4][Points::capacity];
  float* const texel[4] = {texel_values[0], texel_values[1], texel_values[2], texel_values[3]};

  Walk(const Data& data, const Batch& of)
      : d(data), plan(data.plans[static_cast<std::size_t>(of.material)]), batch(of) {
    p.count = batch.padded();
  }

  void interpolate(const Attributes& attributes);
  Footprint footprint(const TextureSlot& slot);
  void sample(const TextureSlot& slot);
  void find_base();
  void find_normals(bool bends);
  void find_emissive();
  void find_occlusion();
  void light_phong();
  void light_metallic();
  void light();
};

/// Vertices to points in world space.
void SurfaceShader::Data::Walk::interpolate(const Attributes& attributes) {
  fetch_corners(d.scene, batch, attributes, corners);
  kernels.interpolate(batch, corners, interpolation(attributes, p), p.count);
  if (attributes.position) kernels.place_positions(batch, corners, d.placements.data(), p);
  if (attributes.normal) kernels.place_normals(batch, corners, d.placements.data(), p);
  if (attributes.tangent) kernels.place_tangents(batch, corners, d.placements.data(), p);
}

/// Where a slot's texture is looked up.
Footprint SurfaceShader::Data::Walk::footprint(const TextureSlot& slot) {
  const auto s = slot.uv_set;
  if (!slot.is_mapped) {
    return {p.uv[s][0], p.uv[s][1], p.uv_dx[s][0], p.uv_dx[s][1], p.uv_dy[s][0], p.uv_dy[s][1]};
  }
  kernels.map_coordinates(slot.map, p, s, coordinates);
  const Coordinates& c = coordinates;
  return {c.uv[0], c.uv[1], c.dx[0], c.dx[1], c.dy[0], c.dy[1]};
}

/// The slot's texture at the points, into `texel`. Slots of one size and one sampler share their taps.
void SurfaceShader::Data::Walk::sample(const TextureSlot& slot) {
  if (taps_of == nullptr || !share_taps(*taps_of, slot)) {
    d.filtering.find_taps(slot.texture->view(), slot.filtering, footprint(slot), taps, p.count);
    taps_of = &slot;
  }
  d.filtering.mix_taps(slot.texture->view(), taps, texel, p.count);
}

/// Factor × texture × vertex colour.
void SurfaceShader::Data::Walk::find_base() {
  const bool is_textured = plan.base_color.texture != nullptr;
  if (is_textured) sample(plan.base_color);
  for (int c = 0; c < 4; ++c) {
    if (is_textured) {
      kernels.scale(p.base[c], texel[c], plan.factor[c], 0, p.count);
    } else {
      kernels.fill(p.base[c], plan.factor[c], p.count);
    }
    if (plan.attributes.color) kernels.multiply(p.base[c], p.color[c], p.count);
  }
  kernels.saturate(p.base[3], p.count);
}

void SurfaceShader::Data::Walk::find_normals(bool bends) {
  if (bends) {
    sample(plan.normal);
    kernels.bend_normals(batch, texel, plan.normal_scale, p);
  } else {
    kernels.face_normals(batch, p);
  }
}

void SurfaceShader::Data::Walk::find_emissive() {
  if (plan.emissive.texture != nullptr) sample(plan.emissive);
  for (int c = 0; c < 3; ++c) {
    if (plan.emissive.texture != nullptr) {
      kernels.scale(p.emissive[c], texel[c], plan.emissive_factor[c], 0, p.count);
    } else {
      kernels.fill(p.emissive[c], plan.emissive_factor[c], p.count);
    }
  }
}

/// 1 + strength (texture - 1).
void SurfaceShader::Data::Walk::find_occlusion() {
  if (plan.occlusion.texture == nullptr) return kernels.fill(p.occlusion, 1, p.count);
  sample(plan.occlusion);
  kernels.scale(p.occlusion, texel[0], plan.occlusion_strength, 1 - plan.occlusion_strength, p.count);
}

void SurfaceShader::Data::Walk::light_phong() {
  for (int c = 0; c < 3; ++c) kernels.fill(p.diffuse[c], 0, p.count), kernels.fill(p.specular[c], 0, p.count);
  for (const PreparedLight& light : d.lights) {
    kernels.reach_light(light, p);
    if (!plan.has_specular) {
      kernels.add_lambert(light, p);
    } else if (plan.model == ShadingModel::Phong) {
      kernels.add_phong(light, plan.exponent, p);
    } else {
      kernels.add_blinn_phong(light, plan.exponent, p);
    }
  }
  kernels.combine_diffuse(plan.ambient, p);
  if (plan.has_specular) kernels.add_specular(plan.specular, p);
}

void SurfaceShader::Data::Walk::light_metallic() {
  if (plan.metallic_roughness.texture != nullptr) {
    sample(plan.metallic_roughness);
    kernels.scale(p.roughness, texel[1], plan.roughness, 0, p.count);
    kernels.scale(p.metallic, texel[2], plan.metallic, 0, p.count);
  } else {
    kernels.fill(p.roughness, plan.roughness, p.count);
    kernels.fill(p.metallic, plan.metallic, p.count);
  }
  for (int c = 0; c < 3; ++c) kernels.fill(p.sum[c], 0, p.count);
  for (const PreparedLight& light : d.lights) {
    kernels.reach_light(light, p);
    kernels.add_metallic(light, p);
  }
  const float3 e = d.surroundings.environment;
  const float environment[3] = {e.x, e.y, e.z};
  if (e.x > 0 || e.y > 0 || e.z > 0) kernels.add_environment(environment, p);
}

/// Base colour and normal to `sum`.
void SurfaceShader::Data::Walk::light() {
  find_occlusion();
  if (plan.model == ShadingModel::MetallicRoughness) {
    light_metallic();
  } else {
    light_phong();
  }
  if (plan.has_emissive) find_emissive(), kernels.add_emissive(p);
  if (plan.has_bare_meshes) mark_lit(d.scene, batch, p.is_lit), kernels.keep_unlit(p);
}

SurfaceShader::SurfaceShader(const Scene& scene, const Surroundings& surroundings, const TextureSet* textures)
    : data_(std::make_unique<Data>(scene, surroundings, textures)) {}

SurfaceShader::~SurfaceShader() = default;

void SurfaceShader::shade(const Batch& batch, Wanted wanted, Shaded& out) const {
  if (batch.count == 0) return;
  Data::Walk walk(*data_, batch);
  const MaterialPlan& plan = walk.plan;
  Points& p = walk.p;

  // What was asked for beside the colour may need more of the vertices.
  Attributes attributes = plan.attributes;
  const bool needs_viewer = plan.needs_viewer || (wanted.normal && plan.has_bare_meshes);
  if (wanted.normal) attributes.normal = true;
  if (needs_viewer && !data_->viewpoint.is_orthographic) attributes.position = true;
  if (wanted.uv) attributes.uv[plan.base_color.uv_set] = true;

  walk.interpolate(attributes);
  walk.find_base();
  if (needs_viewer) walk.kernels.look_back(data_->viewpoint, p);
  if (attributes.normal) walk.find_normals(plan.normal.texture != nullptr);
  if (plan.is_lit) walk.light();

  const Points::Array* color = plan.is_lit ? p.sum : p.base;
  const float* const channels[3] = {color[0], color[1], color[2]};
  walk.kernels.finish(channels, plan.alpha_mode == AlphaMode::Blend ? p.base[3] : nullptr, out, p.count);

  const auto copy = [&](const float* from, float* to) { std::copy_n(from, p.count, to); };
  if (wanted.normal) {
    if (plan.has_bare_meshes) walk.kernels.default_normals(p);
    for (int c = 0; c < 3; ++c) copy(p.normal[c], out.normal[c]);
  }
  if (wanted.albedo)
    for (int c = 0; c < 3; ++c) copy(p.base[c], out.albedo[c]);
  if (wanted.uv) {
    const Footprint at = walk.footprint(plan.base_color);
    copy(at.u, out.uv[0]), copy(at.v, out.uv[1]);
  }
}

void SurfaceShader::alpha(const Batch& batch, float* out) const {
  if (batch.count == 0) return;
  Data::Walk walk(*data_, batch);
  Attributes attributes;
  attributes.color = walk.plan.attributes.color;
  if (walk.plan.base_color.texture != nullptr) attributes.uv[walk.plan.base_color.uv_set] = true;
  walk.interpolate(attributes);
  walk.find_base();
  std::copy_n(walk.p.base[3], walk.p.count, out);
}

}  // namespace zoneplate
