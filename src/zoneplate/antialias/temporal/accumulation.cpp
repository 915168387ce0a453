// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/accumulation.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/smaa/smaa.h"
#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/antialias/temporal/resolve.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate::antialias {
namespace {

constexpr int border = TemporalRow::border;

void for_each_row(int height, const std::function<void(int)>& body) {
  parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) { body(static_cast<int>(row)); });
}

/// Gives a plane a size; its elements are those of earlier frames. New memory costs more than what is done with it.
template <class T>
void resize(Plane<T>& plane, int width, int height) {
  if (plane.width() != width || plane.height() != height) plane = Plane<T>(width, height);
}

/// Continues a row of a bordered plane beyond its sides.
template <class T>
void extend_row(std::span<T> row) {
  std::fill_n(row.begin(), border, row[border]);
  std::fill_n(row.end() - border, border, row[row.size() - border - 1]);
}

/// Continues a bordered plane above its first row and below its last one.
template <class T>
void extend_rows(Plane<T>& plane) {
  const int last = plane.height() - border - 1;
  for (int k = 0; k < border; ++k) {
    std::ranges::copy(plane.row(border), plane.row(k).begin());
    std::ranges::copy(plane.row(last), plane.row(last + 1 + k).begin());
  }
}

/// Makes a plane of value(x, y), which continues beyond its sides.
template <class T, class Value>
void fill_bordered(Plane<T>& out, int width, int height, const Value& value) {
  resize(out, width + 2 * border, height + 2 * border);
  for_each_row(height, [&](int y) {
    const std::span<T> row = out.row(y + border);
    for (int x = 0; x < width; ++x) row[static_cast<std::size_t>(x + border)] = value(x, y);
    extend_row(row);
  });
  extend_rows(out);
}

/// Pixel 0 of a row of a bordered plane.
float* pixels_of(Plane<float>& plane, int y) { return plane.row(y + border).data() + border; }

/// The same; null for an empty plane.
const float* begin_of(const Plane<float>& plane, int y) {
  return plane.empty() ? nullptr : plane.row(y + border).data() + border;
}

/// Row y of the colours in a plane that has four rows, one for each channel, for a row of pixels.
template <class Rows>
auto colors_of(Rows& rows, int y, int margin) {
  auto* const red = rows.row(4 * (y + margin)).data() + margin;
  return ColorPlanes<std::remove_pointer_t<decltype(red)>>{red, std::ptrdiff_t{rows.width()}};
}

/// Encoded rows of a frame in bands, each with the rows above and below, so that a band stays in a processor's cache
/// until it has been resolved.
///
/// The resolved image replaces the frame's colour: the rows beyond each band are encoded before any band is resolved.
class ColorBands {
 public:
  static constexpr std::size_t rows = 16;

  ColorBands(const LinearImage& color, bool is_compressed) : color_(color), is_compressed_(is_compressed) {
    const int bands = (color.height() + static_cast<int>(rows) - 1) / static_cast<int>(rows);
    beyond_ = Plane<float>(color.width() + 2 * border, 4 * 2 * bands);
    for_each_row(bands, [&](int band) {
      const int begin = band * static_cast<int>(rows), end = begin + static_cast<int>(rows);
      encode(std::max(begin - 1, 0), beyond_, 2 * band);
      encode(std::min(end, color.height() - 1), beyond_, 2 * band + 1);
    });
  }

  /// Makes the rows begin - 1 to `end` of colours.
  void encode_band(std::size_t begin, std::size_t end, Plane<float>& out) const {
    const int count = static_cast<int>(end - begin), number = static_cast<int>(begin / rows);
    resize(out, beyond_.width(), 4 * (static_cast<int>(rows) + 2));
    for (int c = 0; c < 4; ++c) {
      std::ranges::copy(beyond_.row(4 * (2 * number) + c), out.row(c).begin());
      std::ranges::copy(beyond_.row(4 * (2 * number + 1) + c), out.row(4 * (count + 1) + c).begin());
    }
    for (int k = 0; k < count; ++k) encode(static_cast<int>(begin) + k, out, k + 1);
  }

