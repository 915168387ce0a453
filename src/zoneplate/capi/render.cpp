// SPDX-License-Identifier: Apache-2.0
// Cameras and rendering.
#include "zoneplate/render/renderer.h"

#include <algorithm>
#include <array>
#include <deque>

#include "zoneplate/base/parallel.h"
#include "zoneplate/capi/arrays.h"
#include "zoneplate/capi/handles.h"
#include "zoneplate/job/look/shadow_args.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/render/aov.h"
#include "zoneplate/render/view.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::capi {
namespace {

template <class T, class Given>
std::optional<T> optional_of(const Given* value) {
  return value == nullptr ? std::nullopt : std::optional<T>(static_cast<T>(*value));
}
std::optional<float3> optional_vector(const float* v) {
  return v == nullptr ? std::nullopt : std::optional(float3{v[0], v[1], v[2]});
}

std::optional<double3> optional_place(const double* v) {
  return v == nullptr ? std::nullopt : std::optional(double3{v[0], v[1], v[2]});
}

/// A camera, and the place of its eye in the coordinates of the file.
struct PlacedCamera {
  Camera camera;
  double3 eye;
};

PlacedCamera find_camera(const zoneplate_scene& scene, const zoneplate_view* given, float aspect) {
  const auto v = completed(given, "zoneplate_view");
  Job job = scene.job();
  job.view = {.index = optional_of<int>(v.index),
              .position = optional_place(v.position),
              .focal_point = optional_place(v.focal_point),
              .view_up = optional_vector(v.view_up),
              .view_angle = optional_of<float>(v.vertical_fov),
              .azimuth = optional_of<float>(v.azimuth),
              .elevation = optional_of<float>(v.elevation),
              .is_orthographic = v.is_orthographic != 0};
  return scene.read([&](const Scene& s) {
    const Camera camera = choose_camera(s, resolve(job, s, ToneMapping::None).view, aspect);
    return PlacedCamera{camera, s.in_file(xyz(camera.world_from_camera.column[3]))};
  });
}

/// The lens of an image of this size; none without intrinsics.
std::optional<Lens> lens_of(const zoneplate_camera& c, int width, int height) {
  const auto& [fx, fy, cx, cy] = c.intrinsics;
  if (fx == 0) return std::nullopt;
  if (!(fx > 0 && fy > 0) || c.is_orthographic != 0)
    throw Error(ErrorKind::Usage, "intrinsics: need focal lengths above 0, and a perspective camera");
  const auto& d = c.distortion;
  Lens lens{.width = width, .height = height, .fx = fx, .fy = fy, .cx = cx, .cy = cy};
  lens.k1 = d[0], lens.k2 = d[1], lens.p1 = d[2], lens.p2 = d[3];
  lens.k3 = d[4], lens.k4 = d[5], lens.k5 = d[6], lens.k6 = d[7];
  return lens;
}

}  // namespace

Camera camera_of(const zoneplate_camera* given, double3 origin, int width, int height) {
  const auto c = completed(given, "zoneplate_camera");
  Camera out;
  const auto& m = c.world_from_camera;
  for (std::size_t i = 0; i < 4; ++i)
    out.world_from_camera.column[i] = {static_cast<float>(m[i]), static_cast<float>(m[4 + i]),
                                       static_cast<float>(m[8 + i]), static_cast<float>(m[12 + i])};
  const float3 place = narrowed(double3{m[3], m[7], m[11]} - origin);
  out.world_from_camera.column[3] = {place.x, place.y, place.z, 1};
  out.is_orthographic = c.is_orthographic != 0;
  out.vertical_fov = static_cast<float>(c.vertical_fov);
  out.half_height = static_cast<float>(c.half_height);
  out.near = static_cast<float>(c.near);
  out.far = static_cast<float>(c.far);
  // A negated comparison is true for NaN.
  const float extent = out.is_orthographic ? out.half_height : out.vertical_fov;
  if (!(extent > 0) || !(out.near > 0 || out.is_orthographic) || !(out.far > out.near))
    throw Error(ErrorKind::Usage, "camera: vertical_fov, half_height, near and far must be positive, and near < far");
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    throw Error(ErrorKind::Usage,
                "world_from_camera: its last row is not 0, 0, 0, 1: it is not rigid, or stored by columns");
  out.lens = lens_of(c, width, height);
  return out;
}

