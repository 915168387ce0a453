// SPDX-License-Identifier: Apache-2.0
// Antialiasing: one region of an image by every method, with its cost and its error against the reference.
#include <fmt/format.h>

#include <cmath>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/cli/demo/demo.h"
#include "zoneplate/cli/demo/picture.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/mse.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate::cli {
namespace {

constexpr const char *scene_name = "wheel:spokes=16", *reference = "ssaa:n=16";
constexpr int factor = 8;
constexpr std::size_t columns = 6;

struct Way {
  const char* method;
  std::size_t kind;
};
constexpr const char* kinds[] = {"post-process filters", "shared samples, few colours", "none, multisampling",
                                 "supersampling"};
constexpr Way ways[] = {
    {"none", 2},   {"fxaa", 0},     {"smaa", 0},     {"mlaa", 0},     {"cmaa2", 0},    {"dlaa", 0},
    {"ddaa", 0},   {"gbaa", 0},     {"quincunx", 1}, {"flipquad", 1}, {"csaa", 1},     {"sraa", 1},
    {"idsraa", 1}, {"msaa:n=4", 2}, {"msaa:n=8", 2}, {"adaptive", 3}, {"ssaa:n=4", 3}, {"ssaa:n=4,filter=mitchell", 3}};

struct Taken {
  Rgba8Image picture;
  RenderCounts counts;
};

Taken taken(const PreparedScene& scene, const Camera& camera, const RenderSettings& settings, const char* method) {
  Renderer renderer(scene, make_resolver(antialias::methods(), method));
  RenderedImage image = renderer.render_still(camera, settings);
  return {std::move(image.display), image.counts};
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
  Figure figure{.title = "The same region by every antialiasing method", .rows = {{}}};
  std::vector<Curve> curves;
  for (const char* kind : kinds) curves.push_back({.name = kind, .mark = Curve::Mark::Points});
  for (std::size_t i = 0; i < std::size(ways); ++i) {
    if (i % columns == 0) figure.rows.emplace_back();
    const Taken own = taken(prepared, camera, settings, ways[i].method);
    const double error = 100 * std::sqrt(metrics::mean_squared_error(exact_codes, codes_of(own.picture)));
    const double shaded = static_cast<double>(own.counts.shaded) / pixels;
    curves[ways[i].kind].points.emplace_back(shaded, error);
    figure.rows.back().push_back({crop_of(own.picture, x, y, factor, crop_side),
                                  fmt::format("{}\nerror {}\u00a0%, {} shaded", heading_of(ways[i].method),
                                              number(error, 2), number(shaded, 2))});
  }
  const Plot plot{.title = "",
                  .x = {.label = "shaded samples per pixel", .is_logarithmic = true},
                  .y = {.label = "error (%)", .low = 0, .high = 2.5},
                  .curves = curves};
  const int gap = size.style().gap_px,
            rest = static_cast<int>(columns) * (crop_side + gap) - width - crop_side - 2 * gap;
  figure.rows[0] = {
      {marked(exact.picture, x, y, factor, crop_side), "The frame marks the region below, enlarged 8 times."},
      {crop_of(exact.picture, x, y, factor, crop_side),
       fmt::format("Reference\n{}: {} shaded samples per pixel.", reference,
                   number(static_cast<double>(exact.counts.shaded) / pixels, 1))},
      plot_panel(plot, rest - gap, side, "Error against cost.")};
  figure.text =
      "Error: root mean square difference from the reference over the whole image, of sRGB values, white being 100 %; "
      "shaded: shaded samples per pixel. Post-process filters shade no more samples than no antialiasing, and infer "
      "edges from the image; gbaa also uses the edges of triangles, sraa and idsraa geometry at more samples. "
      "Multisampling smooths outlines but not highlights; supersampling smooths both, at the cost of shading every "
      "sample. Methods that blur by design (mitchell, quincunx) have a greater error by this measure.";
  return {.frames = {figure}};
}

}  // namespace

Demo demo_antialiasing() { return {"antialiasing", "the same region by every method, with error and cost", make}; }

}  // namespace zoneplate::cli