 private:
  void encode(int y, Plane<float>& out, int row) const {
    const ColorPlanes<float> to = colors_of(out, row, 0);
    TemporalKernels::of().encode(&color_(0, y).r, is_compressed_, {to.red + border, to.width},
                                 static_cast<std::size_t>(color_.width()));
    for (int c = 0; c < 4; ++c) extend_row(out.row(4 * row + c));
  }
  const LinearImage& color_;
  bool is_compressed_;
  Plane<float> beyond_;
};

/// 0, 1, 2, ...
std::vector<float> columns(int width) {
  std::vector<float> out(static_cast<std::size_t>(width));
  for (std::size_t x = 0; x < out.size(); ++x) out[x] = static_cast<float>(x);
  return out;
}

/// Depths that surface points had in the last frame.
struct LastDepths {
  float3 eye, forward;
  double zz, zw, wz, ww;

  LastDepths(const Camera& camera, float aspect)
      : eye(xyz(camera.world_from_camera.column[3])), forward(-xyz(camera.world_from_camera.column[2])) {
    const float4x4 clip = camera.clip_from_camera(aspect);
    zz = clip.column[2].z, zw = clip.column[3].z, wz = clip.column[2].w, ww = clip.column[3].w;
  }
  float distance(float3 point) const { return dot(point - eye, forward); }
  /// Reversed depth; far away for a point behind the camera.
  float nearness(float distance) const {
    if (!(distance > 0)) return 0;
    const double z = -static_cast<double>(distance);
    return static_cast<float>((zz * z + zw) / (wz * z + ww));
  }
};

}  // namespace

Plane<float> TemporalAccumulation::Buffers::take() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return {};
  Plane<float> out = std::move(free_.back());
  free_.pop_back();
  return out;
}

void TemporalAccumulation::Buffers::put(Plane<float> buffer) {
  const std::lock_guard lock(mutex_);
  free_.push_back(std::move(buffer));
}

TemporalAccumulation::TemporalAccumulation(const TemporalOptions& options)
    : options_(options), jitter_(jitter_pattern(options.sequence, options.length)) {}

bool TemporalAccumulation::tests_surfaces() const { return options_.parts.rejection != TemporalParts::Rejection::None; }

/// The position of the frame's samples in their pixels.
SamplePosition TemporalAccumulation::sample() const {
  if (context_.given && context_.given->sample) return *context_.given->sample;
  return jitter_[static_cast<std::size_t>(context_.index) % jitter_.size()];
}

Request TemporalAccumulation::request(const FrameContext& context) {
  context_ = context;
  Request request;
  request.samples = {sample()};
  set_kernel(options_.current, request.samples[0], options_.parts);
  if (options_.bias < 0) request.rate = Rate::Sample, request.footprint = exp2(options_.bias);
  request.halo = Request::whole_image;
  request.settling_frames = options_.settling_frames;
  request.planes.depth = true;
  request.planes.object_id = true;
  request.planes.motion = !options_.follows_camera;
  request.planes.last_position = tests_surfaces();
  request.is_display_referred = options_.new_pixels != NewPixels::Sample;
  request.ends_in_light = !request.is_display_referred;
  return request;
}

