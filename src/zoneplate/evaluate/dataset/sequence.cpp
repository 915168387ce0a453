// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/dataset/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/evaluate/dataset/npy.h"
#include "zoneplate/evaluate/dataset/nss.h"
#include "zoneplate/evaluate/dataset/shots.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/elementary.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/report/json.h"
#include "zoneplate/upscale/upscaler.h"
#include "zoneplate/version.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

/// One sample per pixel, with textures as sharp as the upscaled image needs them, or with another bias.
class OneSample : public Resolver {
 public:
  OneSample(const DatasetSequence& s, double ratio)
      : sequence_(s), footprint_(exp2(static_cast<float>(s.bias)) * static_cast<float>(1 / ratio)) {}
  Request request(const FrameContext& context) override {
    Request request{.samples = {sequence_.sample(context.index)}};
    request.footprint = footprint_;
    return request;
  }

 private:
  const DatasetSequence& sequence_;
  float footprint_;
};

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

/// The motion of each pixel, of the background that of the camera, in pixels.
Plane<float2> motion_of(const Frame& frame, const Cameras& cameras, SamplePosition sample) {
  const int width = frame.motion.width(), height = frame.motion.height();
  const antialias::CameraMotion camera(cameras.now, cameras.last, cameras.aspect, width, height);
  Plane<float2> out(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float depth = frame.depth(x, y);
      out(x, y) = std::isinf(depth) ? camera.at(x + sample.x / 256.0, y + sample.y / 256.0, static_cast<double>(depth))
                                    : frame.motion(x, y);
    }
  return out;
}

/// The frames, this one included, in which the surface of each pixel has been visible without a break: one more than
/// where it was in the last frame, if that saw it. `before` are those of the last frame, or empty.
Plane<std::uint32_t> counted(const Frame& frame, const Plane<float2>& motion, const Plane<std::uint32_t>& before) {
  Plane<std::uint32_t> out(motion.width(), motion.height(), 1);
  if (before.empty()) return out;
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      if (frame.was_visible(x, y) == 0) continue;
      const float2 m = motion(x, y);
      const double from_x = std::floor(x - double{m.x} + 0.5), from_y = std::floor(y - double{m.y} + 0.5);
      if (from_x >= 0 && from_y >= 0 && from_x < out.width() && from_y < out.height())
        out(x, y) = before(static_cast<int>(from_x), static_cast<int>(from_y)) + 1;
    }
  return out;
}

/// The file of one pass of a frame.
std::string path_of(const DatasetSequence& s, const std::string& pass, int frame) {
  const char* const ending = s.layout == DatasetLayout::Npy ? "npy" : "exr";
  return (fs::path(s.folder) / pass / fmt::format("{:04}", s.number) / fmt::format("{:04}.{}", frame, ending)).string();
}

/// The offsets of the samples, as zoneplate filter --jitter reads them.
std::string jitter_path(const DatasetSequence& s) {
  return (fs::path(s.folder) / "jitter" / fmt::format("{:04}.txt", s.number)).string();
}

/// Encodes the planes of a frame and delivers their files.
class PlaneFiles {
 public:
  PlaneFiles(const DatasetSequence& s, int frame, Delivery& out) : s_(s), frame_(frame), out_(out) {}

  void color(const std::string& pass, const LinearImage& image) {
    const float* const first = &image.values().data()->r;
    if (s_.layout == DatasetLayout::Nss) return exr(pass, image, rgba_channels(image));
    if (s_.layout == DatasetLayout::Npy) {
      std::vector<float> values;
      for (const Linear& c : image.values()) values.insert(values.end(), {c.r, c.g, c.b});
      return npy(pass, std::array{image.height(), image.width(), 3}, std::span<const float>(values));
    }
    exr(pass, image,
        {{"R", ExrType::Float, first, nullptr, 4},
         {"G", ExrType::Float, first + 1, nullptr, 4},
         {"B", ExrType::Float, first + 2, nullptr, 4}});
  }
  /// In the layout Nss in widths and heights of the image, otherwise in pixels.
  void motion(const std::string& pass, Plane<float2> motion) {
    const bool is_nss = s_.layout == DatasetLayout::Nss;
    const auto width = static_cast<float>(motion.width()), height = static_cast<float>(motion.height());
    if (is_nss)
      for (float2& m : motion.values()) m = {m.x / width, m.y / height};
    const float* const first = &motion.values().data()->x;
    if (s_.layout == DatasetLayout::Npy)
      return npy(pass, std::array{motion.height(), motion.width(), 2},
                 std::span<const float>(first, 2 * motion.values().size()));
    const ExrType type = is_nss ? ExrType::Half : ExrType::Float;
    exr(pass, motion, {{"R", type, first, nullptr, 2}, {"G", type, first + 1, nullptr, 2}});
  }
  /// In the layout Nss from 0 at the near plane to 1 at the far plane, otherwise the distance along the view axis.
  void depth(const std::string& pass, const Frame& frame) {
    Plane<float> depth = s_.layout == DatasetLayout::Nss ? frame.reversed_depth : frame.depth;
    if (s_.layout == DatasetLayout::Nss)
      for (float& d : depth.values()) d = 1 - d;
    if (s_.layout == DatasetLayout::Npy) return npy(pass, shape_of(depth), std::span<const float>(depth.values()));
    exr(pass, depth, {{"R", ExrType::Float, depth.values().data(), nullptr, 1}});
  }
  void numbers(const std::string& pass, const Plane<std::uint32_t>& plane) {
    if (s_.layout == DatasetLayout::Npy)
      return npy(pass, shape_of(plane), std::span<const std::uint32_t>(plane.values()));
    exr(pass, plane, {{"R", ExrType::Number, nullptr, plane.values().data(), 1}});
  }
  void flags(const std::string& pass, const Plane<std::uint8_t>& plane) {
    if (s_.layout == DatasetLayout::Npy)
      return npy(pass, shape_of(plane), std::span<const std::uint8_t>(plane.values()));
    Plane<std::uint32_t> wide(plane.width(), plane.height());
    std::ranges::copy(plane.values(), wide.values().begin());
    numbers(pass, wide);
  }

