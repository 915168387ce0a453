// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/backend.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/raster/tile/rasterize.h"
#include "zoneplate/render/custom_draw.h"
#include "zoneplate/render/draw_list.h"
#include "zoneplate/render/edge_distances.h"
#include "zoneplate/render/frame_parts.h"
#include "zoneplate/render/geometry_fragments.h"
#include "zoneplate/render/motion.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/render/scene_fragments.h"
#include "zoneplate/render/scene_shadows.h"
#include "zoneplate/render/transmission.h"
#include "zoneplate/shade/cast/ground.h"
#include "zoneplate/shade/environment/prepared_environment.h"
#include "zoneplate/shade/surface/layered_plan.h"
#include "zoneplate/shade/surface/surface.h"
#include "zoneplate/signal/samples.h"

namespace zoneplate {
namespace {

/// Clip space looks x = m00 X + m02 Z, w = -Z: through the pixel's (x, y) goes the direction ((x + m02) / m00, ...,
/// -1).
PixelRays rays_of(const Camera& camera, const float4x4& clip_from_camera, const RenderOptions& options) {
  const float4x4& m = clip_from_camera;
  const float4x4& world = camera.world_from_camera;
  const float3 right = xyz(world.column[0]), up = xyz(world.column[1]), back = xyz(world.column[2]);
  const float tan_x = 1 / m.column[0].x, tan_y = 1 / m.column[1].y;
  const float3 first = back - right * ((m.column[2].x - 1) * tan_x) - up * ((m.column[2].y + 1) * tan_y);
  return {first, right * (-2 * tan_x / (256 * static_cast<float>(options.width))),
          up * (2 * tan_y / (256 * static_cast<float>(options.height)))};
}

ViewUniforms view_uniforms_of(const Lighting& lighting, float3 up, const Camera& camera,
                              const float4x4& clip_from_camera, const RenderOptions& options) {
  const float4x4& world_from_camera = camera.world_from_camera;
  ViewUniforms s;
  s.eye = xyz(world_from_camera.column[3]);
  s.view_direction = normalize(-xyz(world_from_camera.column[2]), {0, 0, -1});
  s.is_orthographic = camera.is_orthographic;
  s.shading_frequency = options.shading_frequency;
  const bool is_by_fragment = options.shading_frequency == ShadingFrequency::Fragment;
  if (!camera.is_orthographic && is_by_fragment) s.rays = rays_of(camera, clip_from_camera, options);
  for (const Light& light : lighting.lights) s.lights.push_back(in_world_space(light, world_from_camera));
  s.environment = lighting.environment.factor();
  if (const PreparedEnvironment* map = lighting.environment.map.get()) {
    s.map = map->view(lighting.environment, up, world_from_camera);
    s.environment = s.environment * map->greatest();
  }
  s.has_environment_behind = options.background.has_value();
  if (const DisplayOptions& display = options.display;
      !options.background && !display.is_transparent && display.exposure > 0) {
    const float4 b = display.background;
    const auto light = [&](float code) { return b.w * (display.raw ? code : decode_srgb(code)) / display.exposure; };
    s.background = float3{light(b.x), light(b.y), light(b.z)};
  }
  if (options.opaque_glass && !options.background && options.display.is_transparent)
    s.background = float3{0, 0, 0}, s.has_environment_behind = true;
  s.ambient_light = lighting.ambient_light;
  s.anisotropy = options.anisotropy;
  s.texture_filter = options.texture_filter, s.specular_aa = options.specular_aa;
  return s;
}

/// Tiles write all of it: the memory of an earlier image of the same size is reused, and that of a new one is not
/// touched here, so that its pages are allocated by all threads.
Rgba8Image make_shown(int w, int h, RasterMemory& memory) {
  const bool fits = memory.display8.width() == w && memory.display8.height() == h;
  return fits ? std::move(memory.display8) : Rgba8Image::unset(w, h);
}

/// The planes of a request that has no colour.
void make_uncoloured(const Request& request, int w, int h, Frame& frame, Target& target) {
  const std::size_t samples = request.samples.size();
  if (request.content == Content::Geometry) {
    frame.sample_geometry.assign(samples, LinearImage(w, h, Linear{0, 0, 0, 0}));
    target.sample_color = &frame.sample_geometry;
  } else if (request.content == Content::EdgeDistances) {
    frame.color = LinearImage(w, h, Linear{0, 0, 0, 0});
    target.color = &frame.color;
  } else {
    frame.sample_triangle.assign(samples, Plane<std::uint32_t>(w, h, Frame::no_id));
    target.sample_triangle = &frame.sample_triangle;
    if (!request.planes.samples) return;
    frame.sample_depth.assign(samples, Plane<float>(w, h, 0.0f));
    target.sample_depth = &frame.sample_depth;
  }
}

void make_planes(const Request& request, int w, int h, Frame& frame, Target& target) {
  Planes planes = request.planes;
  const std::size_t samples = request.samples.size();
  const auto make = [&](bool is_requested, auto& plane, auto*& pointer, auto empty) {
    if (!is_requested) return;
    plane = {w, h, empty};
    pointer = &plane;
  };
  if (planes.any_point_plane()) planes.object_id = planes.primitive_id = true;
  make(request.content == Content::Colour && !target.display_transform, frame.color, target.color, Linear{0, 0, 0, 0});
  make(planes.any_point_plane(), frame.data_position, target.data_position, SamplePosition{});
  make(planes.depth, frame.reversed_depth, target.reversed_depth, 0.0f);
  make(planes.normal, frame.normal, target.normal, float3{});
  make(planes.albedo, frame.albedo, target.albedo, float3{});
  make(planes.uv, frame.uv, target.uv, float2{});
  make(planes.mip_level, frame.mip_level, target.mip_level, FragmentOutputs::no_mip_level);
  make(planes.anisotropy, frame.anisotropy, target.anisotropy, 0.0f);
  make(planes.object_id, frame.object_id, target.instance, Frame::no_id);
  make(planes.material_id, frame.material_id, target.material, Frame::no_id);
  make(planes.primitive_id, frame.primitive_id, target.primitive, Frame::no_id);
  make(planes.coverage, frame.coverage, target.coverage, 0.0f);
  if (planes.samples || planes.sample_triangles) {
    frame.sample_triangle.assign(samples, Plane<std::uint32_t>(w, h, Frame::no_id));
    target.sample_triangle = &frame.sample_triangle;
  }
  if (planes.samples || planes.sample_colors) {
    frame.sample_color.assign(samples, LinearImage(w, h, Linear{0, 0, 0, 0}));
    target.sample_color = &frame.sample_color;
  }
  if (!planes.samples) return;
  frame.sample_depth.assign(samples, Plane<float>(w, h, 0.0f));
  target.sample_depth = &frame.sample_depth;
}

/// The distance along the view axis that the projection maps to this reversed depth.
void compute_distances(const float4x4& clip_from_camera, Frame& frame) {
  const double zz = clip_from_camera.column[2].z, zw = clip_from_camera.column[3].z;
  const double wz = clip_from_camera.column[2].w, ww = clip_from_camera.column[3].w;
  frame.depth = Plane<float>(frame.reversed_depth.width(), frame.reversed_depth.height());
  for (std::size_t i = 0; i < frame.depth.values().size(); ++i) {
    const double z = frame.reversed_depth.values()[i];
    const double view_z = (zw - z * ww) / (z * wz - zz);
    frame.depth.values()[i] = z > 0 ? static_cast<float>(-view_z) : std::numeric_limits<float>::infinity();
  }
}

void check(const RenderOptions& o, const Request& request) {
  const auto reject = [](const std::string& what) { throw Error(ErrorKind::Usage, what); };
  if (o.width < 1 || o.height < 1 || o.width > 32768 || o.height > 32768)
    reject("an image has 1 to 32768 pixels a side, not " + std::to_string(o.width) + " × " + std::to_string(o.height));
  if (const Crop c = o.crop.value_or(Crop{0, 0, o.width, o.height});
      c.x < 0 || c.y < 0 || c.width < 1 || c.height < 1 || c.x > o.width - c.width || c.y > o.height - c.height)
    reject("the crop must lie within the image of " + std::to_string(o.width) + " × " + std::to_string(o.height));
  if (o.ground == GroundKind::Shadow && !has_visibility(o)) reject("a ground of shadows requires shadows or occlusion");
  if (o.shadows.samples < 1 || o.occlusion.samples < 0 || !(o.occlusion.distance >= 0))
    reject("soft shadows have at least one ray, and occlusion has a distance that is not negative");
  if (const ShadowMapOptions& map = o.shadows.map; map.size < 1 || map.size > 16384 || !(map.radius >= 0.5f))
    reject("a shadow map has 1 to 16384 texels a side and a filter of at least half a texel");
  if (!(o.edges.width > 0 && o.edges.width <= 1024)) reject("lines along edges are up to 1024 pixels wide");
  if (request.samples.empty() || (request.rate == Rate::Surface && request.samples.size() > 64))
    reject("a pixel has 1 to 64 samples at rate surface, not " + std::to_string(request.samples.size()));
  if (request.draw && (request.writes_display8 || request.planes.samples || request.planes.sample_colors))
    reject("a method that draws for itself gives a linear image and has no samples");
  assert(request.content == Content::Colour || !(request.draw || request.writes_display8));
  assert(request.content != Content::Data || !(request.planes.samples || request.planes.sample_colors));
  assert(request.content != Content::EdgeDistances || request.samples.size() == 1);
}

/// Rasterizes draws on this process, or with other ranks.
class FrameRasterizer {
 public:
  FrameRasterizer(std::optional<FrameParts>& parts, RasterMemory& memory) : parts_(parts), memory_(memory) {}