/// Makes the planes of surfaces, their depths and motions.
void TemporalAccumulation::take_surfaces(const Frame& frame) {
  const int width = frame.color.width(), height = frame.color.height();
  const auto pixels = static_cast<std::size_t>(width);
  Current& out = current_;
  const CameraMotion camera(context_, width, height);
  const LastDepths last(context_.last_camera, aspect_of(context_));
  const double jitter_x = sample().x / 256.0, jitter_y = sample().y / 256.0;
  const bool tests_nearness = options_.parts.rejection == TemporalParts::Rejection::Edge;
  std::vector<Bordered*> planes{&out.nearness, &out.surface, &out.motion[0], &out.motion[1]};
  if (tests_surfaces()) planes.push_back(&out.last_depth);
  if (tests_nearness) planes.push_back(&out.last_nearness);
  for (Bordered* plane : planes) resize(*plane, width + 2 * border, height + 2 * border);
  const bool has_motion = !options_.follows_camera;
  // All planes of a row together: what a pixel's planes are made of is read once.
  for_each_row(height, [&](int y) {
    std::ranges::copy(frame.reversed_depth.row(y), pixels_of(out.nearness, y));
    const std::span<const std::uint32_t> ids = frame.object_id.row(y);
    float *const motion_x = pixels_of(out.motion[0], y), *const motion_y = pixels_of(out.motion[1], y);
    float* const last_depth = tests_surfaces() ? pixels_of(out.last_depth, y) : nullptr;
    const SurfaceRow row{.ids = ids.data(),
                         .motion = has_motion ? &frame.motion(0, y).x : nullptr,
                         .last_position = last_depth ? &frame.last_position(0, y).x : nullptr,
                         .last_eye = {last.eye.x, last.eye.y, last.eye.z},
                         .last_forward = {last.forward.x, last.forward.y, last.forward.z},
                         .surface = pixels_of(out.surface, y),
                         .motion_x = motion_x,
                         .motion_y = motion_y,
                         .last_depth = last_depth};
    TemporalKernels::of().take_surfaces(row, pixels);
    if (!has_motion) camera.along_row(jitter_x, y + jitter_y, frame.depth.row(y), motion_x, motion_y);
    for (auto i = ids.begin(); (i = std::find(i, ids.end(), Frame::no_id)) != ids.end();) {
      const auto end = std::find_if(i, ids.end(), [](std::uint32_t id) { return id != Frame::no_id; });
      const std::ptrdiff_t begin = i - ids.begin(), n = end - i;
      if (has_motion)
        camera.of_background(static_cast<double>(begin) + jitter_x, y + jitter_y, static_cast<int>(n), motion_x + begin,
                             motion_y + begin);
      if (last_depth) std::fill_n(last_depth + begin, n, std::numeric_limits<float>::infinity());
      i = end;
    }
    if (tests_nearness)
      std::transform(last_depth, last_depth + width, pixels_of(out.last_nearness, y),
                     [&](float distance) { return last.nearness(distance); });
    for (Bordered* plane : planes) extend_row(plane->row(y + border));
  });
  for (Bordered* plane : planes) extend_rows(*plane);
}

/// Where history may contain colours that have moved elsewhere: TemporalKernels::compute_unrest.
void TemporalAccumulation::detect_restless(const ObjectMotions& objects) {
  const int width = past_surface_.width(), height = past_surface_.height();
  const std::vector<float> column = columns(width);
  resize(current_.restless, width, height);
  for_each_row(height, [&](int y) {
    const UnrestRow row{.motion = {begin_of(current_.motion[0], y), begin_of(current_.motion[1], y)},
                        .surface = begin_of(current_.surface, y),
                        .stride = current_.surface.width(),
                        .column = column.data(),
                        .y = y,
                        .width = width,
                        .height = height,
                        .past_surface = past_surface_.values().data(),
                        .object_motion = {objects.x.data(), objects.y.data()}};
    TemporalKernels::of().compute_unrest(row, &current_.restless(0, y), static_cast<std::size_t>(width));
  });
}

/// Compares this frame's luminances with those of the history: TemporalKernels::detect_changes.
void TemporalAccumulation::detect_changes(const Frame& frame) {
  const int width = frames_.width(), height = frames_.height();
  Current& out = current_;
  for (Bordered* plane : {&out.changes, &out.drift, &out.bend, &next_noise_})
    resize(*plane, width + 2 * border, height + 2 * border);
  Bordered* const planes[] = {&out.changes, &out.drift, &out.bend, &last_, &fast_};
  for_each_row(height, [&](int y) {
    const ChangeRow row{.linear = &frame.color(0, y).r,
                        .is_compressed = options_.parts.is_compressed,
                        .restless = &out.restless(0, y),
                        .history = colors_of(std::as_const(history_), y, 0),
                        .frames = &frames_(0, y),
                        .last = pixels_of(last_, y),
                        .step = &step_(0, y),
                        .fast = pixels_of(fast_, y),
                        .noise = pixels_of(noise_, y),
                        .bend = pixels_of(out.bend, y),
                        .changes = pixels_of(out.changes, y),
                        .drift = pixels_of(out.drift, y)};
    TemporalKernels::of().detect_changes(row, static_cast<std::size_t>(width));
    for (Bordered* plane : planes) extend_row(plane->row(y + border));
  });
  for (Bordered* plane : planes) extend_rows(*plane);
}

