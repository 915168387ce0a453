// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/surface_history.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/antialias/temporal/jitter.h"

namespace zoneplate::antialias {
namespace {

float luma_of(const Linear& c) { return (c.r + c.b) * 0.25f + c.g * 0.5f; }

Linear scaled(const Linear& c, float s) { return {c.r * s, c.g * s, c.b * s, c.a * s}; }
Linear sum_of(const Linear& a, const Linear& b) { return {a.r + b.r, a.g + b.g, a.b + b.b, a.a + b.a}; }
bool is_finite(const Linear& c) {
  return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b) && std::isfinite(c.a);
}

/// Weights of Catmull-Rom's cubic for the taps at -1, 0, 1 and 2.
std::array<float, 4> catmull_rom(float t) {
  return {((-0.5f * t + 1) * t - 0.5f) * t, (1.5f * t - 2.5f) * t * t + 1, ((-1.5f * t + 2) * t + 0.5f) * t,
          (0.5f * t - 0.5f) * t * t};
}

/// Samples per pixel of a frame with 1 / `scale` of the image's pixels per side, so that each pixel of the image has at
/// least `samples`.
int per_frame_pixel(int samples, double scale) { return static_cast<int>(std::ceil(samples * scale * scale)); }

}  // namespace

SurfaceHistory::Presence* SurfaceHistory::Presences::find(std::uint32_t object) {
  for (std::size_t i = 0; i < count; ++i)
    if (entry[i].object == object) return &entry[i];
  if (count == capacity) return nullptr;
  entry[count] = {.object = object};
  return &entry[count++];
}

SurfaceHistory::SurfaceHistory(const Options& options)
    : options_(options),
      jitter_(jitter_pattern(JitterSequence::Halton, per_frame_pixel(options.length, options.scale))),
      coverage_(jitter_pattern(JitterSequence::R2, per_frame_pixel(options.coverage, options.scale))),
      radius_(static_cast<int>(std::ceil(options.scale))) {}

/// Textures are sampled at the sample, not at the centre, and less filtered, since the mean of many samples filters
/// them. An alpha test decides as it does for the shaded sample: at another mip level it covers another part of a
/// pixel.
void SurfaceHistory::filter_textures_for_samples(Request& request) const {
  request.rate = Rate::Sample;
  request.footprint = 0.25f / static_cast<float>(options_.scale);
}

Request SurfaceHistory::request(const FrameContext& context) {
  context_ = context;
  pass_ = 0;
  width_ = context.image.width, height_ = context.image.height;
  Request request;
  request.samples = {jitter_[static_cast<std::size_t>(context.index) % jitter_.size()]};
  filter_textures_for_samples(request);
  if (options_.scale > 1) {
    request.frame = frame_size(context.image, options_.scale);
  } else {
    request.halo = Request::whole_image;
  }
  request.settling_frames = options_.most;
  request.ends_in_light = true;
  request.planes.object_id = request.planes.motion = request.planes.was_visible = true;
  return request;
}

std::optional<Request> SurfaceHistory::refine(Frame& frame) {
  if (pass_ == 0) {
    const SamplePosition position = jitter_[static_cast<std::size_t>(context_.index) % jitter_.size()];
    frame_width_ = frame.color.width(), frame_height_ = frame.color.height();
    take_shaded(frame, position);
    presences_ = Plane<Presences>(width_, height_);
    add(frame, position, 0);
  } else {
    add(frame, coverage_[pass_ - 1], 1);
  }
  if (pass_ == coverage_.size()) return std::nullopt;
  Request request;
  request.samples = {coverage_[pass_++]};
  request.content = Content::Data;
  filter_textures_for_samples(request);
  request.planes.object_id = request.planes.motion = request.planes.was_visible = true;
  return request;
}

/// The pixel of the image that contains a sample of a frame's pixel.
SurfaceHistory::Cell SurfaceHistory::cell_of(int x, int y, SamplePosition position) const {
  const auto place = [](int pixel, std::uint8_t offset, int to, int from) {
    return static_cast<int>((256 * std::int64_t{pixel} + offset) * to / (256 * std::int64_t{from}));
  };
  return {place(x, position.x, width_, frame_width_), place(y, position.y, height_, frame_height_)};
}

