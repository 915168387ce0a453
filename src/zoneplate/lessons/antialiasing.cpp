// SPDX-License-Identifier: Apache-2.0
// Antialiasing: one region of an image by many methods, with its cost and its error against the reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/metrics/mse.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate::lessons {
namespace antialiasing_lesson {
namespace {

constexpr const char *scene_name = "wheel:spokes=16", *reference = "ssaa:n=16";
constexpr int factor = 8;
constexpr std::size_t columns = 6;

struct Way {
  const char* method;
  std::size_t kind;
};
constexpr const char* kinds[] = {"post-process", "with geometry", "multisampling, none", "supersampling",
                                 "over frames"};
constexpr Way ways[] = {{"none", 2},     {"fxaa", 0},     {"smaa", 0},           {"smaa-exact", 0},
                        {"mlaa", 0},     {"cmaa2", 0},    {"dlaa", 0},           {"ddaa", 0},
                        {"gbaa", 1},     {"axial", 1},    {"sraa", 1},           {"idsraa", 1},
                        {"quincunx", 2}, {"flipquad", 2}, {"csaa", 2},           {"msaa:n=4", 2},
                        {"msaa:n=8", 2}, {"taa", 4},      {"history-guided", 4}, {"oracle-taa", 4},
                        {"adaptive", 3}, {"ssaa:n=4", 3}, {"analytic", 3},       {"ssaa:n=4,filter=mitchell", 3}};

struct Taken {
  Rgba8Image picture;
  double shaded = 0;  ///< samples of a frame
};

Taken taken(const PreparedScene& scene, const Camera& camera, const RenderSettings& settings, const char* method) {
  Renderer renderer(scene, make_resolver(antialias::methods(), method));
  RenderedImage image = renderer.render_still(camera, settings);
  return {std::move(image.display), static_cast<double>(image.counts.shaded) / renderer.still_frames()};
}

DisplayImage codes_of(const Rgba8Image& picture) {
  DisplayImage out(picture.width(), picture.height());
  std::ranges::transform(picture.values(), out.values().begin(), [](Rgba8 c) {
    const auto unit = [](std::uint8_t v) { return static_cast<float>(v) / 255; };
    return Display{unit(c.r), unit(c.g), unit(c.b), 1};
  });
  return out;
}

/// The method's text with spaces after commas, where lines may break.
std::string heading_of(std::string method) {
  for (std::size_t at = 0; (at = method.find(',', at)) != std::string::npos; at += 2) method.insert(at + 1, " ");
  return method;
}

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, width = side * 4 / 3, crop_side = side / 2;
  Scene scene = scene_of(scene_name);
  const Camera camera = camera_of(scene, width, side);
  light_unlit(scene);
  const PreparedScene prepared(std::move(scene));
  const RenderSettings settings{
      .options = {.width = width, .height = side, .display = {.background = default_background}}};
  const Taken exact = taken(prepared, camera, settings, reference);
  const DisplayImage exact_codes = codes_of(exact.picture);
  const double pixels = static_cast<double>(exact.picture.values().size());

  // The region next to the hub: spokes at many angles in front of dark, round edges.
  const int x = width * 58 / 100, y = side * 43 / 100;
  Figure figure{.title = fmt::format("The same region by {} antialiasing methods", std::size(ways)), .rows = {{}}};
  std::vector<Curve> curves;
  for (const char* kind : kinds) curves.push_back({.name = kind, .mark = Curve::Mark::Points});
  double greatest = 0, least = HUGE_VAL, most = 0;  // errors, and shaded samples
  for (std::size_t i = 0; i < std::size(ways); ++i) {
    if (i % columns == 0) figure.rows.emplace_back();
    const Taken own = taken(prepared, camera, settings, ways[i].method);
    const double error = 100 * std::sqrt(metrics::mean_squared_error(exact_codes, codes_of(own.picture)));
    const double shaded = own.shaded / pixels;
    greatest = std::max(greatest, error), least = std::min(least, shaded), most = std::max(most, shaded);
    Curve& curve = curves[ways[i].kind];
    curve.points.emplace_back(shaded, error);
    curve.labels.emplace_back(ways[i].method);
    figure.rows.back().push_back({crop_of(own.picture, x, y, factor, crop_side),
                                  fmt::format("{}\nerror {}\u00a0%, {} shaded", heading_of(ways[i].method),
                                              number(error, 2), number(shaded, 2))});
  }
  Plot plot{.title = "",
            .x = {.label = "shaded samples per pixel and frame",
                  .low = least / 1.6,
                  .high = 3 * most,
                  .is_logarithmic = true},
            .y = {.label = "error (%)", .low = 0, .high = 1.08 * greatest},
            .curves = std::move(curves)};
  thin_labels(plot.curves, plot.x, plot.y);
  const int gap = size.style().gap_px,
            rest = static_cast<int>(columns) * (crop_side + gap) - width - crop_side - 2 * gap;
  figure.rows[0] = {
      {marked(exact.picture, x, y, factor, crop_side), "The frame marks the region below, enlarged 8 times."},
      {crop_of(exact.picture, x, y, factor, crop_side),
       fmt::format("Reference\n{}: {} shaded samples per pixel.", reference, number(exact.shaded / pixels, 1))},
      plot_panel(plot, rest - gap, side, "Error against cost; the captions below have the figures of each method.")};
  figure.text =
      "Error: root mean square difference from the reference over the whole image, of sRGB values, white being 100 %; "
      "shaded: shaded samples per pixel and frame. Post-process filters shade no more samples than no antialiasing, "
      "and "
      "infer edges from the image; gbaa and axial also use the edges of triangles, sraa and idsraa geometry at more "
      "samples. gbaa keeps one edge per pixel: where spokes are thinner it is worse than none. Methods over frames "
      "show "
      "the last frame of a scene at rest; analytic has exact coverage, with one shaded sample per surface and pixel. "
      "Multisampling smooths outlines but not highlights; supersampling smooths both, at the cost of shading every "
      "sample. Methods that blur by design (mitchell, quincunx) have a greater error by this measure.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace antialiasing_lesson

Demo demo_antialiasing() {
  return {"antialiasing", "the same region by 24 methods, with error and cost", antialiasing_lesson::make};
}

}  // namespace zoneplate::lessons
