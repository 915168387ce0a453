// SPDX-License-Identifier: Apache-2.0
// Adaptive supersampling: four samples per pixel, and many more where those differ.
//
// If the first samples are similar, the pixel is their mean; otherwise it is supersampled, with the same bits as ssaa.
// It costs little more than four samples in smooth regions. Weakness: details that all four samples miss, such as a
// wire or a highlight between them.
//
// Source: Mitchell, Generating Antialiased Images at Low Sampling Densities, SIGGRAPH 1987: contrast (max - min) / (max
// + min) of a colour, compared with 0.4 for red, 0.3 for green, 0.6 for blue.
#include <algorithm>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace adaptive_method {
namespace {

struct Limits {
  float r, g, b, a;
};

/// The minimum and maximum of each channel of a pixel's samples.
struct Range {
  Linear low, high;
  bool is_within(const Limits& limits) const {
    const auto within = [](float a, float b, float limit) { return b - a <= limit * (a + b); };
    return within(low.r, high.r, limits.r) && within(low.g, high.g, limits.g) && within(low.b, high.b, limits.b) &&
           high.a - low.a <= limits.a;
  }
};

Range range_of(const Frame& frame, int x, int y) {
  Range range{frame.sample_color[0](x, y), frame.sample_color[0](x, y)};
  for (const LinearImage& plane : frame.sample_color) {
    const Linear c = plane(x, y);
    const auto widen = [](float& low, float& high, float v) { low = std::min(low, v), high = std::max(high, v); };
    widen(range.low.r, range.high.r, c.r), widen(range.low.g, range.high.g, c.g);
    widen(range.low.b, range.high.b, c.b), widen(range.low.a, range.high.a, c.a);
  }
  return range;
}

class Adaptive : public Resolver {
 public:
  Adaptive(int n, float share)
      : fine_(grid_pattern(n)), limits_{0.4f * share, 0.3f * share, 0.6f * share, 0.3f * share} {}

  Request request(const FrameContext&) override {
    first_ = {};
    pixel_mask_ = {};
    Request request{
        .samples = standard_pattern(4), .rate = Rate::Sample, .weights = {}, .planes = {}, .pixel_mask = {}};
    request.planes.sample_colors = true;
    request.ends_in_light = true;
    return request;
  }
  std::optional<Request> refine(Frame& frame) override {
    if (!pixel_mask_.empty()) return std::nullopt;
    pixel_mask_ = Plane<std::uint8_t>(frame.color.width(), frame.color.height());
    for_rows(pixel_mask_.height(), [&](int y) {
      for (int x = 0; x < pixel_mask_.width(); ++x) pixel_mask_(x, y) = !range_of(frame, x, y).is_within(limits_);
    });
    if (std::ranges::find(pixel_mask_.values(), 1) == pixel_mask_.values().end()) return std::nullopt;
    first_ = std::move(frame.color);
    return Request{.samples = fine_, .rate = Rate::Sample, .weights = {}, .planes = {}, .pixel_mask = pixel_mask_};
  }
  LinearImage resolve(Frame& frame) override {
    if (first_.empty()) return std::move(frame.color);
    LinearImage out = std::move(first_);
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x)
        if (pixel_mask_(x, y)) out(x, y) = frame.color(x, y);
    });
    return out;
  }

 private:
  SamplePattern fine_;
  Limits limits_;
  LinearImage first_;
  Plane<std::uint8_t> pixel_mask_;
};

constexpr Param params[] = {
    {.name = "n", .meaning = "an n × n grid of samples where the first four differ", .value = 4, .low = 2, .high = 16},
    {.name = "contrast",
     .meaning = "contrast threshold, in percent of Mitchell's thresholds",
     .value = 30,
     .low = 0,
     .high = 100}};

constexpr std::string_view variants[] = {"n=8", "n=4,contrast=100"};

}  // namespace
}  // namespace adaptive_method

Method adaptive() {
  return {.name = "adaptive",
          .summary = "four samples per pixel, and a grid of samples where they differ",
          .source = "Mitchell 1987",
          .params = adaptive_method::params,
          .make = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<adaptive_method::Adaptive>(s.integer("n"),
                                                               static_cast<float>(s.integer("contrast")) / 100);
          },
          .variants = adaptive_method::variants};
}

}  // namespace zoneplate::antialias