/// How many frames history at rest may count as: TemporalKernels::find_drift; and where the light has changed at once,
/// and around such pixels, `relit_frames`.
///
/// Pixels that had both lights in their history, and those at the border of a shadow, are found by their neighbours.
void TemporalAccumulation::detect_lasting(const Frame& frame) {
  constexpr int radius = 4;
  const int width = frames_.width(), height = frames_.height();
  Current& out = current_;
  resize(out.lasting, width, height);
  if (options_.parts.rectification == TemporalParts::Rectification::None) {
    std::ranges::fill(out.lasting.values(), std::numeric_limits<float>::infinity());  // all history is kept
    return;
  }
  detect_changes(frame);
  resize(out.relit, width, height), resize(out.wide_relit, width, height);
  std::vector<char> is_relit(static_cast<std::size_t>(height));  // by row
  for_each_row(height, [&](int y) {
    const DriftRow drift{.changes = pixels_of(out.changes, y),
                         .drift = pixels_of(out.drift, y),
                         .last = pixels_of(last_, y),
                         .fast = pixels_of(fast_, y),
                         .noise = pixels_of(noise_, y),
                         .bend = pixels_of(out.bend, y),
                         .stride = fast_.width(),
                         .frames = &frames_(0, y)};
    const std::span<float> row = out.relit.row(y), wide = out.wide_relit.row(y);
    if (!TemporalKernels::of().find_drift(drift, &out.lasting(0, y), row.data(), pixels_of(next_noise_, y),
                                          static_cast<std::size_t>(width)))
      return;
    is_relit[static_cast<std::size_t>(y)] = 1;
    int last = -radius - 1;
    for (int x = -radius; x < width; ++x) {
      if (x + radius < width && row[static_cast<std::size_t>(x + radius)] > 0) last = x + radius;
      if (x >= 0) wide[static_cast<std::size_t>(x)] = x - last <= radius ? 1.0f : 0.0f;
    }
  });
  for_each_row(height, [&](int y) {
    float *const lasting = &out.lasting(0, y), *const step = &step_(0, y), *const fast = pixels_of(fast_, y);
    const float* const last = begin_of(last_, y);
    for (int k = std::max(y - radius, 0); k <= std::min(y + radius, height - 1); ++k) {
      if (!is_relit[static_cast<std::size_t>(k)]) continue;
      for (int x = 0; x < width; ++x)
        // The mean of another light would let any later change pass.
        if (out.wide_relit(x, k) > 0) lasting[x] = TemporalParts::relit_frames, step[x] = 0, fast[x] = last[x];
    }
    extend_row(next_noise_.row(y + border));
  });
  extend_rows(next_noise_);
  std::swap(noise_, next_noise_);
}

