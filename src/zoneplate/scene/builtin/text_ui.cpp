// SPDX-License-Identifier: Apache-2.0
// A window full of text, drawn pixel for pixel: any change by a method is an error.
//
// In an image of the panel's size, the panel has one texel per pixel with nearest filtering: all samples of a pixel
// read the same texel, so that methods with more samples are exact, and image filters show their errors.
#include <algorithm>
#include <array>
#include <string_view>

#include "zoneplate/scene/builtin/shapes.h"

namespace zoneplate {
namespace text_ui_scene {
namespace {

/// Letters of 5 × 7 pixels: rows from the top, the highest of five bits on the left.
struct Glyph {
  char letter;
  std::array<std::uint8_t, 7> rows;
};
constexpr Glyph glyphs[] = {
    {'A', {14, 17, 17, 31, 17, 17, 17}}, {'B', {30, 17, 17, 30, 17, 17, 30}}, {'C', {14, 17, 16, 16, 16, 17, 14}},
    {'D', {30, 17, 17, 17, 17, 17, 30}}, {'E', {31, 16, 16, 30, 16, 16, 31}}, {'F', {31, 16, 16, 30, 16, 16, 16}},
    {'G', {14, 17, 16, 23, 17, 17, 14}}, {'H', {17, 17, 17, 31, 17, 17, 17}}, {'I', {14, 4, 4, 4, 4, 4, 14}},
    {'J', {7, 2, 2, 2, 2, 18, 12}},      {'K', {17, 18, 20, 24, 20, 18, 17}}, {'L', {16, 16, 16, 16, 16, 16, 31}},
    {'M', {17, 27, 21, 21, 17, 17, 17}}, {'N', {17, 25, 21, 19, 17, 17, 17}}, {'O', {14, 17, 17, 17, 17, 17, 14}},
    {'P', {30, 17, 17, 30, 16, 16, 16}}, {'Q', {14, 17, 17, 17, 21, 18, 13}}, {'R', {30, 17, 17, 30, 20, 18, 17}},
    {'S', {15, 16, 16, 14, 1, 1, 30}},   {'T', {31, 4, 4, 4, 4, 4, 4}},       {'U', {17, 17, 17, 17, 17, 17, 14}},
    {'V', {17, 17, 17, 17, 10, 10, 4}},  {'W', {17, 17, 17, 21, 21, 27, 17}}, {'X', {17, 17, 10, 4, 10, 17, 17}},
    {'Y', {17, 17, 10, 4, 4, 4, 4}},     {'Z', {31, 1, 2, 4, 8, 16, 31}},     {'0', {14, 17, 19, 21, 25, 17, 14}},
    {'1', {4, 12, 4, 4, 4, 4, 14}},      {'2', {14, 17, 1, 6, 8, 16, 31}},    {'3', {30, 1, 1, 14, 1, 1, 30}},
    {'4', {2, 6, 10, 18, 31, 2, 2}},     {'5', {31, 16, 30, 1, 1, 17, 14}},   {'6', {14, 16, 16, 30, 17, 17, 14}},
    {'7', {31, 1, 2, 4, 4, 8, 8}},       {'8', {14, 17, 17, 14, 17, 17, 14}}, {'9', {14, 17, 17, 15, 1, 1, 14}},
    {'.', {0, 0, 0, 0, 0, 12, 12}},      {',', {0, 0, 0, 0, 12, 4, 8}},       {'-', {0, 0, 0, 14, 0, 0, 0}},
    {'/', {1, 1, 2, 4, 8, 16, 16}},      {':', {0, 12, 12, 0, 12, 12, 0}},    {'%', {25, 25, 2, 4, 8, 19, 19}}};

/// The image of the panel.
class Panel {
 public:
  Panel(int width, int height) : image_(width, height, {236, 233, 226}) {}