 private:
  template <class T>
  static std::array<int, 2> shape_of(const Plane<T>& plane) {
    return {plane.height(), plane.width()};
  }
  template <class T>
  void npy(const std::string& pass, std::span<const int> shape, std::span<const T> values) {
    out_.save(path_of(s_, pass, frame_), encode_npy(shape, values));
  }
  template <class T>
  void exr(const std::string& pass, const Plane<T>& plane, std::vector<ExrChannel> channels) {
    out_.save(path_of(s_, pass, frame_), encode_exr(plane.width(), plane.height(), std::move(channels)));
  }

  const DatasetSequence& s_;
  int frame_;
  Delivery& out_;
};

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

/// A renderer of one image of each frame with its data, and of the further planes that the sequence has.
class DataPass {
 public:
  DataPass(const DatasetSequence& s, std::unique_ptr<Resolver> method, RenderSettings settings)
      : passes_(s.passes), pass_(std::move(method), with_planes(passes_, std::move(settings))) {}

  RenderedImage render(const SceneView& view) { return pass_.render(view); }
  void save_further(const Frame& frame, const Plane<float2>& motion, PlaneFiles& files, const std::string& folder,
                    const std::string& ending) {
    if (passes_.ids) files.numbers(folder + "object_id" + ending, frame.object_id);
    if (passes_.visible) files.flags(folder + "was_visible" + ending, frame.was_visible);
    if (!passes_.count) return;
    count_ = counted(frame, motion, count_);
    files.numbers(folder + "count" + ending, count_);
  }

 private:
  static RenderSettings with_planes(const DatasetPasses& passes, RenderSettings settings) {
    settings.planes.motion = settings.planes.depth = true;
    settings.planes.object_id = passes.ids;
    settings.planes.was_visible = passes.visible || passes.count;
    return settings;
  }

  DatasetPasses passes_;
  Pass pass_;
  Plane<std::uint32_t> count_;
};

/// The names of the further planes, with an ending.
std::vector<std::string> further_names(const DatasetPasses& passes, const std::string& ending) {
  std::vector<std::string> out;
  if (passes.ids) out.push_back("object_id" + ending);
  if (passes.visible) out.push_back("was_visible" + ending);
  if (passes.count) out.push_back("count" + ending);
  return out;
}

/// The JSON file of the layouts Npy and Exr.
std::string own_json(const DatasetSequence& s, Shots& shots) {
  Json::Object ratios;
  for (const double ratio : s.ratios) {
    const ImageExtent low = frame_size({s.size.x, s.size.y, std::nullopt}, ratio);
    ratios.emplace_back(folder_of_ratio(ratio), Json::Object{{"Width", low.width}, {"Height", low.height}});
  }
  Json::Array further;
  for (const std::string& name : further_names(s.passes, "")) further.emplace_back(name);
  Json::Array frames;
  for (int frame = 0; frame < s.frames; ++frame) {
    const Camera camera = shots.camera(frame);
    const float2 jitter = s.jitter(frame);
    Json::Object row{{"Jitter", Json::Array{jitter.x, jitter.y}},
                     {"WorldFromCamera", columns_of(camera.world_from_camera)},
                     {"Near", camera.near},
                     {"Far", camera.far}};
    if (camera.is_orthographic)
      row.emplace_back("HalfHeight", camera.half_height);
    else
      row.emplace_back("FovY", camera.vertical_fov);
    frames.emplace_back(std::move(row));
  }
  return Json(Json::Object{{"Layout", s.layout == DatasetLayout::Npy ? "npy" : "exr"},
                           {"Program", std::string("Zoneplate ") + version},
                           {"Scene", s.scene},
                           {"Reference", s.reference},
                           {"Seed", static_cast<std::int64_t>(s.seed)},
                           {"Start", shots.start()},
                           {"Rate", s.rate},
                           {"Bias", s.bias},
                           {"Width", s.size.x},
                           {"Height", s.size.y},
                           {"Ratios", std::move(ratios)},
                           {"Passes", std::move(further)},
                           {"Frames", std::move(frames)}})
             .indented() +
         '\n';
}

}  // namespace

