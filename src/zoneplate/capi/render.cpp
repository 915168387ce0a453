// SPDX-License-Identifier: Apache-2.0
// Cameras and rendering.
#include "zoneplate/render/renderer.h"

#include <algorithm>
#include <array>
#include <deque>

#include "zoneplate/base/parallel.h"
#include "zoneplate/capi/arrays.h"
#include "zoneplate/capi/handles.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/render/aov.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/render/view.h"
#include "zoneplate/scene/usual_options.h"
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
  View view{.index = optional_of<int>(v.index),
            .position = optional_place(v.position),
            .focal_point = optional_place(v.focal_point),
            .view_up = optional_vector(v.view_up),
            .view_angle = optional_of<float>(v.vertical_fov),
            .azimuth = optional_of<float>(v.azimuth),
            .elevation = optional_of<float>(v.elevation),
            .is_orthographic = v.is_orthographic != 0};
  if (scene.uses_own_camera && !view.index && !view.position) view.index = 0;
  return scene.read([&](const Scene& s) {
    view.up = s.up;
    const Camera camera = choose_camera(s, view, aspect);
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

RenderSettings settings_of(const zoneplate_render_options& o, const zoneplate_scene& scene) {
  constexpr ImageForm forms[] = {ImageForm::Display8, ImageForm::Display16, ImageForm::Linear};
  constexpr ShadowMethod shadows[] = {ShadowMethod::None, ShadowMethod::Map, ShadowMethod::Hard, ShadowMethod::Soft};
  RenderSettings out;
  RenderOptions& options = out.options;
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
  options.anisotropy = o.anisotropy != 0 ? std::clamp(o.anisotropy, 1, 16) : scene.is_builtin ? 1 : usual_anisotropy;
  if (o.point_size != 0 && !(o.point_size >= 0.01f && o.point_size <= 1024))
    throw Error(ErrorKind::Usage, fmt::format("point_size: {} is not between 0.01 and 1024", o.point_size));
  options.shadows.method = at(shadows, o.shadows, "shadows");
  options.occlusion.samples = std::clamp(o.occlusion_samples, 0, 4096);
  options.ground = o.has_shadow_ground != 0 ? GroundKind::Shadow : GroundKind::None;
  if (options.ground == GroundKind::Shadow && !has_visibility(options))
    throw Error(ErrorKind::Usage, "a ground for shadows requires shadows or ambient occlusion");
  DisplayOptions& display = options.display;
  display.exposure = exp2(std::clamp(o.exposure, -32.0f, 32.0f));
  display.is_transparent = o.is_transparent != 0;
  display.background = scene.background.value_or(default_background);
  if (const float* c = o.background) display.background = {c[0], c[1], c[2], c[3]};
  out.form = at(forms, o.form, "form");
  return out;
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

std::unique_ptr<zoneplate_image> render_image(zoneplate_scene& scene, const zoneplate_camera* camera,
                                              const zoneplate_render_options& o) {
  RenderSettings settings = settings_of(o, scene);
  const RenderOptions& options = settings.options;
  const std::vector<const Aov*> passes = passes_of(o.passes);
  for (const Aov* aov : passes) settings.planes.*(aov->plane) = true;
  std::unique_ptr<Resolver> method = upscale::make_method(o.method == nullptr ? usual_method : o.method);
  const Request request = method->request({.image = {options.width, options.height, options.crop}});
  if (settings.form == ImageForm::Linear && request.is_display_referred)
    throw Error(ErrorKind::Usage, fmt::format("{} works after tone mapping, and the image is linear", o.method));
  if (settings.planes.error && !request.estimates_error)
    throw Error(ErrorKind::Usage, "the data pass error requires the method converged or analytic");

  LightingOptions lighting;
  if (o.light_intensity != nullptr) lighting.intensity = *o.light_intensity;
  if (const float* c = o.environment) lighting.environment = Environment{.color = {c[0], c[1], c[2]}};
  const std::optional<ToneMapping> tone_mapping = tone_mapping_of(o.tone_mapping);
  const PreparedScene prepared = scene.prepared();
  const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
  settings.options.point_size =
      o.point_size != 0 ? o.point_size : usual_point_size(prepared.scene(), options.width, options.height);
  const Lighting light = make_lighting(prepared.scene(), lighting);
  settings.options.display.mapping = tone_mapping.value_or(light.tone_mapping);
  const Camera view = camera != nullptr ? camera_of(camera, prepared.scene().origin, options.width, options.height)
                                        : find_camera(scene, nullptr, aspect).camera;
  PreparedScene lit = prepared.lit(light);
  if (o.light_intensity == nullptr && !lighting.environment && o.exposure == 0 && settings.form != ImageForm::Linear)
    lit = dimmed(lit, dimming_of(lit, upscale::make_method("none")).factor);
  Renderer renderer(std::move(lit), std::move(method));
  RenderedImage image = renderer.render_still(view, settings);

  const bool has_alpha = options.display.is_transparent || options.display.background.w < 1;
  std::unique_ptr<zoneplate_image> out;
  if (settings.form == ImageForm::Linear)
    out = std::make_unique<zoneplate_image>(over_background(std::move(image.linear), options.display), has_alpha);
  else if (settings.form == ImageForm::Display16)
    out = std::make_unique<zoneplate_image>(std::move(image.display16), has_alpha);
  else
    out = std::make_unique<zoneplate_image>(std::move(image.display), has_alpha);
  const auto frame = std::make_shared<const Frame>(std::move(image.data));
  for (const Aov* aov : passes) add_pass(*aov, frame, prepared.scene(), *out);
  return out;
}

}  // namespace
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
    with_threads(std::clamp(o.threads, 0, 1024), [&] { out = render_image(from, camera, o); });
    required(image, "image") = out.release();
  });
}