  RasterCounts operator()(std::span<const Draw> draws, const FragmentShader& shader, const RasterRules& rules,
                          const Target& target) {
    if (!parts_) return rasterize(draws, shader, rules, target, &memory_);
    Ranks& ranks = parts_->ranks;
    PartTimes times;
    std::vector<Draw> own;
    if (parts_->elsewhere.empty())
      own = draws_of_rank(draws, runs_of(draws, parts_->partition, ranks.count()), ranks.rank());
    return rasterize_parts(own.empty() ? draws : own, shader, rules, target, memory_, ranks, held_,
                           parts_->times ? *parts_->times : times);
  }

  /// Draws by a method, on each rank a strip of the target.
  RasterCounts draw_strip(const Request& request, std::span<const Draw> draws, const FragmentShader& shader,
                          const RasterRules& rules, const Target& target, const RenderOptions& options,
                          Plane<float>* error) {
    RasterCounts counts;
    if (!parts_) {
      request.draw({draws, shader, rules, target, options, error, counts, memory_});
      return counts;
    }
    const int rank = parts_->ranks.rank(), ranks = parts_->ranks.count();
    const auto row = [&](int part) { return static_cast<int>(std::int64_t{target.height} * part / ranks); };
    const int top = row(rank), rows = row(rank + 1) - top;
    held_.colors = {target.width, target.height, std::uint8_t{0}};
    if (rows == 0) return counts;
    Target strip = target;
    strip.y += top, strip.height = rows;
    LinearImage color(target.width, rows, Linear{0, 0, 0, 0});
    Plane<float> coverage, own_error;
    Plane<std::uint8_t> mask;
    strip.color = &color;
    if (target.coverage) strip.coverage = &(coverage = rows_of(*target.coverage, top, rows));
    if (error) own_error = rows_of(*error, top, rows);
    if (target.pixel_mask) strip.pixel_mask = &(mask = rows_of(*target.pixel_mask, top, rows));
    request.draw({draws, shader, rules, strip, options, error ? &own_error : nullptr, counts, memory_});
    const auto put = [&](const auto& part, auto& whole) {
      for (int y = 0; y < rows; ++y) std::ranges::copy(part.row(y), whole.row(top + y).begin());
    };
    put(color, *target.color);
    if (target.coverage) put(coverage, *target.coverage);
    if (error) put(own_error, *error);
    for (int y = 0; y < rows; ++y) std::ranges::fill(held_.colors.row(top + y), std::uint8_t{1});
    return counts;
  }