/// The mean motions of the objects of this frame and of the last one.
TemporalAccumulation::ObjectMotions TemporalAccumulation::object_motions(const Frame& frame) {
  // Four sums, of which each has every fourth pixel of a run, do not wait for each other.
  struct Sum {
    double x[4] = {}, y[4] = {};
    int pixels = 0;
  };
  std::vector<Sum> sums(past_objects_);
  for (int y = 0; y < frame.object_id.height(); ++y) {
    const std::span<const std::uint32_t> ids = frame.object_id.row(y);
    const float *const motion_x = begin_of(current_.motion[0], y), *const motion_y = begin_of(current_.motion[1], y);
    for (std::size_t i = 0; i < ids.size();) {
      const std::size_t begin = i;
      const std::uint32_t id = ids[i];
      while (i < ids.size() && ids[i] == id) ++i;
      const std::size_t number = id == Frame::no_id ? 0 : std::size_t{id} + 1;
      if (number >= sums.size()) sums.resize(number + 1);
      Sum sum = sums[number];
      std::size_t x = begin;
      for (; x + 4 <= i; x += 4)
        for (std::size_t k = 0; k < 4; ++k)
          sum.x[k] += static_cast<double>(motion_x[x + k]), sum.y[k] += static_cast<double>(motion_y[x + k]);
      for (; x < i; ++x) sum.x[0] += static_cast<double>(motion_x[x]), sum.y[0] += static_cast<double>(motion_y[x]);
      sum.pixels += static_cast<int>(i - begin);
      sums[number] = sum;
    }
  }
  past_objects_ = sums.size();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  ObjectMotions out;
  const auto mean = [](const Sum& sum, const double(&parts)[4]) {
    return sum.pixels > 0 ? static_cast<float>(((parts[0] + parts[1]) + (parts[2] + parts[3])) / sum.pixels) : infinity;
  };
  for (const Sum& sum : sums) out.x.push_back(mean(sum, sum.x)), out.y.push_back(mean(sum, sum.y));
  return out;
}

/// A history of the first frame alone, which the resolve replaces.
void TemporalAccumulation::begin_history(const Frame& frame) {
  const int width = frame.color.width(), height = frame.color.height();
  history_ = ColorRows(width, 4 * height);
  past_objects_ = 1;
  for (const std::uint32_t id : frame.object_id.values())
    if (id != Frame::no_id) past_objects_ = std::max(past_objects_, std::size_t{id} + 2);
  const bool is_confidence = options_.parts.blend == TemporalParts::Blend::Confidence;
  if (options_.parts.trusts_rest) {
    step_ = Plane<float>(width, height);
    last_ = fast_ = noise_ = Bordered(width + 2 * border, height + 2 * border);
  }
  frames_ = Plane<float>(width, height, is_confidence ? 1 / options_.parts.min_weight : 1.0f);
}

void TemporalAccumulation::keep_surfaces(const Frame& frame) {
  past_depth_ = frame.depth;
  if (options_.parts.rejection == TemporalParts::Rejection::Edge) past_nearness_ = frame.reversed_depth;
  resize(past_surface_, frame.object_id.width(), frame.object_id.height());
  for (int y = 0; y < past_surface_.height(); ++y)
    std::copy_n(begin_of(current_.surface, y), past_surface_.width(), past_surface_.row(y).begin());
}

