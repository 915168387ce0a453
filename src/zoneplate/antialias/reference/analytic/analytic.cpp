// Exact coverage: the visible polygons of every pixel, hidden surfaces removed exactly, and the filter's integral over
// each in closed form. What every other method can be measured from, without any noise of sampling.
//
// Coverage is exact; colour is that of each visible surface at the centroid of what is seen of it in the pixel, or with
// shading=n the mean of n × n parts of the pixel. Alpha-masked surfaces end along the line where alpha crosses the
// cutoff, which is followed in mask × mask parts; blended ones are laid over each other in their exact order. Pixels
// that are too crowded for polygons are sampled, up to 4,096 times, and the method estimates the error of that (--aov
// error: 0 where nothing was sampled). Weak where shading changes within a pixel faster than its parts: highlights and
// textures far below a pixel are sampled like elsewhere.
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
    {.name = "filter", .meaning = "integrated exactly over what is seen", .value = 0, .names = filters},
    {.name = "shading",
     .meaning = "n × n parts of a pixel, each surface shaded in each",
     .value = 1,
     .low = 1,
     .high = 16},
    {.name = "mask",
     .meaning = "n × n parts of a pixel where a mask's edge is followed",
     .value = 8,
     .low = 1,
     .high = 64},
    {.name = "order",
     .meaning = "filter the scene's light, or what the display shows of it",
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
          .summary = "exact coverage by what is visible of each pixel, the reference for edges",
          .source = "Catmull 1978",
          .params = params,
          .make = make,
          .is_reference = true};
}

}  // namespace zoneplate::antialias
