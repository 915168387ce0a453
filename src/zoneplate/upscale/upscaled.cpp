// SPDX-License-Identifier: Apache-2.0
// An antialiasing method whose frame is smaller than the image, followed by a spatial upscaler.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

/// The pixels first to end - 1 of one axis of the input that output pixels begin to begin + count - 1 read.
struct Needed {
  int first, end;
};
Needed needed(int begin, int count, int to, int from, int radius) {
  // ⌊(o + ½) from / to - ½⌋ in whole numbers. Upscalers compute positions in floats, which may round to the next pixel.
  const auto place = [&](int o) {
    const std::int64_t twice = (2 * std::int64_t{o} + 1) * from - to;
    return static_cast<int>((twice + 2 * std::int64_t{to}) / (2 * std::int64_t{to})) - 1;
  };
  return {std::max(0, place(begin) - radius), std::min(from, place(begin + count - 1) + radius + 2)};
}

class Upscaled : public Resolver {
 public:
  Upscaled(std::unique_ptr<Resolver> method, std::unique_ptr<SpatialUpscaler> upscaler, double scale)
      : method_(std::move(method)), upscaler_(std::move(upscaler)), scale_(scale) {}

  bool has_history() const override { return method_->has_history(); }
  Request request(const FrameContext& context) override {
    FrameContext own = context;
    own.aspect = aspect_of(context);
    grid_.to = context.image;
    frame_ = own.image = frame_size(context.image, scale_);
    if (const std::optional<Crop>& crop = context.image.crop) {
      const int radius = upscaler_->radius();
      const Needed x = needed(crop->x, crop->width, context.image.width, frame_.width, radius);
      const Needed y = needed(crop->y, crop->height, context.image.height, frame_.height, radius);
      frame_.crop = own.image.crop = Crop{x.first, y.first, x.end - x.first, y.end - y.first};
    }
    grid_.width = frame_.width, grid_.height = frame_.height;
    return shrunk(method_->request(own));
  }
  std::optional<Request> refine(Frame& frame) override {
    std::optional<Request> more = method_->refine(frame);
    return more ? std::optional(shrunk(std::move(*more))) : std::nullopt;
  }
  LinearImage resolve(Frame& frame) override { return method_->resolve(frame); }
  DisplayImage post_process(DisplayImage image, const Frame& frame) override {
    UpscaleGrid grid = grid_;
    grid.x = frame.x, grid.y = frame.y;
    return upscaler_->upscale(method_->post_process(std::move(image), frame), grid);
  }

 private:
  Request shrunk(Request request) const {
    request.frame = frame_;
    request.is_display_referred = true;
    request.resolves_per_pixel = request.ends_in_light = request.estimates_error = false;
    const float own = request.footprint > 0          ? request.footprint
                      : request.rate == Rate::Sample ? 1 / std::sqrt(static_cast<float>(request.samples.size()))
                                                     : 1.0f;
    request.footprint = own / static_cast<float>(scale_);
    return request;
  }

  std::unique_ptr<Resolver> method_;
  std::unique_ptr<SpatialUpscaler> upscaler_;
  double scale_;
  ImageExtent frame_;  ///< of the frame that is being rendered
  UpscaleGrid grid_;
};

}  // namespace

std::unique_ptr<SpatialUpscaler> make_spatial_upscaler(std::string_view text) {
  const auto [row, settings] = parse_spec("upscaler", upscalers(), text);
  if (!row.make_spatial)
    throw Error(ErrorKind::Usage, std::string(row.name) + " reads a sequence of frames, expected a spatial upscaler");
  return row.make_spatial(settings);
}

namespace {

constexpr float min_rest = 1.0f / 32768;  // of 1 - c / (1 + c): the greatest light is its reciprocal

/// The display-referred values of premultiplied light, and back.
Display mapped_light(const Linear& c) {
  if (!(c.a > 0)) return Display{0, 0, 0, 0};
  const auto straight = [&](float v) { return v > 0 ? std::min(v / c.a, 1 / min_rest) : 0.0f; };
  const float r = straight(c.r), g = straight(c.g), b = straight(c.b), scale = 1 / (1 + std::max({r, g, b}));
  return Display{std::sqrt(r * scale), std::sqrt(g * scale), std::sqrt(b * scale), std::min(c.a, 1.0f)};
}
Linear unmapped_light(const Display& c) {
  const float r = c.r * c.r, g = c.g * c.g, b = c.b * c.b;
  const float scale = c.a / std::max(min_rest, 1 - std::max({r, g, b}));
  return Linear{r * scale, g * scale, b * scale, c.a};
}

/// What a constant image of this light becomes.
float upscaled_constant(const SpatialUpscaler& upscaler, float light) {
  constexpr int from = 8, to = 12;
  const DisplayImage image(from, from, mapped_light({light, light, light, 1}));
  return unmapped_light(upscaler.upscale(image, {from, from, 0, 0, {to, to, std::nullopt}})(to / 2, to / 2)).r;
}

}  // namespace

UpscaledLight upscale_linear(const SpatialUpscaler& upscaler, const LinearImage& image, const UpscaleGrid& grid) {
  if (std::optional<LinearImage> light = upscaler.upscale_light(image, grid)) return {.image = std::move(*light)};
  UpscaledLight out;
  for (const Linear& c : image.values()) {
    const float least = std::min({c.r, c.g, c.b, c.a}), most = std::max({c.r, c.g, c.b});
    out.negative += least < 0;
    out.bright += c.a > 0 && most / c.a > 1 / min_rest;
    out.additive += !(c.a > 0) && most > 0;
    if (c.a > 0) out.brightest = std::max(out.brightest, std::min(most / c.a, 1 / min_rest));
  }
  out.constant = upscaled_constant(upscaler, out.brightest);
  DisplayImage mapped(image.width(), image.height());
  std::ranges::transform(image.values(), mapped.values().begin(), mapped_light);
  const DisplayImage upscaled = upscaler.upscale(mapped, grid);
  out.image = LinearImage(upscaled.width(), upscaled.height());
  std::ranges::transform(upscaled.values(), out.image.values().begin(), unmapped_light);
  return out;
}

std::unique_ptr<Resolver> make_method(std::string_view text) {
  const std::size_t plus = text.find('+');
  const bool has_upscaler = plus != text.npos || find_row(upscalers(), text) != nullptr;
  if (!has_upscaler) return make_resolver(antialias::methods(), text);
  const std::string_view method = plus == text.npos ? "none" : text.substr(0, plus);
  const auto [row, settings] = parse_spec("upscaler", upscalers(), plus == text.npos ? text : text.substr(plus + 1));
  if (row.make_spatial)
    return std::make_unique<Upscaled>(make_resolver(antialias::methods(), method), row.make_spatial(settings),
                                      settings.number("scale"));
  if (method != "none")
    throw Error(ErrorKind::Usage, std::string(row.name) +
                                      " jitters its own samples and follows no other method than "
                                      "none; found " +
                                      std::string(method));
  return row.make_temporal(settings);
}

}  // namespace zoneplate::upscale
