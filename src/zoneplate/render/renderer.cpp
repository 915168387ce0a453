// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/renderer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <functional>
#include <iterator>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/edges/scene_edges.h"
#include "zoneplate/image/dither.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/lens/lens_warp.h"
#include "zoneplate/render/environment_background.h"
#include "zoneplate/shade/cast/ground.h"

namespace zoneplate {
namespace {

constexpr int jitter_period = 8;

void add(RenderCounts& sum, const RenderCounts& c) {
  sum.prepare_ms += c.prepare_ms, sum.geometry_ms += c.geometry_ms, sum.tiles_ms += c.tiles_ms;
  sum.stages += c.stages;
  sum.vertices = c.vertices, sum.triangles = c.triangles, sum.triangles_set_up = c.triangles_set_up;
  sum.shaded += c.shaded, sum.geometric += c.geometric;
}

template <class T>
void cut_out(Plane<T>& image, const Crop& part) {
  if (image.empty()) return;
  Plane<T> out(part.width, part.height);
  for (int y = 0; y < part.height; ++y)
    std::ranges::copy_n(image.row(part.y + y).begin() + part.x, part.width, out.row(y).begin());
  image = std::move(out);
}

/// The data planes of a frame, which are moved out of it, and its position in the image.
Frame data_of(Frame& frame) {
  Frame data;
  data.x = frame.x, data.y = frame.y;
  data.sample_triangle.resize(frame.sample_triangle.size());
  Frame::for_data_planes(frame, data, [](auto& from, auto& to) { to = std::move(from); });
  return data;
}

/// The part of a padded frame without its apron.
void cut_out(RenderedImage& image, const Crop& whole, const Crop& crop) {
  const Crop part{crop.x - whole.x, crop.y - whole.y, crop.width, crop.height};
  cut_out(image.display, part), cut_out(image.display16, part), cut_out(image.linear, part);
  image.data.for_data_planes([&](auto& plane) { cut_out(plane, part); });
  image.data.x = crop.x, image.data.y = crop.y;
}

/// Whether the image shows surfaces, and not the lines of their edges alone.
bool draws_surfaces(const RenderOptions& o) { return o.edges.kind == EdgeKind::None || o.edges.has_surfaces; }

void clear(LinearImage& image) { std::ranges::fill(image.values(), Linear{0, 0, 0, 0}); }

bool is_distorted(const Camera& camera) { return camera.lens && camera.lens->is_distorted(); }

Camera with_lens(Camera camera, const Lens& lens) {
  camera.lens = lens;
  return camera;
}

/// Whether planes of the next frame show what has changed since this one.
bool reads_last_moment(const Planes& planes) { return planes.motion || planes.last_position || planes.was_visible; }

bool is_same(const std::optional<Crop>& a, const std::optional<Crop>& b) {
  if (!a || !b) return !a && !b;
  return a->x == b->x && a->y == b->y && a->width == b->width && a->height == b->height;
}

}  // namespace

std::optional<Crop> padded_crop(const RenderOptions& options, int halo) {
  if (!options.crop) return std::nullopt;
  const Crop c = *options.crop;
  const int left = std::min(halo, c.x), top = std::min(halo, c.y);
  return Crop{c.x - left, c.y - top, left + c.width + std::min(halo, options.width - c.x - c.width),
              top + c.height + std::min(halo, options.height - c.y - c.height)};
}

Renderer::Renderer(PreparedScene scene, std::unique_ptr<Resolver> method, std::unique_ptr<Backend> backend)
    : scene_(std::move(scene)),
      method_(std::move(method)),
      backend_(std::move(backend)),
      edges_(std::make_unique<SceneEdges>()),
      jitter_(named_pattern("halton", jitter_period)) {}

Renderer::~Renderer() = default;

void Renderer::set_scene(PreparedScene scene) { scene_ = std::move(scene); }

void Renderer::recycle(Rgba8Image image) { backend_->recycle(std::move(image)); }

void Renderer::begin_frame(const Camera& camera, const RenderSettings& settings) {
  const RenderOptions& o = settings.options;
  if (o.width != width_ || o.height != height_ || !is_same(o.crop, crop_)) index_ = 0;
  width_ = o.width, height_ = o.height, crop_ = o.crop;
  if (index_ == 0) moment_.reset(), previous_.reset();
  context_ = {.image = {o.width, o.height, o.crop},
              .aspect = aspect_of(o),
              .index = index_,
              .is_first = index_ == 0,
              .jitter = jitter_[static_cast<std::size_t>(index_ % jitter_period)],
              .previous = previous_ ? &*previous_ : nullptr,
              .camera = camera,
              .last_camera = index_ == 0 ? camera : camera_};
}

Request Renderer::request_for(const RenderSettings& settings) {
  Request request = method_->request(context_);
  assert(request.settling_frames == 1 || method_->has_history());
  if (!request.frame) request.planes = request.planes | settings.planes;
  if (settings.planes.error && !request.estimates_error)
    throw Error(ErrorKind::Usage, "the method has no estimate of its error");
  if (settings.planes.any_light() && (request.frame || method_->has_history()))
    throw Error(ErrorKind::Usage,
                "light passes require an antialiasing method that renders each frame by itself, at the image's size");
  if (request.frame && request.is_display_referred && settings.form == ImageForm::Linear)
    throw Error(ErrorKind::Usage, "the upscaler works after tone mapping, and the image is scene-linear");
  request.writes_display8 = request.resolves_per_pixel && settings.form == ImageForm::Display8 &&
                            !settings.options.background && !request.frame &&
                            settings.options.edges.kind == EdgeKind::None;
  return request;
}

/// The options of the frame that the backend renders: its size, its part with the apron, and the last moment.
RenderOptions Renderer::frame_options(const RenderSettings& settings, const Request& request) const {
  RenderOptions options = settings.options;
  if (request.frame) {
    options.aspect = aspect_of(options);
    const float scale = static_cast<float>(request.frame->height) / static_cast<float>(options.height);
    options.point_size *= scale, options.line_width *= scale;
    options.width = request.frame->width, options.height = request.frame->height, options.crop = request.frame->crop;
    // A scene-linear image has no display transform, which would decide on the light of the background.
    if (settings.form == ImageForm::Linear) options.display.mapping = ToneMapping::None, options.display.exposure = 1;
  }
  options.crop = padded_crop(options, request.halo);
  if (!options.last) options.last = moment_;
  return options;
}

void Renderer::draw_behind(const Camera& camera, const RenderOptions& options, LinearImage& color) const {
  // Glass shows the background in its own light; the background beside surfaces is in no component of it.
  if (options.background && options.light_component == LightComponent::All && !color.empty())
    draw_environment(scene_.lighting().environment, scene_.scene().up, camera, options, color);
}

/// The data planes of the settings at the image's size, for a method whose frame has another size.
Frame Renderer::render_data(const Camera& camera, const Request& request, const RenderSettings& settings,
                            RenderCounts& counts) {
  RenderOptions options = settings.options;
  if (!options.last) options.last = moment_;
  RenderCounts own;
  const Request data{.samples = request.samples, .content = Content::Data, .planes = settings.planes};
  Frame frame = backend_->render(scene_, camera, data, options, &own);
  add(counts, own);
  return data_of(frame);
}

/// The requested components of the light, each drawn by the whole method.
void Renderer::render_light(const Camera& camera, const RenderSettings& settings, RenderCounts& counts, Frame& data) {
  constexpr std::pair<bool Planes::*, LightComponent> components[] = {
      {&Planes::diffuse, LightComponent::Diffuse},
      {&Planes::specular, LightComponent::Specular},
      {&Planes::transmission, LightComponent::Transmission},
      {&Planes::emission, LightComponent::Emission}};
  static_assert(std::size(components) == std::tuple_size_v<decltype(data.light)>);
  for (std::size_t k = 0; k < std::size(components); ++k) {
    if (!(settings.planes.*components[k].first)) continue;
    const Request request = method_->request(context_);
    RenderOptions options = frame_options(settings, request);
    options.light_component = components[k].second;
    Rounds rounds = render_rounds(camera, request, options, counts);
    const LinearImage picture = method_->resolve(rounds.frame);
    data.light[k] = Plane<float3>(picture.width(), picture.height());
    std::ranges::transform(picture.values(), data.light[k].values().begin(), [](const Linear& c) {
      return float3{c.r, c.g, c.b};
    });
  }
}

Frame Renderer::Rounds::take_data() { return data ? std::move(*data) : data_of(frame); }

Renderer::Rounds Renderer::render_rounds(const Camera& camera, const Request& request, const RenderOptions& options,
                                         RenderCounts& counts) {
  const auto round = [&](const Request& round_request) {
    RenderCounts own;
    Frame frame = backend_->render(scene_, camera, round_request, options, &own);
    frame.display = options.display;
    add(counts, own);
    // Behind every colour that the method may read, so that it also filters the edges before the environment.
    draw_behind(camera, options, frame.color);
    for (LinearImage& color : frame.sample_color) draw_behind(camera, options, color);
    return frame;
  };
  Rounds rounds{round(request), std::nullopt};
  while (const std::optional<Request> more = method_->refine(rounds.frame)) {
    if (!rounds.data) rounds.data = data_of(rounds.frame);
    rounds.frame = round(*more);
  }
  return rounds;
}

Plane<float> Renderer::edge_coverage(const Camera& camera, const RenderSettings& settings, const Request& request) {
  const RenderOptions& options = settings.options;
  if (options.edges.kind == EdgeKind::None) return {};
  const Crop whole{0, 0, options.width, options.height};
  const Crop part = padded_crop(options, request.frame ? 0 : request.halo).value_or(whole);
  return edges_->coverage(scene_.shared_scene(), scene_.textures(),
                          {.camera = camera,
                           .aspect = aspect_of(options),
                           .width = options.width,
                           .height = options.height,
                           .x = part.x,
                           .y = part.y,
                           .part_width = part.width,
                           .part_height = part.height,
                           .culls_back_faces = options.cull_back_faces},
                          options.edges);
}

/// Converts the method's linear image to the requested format, with the lines over it.
void Renderer::finish(LinearImage picture, const Frame& frame, const Request& request, const RenderSettings& settings,
                      const Plane<float>& edges, RenderedImage& out) {
  const ImageForm form = settings.form;
  if (form == ImageForm::Linear) {
    if (!edges.empty()) draw_edges(edges, settings.options.edges, settings.options.display, picture);
    out.linear = std::move(picture);
    return;
  }
  Stopwatch watch;
  if (form == ImageForm::Display8 && (request.ends_in_light || request.resolves_per_pixel) && edges.empty()) {
    out.display = make_display8(picture, frame.display);
    out.counts.display_ms += watch.ms();
    if (method_->has_history()) memory_ = std::move(picture);
    return;
  }
  DisplayImage display = make_display(picture, frame.display);
  if (method_->has_history()) memory_ = std::move(picture);
  out.counts.display_ms += watch.lap_ms();
  display = method_->post_process(std::move(display), frame);
  if (!edges.empty()) draw_edges(edges, settings.options.edges, settings.options.display, display);
  out.counts.filter_ms += watch.lap_ms();
  if (form == ImageForm::Display16)
    out.display16 = quantize16(display);
  else
    out.display = form == ImageForm::Display8Dithered ? quantize8_dithered(display) : quantize8(display);
  out.counts.display_ms += watch.ms();
}

/// Keeps the state of this frame that the next frame may use.
void Renderer::end_frame(const Camera& camera, bool keeps_moment, const Request& request, bool are_planes_requested,
                         Frame& data) {
  moment_.reset();
  if (keeps_moment) moment_ = {scene_.shared_scene(), camera};
  camera_ = camera, settling_frames_ = request.settling_frames;
  previous_.reset();
  if (request.keeps_planes && are_planes_requested)
    previous_ = data;
  else if (request.keeps_planes)
    previous_ = std::move(data);
  ++index_;
}

/// The camera whose near and far planes the frame has: a ground moves them.
Camera Renderer::seeing_ground(const Camera& camera, const RenderOptions& options) const {
  return options.ground == GroundKind::Shadow ? GroundSquare(scene_.scene()).enclosing(camera) : camera;
}

/// The frame without distortion is larger than the image. It is tone-mapped before the warp, with 16 bits: filters of
/// methods and the resolve of a pixel's samples before the curve or after it are those of the frame.
RenderedImage Renderer::through_lens(const Lens& lens, const RenderSettings& settings,
                                     const std::function<RenderedImage(const Lens&, const RenderSettings&)>& frame) {
  const RenderOptions& o = settings.options;
  const Crop part = o.crop.value_or(Crop{0, 0, o.width, o.height});
  const LensWarp warp(lens, o.width, o.height, part.x, part.y, part.width, part.height);
  const auto scale = static_cast<float>(warp.scale());
  const LensWarp::Part& read = warp.frame_part();
  RenderSettings own = settings;
  own.options.width = warp.frame().width, own.options.height = warp.frame().height;
  own.options.crop = Crop{read.x, read.y, read.width, read.height};
  own.options.aspect = 0;
  own.options.point_size *= scale, own.options.line_width *= scale, own.options.edges.width *= scale;
  if (settings.form != ImageForm::Linear) own.form = ImageForm::Display16;
  for (std::optional<Moment>* const other : {&own.options.last, &own.options.next})
    if (*other) (*other)->camera.lens = warp.frame();
  RenderedImage image = frame(warp.frame(), own);

  RenderedImage out;
  out.counts = image.counts;
  if (settings.form == ImageForm::Linear) {
    out.linear = warp.warped(image.linear);
  } else {
    const DisplayImage display = warp.warped(image.display16, o.display.raw);
    if (settings.form == ImageForm::Display16)
      out.display16 = quantize16(display);
    else
      out.display = settings.form == ImageForm::Display8Dithered ? quantize8_dithered(display) : quantize8(display);
  }
  out.data.x = part.x, out.data.y = part.y;
  out.data.sample_triangle.resize(image.data.sample_triangle.size());
  Frame::for_data_planes(image.data, out.data, [&](const auto& from, auto& to) { to = warp.nearest(from); });
  out.data.motion = warp.nearest_steps(image.data.motion, -1, 0);
  out.data.flow = warp.nearest_steps(image.data.flow, 0, 1);
  for (std::size_t k = 0; k < out.data.light.size(); ++k) {
    if (image.data.light[k].empty()) continue;
    LinearImage light(read.width, read.height);
    std::ranges::transform(image.data.light[k].values(), light.values().begin(), [](float3 c) {
      return Linear{c.x, c.y, c.z, 1};
    });
    std::ranges::transform(warp.warped(light).values(), out.data.light[k].values().begin(), [](const Linear& c) {
      return float3{c.r, c.g, c.b};
    });
  }
  return out;
}

RenderedImage Renderer::render(const Camera& scene_camera, const RenderSettings& settings) {
  if (is_distorted(scene_camera))
    return through_lens(*scene_camera.lens, settings, [&](const Lens& lens, const RenderSettings& own) {
      return render(with_lens(scene_camera, lens), own);
    });
  const Camera camera = seeing_ground(scene_camera, settings.options);
  begin_frame(camera, settings);
  const Request request = request_for(settings);
  const RenderOptions options = frame_options(settings, request);

  RenderedImage out;
  Rounds rounds = render_rounds(camera, request, options, out.counts);
  Frame& frame = rounds.frame;
  if (request.writes_display8) {
    out.display = std::move(frame.display8);
  } else {
    const Stopwatch watch;
    frame.memory = std::move(memory_);
    LinearImage linear = method_->resolve(frame);
    frame.memory = {};
    // An upscaler in scene-linear light resolves to the image's size, with the environment already behind the frame.
    const bool is_upscaled = request.frame && !request.is_display_referred;
    if (!draws_surfaces(settings.options)) {
      clear(linear);
      draw_behind(camera, is_upscaled ? settings.options : options, linear);
    } else if (!is_upscaled) {
      draw_behind(camera, options, linear);
    }
    out.counts.resolve_ms = watch.ms();
    finish(std::move(linear), frame, request, settings, edge_coverage(camera, settings, request), out);
  }
  const bool are_planes_requested = settings.planes.any();
  Frame data = rounds.take_data();
  if (request.frame && are_planes_requested) out.data = render_data(camera, request, settings, out.counts);
  if (settings.planes.any_light()) render_light(camera, settings, out.counts, data);
  end_frame(camera, reads_last_moment(request.planes | settings.planes), request,
            are_planes_requested && !request.frame, data);
  if (are_planes_requested && !request.frame) out.data = std::move(data);
  if (request.halo > 0 && options.crop && !request.frame) cut_out(out, *options.crop, *settings.options.crop);
  return out;
}

RenderedImage Renderer::render_still(const Camera& camera, const RenderSettings& settings) {
  if (is_distorted(camera))
    return through_lens(*camera.lens, settings, [&](const Lens& lens, const RenderSettings& own) {
      return render_still(with_lens(camera, lens), own);
    });
  begin_sequence();
  RenderedImage image = render(camera, settings);
  // Lines are in no history: frames between the first and the last need none.
  RenderSettings settling = settings;
  settling.options.edges.kind = EdgeKind::None;
  RenderCounts counts = image.counts;
  for (int i = 1; i < settling_frames_; ++i) {
    recycle(std::move(image.display));
    image = render(camera, i + 1 < settling_frames_ ? settling : settings);
    add(counts, image.counts);
    counts.resolve_ms += image.counts.resolve_ms, counts.display_ms += image.counts.display_ms;
    counts.filter_ms += image.counts.filter_ms;
  }
  image.counts = counts;
  return image;
}

RenderedImage Renderer::render_mean(int count, const std::function<SceneView(int)>& moment,
                                    const RenderSettings& settings) {
  SceneView view = moment(0);
  if (is_distorted(view.camera))
    return through_lens(*view.camera.lens, settings, [&](const Lens& lens, const RenderSettings& own) {
      const auto without_distortion = [&](int i) {
        SceneView at = i == 0 ? view : moment(i);
        at.camera.lens = lens;
        return at;
      };
      return render_mean(count, without_distortion, own);
    });
  scene_ = std::move(view.scene);  // the ground of which the camera sees
  begin_frame(seeing_ground(view.camera, settings.options), settings);
  Request request = request_for(settings);
  if (method_->has_history())
    throw Error(ErrorKind::Usage,
                "motion blur is the mean of several moments, and the method keeps one history for all");
  request.writes_display8 = false;
  const RenderOptions options = frame_options(settings, request);

  RenderedImage out;
  LinearImage sum;
  Plane<float> edges;
  Rounds rounds;
  Camera camera;
  for (int i = 0; i < count; ++i) {
    if (i > 0) view = moment(i), scene_ = std::move(view.scene);
    camera = seeing_ground(view.camera, settings.options);
    rounds = render_rounds(camera, request, options, out.counts);
    const Stopwatch watch;
    LinearImage picture = method_->resolve(rounds.frame);
    if (!draws_surfaces(settings.options)) {
      clear(picture);
      draw_behind(camera, options, picture);
    }
    const Plane<float> covered = edge_coverage(camera, settings, request);
    if (edges.empty()) edges = {covered.width(), covered.height(), 0.0f};
    std::ranges::transform(edges.values(), covered.values(), edges.values().begin(), std::plus());
    if (i == 0) {
      sum = std::move(picture);
    } else {
      const auto values = sum.values();
      std::transform(values.begin(), values.end(), picture.values().begin(), values.begin(),
                     [](const Linear& a, const Linear& b) { return a + b; });
    }
    out.counts.resolve_ms += watch.ms();
  }
  const float weight = 1 / static_cast<float>(count);
  for (Linear& c : sum.values()) c = c * weight;
  for (float& part : edges.values()) part *= weight;
  finish(std::move(sum), rounds.frame, request, settings, edges, out);
  Frame data = rounds.take_data();
  end_frame(camera, reads_last_moment(request.planes), request, false, data);
  if (request.halo > 0 && options.crop && !request.frame) cut_out(out, *options.crop, *settings.options.crop);
  return out;
}

}  // namespace zoneplate