  void fill(int x, int y, int w, int h, Rgba8 color) {
    for (int j = std::max(y, 0); j < std::min(y + h, image_.height()); ++j)
      for (int i = std::max(x, 0); i < std::min(x + w, image_.width()); ++i) image_(i, j) = color;
  }
  void frame(int x, int y, int w, int h, Rgba8 color) {
    fill(x, y, w, 1, color), fill(x, y + h - 1, w, 1, color);
    fill(x, y, 1, h, color), fill(x + w - 1, y, 1, h, color);
  }
  void text(int x, int y, std::string_view words, Rgba8 color, int scale = 1) {
    for (const char c : words) {
      const auto* glyph = std::ranges::find(glyphs, c, &Glyph::letter);
      if (glyph != std::end(glyphs))
        for (int j = 0; j < 7; ++j)
          for (int i = 0; i < 5; ++i)
            if (glyph->rows[static_cast<std::size_t>(j)] >> (4 - i) & 1)
              fill(x + i * scale, y + j * scale, scale, scale, color);
      x += 6 * scale;
    }
  }
  void disc(int cx, int cy, int radius, Rgba8 color) {
    for (int y = -radius; y <= radius; ++y)
      for (int x = -radius; x <= radius; ++x)
        if (x * x + y * y <= radius * radius + radius / 2) fill(cx + x, cy + y, 1, 1, color);
  }
  int width() const { return image_.width(); }
  int height() const { return image_.height(); }
  Rgba8Image take() { return std::move(image_); }

