// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/surface_history.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "zoneplate/antialias/temporal/camera_motion.h"
#include "zoneplate/antialias/temporal/jitter.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate::antialias {
namespace {

void for_rows(int height, const std::function<void(int)>& body) {
  parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) { body(static_cast<int>(row)); });
}

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
      jitter_(jitter_pattern(JitterSequence::Halton, options.length)),
      coverage_(jitter_pattern(JitterSequence::R2, options.coverage)) {}

Request SurfaceHistory::request(const FrameContext& context) {
  context_ = context;
  pass_ = 0;
  Request request;
  request.samples = {jitter_[static_cast<std::size_t>(context.index) % jitter_.size()]};
  request.rate = Rate::Sample;  // textures are sampled there too, not at the centre
  request.footprint = 0.25f;    // the mean of many samples filters the rest
  request.halo = Request::whole_image;
  request.settling_frames = options_.most;
  request.planes.object_id = request.planes.motion = request.planes.was_visible = true;
  return request;
}

std::optional<Request> SurfaceHistory::refine(Frame& frame) {
  if (pass_ == 0) {
    color_ = std::move(frame.color);
    object_ = frame.object_id;
    presences_ = Plane<Presences>(object_.width(), object_.height());
    add(frame, jitter_[static_cast<std::size_t>(context_.index) % jitter_.size()], 0);
  } else {
    add(frame, coverage_[pass_ - 1], 1);
  }
  if (pass_ == coverage_.size()) return std::nullopt;
  Request request;
  request.samples = {coverage_[pass_++]};
  request.content = Content::Data;
  request.planes.object_id = request.planes.motion = request.planes.was_visible = true;
  return request;
}

/// Adds the surfaces of one sample of every pixel. The background moves with the camera.
void SurfaceHistory::add(const Frame& frame, SamplePosition position, int weight) {
  const int width = object_.width(), height = object_.height();
  const CameraMotion camera(context_.camera, context_.last_camera, width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::uint32_t object = frame.object_id(x, y);
      Presence* const presence = presences_(x, y).find(object);
      if (presence == nullptr) continue;
      presence->samples += weight;
      const bool is_background = object == Frame::no_id;
      if (!is_background && frame.was_visible(x, y) == 0) continue;
      const float2 motion = is_background ? camera.at(x + position.x / 256.0, y + position.y / 256.0,
                                                      std::numeric_limits<double>::infinity())
                                          : frame.motion(x, y);
      ++presence->seen;
      presence->motion = {presence->motion.x + motion.x, presence->motion.y + motion.y};
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

/// The range of the lumas of an object's samples of 3 × 3 pixels.
float SurfaceHistory::range_around(int x, int y) const {
  float low = luma_of(color_(x, y)), high = low;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, object_.height() - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, object_.width() - 1); ++i)
      if (object_(i, j) == object_(x, y)) {
        const float luma = luma_of(color_(i, j));
        low = std::min(low, luma), high = std::max(high, luma);
      }
  return high - low;
}

/// The change of every shaded sample against the history of its object. Its variance is that of earlier samples, and
/// that which the range of its neighbours suggests.
void SurfaceHistory::find_changes() {
  const int width = object_.width(), height = object_.height();
  changes_ = Plane<Change>(width, height);
  if (context_.is_first) return;
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
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

/// True if the light on an object has changed around a pixel: by the sum over its samples of 3 × 3 pixels.
bool SurfaceHistory::has_changed(std::uint32_t object, int x, int y) const {
  constexpr float deviations = 2.5f;
  Change sum;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, object_.height() - 1); ++j)
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, object_.width() - 1); ++i) {
      if (object_(i, j) != object) continue;
      const Change& c = changes_(i, j);
      sum.luma += c.luma, sum.variance += c.variance, sum.tolerance += c.tolerance;
    }
  return std::abs(sum.luma) > deviations * std::sqrt(sum.variance) + sum.tolerance;
}

/// The mean of the object's samples of 3 × 3 pixels, or of 5 × 5.
SurfaceHistory::Layer SurfaceHistory::borrowed(std::uint32_t object, int x, int y) const {
  for (int reach = 1; reach <= 2; ++reach) {
    Layer out{.object = object};
    float count = 0;
    for (int j = std::max(y - reach, 0); j <= std::min(y + reach, object_.height() - 1); ++j)
      for (int i = std::max(x - reach, 0); i <= std::min(x + reach, object_.width() - 1); ++i)
        if (object_(i, j) == object && is_finite(color_(i, j))) out.color = sum_of(out.color, color_(i, j)), ++count;
    if (count == 0) continue;
    out.color = scaled(out.color, 1 / count);
    out.luma = luma_of(out.color), out.square = out.luma * out.luma;
    out.frames = 0.5f;
    return out;
  }
  return {};
}

/// The colour of an object of this frame; its `frames` are 0 if nothing shows it.
SurfaceHistory::Layer SurfaceHistory::updated(const Presence& presence, int x, int y) const {
  const bool is_shaded = object_(x, y) == presence.object && is_finite(color_(x, y));
  Layer past;
  if (!context_.is_first && !has_changed(presence.object, x, y))
    past = is_shaded ? changes_(x, y).past : past_of(presence, x, y);
  if (!is_shaded) return past.frames > 0 ? past : borrowed(presence.object, x, y);
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

LinearImage SurfaceHistory::resolve(Frame&) {
  const int width = object_.width(), height = object_.height();
  find_changes();
  LinearImage out(width, height);
  Plane<Layers> history(width, height);
  for_rows(height, [&](int y) {
    for (int x = 0; x < width; ++x) {
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
      out(x, y) = covered > 0 ? scaled(color, 1 / covered) : color_(x, y);
    }
  });
  history_ = std::move(history);
  return out;
}

}  // namespace zoneplate::antialias
