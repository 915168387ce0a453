// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/filter/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <sstream>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/imaging/filter/color.h"
#include "zoneplate/imaging/filter/frames.h"
#include "zoneplate/imaging/filter/still.h"
#include "zoneplate/metrics/backdrop.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/os/file.h"
#include "zoneplate/process/exr_layer.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

using Names = std::vector<std::string>;

/// A plane of data in the channels of an EXR file, of the first of these lists that the file has completely.
struct Pass {
  const char* name;
  std::vector<Names> in_frame, in_own_file;
};

const Pass& depth_pass() {
  static const Pass pass{"depth", {{"Z"}, {"depth.Z"}}, {{"Z"}, {"depth.Z"}, {"R"}, {"Y"}}};
  return pass;
}
const Pass& motion_pass() {
  static const Pass pass{"motion", {{"motion.X", "motion.Y"}}, {{"motion.X", "motion.Y"}, {"X", "Y"}, {"R", "G"}}};
  return pass;
}

/// Where the planes of one frame are.
struct FrameFiles {
  std::string color, depth, motion, output;
  Names depth_channels, motion_channels;
  bool has_ids = false;  ///< in `color`
};

constexpr const char* id_channel = "objectId";

bool has_all(const Names& found, const Names& wanted) {
  return std::ranges::all_of(wanted, [&](const std::string& w) { return std::ranges::find(found, w) != found.end(); });
}

Names channels_in(const std::string& path) {
  const FileBytes file(path);
  return exr_channel_names(file.bytes());
}

/// `found` are the channels of the file.
Names channels_of(const Pass& pass, const std::string& path, const Names& found, bool is_own_file) {
  for (const Names& wanted : is_own_file ? pass.in_own_file : pass.in_frame)
    if (has_all(found, wanted)) return wanted;
  if (is_own_file)
    throw Error(ErrorKind::Input, fmt::format("{}: is no EXR image with a channel of {}", path, pass.name));
  throw Error(ErrorKind::Input, fmt::format("{0}: has no channel of {1}: give --{1} FILES, or render with --aov "
                                            "depth,motion,object-id to .exr; of images alone: --aa "
                                            "learned-smaa, --upscale learned-still",
                                            path, pass.name));
}

std::vector<FrameFiles> checked_files(const SequenceFilter& filter) {
  const std::vector<std::string>&depth = filter.passes.depth, &motion = filter.passes.motion;
  const std::size_t count = filter.animation ? filter.animation->names.size() : filter.items.size();
  if (!depth.empty()) check_count("--depth", depth.size(), count);
  if (!motion.empty()) check_count("--motion", motion.size(), count);
  std::vector<FrameFiles> out;
  for (std::size_t i = 0; i < count; ++i) {
    FrameFiles frame;
    if (filter.animation)
      frame.color = fmt::format("{}, {}", filter.items[0].input, filter.animation->names[i]);
    else
      frame.color = filter.items[i].input, frame.output = filter.items[i].output;
    const Names own = filter.animation ? Names{} : channels_in(frame.color);
    frame.depth = depth.empty() ? frame.color : depth[i], frame.motion = motion.empty() ? frame.color : motion[i];
    frame.depth_channels =
        channels_of(depth_pass(), frame.depth, depth.empty() ? own : channels_in(frame.depth), !depth.empty());
    frame.motion_channels =
        channels_of(motion_pass(), frame.motion, motion.empty() ? own : channels_in(frame.motion), !motion.empty());
    frame.has_ids = has_all(own, {id_channel});
    out.push_back(std::move(frame));
  }
  return out;
}

/// The samples of a text file: two numbers for each frame, the offset from the pixel's centre, +x right, +y down.
std::vector<SamplePosition> samples_of(const std::string& path, std::size_t count) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorKind::Input, path + ": cannot be read");
  std::vector<SamplePosition> out;
  for (std::string line; std::getline(file, line);) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::istringstream words(line);
    double x = 0, y = 0;
    std::string rest;
    const bool is_read = static_cast<bool>(words >> x >> y) && !(words >> rest);
    if (!is_read || !(x >= -0.5 && x < 0.5 && y >= -0.5 && y < 0.5))
      throw Error(ErrorKind::Input,
                  fmt::format("{}:{}: is '{}', expected an offset from the pixel's centre, x and y in [-0.5, 0.5)",
                              path, out.size() + 1, line));
    const auto code = [](double v) { return static_cast<std::uint8_t>(std::min(255.0, std::floor(v * 256 + 128.5))); };
    out.push_back({code(x), code(y)});
  }
  if (out.size() != count)
    throw Error(ErrorKind::Input,
                fmt::format("{}: has {} samples, expected {}, one for each image", path, out.size(), count));
  return out;
}