  /// Completes the coverage and the planes by sample by those of the other ranks, on every rank.
  void gather_samples(Frame& frame) {
    if (parts_) gather(parts_->ranks, held_.colors, false, true, frame);
  }
  /// Completes all planes.
  void gather_planes(const Request& request, Frame& frame) {
    if (!parts_) return;
    const bool to_every_rank = !request.resolves_per_pixel;
    gather(parts_->ranks, held_.colors, false, to_every_rank, frame);
    gather(parts_->ranks, held_.data, true, to_every_rank, frame);
  }

 private:
  template <class T>
  static Plane<T> rows_of(const Plane<T>& plane, int top, int rows) {
    Plane<T> out(plane.width(), rows);
    for (int y = 0; y < rows; ++y) std::ranges::copy(plane.row(top + y), out.row(y).begin());
    return out;
  }

  std::optional<FrameParts>& parts_;
  RasterMemory& memory_;
  HeldPixels held_;
};

/// Draws the colour by Request::draw, and the data passes by tiles.
RasterCounts draw_by(const Request& request, std::span<const Draw> draws, const FragmentShader& shader,
                     const RasterRules& rules, const Target& target, const RenderOptions& options,
                     FrameRasterizer& rasterizer, Frame& frame, std::uint64_t& geometric) {
  Plane<float>* const error = frame.error.empty() ? nullptr : &frame.error;
  if (request.planes.any_pixel_plane()) {
    Target planes = target;
    planes.color = nullptr;
    const RasterCounts data = rasterizer(draws, shader, rules, planes);
    geometric = data.shaded + data.evaluated;
    rasterizer.gather_samples(frame);
  }
  return rasterizer.draw_strip(request, draws, shader, rules, target, options, error);
}

/// Without colour only opaque and alpha-tested surfaces matter. Data passes keep the blended draws, so that triangle
/// ids stay the same.
RasterCounts draw_uncoloured(const Scene& scene, const Camera& camera, const Request& request, std::vector<Draw>& draws,
                             const FragmentShader& surfaces, const RasterRules& rules, Target& target,
                             FrameRasterizer& rasterizer) {
  const auto run = [&](const FragmentShader& shader) { return rasterizer(draws, shader, rules, target); };
  if (request.content == Content::Data) return run(surfaces);
  std::erase_if(draws, [](const Draw& draw) { return draw.alpha_mode == AlphaMode::Blend; });
  if (request.content == Content::EdgeDistances) return run(EdgeDistances(scene, draws, target.viewport, surfaces));
  if (request.content == Content::Visibility) return run(surfaces);
  target.is_per_sample = true;
  return run(GeometryFragmentShader(scene, camera, surfaces));
}

/// Refuses what a part of the scene does not suffice for.
void check_parts(const FrameParts& parts, const PreparedScene& prepared, const Request& request,
                 const RenderOptions& options) {
  if (parts.elsewhere.empty()) return;
  const auto refuse = [](const char* what) {
    throw Error(ErrorKind::Usage, std::string(what) + " the whole scene, and each rank has a part of it alone");
  };
  if (has_visibility(options)) refuse("shadows and ambient occlusion need");
  if (request.draw) refuse("the antialiasing method needs");
  if (options.edges.kind != EdgeKind::None) refuse("lines along edges need");
  if (request.planes.was_visible) refuse("the history of the antialiasing method needs");
  if (std::ranges::any_of(prepared.scene().materials, is_transmissive)) refuse("surfaces that transmit light need");
}

/// Leaves of the draws of other ranks their ids.
void leave_ids(std::span<const std::uint32_t> elsewhere, std::span<Draw> draws) {
  for (std::size_t i = 0; i < elsewhere.size(); ++i) {
    if (elsewhere[i] == 0) continue;
    draws[i].elsewhere = elsewhere[i];
    draws[i].index = {}, draws[i].position = {}, draws[i].quads = nullptr;
  }
}

/// The pixels that are drawn, without their planes.
Target target_of(const Request& request, const RenderOptions& options, const Crop& crop) {
  Target target;
  target.viewport = {options.width, options.height};
  target.x = crop.x, target.y = crop.y, target.width = crop.width, target.height = crop.height;
  target.samples = request.samples;
  target.weights = request.weights;
  target.alpha = request.alpha;
  target.centroid = request.centroid;
  target.is_per_sample = request.rate == Rate::Sample;
  target.has_data_at_samples = request.planes.was_visible;
  if (request.footprint > 0 && (options.sample_footprint || !target.is_per_sample))
    target.spacing = request.footprint;
  else if (target.is_per_sample && options.sample_footprint)
    target.spacing = 1 / std::sqrt(static_cast<float>(request.samples.size()));
  if (!request.pixel_mask.empty()) target.pixel_mask = &request.pixel_mask;
  return target;
}

RenderCounts counts_of(const RasterCounts& c, double prepare_ms, bool has_color, std::uint64_t geometric) {
  return {.prepare_ms = prepare_ms,
          .geometry_ms = c.geometry_ms,
          .tiles_ms = c.tiles_ms,
          .stages = c.stages,
          .vertices = c.vertices,
          .triangles = c.triangles,
          .triangles_set_up = c.set_up,
          .shaded = has_color ? c.shaded : 0,
          .geometric = geometric + c.evaluated + (has_color ? 0 : c.shaded)};
}

class CpuBackend : public Backend {
 public:
  explicit CpuBackend(std::optional<FrameParts> parts = {}) : parts_(std::move(parts)) {}
  Frame render(const PreparedScene& scene, const Camera& camera, const Request& request, const RenderOptions& options,
               RenderCounts* counts) override;
  void recycle(Rgba8Image image) override { memory_.display8 = std::move(image); }

