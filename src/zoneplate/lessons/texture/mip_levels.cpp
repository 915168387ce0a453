// SPDX-License-Identifier: Apache-2.0
// Mip levels: what they are, where each is read, how their filter and their alpha are chosen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/job/output/false_color.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/math/random.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/make.h"
#include "zoneplate/shade/texture/texture.h"
#include "zoneplate/shade/texture/texture_view.h"
#include "zoneplate/signal/filter/kernel.h"
#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/signal/pattern/pattern.h"

namespace zoneplate::lessons {
namespace mip_levels_lesson {
namespace {

constexpr int texels = 256;
constexpr Param params[] = {
    {.name = "cutoff", .meaning = "of the alpha test", .value = 0.5, .low = 0.1, .high = 0.9, .decimals = 2}};

/// Level 0 on the left, the others below one another on its right, reduced or enlarged to `side` pixels in height.
Rgba8Image pyramid(const Texture& texture, int side, Rgba8 paper) {
  const TextureView& view = texture.view();
  Rgba8Image image(view.width[0] + view.width[1], view.height[0], paper);
  int left = 0, top = 0;
  for (int l = 0; l < view.levels && view.height[l] > 0; ++l) {
    for (int y = 0; y < view.height[l]; ++y)
      for (int x = 0; x < view.width[l]; ++x) {
        const std::uint16_t* const c = view.unorm15 + std::ptrdiff_t{4} * view.texel(l, x, y);
        const auto code = [&](int i) { return encode_srgb8(static_cast<float>(c[i]) / 32767); };
        if (top + y < image.height()) image(left + x, top + y) = {code(0), code(1), code(2), 255};
      }
    if (l == 0)
      left = view.width[0];
    else
      top += view.height[l];
  }
  const int width = side * image.width() / image.height();
  return shown(resample(
      [&] {
        LinearImage light(image.width(), image.height());
        std::ranges::transform(image.values(), light.values().begin(), [](Rgba8 c) {
          return Linear{decode_srgb8(c.r), decode_srgb8(c.g), decode_srgb8(c.b), 1};
        });
        return light;
      }(),
      width, side, make_kernel("mitchell")));
}

/// A data pass of the board in false colour, transparent where nothing is drawn.
Rgba8Image pass(const Scene& scene, bool Planes::*plane, Plane<float> Frame::*values, Rgba8 (*color)(float), int side) {
  Renderer renderer(PreparedScene(scene), make_resolver(antialias::methods(), "none"));
  Planes planes;
  planes.depth = planes.*plane = true;
  const RenderedImage image =
      renderer.render(camera_of(scene, side, side), {.options = {.width = side, .height = side}, .planes = planes});
  Rgba8Image out(side, side, Rgba8{0, 0, 0, 0});
  for (std::size_t i = 0; i < out.values().size(); ++i)
    if (std::isfinite(image.data.depth.values()[i])) out.values()[i] = color((image.data.*values).values()[i]);
  return out;
}

/// The fraction of the texels of each level that pass an alpha test.
std::string coverage_text(const Texture& texture, float cutoff) {
  const TextureView& view = texture.view();
  std::string text;
  for (int l = 0; l < std::min(view.levels, 6); ++l) {
    int passing = 0;
    for (int y = 0; y < view.height[l]; ++y)
      for (int x = 0; x < view.width[l]; ++x)
        if (static_cast<float>(view.unorm15[std::ptrdiff_t{4} * view.texel(l, x, y) + 3]) >= cutoff * 32767) ++passing;
    text +=
        fmt::format("{}{}\u00a0%", l > 0 ? ", " : "", number(100.0 * passing / (view.width[l] * view.height[l]), 0));
  }
  return text;
}

/// Blades of grass, one or two texels wide, on nothing.
TexelImage grass() {
  Rgba8Image image(texels, texels, Rgba8{70, 120, 40, 0});
  for (std::uint32_t n = 0; n < 40; ++n) {
    const auto random = [&](std::uint32_t axis) { return unit_float(hash(n, axis, 31)); };
    const float x = random(0) * texels, lean = 60 * (random(1) - 0.5f), length = (0.4f + 0.6f * random(2)) * texels;
    const auto code = static_cast<std::uint8_t>(90 + 90 * random(3));
    for (int y = 0; static_cast<float>(y) < length; ++y) {
      const float along = static_cast<float>(y) / length, middle = x + lean * along * along;
      for (int k = 0; k <= 1; ++k) {
        const int column = (static_cast<int>(middle) + k + texels) % texels;
        if (k == 1 && along > 0.25f) continue;
        image(column, texels - 1 - y) = {static_cast<std::uint8_t>(code / 2), code, 40, 255};
      }
    }
  }
  return image;
}

/// The same hedge at 1, 2, 4, 8 and 16 times a distance.
Scene receding(const TexelImage& blades, float cutoff) {
  Scene scene;
  scene.images.push_back({"grass", blades});
  Material leaf;
  leaf.name = "grass";
  leaf.model = ShadingModel::Unlit;
  leaf.alpha_mode = AlphaMode::Mask, leaf.alpha_cutoff = cutoff;
  leaf.base_color_texture.image = 0;
  leaf.base_color_texture.sampler.wrap_v = Wrap::Clamp;
  scene.materials.push_back(leaf);
  Mesh mesh;
  for (int i = 0; i < 5; ++i) {
    const float distance = 2.2f * static_cast<float>(1 << i), half = 2 * distance;
    const auto first = static_cast<std::uint32_t>(mesh.position.size());
    for (const float y : {0.0f, 1.0f})
      for (const float x : {-half, half}) {
        mesh.position.push_back({x + 0.3f, y, -distance});
        mesh.normal.push_back({0, 0, 1});
        mesh.uv0.push_back({x, 1 - y});
      }
    for (const std::uint32_t v : {0u, 1u, 3u, 0u, 3u, 2u}) mesh.index.push_back(first + v);
  }
  add_object(scene, "hedges", std::move(mesh));
  scene.cameras.push_back(camera_at({0, 1.9f, 0}, {0, 1.0f, -3.2f}, 0.8f, 0.1f, 200));
  return scene;
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel;
  const auto cutoff = static_cast<float>(settings.number("cutoff"));
  Figure figure{.title = "Mip levels: a texture at every size, made before it is needed", .rows = {{}, {}, {}}};

  const Rgba8Image wall = shown(make_pattern(fmt::format("bricks:size={}", texels)));
  const Texture box(wall, TexelMeaning::Color), kaiser(wall, TexelMeaning::Color, {.filter = MipFilter::Kaiser});
  const Rgba8 paper = size.style().paper;
  figure.rows[0].push_back({pyramid(box, side, paper),
                            "The pyramid\nEach level is half as wide and high as the one before: all of them together "
                            "take a third more memory than the image."});
  Scene scene = scene_of("checkerboard");
  scene.images.at(0).pixels = wall;
  figure.rows[0].push_back({pass(scene, &Planes::mip_level, &Frame::mip_level, mip_level_color, side),
                            "--aov mip-level\nlog2 of the longer side of a pixel's footprint in texels: white where "
                            "the texture is magnified, red level 0, then a hue for each level."});
  figure.rows[0].push_back({pass(scene, &Planes::anisotropy, &Frame::anisotropy, anisotropy_color, side),
                            "--aov anisotropy\nThe footprint's length over its width: towards the horizon, where no "
                            "square level fits; pale is 16 and more."});

  const auto board = [&](const char* filter, MipFilter mips, const char* method = "none") {
    return shown(shoot(scene, method,
                       RenderOptions{.width = side, .height = side, .texture_filter = parse_texture_filter(filter)},
                       {.filter = mips}));
  };
  figure.rows[1].push_back(
      {board("bilinear", MipFilter::Box), "Without levels\nPixels that cover many texels read four of them."});
  figure.rows[1].push_back(
      {board("trilinear", MipFilter::Box), "Box levels\nThe mean of 2 × 2 texels: --mip-filter box."});
  figure.rows[1].push_back(
      {board("trilinear", MipFilter::Kaiser),
       "Kaiser levels\nA wider filter with negative lobes keeps more contrast: --mip-filter kaiser."});
  figure.rows[1].push_back({board("bilinear", MipFilter::Box, "ssaa:samples=256"),
                            "256 samples a pixel\nThe reference, without levels: what an ideal filter keeps."});

  const TexelImage blades = grass();
  const Scene hedges = receding(blades, cutoff);
  const auto view = [&](const std::string& method, const RenderOptions& options, bool keeps_coverage) {
    return enlarged(shown(shoot(hedges, method, options, {.keeps_coverage = keeps_coverage})), 2);
  };
  const RenderOptions small{.width = side / 2, .height = side / 2};
  figure.rows[2].push_back(
      {view("none", small, false), "Alpha averaged\nWith distance the test removes the blades: " +
                                       coverage_text(Texture(blades, TexelMeaning::Color), cutoff) +
                                       " of the texels pass at levels 0 to 5."});
  figure.rows[2].push_back({view("none", small, true),
                            "Coverage kept\nAlpha is scaled level by level (--mip-filter box:alpha=coverage): " +
                                coverage_text(Texture(blades, TexelMeaning::Color, {.kept_cutoff = cutoff}), cutoff) +
                                "."});
  figure.rows[2].push_back(
      {view("msaa:n=8,alpha=samples", small, true),
       "Tested at 8 samples\nThe default method tests alpha at each sample: edges are as smooth as "
       "those of triangles."});
  figure.rows[2].push_back({view("ssaa:samples=256", small, false), "256 samples a pixel\nThe reference."});
  figure.text =
      "Levels are made in linear light, as light adds up. Source of the pyramid: Williams, Pyramidal Parametrics, "
      "1983; "
      "of the kept coverage: Castaño, Computing Alpha Mipmaps, 2010.";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace mip_levels_lesson

Demo demo_mip_levels() {
  return {"mip-levels", "mip levels: where each is read, their filters and their alpha", mip_levels_lesson::make,
          mip_levels_lesson::params};
}

}  // namespace zoneplate::lessons