/// Puts the shaded samples of the frame into the pixels of the image.
void SurfaceHistory::take_shaded(Frame& frame, SamplePosition position) {
  if (options_.scale == 1) {
    color_ = std::move(frame.color), object_ = frame.object_id;
    width_ = color_.width(), height_ = color_.height();
    is_shaded_ = Plane<std::uint8_t>(width_, height_, std::uint8_t{1});
    return;
  }
  color_ = LinearImage(width_, height_, Linear{0, 0, 0, 0});
  object_ = Plane<std::uint32_t>(width_, height_);
  is_shaded_ = Plane<std::uint8_t>(width_, height_);
  for (int y = 0; y < frame_height_; ++y)
    for (int x = 0; x < frame_width_; ++x) {
      const Cell cell = cell_of(x, y, position);
      color_(cell.x, cell.y) = frame.color(x, y), object_(cell.x, cell.y) = frame.object_id(x, y);
      is_shaded_(cell.x, cell.y) = 1;
    }
}

/// Adds the surfaces of one sample of every pixel of a frame. The background moves with the camera.
void SurfaceHistory::add(const Frame& frame, SamplePosition position, int weight) {
  const CameraMotion camera(context_, frame_width_, frame_height_);
  const float scale_x = static_cast<float>(width_) / static_cast<float>(frame_width_);
  const float scale_y = static_cast<float>(height_) / static_cast<float>(frame_height_);
  for_rows(frame_height_, [&](int y) {
    for (int x = 0; x < frame_width_; ++x) {
      const std::uint32_t object = frame.object_id(x, y);
      const Cell cell = cell_of(x, y, position);
      Presence* const presence = presences_(cell.x, cell.y).find(object);
      if (presence == nullptr) continue;
      presence->samples += weight;
      const bool is_background = object == Frame::no_id;
      if (!is_background && frame.was_visible(x, y) == 0) continue;
      const float2 motion = is_background ? camera.at(x + position.x / 256.0, y + position.y / 256.0,
                                                      std::numeric_limits<double>::infinity())
                                          : frame.motion(x, y);
      ++presence->seen;
      presence->motion = {presence->motion.x + motion.x * scale_x, presence->motion.y + motion.y * scale_y};
    }
  });
}

/// The colour of an object at a position of the last frame, in pixels from the centre of the first: interpolated by
/// Catmull-Rom where all 16 pixels have the object, and bilinearly by those of four that have it.
SurfaceHistory::Layer SurfaceHistory::moved(std::uint32_t object, float x, float y) const {
  const int width = history_.width(), height = history_.height();
  if (!(x > -1 && y > -1 && x < static_cast<float>(width) && y < static_cast<float>(height))) return {};
  const float left = std::floor(x), top = std::floor(y), tx = x - left, ty = y - top;
  const Layer* taps[4][4] = {};
  bool has_all = true;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) {
      const int px = static_cast<int>(left) + i - 1, py = static_cast<int>(top) + j - 1;
      if (px < 0 || py < 0 || px >= width || py >= height) {
        has_all = false;
        continue;
      }
      for (const Layer& layer : history_(px, py))
        if (layer.frames > 0 && layer.object == object) taps[j][i] = &layer;
      has_all = has_all && taps[j][i] != nullptr;
    }
  const std::array<float, 2> linear_x{1 - tx, tx}, linear_y{1 - ty, ty};
  Layer out{.object = object};
  float total = 0;
  for (std::size_t j = 0; j < 2; ++j)
    for (std::size_t i = 0; i < 2; ++i) {
      const Layer* const tap = taps[j + 1][i + 1];
      const float weight = linear_x[i] * linear_y[j];
      if (tap == nullptr || weight == 0) continue;
      out.color = sum_of(out.color, scaled(tap->color, weight));
      out.luma += tap->luma * weight, out.square += tap->square * weight, out.frames += tap->frames * weight;
      total += weight;
    }
  if (total == 0) return {};
  out.color = scaled(out.color, 1 / total);
  out.luma /= total, out.square /= total, out.frames /= total;
  if (!has_all || (tx == 0 && ty == 0)) return out;

  const std::array<float, 4> wx = catmull_rom(tx), wy = catmull_rom(ty);
  Linear sharp{0, 0, 0, 0}, low = taps[0][0]->color, high = low;
  for (std::size_t j = 0; j < 4; ++j)
    for (std::size_t i = 0; i < 4; ++i) {
      const Linear& c = taps[j][i]->color;
      sharp = sum_of(sharp, scaled(c, wx[i] * wy[j]));
      low = {std::min(low.r, c.r), std::min(low.g, c.g), std::min(low.b, c.b), std::min(low.a, c.a)};
      high = {std::max(high.r, c.r), std::max(high.g, c.g), std::max(high.b, c.b), std::max(high.a, c.a)};
    }
  out.color = {std::clamp(sharp.r, low.r, high.r), std::clamp(sharp.g, low.g, high.g),
               std::clamp(sharp.b, low.b, high.b), std::clamp(sharp.a, low.a, high.a)};
  return out;
}