namespace {

std::optional<ToneMapping> tone_mapping_of(const char* name) {
  constexpr std::string_view names[] = {"none", "aces", "neutral", "agx", "filmic"};  // in the order of ToneMapping
  if (name == nullptr) return std::nullopt;
  const auto found = std::ranges::find(names, std::string_view(name));
  if (found == std::end(names)) refuse_name("tone mapping", name, names);
  return static_cast<ToneMapping>(found - std::begin(names));
}

/// The data passes of a list of names, each once.
std::vector<const Aov*> passes_of(const char* list) {
  std::vector<const Aov*> out;
  std::string_view rest = list == nullptr ? "" : list;
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view name = rest.substr(0, comma);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
    const auto found = std::ranges::find(aovs(), name, &Aov::name);
    if (found == aovs().end()) {
      std::vector<std::string_view> names;
      for (const Aov& aov : aovs()) names.push_back(aov.name);
      refuse_name("data pass", name, names);
    }
    if (found->plane == &Planes::motion || found->plane == &Planes::flow)
      throw Error(ErrorKind::Usage, fmt::format("the data pass {} requires a sequence of frames", name));
    if (std::ranges::find(out, &*found) == out.end()) out.push_back(&*found);
  }
  return out;
}

/// The job of the options; the scene's textures and materials stay as they are.
Job job_of(const zoneplate_render_options& o, const zoneplate_scene& scene) {
  constexpr const char* outputs[] = {"image.png", "image.png", "image.pfm"};
  constexpr const char* shadows[] = {"none", "map", "hard", "soft"};
  Job job = scene.job();
  job.output = at(outputs, o.form, "form");
  job.bit_depth = o.form == ZONEPLATE_SRGB16 ? 16 : 8;
  if (o.method != nullptr) job.method = o.method;
  job.aovs = passes_of(o.passes);
  RenderOptions& options = job.options;
  options.width = o.width == 0 ? options.width : o.width;
  options.height = o.height == 0 ? options.height : o.height;
  if (o.crop[2] != 0) {
    options.crop = Crop{o.crop[0], o.crop[1], o.crop[2], o.crop[3]};
    if (o.crop[0] < 0 || o.crop[1] < 0 || o.crop[2] < 0 || o.crop[3] <= 0 || o.crop[0] > options.width - o.crop[2] ||
        o.crop[1] > options.height - o.crop[3])
      throw Error(ErrorKind::Usage,
                  fmt::format("crop: the rectangle is not inside the image of {}x{}", options.width, options.height));
  }
  options.cull_back_faces = o.keeps_back_faces == 0;
  if (o.anisotropy != 0) job.anisotropy = std::clamp(o.anisotropy, 1, 16);
  if (o.point_size != 0 && !(o.point_size >= 0.01f && o.point_size <= 1024))
    throw Error(ErrorKind::Usage, fmt::format("point_size: {} is not between 0.01 and 1024", o.point_size));
  if (o.point_size != 0) job.point_size = o.point_size;
  options.shadows = parse_shadows(at(shadows, o.shadows, "shadows"));
  options.occlusion.samples = std::clamp(o.occlusion_samples, 0, 4096);
  options.ground = o.has_shadow_ground != 0 ? GroundKind::Shadow : GroundKind::None;
  if (options.ground == GroundKind::Shadow && !has_visibility(options))
    throw Error(ErrorKind::Usage, "a ground for shadows requires shadows or ambient occlusion");
  job.tone_mapping = tone_mapping_of(o.tone_mapping);
  job.display.exposure = exp2(std::clamp(o.exposure, -32.0f, 32.0f));
  job.display.is_transparent = o.is_transparent != 0;
  job.has_own_brightness = o.exposure != 0 || o.light_intensity != nullptr;
  if (const float* c = o.background) job.background = float4{c[0], c[1], c[2], c[3]};
  if (o.light_intensity != nullptr) job.lighting.intensity = *o.light_intensity;
  if (const float* c = o.environment) job.lighting.environment = Environment{.color = {c[0], c[1], c[2]}};
  return job;
}

