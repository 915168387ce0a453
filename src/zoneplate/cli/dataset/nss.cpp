// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/dataset/nss.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/dataset/camera_path.h"
#include "zoneplate/codec/exr_encode.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/sequence.h"
#include "zoneplate/upscale/upscaler.h"
#include "zoneplate/version.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

/// Width / height of all views: a frame of fewer pixels shows that of the ground truth.
float aspect_of(const NssSequence& s) { return static_cast<float>(s.size.x) / static_cast<float>(s.size.y); }

SamplePosition sample_of(int frame, int positions) {
  return halton_sequence(positions)[static_cast<std::size_t>(frame % positions)];
}
float offset_of(std::uint8_t position) { return static_cast<float>(position) / 256 - 0.5f; }

/// One sample per pixel, with textures as sharp as the upscaled image needs them.
class OneSample : public Resolver {
 public:
  OneSample(int positions, double ratio) : positions_(positions), footprint_(static_cast<float>(1 / ratio)) {}
  Request request(const FrameContext& context) override {
    Request request{.samples = {sample_of(context.index, positions_)}};
    request.footprint = footprint_;
    return request;
  }

 private:
  int positions_;
  float footprint_;
};

/// The data of the nearest surface at 16 samples of each pixel.
class NearestOfSixteen : public Resolver {
 public:
  Request request(const FrameContext&) override { return {.samples = standard_pattern(16), .content = Content::Data}; }
};

/// The distance that a quarter of a view's surfaces do not reach; 1 without surfaces.
float usual_distance(const SceneView& view, float aspect) {
  RenderSettings settings{.form = ImageForm::Linear};
  settings.options.width = 64, settings.options.height = 36, settings.options.aspect = aspect;
  settings.planes.depth = true;
  std::vector<float> found;
  const Frame data = Renderer(view.scene, std::make_unique<NearestOfSixteen>()).render(view.camera, settings).data;
  for (const float depth : data.depth.values())
    if (std::isfinite(depth)) found.push_back(depth);
  if (found.empty()) return 1;
  const auto quarter = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 4);
  std::nth_element(found.begin(), quarter, found.end());
  return *quarter;
}

LinearImage opaque(LinearImage image) {
  const float light = decode_srgb(default_background.x);
  for (Linear& c : image.values()) c = {c.r + light * (1 - c.a), c.g + light * (1 - c.a), c.b + light * (1 - c.a), 1};
  return image;
}

/// The cameras of two frames, for views of this aspect.
struct Cameras {
  const Camera &now, &last;
  float aspect;
};

/// The motion of each pixel, of the background that of the camera, in widths and heights of the image.
std::vector<float2> motion_of(const Frame& frame, const Cameras& cameras, SamplePosition sample) {
  const int width = frame.motion.width(), height = frame.motion.height();
  const antialias::CameraMotion camera(cameras.now, cameras.last, cameras.aspect, width, height);
  std::vector<float2> out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float depth = frame.depth(x, y);
      const float2 pixels = std::isinf(depth)
                                ? camera.at(x + sample.x / 256.0, y + sample.y / 256.0, static_cast<double>(depth))
                                : frame.motion(x, y);
      out.push_back({pixels.x / static_cast<float>(width), pixels.y / static_cast<float>(height)});
    }
  return out;
}

/// Depth that increases from 0 at the near plane to 1 at the far plane.
Plane<float> forward_depth(Plane<float> reversed) {
  for (float& depth : reversed.values()) depth = 1 - depth;
  return reversed;
}

std::vector<ExrChannel> motion_channels(const std::vector<float2>& motion) {
  return {{"R", ExrType::Half, &motion[0].x, nullptr, 2}, {"G", ExrType::Half, &motion[0].y, nullptr, 2}};
}

Json::Object vector(double x, double y) { return {{"X", x}, {"Y", y}}; }

/// The matrix that multiplies column vectors, column by column.
Json::Array columns_of(const float4x4& m) {
  Json::Array out;
  for (const float4& column : m.column)
    for (const float value : {column.x, column.y, column.z, column.w}) out.emplace_back(value);
  return out;
}

/// A projection to reversed depth as one to forward_depth.
float4x4 forward_projection(float4x4 clip_from_camera) {
  for (float4& column : clip_from_camera.column) column.z = column.w - column.z;
  return clip_from_camera;
}