 private:
  Rgba8Image image_;
};

constexpr Rgba8 ink{34, 32, 40}, faint{150, 146, 140}, accent{32, 92, 168}, white{255, 255, 255}, night{30, 34, 44};

constexpr std::string_view lines[] = {
    "ALIASING IS NOT NOISE. A WAVE THAT IS TOO FINE", "FOR THE PIXELS COMES BACK AS A COARSE ONE, AND",
    "NO FILTER CAN TELL IT FROM THE TRUTH.",          "",
    "TEXT IS DRAWN TO THE PIXELS. A METHOD THAT",     "LOOKS FOR STAIRS IN THE PICTURE FINDS SERIFS,",
    "HAIRLINES AND DOTS, AND ROUNDS THEM OFF.",       "",
    "0123456789 - 3840/2160 - 16:9 - 99.5%"};

void draw_window(Panel& p) {
  p.fill(0, 0, p.width(), 24, night);
  p.text(10, 8, "ZONEPLATE", white), p.text(96, 8, "FILE  EDIT  VIEW  HELP", {190, 194, 204});
  for (int i = 0; i < 3; ++i) p.disc(p.width() - 16 - 18 * i, 12, 5, i == 0 ? Rgba8{214, 84, 70} : Rgba8{96, 100, 112});
  p.fill(14, 40, 330, 190, white), p.frame(14, 40, 330, 190, faint);
  p.text(28, 54, "THE BLUR TAX", accent, 2);
  p.fill(28, 74, 302, 1, faint);
  int y = 86;
  for (const std::string_view line : lines) p.text(28, y, line, ink), y += 14;
}

void draw_controls(Panel& p) {
  constexpr std::string_view names[] = {"EDGES", "SAMPLES", "SHARPEN", "GAMMA"};
  for (int i = 0; i < 4; ++i) {
    const int y = 46 + 28 * i, at = 470 + 26 * i;
    p.text(366, y, names[static_cast<std::size_t>(i)], ink);
    p.fill(440, y + 3, 170, 2, faint), p.fill(440, y + 3, at - 440, 2, accent);
    p.disc(at, y + 3, 5, white), p.disc(at, y + 3, 4, accent);
  }
  for (int i = 0; i < 3; ++i) {
    const int x = 366 + 84 * i;
    p.fill(x, 172, 74, 22, i == 0 ? accent : white), p.frame(x, 172, 74, 22, i == 0 ? accent : faint);
    constexpr std::string_view words[] = {"RENDER", "COMPARE", "CANCEL"};
    p.text(x + 12, 180, words[static_cast<std::size_t>(i)], i == 0 ? white : ink);
  }
  for (int i = 0; i < 5; ++i) {
    p.frame(366 + 50 * i, 208, 11, 11, ink);
    if (i % 2 == 0) p.fill(368 + 50 * i, 210, 7, 7, accent);
    p.text(382 + 50 * i, 210, std::string_view("ABCDE").substr(static_cast<std::size_t>(i), 1), ink);
  }
}

/// A table, a plot of single pixels, and patterns of one pixel.
void draw_figures(Panel& p) {
  p.fill(14, 246, 330, 216, night), p.frame(14, 246, 330, 216, ink);
  for (int i = 1; i < 10; ++i)
    p.fill(14 + 33 * i, 247, 1, 214, {48, 54, 66}), p.fill(15, 246 + 21 * i, 328, 1, {48, 54, 66});
  for (int x = 0; x < 300; ++x) {
    const int y = (x * x / 300 - 300) * x / 420 + 150;
    p.fill(28 + x, 300 + y * 2 / 3 - 20, 1, 1, {120, 220, 150}), p.fill(28 + x, 440 - x * 2 / 5, 1, 1, {240, 170, 80});
  }
  constexpr std::string_view rows[] = {"NONE", "FXAA", "SMAA", "CMAA2", "MSAA 4", "MSAA 8", "SSAA 4", "SSAA 16"};
  p.text(26, 256, "PSNR DB", {180, 186, 200});
  for (int row = 0; row < 9; ++row) {
    const int y = 254 + 22 * row;
    if (row % 2 == 0) p.fill(360, y - 6, 266, 22, {246, 244, 240});
    p.text(368, y, row == 0 ? "METHOD      FLIP    MS" : rows[row - 1], row == 0 ? accent : ink);
    if (row == 0) continue;
    const char digits[] = {static_cast<char>('0' + row), '.', static_cast<char>('0' + row * 7 % 10),
                           static_cast<char>('0' + row * 3 % 10)};
    p.text(440, y, {digits, 4}, ink), p.text(488, y, {digits, 3}, ink);
    for (int x = 0; x < 100; x += 2) p.fill(520 + x, y + (x * row / 8) % 7, 1, 1, faint);
  }
  p.fill(360, 452, 266, 1, faint);
  for (int x = 0; x < 130; x += 2) p.fill(360 + x, 458, 1, 12, ink);
  for (int y = 0; y < 12; ++y)
    for (int x = y % 2; x < 130; x += 2) p.fill(496 + x, 458 + y, 1, 1, ink);
}

constexpr Param params[] = {{"width", "of the panel, in texels", 640, 64, 8192},
                            {"height", "of the panel, in texels", 480, 64, 8192}};

Scene make(std::span<const std::int64_t> values) {
  Panel panel(static_cast<int>(values[0]), static_cast<int>(values[1]));
  draw_window(panel);
  draw_controls(panel);
  draw_figures(panel);
  const float w = static_cast<float>(panel.width()) / 2, h = static_cast<float>(panel.height()) / 2;
  Scene scene;
  scene.images.push_back({"panel", panel.take()});
  Mesh mesh;
  add_quad(mesh, {{-w, -h, 0}, {w, -h, 0}, {w, h, 0}, {-w, h, 0}});
  Material material = unlit("panel", {1, 1, 1});
  material.base_color_texture = {.image = 0,
                                 .sampler = {.wrap_u = Wrap::Clamp,
                                             .wrap_v = Wrap::Clamp,
                                             .magnify = TexelFilter::Nearest,
                                             .minify = TexelFilter::Nearest,
                                             .level = LevelFilter::None}};
  add_part(scene, std::move(material), std::move(mesh));
  scene.cameras.push_back(flat_camera(h));
  return scene;
}

}  // namespace
}  // namespace text_ui_scene

BuiltinMaker builtin_text_ui() {
  return {"text-ui",
          "a window of text and controls, one texel a pixel in an image of its size",
          text_ui_scene::params,
          text_ui_scene::make,
          "blur tax",
          "Text and controls are blurred: Unity PostProcessing issues 288 and 841."};
}

}  // namespace zoneplate