std::string folder_of_ratio(double ratio) {
  const int tenths = static_cast<int>(std::lround(ratio * 10));
  return tenths % 10 == 0 ? fmt::format("x{}", tenths / 10) : fmt::format("x{}_{}", tenths / 10, tenths % 10);
}

std::string dataset_json_path(const DatasetSequence& s) {
  return (fs::path(s.folder) / fmt::format("{:04}.json", s.number)).string();
}

std::vector<std::string> dataset_paths(const DatasetSequence& s) {
  std::vector<std::string> passes = further_names(s.passes, "_gt"), out{dataset_json_path(s)};
  passes.insert(passes.end(), {"ground_truth", "motion_gt"});
  for (const double ratio : s.ratios) {
    std::vector<std::string> names = further_names(s.passes, "");
    names.insert(names.end(), {"color", "motion", "depth"});
    for (const std::string& name : names) passes.push_back(folder_of_ratio(ratio) + '/' + name);
  }
  for (const std::string& pass : passes)
    for (int frame = 0; frame < s.frames; ++frame) out.push_back(path_of(s, pass, frame));
  if (s.layout != DatasetLayout::Nss) out.push_back(jitter_path(s));
  return out;
}

void make_dataset_sequence(const DatasetSequence& s, const std::function<void(int frame)>& progress, Delivery& out) {
  std::optional<SceneSource> source;
  out.read(s.scene, [&] { source.emplace(s.scene, s.load).load({}); });
  Shots shots(s, *source);
  const std::string json = s.layout == DatasetLayout::Nss ? nss_json(s, shots) : own_json(s, shots);
  const std::string json_path = dataset_json_path(s);
  if (fs::exists(json_path)) {
    const FileBytes file(json_path);
    if (std::string(file.bytes().begin(), file.bytes().end()) == json) return;
    throw Error(ErrorKind::Output, json_path + ": is of a sequence with other settings; choose another folder");
  }

  Pass truth(upscale::make_method(s.reference), settings_of(s.size.x, s.size.y));
  DataPass truth_data(s, nearest_of_sixteen(), settings_of(s.size.x, s.size.y));
  std::vector<DataPass> inputs;
  for (const double ratio : s.ratios) {
    const ImageExtent low = frame_size({s.size.x, s.size.y, std::nullopt}, ratio);
    RenderSettings settings = settings_of(low.width, low.height);
    settings.options.aspect = s.aspect();
    inputs.emplace_back(s, std::make_unique<OneSample>(s, ratio), settings);
  }

  Camera last;
  for (int frame = 0; frame < s.frames; ++frame) {
    progress(frame);
    const SceneView view = shots.view(frame);
    if (frame == 0) last = view.camera;
    const Cameras cameras{view.camera, last, s.aspect()};
    PlaneFiles files(s, frame, out);
    files.color("ground_truth", opaque(truth.render(view).linear));
    const Frame nearest = truth_data.render(view).data;
    const Plane<float2> motion = motion_of(nearest, cameras, {});
    files.motion("motion_gt", motion);
    truth_data.save_further(nearest, motion, files, "", "_gt");
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const std::string folder = folder_of_ratio(s.ratios[i]) + '/';
      RenderedImage image = inputs[i].render(view);
      const Plane<float2> low_motion = motion_of(image.data, cameras, s.sample(frame));
      files.color(folder + "color", opaque(std::move(image.linear)));
      files.motion(folder + "motion", low_motion);
      files.depth(folder + "depth", image.data);
      inputs[i].save_further(image.data, low_motion, files, folder, "");
    }
    last = view.camera;
  }
  if (s.layout != DatasetLayout::Nss) {
    std::string lines;
    for (int frame = 0; frame < s.frames; ++frame)
      lines += fmt::format("{} {}\n", s.jitter(frame).x, s.jitter(frame).y);
    out.save(jitter_path(s), lines);
  }
  out.save(json_path, json);
}

}  // namespace zoneplate