std::vector<Plane<float>> planes_of(const std::string& path, const Names& channels, const std::string& color, int width,
                                    int height, Delivery& out) {
  std::vector<Plane<float>> planes;
  out.read(path, [&] {
    const FileBytes file(path);
    planes = decode_exr_channels(file.bytes(), path, channels, out.limits().pixels);
  });
  if (planes[0].width() != width || planes[0].height() != height)
    throw Error(ErrorKind::Input, fmt::format("{}: has {}x{} pixels, expected {}x{} as {}", path, planes[0].width(),
                                              planes[0].height(), width, height, color));
  return planes;
}

/// The numbers of objects in the order in which they appear, for methods whose tables have one entry for each.
class ObjectNumbers {
 public:
  std::uint32_t of(float id) { return numbers_.emplace(id, static_cast<std::uint32_t>(numbers_.size())).first->second; }

 private:
  std::map<float, std::uint32_t> numbers_;
};

/// The planes of a frame, of every pixel as of a surface: the motion of the background is that of the files.
Frame frame_of(const FrameFiles& files, LinearImage color, const SequenceFilter& filter, float near,
               ObjectNumbers& objects, Delivery& out) {
  const int width = color.width(), height = color.height();
  constexpr float farthest = 9999999;  // finite, beyond all surfaces
  Frame frame;
  frame.color = std::move(color);
  frame.depth = std::move(planes_of(files.depth, files.depth_channels, files.color, width, height, out)[0]);
  const std::vector<Plane<float>> motion =
      planes_of(files.motion, files.motion_channels, files.color, width, height, out);
  Plane<float> ids;
  if (files.has_ids) ids = std::move(planes_of(files.color, {id_channel}, files.color, width, height, out)[0]);
  frame.reversed_depth = Plane<float>(width, height);
  frame.motion = Plane<float2>(width, height);
  frame.object_id = Plane<std::uint32_t>(width, height);
  frame.last_position = Plane<float3>(width, height);
  for (std::size_t i = 0; i < frame.depth.values().size(); ++i) {
    float& depth = frame.depth.values()[i];
    const float2 found{motion[0].values()[i], motion[1].values()[i]};
    if (std::isnan(depth) || depth < 0 || !std::isfinite(found.x) || !std::isfinite(found.y))
      throw Error(
          ErrorKind::Input,
          fmt::format("{}: pixel ({}, {}) has depth {} and motion ({}, {}), expected a distance and finite numbers",
                      std::isnan(depth) || depth < 0 ? files.depth : files.motion, i % static_cast<std::size_t>(width),
                      i / static_cast<std::size_t>(width), depth, found.x, found.y));
    const bool is_empty = depth >= farthest;
    depth = std::min(depth, farthest);
    frame.reversed_depth.values()[i] = near / std::max(depth, near);
    frame.motion.values()[i] = {found.x * filter.motion_scale.x, found.y * filter.motion_scale.y};
    frame.object_id.values()[i] = objects.of(!ids.empty() ? ids.values()[i] : is_empty ? 1.0f : 0.0f);
    frame.last_position.values()[i] = {0, 0, -depth};  // its depth in the last frame is taken to be that of this one
  }
  return frame;
}

/// `light` is of the primaries of the space.
void save_codes(const std::string& path, LinearImage light, const RgbSpacePtr& space, int bit_depth, Delivery& out) {
  const ColorProfile profile = profile_of(space);
  const DisplayImage display = display_of(std::move(light), space);
  if (bit_depth == 8) return out.save(path, encode_image(path, quantize8(display), profile));
  out.save(path, encode_png(quantize16(display), {.profile = profile}));
}

}  // namespace

