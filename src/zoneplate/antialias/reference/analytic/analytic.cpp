// SPDX-License-Identifier: Apache-2.0
// Exact coverage: the visible polygons of every pixel, with exact hidden-surface removal, and the integral of the
// filter over each polygon in closed form. A reference for all other methods, without sampling noise.
//
// Coverage is exact; the colour is that of each visible surface at the centroid of its visible part of the pixel, or
// with shading=n the mean over n × n parts of the pixel. Alpha-tested surfaces end at the contour where alpha equals
// the cutoff, which is approximated in mask × mask parts; blended ones are composited in their exact order. Pixels that
// are too crowded for polygons are sampled, up to 4,096 times, with an estimate of the error (--aov error: 0 if no
// samples were taken). Weaknesses: shading that varies within a part of a pixel: highlights and textures far smaller
// than a pixel are only sampled.
//
// Source: Catmull, A Hidden-Surface Algorithm with Anti-Aliasing, SIGGRAPH 1978; wider filters: Duff, Polygon Scan
// Conversion by Exact Convolution, 1989; as a measure for sampled methods: Auzinger et al., Non-Sampled Anti-Aliasing,
// VMV 2013.
#include "zoneplate/antialias/reference/analytic/draw.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

class Analytic : public Resolver {
 public:
  explicit Analytic(const AnalyticOptions& options) : options_(options) {}
  Request request(const FrameContext&) override {
    Request request{.samples = standard_pattern(8)};
    request.draw = [options = options_](const CustomDraw& drawing) { draw_analytic(drawing, options); };
    request.estimates_error = true;
    request.is_display_referred = options_.order == FilterOrder::Display;
    return request;
  }
  DisplayImage post_process(DisplayImage image, const Frame& frame) override {
    return options_.order == FilterOrder::Scene ? image : encode_display_light(light_, frame.display);
  }
  LinearImage resolve(Frame& frame) override {
    if (options_.order == FilterOrder::Display) light_ = frame.color;
    return std::move(frame.color);
  }

 private:
  AnalyticOptions options_;
  LinearImage light_;  ///< display-referred, kept for `post_process`
};

constexpr std::string_view filters[] = {"box", "tent", "quadratic", "b-spline", "mitchell", "catmull-rom"};
constexpr std::string_view orders[] = {"scene", "display"};
constexpr Param params[] = {
    {.name = "filter",
     .meaning = "reconstruction filter, integrated exactly over the visible surfaces",
     .value = 0,
     .names = filters},
    {.name = "shading",
     .meaning = "each surface is shaded in n × n parts of a pixel",
     .value = 1,
     .low = 1,
     .high = 16},
    {.name = "mask",
     .meaning = "edges of alpha-tested surfaces are followed in n × n parts of a pixel",
     .value = 8,
     .low = 1,
     .high = 64},
    {.name = "order",
     .meaning = "filter in linear HDR, then tone-map (scene), or tone-map first (display)",
     .value = 0,
     .names = orders},
};

std::unique_ptr<Resolver> make(const Settings& s) {
  return std::make_unique<Analytic>(
      AnalyticOptions{.filter = s.chosen("filter"),
                      .shading = s.integer("shading"),
                      .mask = s.integer("mask"),
                      .order = s.chosen("order") == "scene" ? FilterOrder::Scene : FilterOrder::Display});
}

}  // namespace

Method analytic() {
  return {.name = "analytic",
          .summary = "exact coverage of each pixel by visible surfaces, the reference for edges",
          .source = "Catmull 1978",
          .params = params,
          .make = make,
          .is_reference = true};
}

}  // namespace zoneplate::antialias
