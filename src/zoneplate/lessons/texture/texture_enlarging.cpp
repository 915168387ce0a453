// SPDX-License-Identifier: Apache-2.0
// Texture filters where a texture is enlarged: each texel covers many pixels.
#include <fmt/format.h>

#include <array>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/shade/texture/sample.h"
#include "zoneplate/signal/filter/kernel.h"
#include "zoneplate/signal/filter/resample.h"

namespace zoneplate::lessons {
namespace texture_enlarging_lesson {
namespace {

constexpr int reduction = 9;

struct Enlarged {
  const char* filter;
  const char* meaning;
};
constexpr std::array<Enlarged, 4> enlarged_by = {
    {{"bilinear", "Continuous, with creases along the rows of texels."},
     {"catmull-rom", "Smooth and sharp; slight dark and light seams at edges."},
     {"b-spline", "Smoothest, without seams, but blurred."},
     {"mitchell", "Between both."}}};

Lesson make(const DemoSize& size, const Settings&) {
  const int side = size.panel, small = side / reduction;
  const LinearImage original = shoot(scene_of("teapot"), "ssaa:n=8", side, side);
  const Texture texture(shown(resample(original, small, small, make_kernel("box"))), TexelMeaning::Color);
  const auto luminance = luminance_of(original);
  const int crop_x = side * 2 / 3, crop_y = side / 2, factor = 4;
  const auto framed = [&](const LinearImage& image) { return marked(shown(image), crop_x, crop_y, factor, side); };
  const auto crop = [&](const LinearImage& image) { return crop_of(shown(image), crop_x, crop_y, factor, side); };
  Figure figure{.title = "Texture filters where a texture is enlarged", .rows = {{}, {}}};
  Table table{{"filter", "error"}, {}};
  for (std::size_t i = 0; i < enlarged_by.size(); ++i) {
    const TextureFilter filter = parse_texture_filter(enlarged_by[i].filter);
    const float step = 1 / static_cast<float>(side);
    LinearImage image(side, side);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const float2 uv{(static_cast<float>(x) + 0.5f) * step, (static_cast<float>(y) + 0.5f) * step};
        const float4 c = sample(texture, {}, filter, uv, {step, 0}, {0, step});
        image(x, y) = {c.x, c.y, c.z, 1};
      }
    const std::string error = number(100 * rms_difference(luminance_of(image), luminance), 2);
    figure.rows[0].push_back(
        {framed(image), fmt::format("{}\n{} Error {}\u00a0%.", enlarged_by[i].filter, enlarged_by[i].meaning, error)});
    figure.rows[1].push_back({crop(image), ""});
    table.rows.push_back({enlarged_by[i].filter, error + " %"});
  }
  figure.rows[0].push_back({framed(original), "The image before its reduction"});
  figure.rows[1].push_back({crop(original), ""});
  figure.text = fmt::format(
      "An image of {0} × {0} pixels is reduced to {1} × {1} texels by a box, and drawn as a texture at its own size, "
      "so "
      "that each texel covers {2} × {2} pixels. Errors: root mean square of the difference from the image before its "
      "reduction, in linear light, in percent of white. Below: the region in the frame, enlarged {3} times.",
      side, small, reduction, factor);
  return {.frames = {figure}, .tables = {table}};
}

}  // namespace
}  // namespace texture_enlarging_lesson

Demo demo_texture_enlarging() {
  return {"texture-enlarging", "texture filters where each texel covers many pixels, with their errors",
          texture_enlarging_lesson::make};
}

}  // namespace zoneplate::lessons