bool filters_sequences(const std::string& method) {
  FrameContext context;
  context.image = {64, 64, std::nullopt};
  const std::unique_ptr<Resolver> resolver = upscale::make_method(method);
  const Request request = resolver->request(context);
  const Planes& p = request.planes;
  const bool reads_more = p.normal || p.albedo || p.uv || p.material_id || p.primitive_id || p.coverage || p.position ||
                          p.flow || p.was_visible || p.mip_level || p.anisotropy || p.error || p.samples ||
                          p.sample_triangles || p.sample_colors;
  return resolver->has_history() && request.samples.size() == 1 && !request.draw &&
         request.content == Content::Colour && !request.is_display_referred && !reads_more;
}

void filter_sequence(const SequenceFilter& filter, Delivery& out) {
  const std::vector<FrameFiles> files = checked_files(filter);
  std::vector<SamplePosition> samples;
  if (!filter.jitter.empty()) samples = samples_of(filter.jitter, files.size());

  const std::unique_ptr<Resolver> method = upscale::make_method(filter.method);
  Camera camera;
  camera.near = 0.1f, camera.far = std::numeric_limits<float>::infinity();
  camera.vertical_fov = filter.fov * std::numbers::pi_v<float> / 180;
  ObjectNumbers objects;
  int2 frame_size{0, 0};
  std::optional<FrameSink> sink;
  if (filter.animation) sink.emplace(filter.items[0], *filter.animation, filter.bit_depth, out);
  for (std::size_t i = 0; i < files.size(); ++i) {
    out.progress(files[i].color, static_cast<double>(i) / static_cast<double>(files.size()));
    Still still;
    if (filter.animation)
      still.file = filter.animation->open(i), still.picture = load_still(still.file, out);
    else
      still = load_still(files[i].color, {.layer = filter.layer}, out);
    metrics::Picture& picture = still.picture;
    picture = sink ? metrics::in_srgb(std::move(picture))
                   : in_space_of(std::move(picture), FilteredValues::Light, files[i].color, files[i].output, out);
    if (filter.background) lay_over(picture, *filter.background);
    if (!sink && picture.is_scene_linear != is_linear_file(files[i].output))
      throw Error(ErrorKind::Usage,
                  fmt::format("{}: is a {} image, and {} is not: write {}", files[i].color,
                              picture.is_scene_linear ? "scene-linear" : "display-referred", files[i].output,
                              picture.is_scene_linear ? "an .exr or a .pfm" : "a .png"));
    const int2 own{picture.width(), picture.height()};
    if (i == 0) frame_size = own;
    if (own.x != frame_size.x || own.y != frame_size.y)
      throw Error(ErrorKind::Input, fmt::format("{}: has {}x{} pixels, expected {}x{} as the first frame",
                                                files[i].color, own.x, own.y, frame_size.x, frame_size.y));
    const auto scaled = [&](int side) { return static_cast<int>(std::floor(side * filter.scale + 0.5)); };
    const int2 size = filter.size.value_or(int2{scaled(own.x), scaled(own.y)});
    if (size.x < own.x || size.y < own.y)
      throw Error(ErrorKind::Usage, fmt::format("--size {}x{}: is smaller than {}, which has {}x{} pixels", size.x,
                                                size.y, files[i].color, own.x, own.y));
    FrameContext context{.image = {size.x, size.y, std::nullopt},
                         .index = static_cast<int>(i),
                         .is_first = i == 0,
                         .camera = camera,
                         .last_camera = camera};
    context.given = GivenFrame{own.x, own.y, std::nullopt};
    if (!samples.empty()) context.given->sample = samples[i];
    method->request(context);
    const bool is_scene_linear = picture.is_scene_linear, has_alpha = metrics::has_alpha(picture);
    const RgbSpacePtr space = picture.space;
    Frame frame = frame_of(files[i], std::move(picture.linear), filter, camera.near, objects, out);
    frame.display.is_transparent = has_alpha;
    LinearImage image;
    try {
      image = method->resolve(frame);
    } catch (const Error& error) {
      throw Error(error.kind(), files[i].color + ": " + error.what());
    }
    if (sink) {
      sink->add(display_of(std::move(image), space), filter.animation->time_of(i));
      continue;
    }
    if (!is_scene_linear) {
      save_codes(files[i].output, std::move(image), space, filter.bit_depth, out);
      continue;
    }
    warn_of_left_out(files[i].output, files[i].color, save_light(files[i].output, image, still.file, {}, out), out);
  }
  if (sink) sink->finish();
}

}  // namespace zoneplate