/// Adds the arrays of a data pass, which are views of `frame` or of planes that are made from it.
void add_pass(const Aov& aov, const std::shared_ptr<const Frame>& frame, const Scene& scene, zoneplate_image& image) {
  struct Kept {
    std::shared_ptr<const Frame> frame;
    DataChannels channels;
  };
  const auto kept = std::make_shared<Kept>(Kept{frame, {}});
  aov.add_channels(*frame, scene, kept->channels);
  const std::vector<DataChannel>& list = kept->channels.list;
  const std::int64_t height = image.arrays().front().second.shape[0], width = image.arrays().front().second.shape[1];
  for (std::size_t i = 0; i < list.size(); i += list[i].step) {
    const DataChannel& first = list[i];
    const bool is_number = first.precision == ChannelPrecision::Number;
    const void* const memory = is_number ? static_cast<const void*>(first.number) : first.value;
    const zoneplate_type type = is_number ? ZONEPLATE_UINT32 : ZONEPLATE_FLOAT32;
    const std::string name =
        list.size() > first.step ? first.name.substr(0, first.name.find('.')) : std::string(aov.name);
    const auto channels = static_cast<std::int64_t>(first.step);
    image.add(
        name,
        channels == 1 ? array_of(memory, type, {height, width}) : array_of(memory, type, {height, width, channels}),
        kept);
  }
}

}  // namespace

std::unique_ptr<zoneplate_image> image_of(const Job& job, RenderedImage image, const Scene& scene) {
  const bool has_alpha = job.display.is_transparent || job.display.background.w < 1;
  std::unique_ptr<zoneplate_image> out;
  if (is_linear(job.output))
    out = std::make_unique<zoneplate_image>(over_background(std::move(image.linear), job.display), has_alpha);
  else if (job.bit_depth == 16)
    out = std::make_unique<zoneplate_image>(std::move(image.display16), has_alpha);
  else
    out = std::make_unique<zoneplate_image>(std::move(image.display), has_alpha);
  const auto frame = std::make_shared<const Frame>(std::move(image.data));
  for (const Aov* aov : job.aovs) add_pass(*aov, frame, scene, *out);
  return out;
}

std::unique_ptr<zoneplate_image> render_image(Job job, const PreparedScene& scene, const zoneplate_camera* camera) {
  std::unique_ptr<Resolver> method = upscale::make_method(job.method);
  const Request request = request_of(job, *method);
  if (is_linear(job.output) && request.is_display_referred)
    throw Error(ErrorKind::Usage, fmt::format("{} works after tone mapping, and the image is linear", job.method));
  check_passes(job, request);
  std::optional<Camera> given;
  if (camera != nullptr) given = camera_of(camera, scene.scene().origin, job.options.width, job.options.height);
  const bool is_light = is_linear(job.output);
  LitStill still = light_still(std::move(job), scene, is_light, given ? &*given : nullptr);
  RenderedImage image =
      Renderer(still.scene, std::move(method)).render_still(still.camera, settings_of(still.job, still.job.output));
  return image_of(still.job, std::move(image), scene.scene());
}

}  // namespace zoneplate::capi

using namespace zoneplate;
using namespace zoneplate::capi;

zoneplate_status zoneplate_scene_camera(const zoneplate_scene* scene, const zoneplate_view* view, double aspect,
                                        zoneplate_camera* camera) {
  return guarded([&] {
    if (!(aspect > 0 && aspect < 1e6)) throw Error(ErrorKind::Usage, fmt::format("aspect: is {}", aspect));
    const auto [found, place] = find_camera(required(scene, "scene"), view, static_cast<float>(aspect));
    zoneplate_camera out{};
    out.size = sizeof out;
    for (std::size_t c = 0; c < 4; ++c) {
      const float4 column = found.world_from_camera.column[c];
      const float values[] = {column.x, column.y, column.z, column.w};
      for (std::size_t row = 0; row < 4; ++row) out.world_from_camera[4 * row + c] = static_cast<double>(values[row]);
    }
    out.world_from_camera[3] = place.x, out.world_from_camera[7] = place.y, out.world_from_camera[11] = place.z;
    out.is_orthographic = found.is_orthographic ? 1 : 0;
    out.vertical_fov = static_cast<double>(found.vertical_fov);
    out.half_height = static_cast<double>(found.half_height);
    out.near = static_cast<double>(found.near);
    out.far = static_cast<double>(found.far);
    required(camera, "camera") = out;
  });
}

zoneplate_status zoneplate_render(zoneplate_scene* scene, const zoneplate_camera* camera,
                                  const zoneplate_render_options* options, zoneplate_image** image) {
  return guarded([&] {
    const auto o = completed(options, "zoneplate_render_options");
    zoneplate_scene& from = required(scene, "scene");
    std::unique_ptr<zoneplate_image> out;
    with_threads(std::clamp(o.threads, 0, 1024), [&] { out = render_image(job_of(o, from), from.prepared(), camera); });
    required(image, "image") = out.release();
  });
}