 private:
  std::optional<FrameParts> parts_;
  RasterMemory memory_;
  SceneShadows shadows_;
  LastVisibility last_visibility_;
};

Frame CpuBackend::render(const PreparedScene& prepared, const Camera& scene_camera, const Request& request,
                         const RenderOptions& options, RenderCounts* counts) {
  check(options, request);
  if (parts_) check_parts(*parts_, prepared, request, options);
  const Scene& scene = prepared.scene();
  const Camera camera =
      options.ground == GroundKind::Shadow ? GroundSquare(scene).enclosing(scene_camera) : scene_camera;
  const Stopwatch prepare;
  const Crop crop = options.crop.value_or(Crop{0, 0, options.width, options.height});
  const float4x4 clip_from_camera = camera.clip_from_camera(aspect_of(options));
  const float4x4 clip_from_world = clip_from_camera * inverse(camera.world_from_camera);
  SceneDraws draws = growing("draws", [&] { return make_draws(scene, clip_from_world, options); });
  if (parts_) leave_ids(parts_->elsewhere, draws.draws);
  RasterRules rules{.edge_rule = options.edge_rule, .visibility = options.visibility, .capacity = options.capacity};
  ViewUniforms view = view_uniforms_of(prepared.lighting(), scene.up, camera, clip_from_camera, options);
  if (request.content == Content::Colour)
    view.visibility = shadows_.of_frame(prepared, view, {camera, clip_from_camera, options}, options);
  std::optional<Ground> ground;
  if (options.ground == GroundKind::Shadow && view.visibility != nullptr) {
    ground.emplace(scene, view);
    draws.draws.push_back(ground->draw(clip_from_world, static_cast<std::uint32_t>(scene.instances.size()),
                                       static_cast<int>(scene.materials.size())));
  }
  const Ground* const shadow_catcher = ground ? &*ground : nullptr;
  std::optional<Backdrop> backdrop;
  if (request.content == Content::Colour)
    backdrop =
        make_backdrop(prepared, view, draws.draws, shadow_catcher, camera, clip_from_world, rules, options, memory_);
  if (backdrop) view.backdrop = backdrop->view();
  // Transmissive surfaces refract all of the light behind them.
  view.component = options.light_component;
  const SceneFragmentShader shader(prepared, view, shadow_catcher);
  if (options.progress) rules.progress = &options.progress;

  Frame frame;
  frame.x = crop.x, frame.y = crop.y;
  Target target = target_of(request, options, crop);
  std::optional<DisplayTransform> display_transform;
  if (request.writes_display8) target.display_transform = &display_transform.emplace(options.display);
  const bool has_color = request.content == Content::Colour;
  const bool has_data = has_color || request.content == Content::Data;
  if (has_data)
    make_planes(request, crop.width, crop.height, frame, target);
  else
    make_uncoloured(request, crop.width, crop.height, frame, target);
  if (target.display_transform) target.display8 = &(frame.display8 = make_shown(crop.width, crop.height, memory_));
  const double prepare_ms = prepare.ms();

  if (request.planes.error && request.estimates_error) frame.error = {crop.width, crop.height, 0.0f};
  std::uint64_t geometric = 0;
  FrameRasterizer rasterizer(parts_, memory_);
  const RasterCounts c =
      !has_color     ? draw_uncoloured(scene, camera, request, draws.draws, shader, rules, target, rasterizer)
      : request.draw ? draw_by(request, draws.draws, shader, rules, target, options, rasterizer, frame, geometric)
                     : rasterizer(draws.draws, shader, rules, target);
  if (request.content == Content::EdgeDistances)
    frame.edge_distance = edge_distances_of(std::exchange(frame.color, {}));
  if (target.reversed_depth) compute_distances(clip_from_camera, frame);
  if (has_data && request.planes.any_point_plane()) {
    frame.instance = request.planes.object_id ? frame.object_id : std::move(frame.object_id);
    const Moment now{prepared.shared_scene(), camera};
    add_surface_points(now, request.planes, options, frame);
    if (request.planes.was_visible) last_visibility_.find(now, prepared.textures(), options, frame);
  }
  for (std::uint32_t& id : frame.object_id.values())
    if (id != Frame::no_id) id = static_cast<std::uint32_t>(scene.instances[id].object);
  rasterizer.gather_planes(request, frame);
  if (counts) *counts = counts_of(c, prepare_ms, has_color, geometric);
  return frame;
}

}  // namespace

std::unique_ptr<Backend> make_cpu_backend() { return std::make_unique<CpuBackend>(); }
std::unique_ptr<Backend> make_cpu_backend(FrameParts parts) { return std::make_unique<CpuBackend>(std::move(parts)); }

Frame render(const PreparedScene& scene, const Camera& camera, const Request& request, const RenderOptions& options,
             RenderCounts* counts) {
  return CpuBackend().render(scene, camera, request, options, counts);
}

}  // namespace zoneplate
