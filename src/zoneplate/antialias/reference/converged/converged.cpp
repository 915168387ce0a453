// SPDX-License-Identifier: Apache-2.0
// The converged reference: many shaded samples per pixel, whose variance gives an estimate of the remaining error.
//
// The reference for shading inside surfaces (textures, highlights, alpha), for which exact coverage has no closed form;
// with any reconstruction filter, and an error estimate for each pixel (--aov error). Weaknesses: its cost; and edges
// along an axis, for which the sample lattice of 1/256 pixel has a resolution of half a step: there `analytic` is
// exact.
//
// Source: Owen-scrambled Sobol points, Owen 1995; the estimate by independent groups is the method of batch means.
#include "zoneplate/antialias/reference/converged/draw.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

class Converged : public Resolver {
 public:
  explicit Converged(ConvergedOptions options) : options_(std::move(options)) {}
  Request request(const FrameContext&) override {
    Request request{.samples = standard_pattern(8)};
    request.draw = [options = options_](const CustomDraw& drawing) { draw_converged(drawing, options); };
    request.estimates_error = true;
    request.is_display_referred = options_.order == FilterOrder::Display;
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    if (options_.order == FilterOrder::Display) light_ = frame.color;
    return std::move(frame.color);
  }
  DisplayImage post_process(DisplayImage image, const Frame& frame) override {
    return options_.order == FilterOrder::Scene ? image : encode_display_light(light_, frame.display);
  }

 private:
  ConvergedOptions options_;
  LinearImage light_;  ///< display-referred, kept for `post_process`
};

constexpr int counts[] = {64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384};
constexpr std::string_view filters[] = {"box",         "tent",     "quadratic", "b-spline", "mitchell",
                                        "catmull-rom", "gaussian", "lanczos2",  "lanczos3", "blackman-harris",
                                        "kaiser"};
constexpr std::string_view orders[] = {"scene", "display"};
constexpr Param params[] = {
    {.name = "samples", .meaning = "shaded samples per pixel", .value = 1024, .choices = counts},
    {.name = "filter", .meaning = "reconstruction filter; gaussian has sigma 0.5", .value = 0, .names = filters},
    {.name = "order",
     .meaning = "filter in linear HDR, then tone-map (scene), or tone-map first (display)",
     .value = 0,
     .names = orders},
};

std::unique_ptr<Resolver> make(const Settings& s) {
  const std::string filter(s.chosen("filter"));
  return std::make_unique<Converged>(
      ConvergedOptions{.samples = s.integer("samples"),
                       .filter = filter == "gaussian" ? "gaussian:sigma=0.5" : filter,
                       .order = s.chosen("order") == "scene" ? FilterOrder::Scene : FilterOrder::Display});
}

}  // namespace

Method converged() {
  return {.name = "converged",
          .summary = "many stratified samples with an error estimate, the reference for shading",
          .source = "Owen 1995",
          .params = params,
          .make = make,
          .is_reference = true};
}

}  // namespace zoneplate::antialias