/// The history of an object in a pixel; none where the last camera did not see it.
SurfaceHistory::Layer SurfaceHistory::past_of(const Presence& presence, int x, int y) const {
  if (presence.seen == 0) return {};
  const float seen = static_cast<float>(presence.seen);
  return moved(presence.object, static_cast<float>(x) - presence.motion.x / seen,
               static_cast<float>(y) - presence.motion.y / seen);
}

bool SurfaceHistory::has_sample(std::uint32_t object, int x, int y) const {
  return is_shaded_(x, y) != 0 && object_(x, y) == object;
}

/// Calls use(i, j) for the shaded samples of an object within a distance in pixels, by row.
template <class Use>
void SurfaceHistory::for_samples_around(std::uint32_t object, int x, int y, int radius, const Use& use) const {
  for (int j = std::max(y - radius, 0); j <= std::min(y + radius, height_ - 1); ++j)
    for (int i = std::max(x - radius, 0); i <= std::min(x + radius, width_ - 1); ++i)
      if (has_sample(object, i, j)) use(i, j);
}

/// The range of the lumas of the samples of a shaded pixel's object around it.
float SurfaceHistory::range_around(int x, int y) const {
  float low = luma_of(color_(x, y)), high = low;
  for_samples_around(object_(x, y), x, y, radius_, [&](int i, int j) {
    const float luma = luma_of(color_(i, j));
    low = std::min(low, luma), high = std::max(high, luma);
  });
  return high - low;
}

/// The change of every shaded sample against the history of its object. Its variance is that of earlier samples, and
/// that which the range of its neighbours suggests.
void SurfaceHistory::detect_changes() {
  changes_ = Plane<Change>(width_, height_);
  if (context_.is_first) return;
  for_rows(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      if (is_shaded_(x, y) == 0) continue;
      const Presence* const presence = presences_(x, y).find(object_(x, y));
      if (presence == nullptr) continue;
      const Layer past = past_of(*presence, x, y);
      if (past.frames == 0) continue;
      constexpr float floor = 0.002f, part = 0.05f;
      const float half_range = range_around(x, y) / 2;
      changes_(x, y) = {.past = past,
                        .luma = luma_of(color_(x, y)) - past.luma,
                        .variance = std::max(past.square - past.luma * past.luma, 0.0f) + half_range * half_range,
                        .tolerance = part * past.luma + floor};
    }
  });
}

/// True if the light on an object has changed around a pixel: by the sum over its samples there.
bool SurfaceHistory::has_changed(std::uint32_t object, int x, int y) const {
  constexpr float deviations = 2.5f;
  Change sum;
  for_samples_around(object, x, y, radius_, [&](int i, int j) {
    const Change& c = changes_(i, j);
    sum.luma += c.luma, sum.variance += c.variance, sum.tolerance += c.tolerance;
  });
  return std::abs(sum.luma) > deviations * std::sqrt(sum.variance) + sum.tolerance;
}