/// The scenes and the cameras of a sequence.
class Shots {
 public:
  /// `source` is that of the sequence's scene, and outlives this object.
  Shots(const NssSequence& s, SceneSource& source)
      : source_(source), path_(s.seed, static_cast<std::uint32_t>(s.number)), sequence_(sequence_of(s)) {
    const Scene first = at(0);
    View view{.up = first.up};
    if (!first.cameras.empty()) view.index = 0;
    const float aspect = aspect_of(s);
    sequence_.set_view(view, aspect);
    distance_ = usual_distance(sequence_.view(0), aspect);
  }
  SceneView view(int frame) {
    SceneView out = sequence_.view(frame);
    out.camera = path_.at(out.camera, distance_, frame);
    return out;
  }
  Camera camera(int frame) { return path_.at(sequence_.moment(frame).camera, distance_, frame); }

 private:
  Scene at(double seconds) {
    choice_.time = seconds;
    Scene scene = source_.load(choice_);
    light_unlit(scene);
    return scene;
  }
  Sequence sequence_of(const NssSequence& s) {
    const Scene scene = source_.load({});
    if (!scene.animations.empty()) choice_.animation = 0;
    const auto load = [this](double seconds) { return at(seconds); };
    const auto shape = [this](double seconds) {
      choice_.time = seconds;
      return source_.load_shape(choice_);
    };
    const auto key_times = [this] { return source_.key_times(choice_); };
    // A sequence begins early enough to end within the animation, if it is long enough.
    double duration = 0;
    for (const auto& animation : scene.animations) duration = std::max(duration, static_cast<double>(animation.end));
    const double length = static_cast<double>(s.frames) / s.rate;
    const double start = std::max(0.0, duration - length) * static_cast<double>(path_.start());
    return {{load, shape, key_times}, {}, {.rate = static_cast<double>(s.rate), .start = start, .duration = length}};
  }

  SceneSource& source_;
  CameraPath path_;
  SceneChoice choice_;
  Sequence sequence_;
  float distance_ = 1;
};

Json::Object frame_json(const NssSequence& s, const Camera& camera, int frame) {
  const float aspect = aspect_of(s);
  const SamplePosition sample = sample_of(frame, s.positions);
  const double x = static_cast<double>(offset_of(sample.x)), y = static_cast<double>(offset_of(sample.y));
  Json::Array jitters;
  for (const double ratio : s.ratios) {
    const ImageExtent low = frame_size({s.size.x, s.size.y, std::nullopt}, ratio);
    jitters.emplace_back(vector(x / low.width, y / low.height));
  }
  const float4x4 clip = camera.clip_from_camera(aspect);
  return {{"Frame", frame},
          {"FovX", static_cast<float>(2 * std::atan(1 / static_cast<double>(clip.column[0].x)))},
          {"FovY", camera.vertical_fov},
          {"CameraNearPlane", camera.near},
          {"CameraFarPlane", std::isinf(camera.far) ? -1.0f : camera.far},
          {"ViewProjection", columns_of(forward_projection(clip) * inverse(camera.world_from_camera))},
          {"Exposure", 1.0},
          {"CameraCut", frame == 0},
          {"Jitter", vector(x, y)},
          {"NormalizedPerRatioJitter", std::move(jitters)}};
}

std::string json_of(const NssSequence& s, Shots& shots) {
  Json::Object indices;
  for (std::size_t i = 0; i < s.ratios.size(); ++i)
    indices.emplace_back(nss_folder_of(s.ratios[i]) + "_index", static_cast<std::int64_t>(i));
  Json::Array frames;
  for (int frame = 0; frame < s.frames; ++frame) frames.emplace_back(frame_json(s, shots.camera(frame), frame));
  return Json(Json::Object{
                  {"Version", "1.0.1"},
                  {"Source", Json::Object{{"Program", std::string("Zoneplate ") + version},
                                          {"Scene", s.scene},
                                          {"Reference", s.reference},
                                          {"Seed", static_cast<std::int64_t>(s.seed)}}},
                  {"MotionVectorsDilated", false},
                  {"UnjitteredSrcColor_Exported", false},
                  {"OpaqueOnlyColor_Exported", false},
                  {"EmulatedFramerate", s.rate},
                  {"GTColorSpace", "Linear"},
                  {"ReverseZ", false},
                  {"TargetResolution", Json::Object{{"X", s.size.x}, {"Y", s.size.y}}},
                  {"UpscalingRatiosIndices", std::move(indices)},
                  {"Samples", Json::Object{{"Sequence", "Halton"}, {"Count", s.positions}, {"Quantized", true}}},
                  {"Frames", std::move(frames)}})
             .indented() +
         '\n';
}

/// The file of one pass of a frame.
std::string path_of(const NssSequence& s, const std::string& pass, int frame) {
  return (fs::path(s.folder) / pass / fmt::format("{:04}", s.number) / fmt::format("{:04}.exr", frame)).string();
}