/// The blend takes the place of the frame's colour.
LinearImage TemporalAccumulation::blended(Frame& frame) {
  const int width = frame.color.width(), height = frame.color.height();
  take_surfaces(frame);
  if (options_.parts.trusts_rest && !context_.is_first) detect_restless(object_motions(frame));
  const Current& current = current_;
  TemporalParts parts = options_.parts;
  if (context_.is_first) {
    begin_history(frame);
    parts.rejection = TemporalParts::Rejection::None;
    parts.rectification = TemporalParts::Rectification::None;
    parts.blend = TemporalParts::Blend::Fixed, parts.min_weight = 1;
    parts.weighting = TemporalParts::Weighting::None;
    parts.trusts_rest = false;
  }
  const std::vector<float> column = columns(width);
  const bool tests_light = options_.parts.trusts_rest && !context_.is_first;
  if (tests_light) detect_lasting(frame);
  resize(next_history_, width, 4 * height);
  resize(next_frames_, width, height);
  const auto stride = static_cast<std::ptrdiff_t>(width + 2 * border);
  const auto resolve_row = [&](int y, const ColorPlanes<const float>& color) {
    const float* const nearness = begin_of(current.nearness, y);
    const auto or_nearness = [&](const Plane<float>& plane) { return plane.empty() ? nearness : begin_of(plane, y); };
    const TemporalRow row{.color = color,
                          .nearness = nearness,
                          .motion = {begin_of(current.motion[0], y), begin_of(current.motion[1], y)},
                          .surface = begin_of(current.surface, y),
                          .last_depth = or_nearness(current.last_depth),
                          .last_nearness = or_nearness(current.last_nearness),
                          .restless = tests_light ? &current.restless(0, y) : nullptr,
                          .lasting = tests_light ? &current.lasting(0, y) : nullptr,
                          .noise = tests_light ? begin_of(noise_, y) : nullptr,
                          .stride = stride,
                          .column = column.data(),
                          .y = y,
                          .history = colors_of(std::as_const(history_), 0, 0),
                          .frames = &frames_(0, 0),
                          .past_surface = past_surface_.values().data(),
                          .past_depth = past_depth_.values().data(),
                          .past_nearness = past_nearness_.values().data(),
                          .width = width,
                          .height = height,
                          .resolved = colors_of(next_history_, y, 0),
                          .frames_out = &next_frames_(0, y)};
    const TemporalKernels& kernels = TemporalKernels::of();
    kernels.resolve(row, parts, static_cast<std::size_t>(width));
    kernels.decode(colors_of(std::as_const(next_history_), y, 0), row.color, &frame.color(0, y).r, parts.is_compressed,
                   &frame.color(0, y).r, static_cast<std::size_t>(width));
  };
  const ColorBands bands(frame.color, parts.is_compressed);
  parallel_ranges(static_cast<std::size_t>(height), ColorBands::rows, [&](std::size_t begin, std::size_t end) {
    Plane<float> band = band_buffers_.take();
    bands.encode_band(begin, end, band);
    for (std::size_t y = begin; y < end; ++y) {
      const ColorPlanes<float> colors = colors_of(band, static_cast<int>(y - begin) + 1, 0);
      resolve_row(static_cast<int>(y), {colors.red + border, colors.width});
    }
    band_buffers_.put(std::move(band));
  });
  std::swap(history_, next_history_);
  if (!context_.is_first) std::swap(frames_, next_frames_);
  if (context_.is_first && options_.parts.trusts_rest) begin_luminances();
  return std::move(frame.color);
}

/// Of the first frame alone.
void TemporalAccumulation::begin_luminances() {
  for_each_row(step_.height(), [&](int y) {
    const auto color = colors_of(std::as_const(history_), y, 0);
    const float *const red = color.channel(0), *const green = color.channel(1), *const blue = color.channel(2);
    float *const last = pixels_of(last_, y), *const fast = pixels_of(fast_, y);
    for (int x = 0; x < step_.width(); ++x) {
      const float luminance = red[x] * 0.2126f + green[x] * 0.7152f + blue[x] * 0.0722f;
      last[x] = fast[x] = luminance;
    }
  });
}

LinearImage TemporalAccumulation::sharpened(LinearImage image) const {
  const int width = image.width(), height = image.height();
  LinearImage wide;
  fill_bordered(wide, width, height, [&](int x, int y) { return image(x, y); });
  for_each_row(height, [&](int y) {
    TemporalKernels::of().sharpen(&wide(border, y + border).r, 4 * static_cast<std::ptrdiff_t>(wide.width()),
                                  options_.sharpening, &image(0, y).r, static_cast<std::size_t>(width));
  });
  return image;
}

LinearImage TemporalAccumulation::resolve(Frame& frame) {
  LinearImage out = blended(frame);
  if (tests_surfaces() || options_.parts.trusts_rest) keep_surfaces(frame);
  if (options_.sharpening > 0) return sharpened(std::move(out));
  return out;
}

DisplayImage TemporalAccumulation::post_process(DisplayImage image, const Frame&) {
  if (options_.new_pixels == NewPixels::Sample) return image;
  SmaaOptions options;
  if (options_.new_pixels == NewPixels::SmaaExact) options.exact_offset = offset_from_centre(sample());
  DisplayImage smooth =
      filter_encoded(image, Mixing::Linear, [&](const Rgba8Image& i) { return apply_smaa(i, nullptr, options); });
  // A pixel of n frames is the mean of n samples: SMAA stands for those that it lacks.
  for_each_row(image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x) {
      const float frames = frames_(x, y);
      if (frames < TemporalParts::known_frames)
        image(x, y) = mixed(image(x, y), smooth(x, y), 1 / (frames * frames), Mixing::Linear);
    }
  });
  return image;
}

}  // namespace zoneplate::antialias