/// The colour of the object's samples around a pixel, interpolated bilinearly where all of the frame's samples are of
/// the object; where there are none, of those at up to 2, 4 or 8 times that distance.
SurfaceHistory::Layer SurfaceHistory::borrowed(std::uint32_t object, int x, int y) const {
  for (const float times : {1.0f, 2.0f, 4.0f, 8.0f}) {
    const float radius = times * std::max(2.0f, static_cast<float>(options_.scale));
    const auto weight_along = [radius](int distance) { return 1 - static_cast<float>(std::abs(distance)) / radius; };
    Layer out{.object = object};
    float count = 0;
    for_samples_around(object, x, y, static_cast<int>(std::ceil(radius)) - 1, [&](int i, int j) {
      if (!is_finite(color_(i, j))) return;
      const float weight = weight_along(i - x) * weight_along(j - y);
      out.color = sum_of(out.color, scaled(color_(i, j), weight)), count += weight;
    });
    if (count == 0) continue;
    out.color = scaled(out.color, 1 / count);
    out.luma = luma_of(out.color), out.square = out.luma * out.luma;
    out.frames = 0.5f;
    return out;
  }
  return {};
}

/// The colour of an object without samples in a pixel: the mean of what was borrowed in n frames, which counts as
/// n / (n + 1) of a sample.
SurfaceHistory::Layer SurfaceHistory::guessed(const Layer& past, std::uint32_t object, int x, int y) const {
  Layer out = borrowed(object, x, y);
  if (past.frames == 0 || out.frames == 0) return past.frames > 0 ? past : out;
  out.color = sum_of(scaled(past.color, past.frames), scaled(out.color, 1 - past.frames));
  out.luma = luma_of(out.color), out.square = out.luma * out.luma;
  out.frames = 1 / (2 - past.frames);
  return out;
}

/// The colour of an object of this frame; its `frames` are 0 if nothing shows it.
SurfaceHistory::Layer SurfaceHistory::updated(const Presence& presence, int x, int y) const {
  const bool is_shaded = has_sample(presence.object, x, y) && is_finite(color_(x, y));
  Layer past;
  if (!context_.is_first && !has_changed(presence.object, x, y))
    past = is_shaded ? changes_(x, y).past : past_of(presence, x, y);
  if (!is_shaded) return past.frames >= 1 ? past : guessed(past, presence.object, x, y);
  const Linear& color = color_(x, y);
  const float luma = luma_of(color);
  const float before = std::min(past.frames, static_cast<float>(options_.most - 1));
  const float rate = 1 / (before + 1);
  const auto mean = [rate](float a, float b) { return a + (b - a) * rate; };
  return {.color = {mean(past.color.r, color.r), mean(past.color.g, color.g), mean(past.color.b, color.b),
                    mean(past.color.a, color.a)},
          .luma = mean(past.luma, luma),
          .square = mean(past.square, luma * luma),
          .frames = before + 1,
          .object = presence.object};
}

/// The pixel's own sample, or the mean of all samples around it.
Linear SurfaceHistory::color_around(int x, int y) const {
  if (is_shaded_(x, y) != 0) return color_(x, y);
  Linear sum{0, 0, 0, 0};
  float count = 0;
  for (int j = std::max(y - radius_, 0); j <= std::min(y + radius_, height_ - 1); ++j)
    for (int i = std::max(x - radius_, 0); i <= std::min(x + radius_, width_ - 1); ++i)
      if (is_shaded_(i, j) != 0) sum = sum_of(sum, color_(i, j)), ++count;
  return count > 0 ? scaled(sum, 1 / count) : sum;
}

LinearImage SurfaceHistory::resolve(Frame&) {
  detect_changes();
  LinearImage out(width_, height_);
  Plane<Layers> history(width_, height_);
  for_rows(height_, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      const Presences& here = presences_(x, y);
      Linear color{0, 0, 0, 0};
      float covered = 0;
      for (std::size_t i = 0; i < here.count; ++i) {
        const Layer layer = history(x, y)[i] = updated(here.entry[i], x, y);
        const auto samples = static_cast<float>(here.entry[i].samples);
        if (layer.frames == 0 || samples == 0) continue;
        color = sum_of(color, scaled(layer.color, samples));
        covered += samples;
      }
      out(x, y) = covered > 0 ? scaled(color, 1 / covered) : color_around(x, y);
    }
  });
  history_ = std::move(history);
  return out;
}

}  // namespace zoneplate::antialias