RenderSettings settings_of(int width, int height) {
  RenderSettings settings{.form = ImageForm::Linear};
  settings.options.width = width, settings.options.height = height;
  return settings;
}

/// A renderer of one image of each frame.
class Pass {
 public:
  Pass(std::unique_ptr<Resolver> method, RenderSettings settings)
      : method_(std::move(method)), settings_(std::move(settings)) {}
  RenderedImage render(const SceneView& view) {
    if (renderer_)
      renderer_->set_scene(view.scene);
    else
      renderer_ = std::make_unique<Renderer>(view.scene, std::move(method_));
    return renderer_->render(view.camera, settings_);
  }

 private:
  std::unique_ptr<Resolver> method_;
  RenderSettings settings_;
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace

std::string nss_folder_of(double ratio) {
  const int tenths = static_cast<int>(std::lround(ratio * 10));
  return tenths % 10 == 0 ? fmt::format("x{}", tenths / 10) : fmt::format("x{}_{}", tenths / 10, tenths % 10);
}

std::string nss_json_path(const NssSequence& s) {
  return (fs::path(s.folder) / fmt::format("{:04}.json", s.number)).string();
}

std::vector<std::string> nss_paths(const NssSequence& s) {
  std::vector<std::string> passes{"ground_truth", "motion_gt"}, out{nss_json_path(s)};
  for (const double ratio : s.ratios)
    for (const char* pass : {"/color", "/motion", "/depth"}) passes.push_back(nss_folder_of(ratio) + pass);
  for (const std::string& pass : passes)
    for (int frame = 0; frame < s.frames; ++frame) out.push_back(path_of(s, pass, frame));
  return out;
}

void make_nss_sequence(const NssSequence& s, const std::function<void(int frame)>& progress, Delivery& out) {
  std::optional<SceneSource> source;
  out.read(s.scene, [&] { source.emplace(s.scene, s.load).load({}); });
  Shots shots(s, *source);
  const std::string json = json_of(s, shots), json_path = nss_json_path(s);
  if (fs::exists(json_path)) {
    const FileBytes file(json_path);
    if (std::string(file.bytes().begin(), file.bytes().end()) == json) return;
    throw Error(ErrorKind::Output, json_path + ": is of a sequence with other settings; choose another folder");
  }

  Pass truth(upscale::make_method(s.reference), settings_of(s.size.x, s.size.y));
  RenderSettings data = settings_of(s.size.x, s.size.y);
  data.planes.motion = data.planes.depth = true;
  Pass truth_motion(std::make_unique<NearestOfSixteen>(), data);
  std::vector<Pass> inputs;
  for (const double ratio : s.ratios) {
    const ImageExtent low = frame_size({s.size.x, s.size.y, std::nullopt}, ratio);
    RenderSettings settings = settings_of(low.width, low.height);
    settings.options.aspect = aspect_of(s);
    settings.planes.motion = settings.planes.depth = true;
    inputs.emplace_back(std::make_unique<OneSample>(s.positions, ratio), settings);
  }

  Camera last;
  for (int frame = 0; frame < s.frames; ++frame) {
    progress(frame);
    const SceneView view = shots.view(frame);
    if (frame == 0) last = view.camera;
    const Cameras cameras{view.camera, last, aspect_of(s)};
    const auto save = [&](const std::string& pass, int width, int height, std::vector<ExrChannel> channels) {
      out.save(path_of(s, pass, frame), encode_exr(width, height, std::move(channels)));
    };
    const LinearImage color = opaque(truth.render(view).linear);
    save("ground_truth", s.size.x, s.size.y, rgba_channels(color));
    const Frame nearest = truth_motion.render(view).data;
    const std::vector<float2> motion = motion_of(nearest, cameras, {});
    save("motion_gt", s.size.x, s.size.y, motion_channels(motion));
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const std::string folder = nss_folder_of(s.ratios[i]);
      RenderedImage image = inputs[i].render(view);
      const int width = image.linear.width(), height = image.linear.height();
      const LinearImage low = opaque(std::move(image.linear));
      const std::vector<float2> low_motion = motion_of(image.data, cameras, sample_of(frame, s.positions));
      const Plane<float> depth = forward_depth(std::move(image.data.reversed_depth));
      save(folder + "/color", width, height, rgba_channels(low));
      save(folder + "/motion", width, height, motion_channels(low_motion));
      save(folder + "/depth", width, height, {{"R", ExrType::Float, depth.values().data(), nullptr, 1}});
    }
    last = view.camera;
  }
  out.save(json_path, json);
}

}  // namespace zoneplate::cli
