// Antialiasing: one place of one picture under every method, with what it costs and how far it is from the truth.
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
constexpr const char* kinds[] = {"filters of the picture", "shared samples, few colours", "none, multisampling",
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
  RenderedImage image = renderer.render(camera, settings);
  return {std::move(image.display), image.counts};
}

DisplayImage codes_of(const Rgba8Image& picture) {
  DisplayImage out(picture.width(), picture.height());
  std::ranges::transform(picture.values(), out.values().begin(), [](Rgba8 c) {
    const auto share = [](std::uint8_t v) { return static_cast<float>(v) / 255; };
    return Display{share(c.r), share(c.g), share(c.b), 1};
  });
  return out;
}

/// A text that may be broken at its commas.
std::string heading_of(std::string method) {
  for (std::size_t at = 0; (at = method.find(',', at)) != std::string::npos; at += 2) method.insert(at + 1, " ");
  return method;
}

Lesson make(const DemoSize& size) {
  const int side = size.panel, width = side * 4 / 3, crop_side = side / 2;
  Scene scene = scene_of(scene_name);
  const Camera camera = camera_of(scene, width, side);
  light_unlit(scene);
  const PreparedScene prepared(std::move(scene));
  const RenderSettings settings{
      .options = {.width = width, .height = side, .display = {.background = default_background}}};
  const Taken truth = taken(prepared, camera, settings, reference);
  const DisplayImage truth_codes = codes_of(truth.picture);
  const double pixels = static_cast<double>(truth.picture.values().size());

  // Beside the hub: spokes at many angles before dark, round edges.
  const int x = width * 58 / 100, y = side * 43 / 100;
  Figure figure{.title = "One place under every method", .rows = {{}}};
  std::vector<Curve> curves;
  for (const char* kind : kinds) curves.push_back({.name = kind, .mark = Curve::Mark::Points});
  for (std::size_t i = 0; i < std::size(ways); ++i) {
    if (i % columns == 0) figure.rows.emplace_back();
    const Taken own = taken(prepared, camera, settings, ways[i].method);
    const double error = 100 * std::sqrt(metrics::mean_squared_error(truth_codes, codes_of(own.picture)));
    const double shaded = static_cast<double>(own.counts.shaded) / pixels;
    curves[ways[i].kind].points.emplace_back(shaded, error);
    figure.rows.back().push_back({crop_of(own.picture, x, y, factor, crop_side),
                                  fmt::format("{}\nerror {}\u00a0%, {} shaded", heading_of(ways[i].method),
                                              number(error, 2), number(shaded, 2))});
  }
  const Plot plot{.title = "",
                  .x = {.label = "points shaded a pixel", .is_logarithmic = true},
                  .y = {.label = "error (%)", .low = 0, .high = 2.5},
                  .curves = curves};
  const int gap = size.style().gap_px,
            rest = static_cast<int>(columns) * (crop_side + gap) - width - crop_side - 2 * gap;
  figure.rows[0] = {
      {marked(truth.picture, x, y, factor, crop_side), "The frame marks what is shown below, 8 times enlarged."},
      {crop_of(truth.picture, x, y, factor, crop_side),
       fmt::format("The truth\n{}: {} shaded a pixel.", reference,
                   number(static_cast<double>(truth.counts.shaded) / pixels, 1))},
      {plot_at(plot, rest - gap, side), "Error over cost."}};
  figure.text =
      "The error is the root mean square of the difference from the truth over the whole picture, in codes, white "
      "being 100 %; beside it the points shaded for each pixel of the picture. Filters of the picture shade no more "
      "than "
      "none does, and guess; gbaa knows the triangles' edges besides, sraa and idsraa their geometry at more samples; "
      "multisampling knows the outlines and not the highlights; supersampling knows both and pays for both. A method "
      "that is soft on purpose (mitchell, quincunx) is counted here as wrong.";
  return {.frames = {figure}};
}

}  // namespace

Demo demo_antialiasing() { return {"antialiasing", "one place under every method, with its error and its cost", make}; }

}  // namespace zoneplate::cli
