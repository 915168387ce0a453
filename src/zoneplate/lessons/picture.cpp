// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/lessons/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/flip/magma.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/render/view.h"
#include "zoneplate/report/typeface.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/signal/border.h"
#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/signal/fourier/spectrum.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::lessons {
namespace {

constexpr float background_code = 0.2f;        // the default of `zoneplate render`
constexpr Rgba8 mark_color{255, 196, 0, 255};  // outline of crops, visible on light and dark backgrounds

}  // namespace

Scene scene_of(const std::string& text) {
  std::optional<Scene> scene = make_builtin_scene(text);
  if (!scene) throw Error(ErrorKind::Usage, text + ": no such built-in scene");
  return std::move(*scene);
}

Camera camera_of(const Scene& scene, int width, int height) {
  View view;
  if (!scene.cameras.empty()) view.index = 0;
  return choose_camera(scene, view, static_cast<float>(width) / static_cast<float>(height));
}

LinearImage shoot(const Scene& scene, const std::string& method, int width, int height, RenderCounts* counts,
                  ShadingFrequency frequency) {
  return shoot(scene, method, {.width = width, .height = height, .shading_frequency = frequency}, {}, counts);
}

LinearImage shoot(const Scene& scene, const std::string& method, const RenderOptions& options, const MipOptions& mips,
                  RenderCounts* counts) {
  Scene lit = scene;
  light_unlit(lit);
  Renderer renderer(PreparedScene(std::move(lit), mips), upscale::make_method(method));
  RenderedImage image = renderer.render_still(camera_of(scene, options.width, options.height),
                                              {.options = options, .form = ImageForm::Linear});
  if (counts) *counts = image.counts;
  LinearImage light = std::move(image.linear);
  const float background = decode_srgb(background_code);
  for (Linear& c : light.values()) {
    const float behind = background * (1 - c.a);
    c = {c.r + behind, c.g + behind, c.b + behind, 1};
  }
  return light;
}

Rgba8Image shown(const LinearImage& light) { return quantize8(make_display(light, {})); }

Rgba8Image shown(const Plane<float>& light) {
  Rgba8Image picture(light.width(), light.height());
  std::transform(light.values().begin(), light.values().end(), picture.values().begin(), [](float v) {
    const std::uint8_t code = encode_srgb8(v);
    return Rgba8{code, code, code, 255};
  });
  return picture;
}

Plane<float> inside(const Plane<float>& plate) {
  return cropped(plate, seam, seam, plate.width() - 2 * seam, plate.height() - 2 * seam);
}

// Rec.709.
Plane<float> luminance_of(const LinearImage& light) {
  Plane<float> plane(light.width(), light.height());
  std::transform(light.values().begin(), light.values().end(), plane.values().begin(),
                 [](Linear c) { return (0.2126f * c.r + 0.7152f * c.g) + 0.0722f * c.b; });
  return plane;
}

Rgba8Image spectrum_picture(const Spectrum& spectrum, double range_db) {
  return metrics::paint_magma(centred_log_magnitude(spectrum, range_db));
}

namespace {

struct Corner {
  int x, y, pixels;
};
Corner corner_of(const Rgba8Image& picture, int centre_x, int centre_y, int factor, int side) {
  const int pixels = std::min({(side + factor - 1) / factor, picture.width(), picture.height()});
  return {std::clamp(centre_x - pixels / 2, 0, picture.width() - pixels),
          std::clamp(centre_y - pixels / 2, 0, picture.height() - pixels), pixels};
}

}  // namespace

Rgba8Image crop_of(const Rgba8Image& picture, int centre_x, int centre_y, int factor, int side) {
  const Corner corner = corner_of(picture, centre_x, centre_y, factor, side);
  const int shown_side = std::min(side, corner.pixels * factor);
  Rgba8Image part(shown_side, shown_side);
  for (int y = 0; y < shown_side; ++y)
    for (int x = 0; x < shown_side; ++x) part(x, y) = picture(corner.x + x / factor, corner.y + y / factor);
  return part;
}

Rgba8Image marked(Rgba8Image picture, int centre_x, int centre_y, int factor, int side) {
  const Corner corner = corner_of(picture, centre_x, centre_y, factor, side);
  const auto set = [&](int x, int y) {
    if (x >= 0 && y >= 0 && x < picture.width() && y < picture.height()) picture(x, y) = mark_color;
  };
  for (int i = -1; i <= corner.pixels; ++i) {
    set(corner.x + i, corner.y - 1), set(corner.x + i, corner.y + corner.pixels);
    set(corner.x - 1, corner.y + i), set(corner.x + corner.pixels, corner.y + i);
  }
  return picture;
}

Rgba8Image sign_picture(const std::string& sign, int height, const FigureStyle& style) {
  const Typeface face(Typeface::Weight::Regular, 2 * style.text_px);
  const int width = static_cast<int>(face.width(sign) + 1);
  Rgba8Image picture(width, height, style.paper);
  face.draw(picture, 0, (height - face.leading()) / 2, sign, style.ink);
  return picture;
}

namespace {

Rgba8Image plot_at(const Plot& plot, int width, int height, int designed_width) {
  const int drawn_width = std::max(width, designed_width);
  const int drawn_height = static_cast<int>(std::int64_t{height} * drawn_width / width);
  const Rgba8Image drawn = plot_picture(plot, {drawn_width, drawn_height});
  if (drawn_width == width || drawn.empty()) return drawn;
  LinearImage light(drawn_width, drawn_height);
  std::transform(drawn.values().begin(), drawn.values().end(), light.values().begin(), [](Rgba8 c) {
    return Linear{decode_srgb8(c.r), decode_srgb8(c.g), decode_srgb8(c.b), 1};
  });
  return shown(resample(light, width, height, make_kernel("mitchell")));
}

}  // namespace

Panel plot_panel(Plot plot, int width, int height, std::string caption, int designed_width) {
  Rgba8Image drawn = plot_at(plot, width, height, designed_width);
  return {std::move(drawn), std::move(caption), std::move(plot)};
}

double rms_difference(const Plane<float>& a, const Plane<float>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    const double d = static_cast<double>(a.values()[i]) - static_cast<double>(b.values()[i]);
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(a.values().size()));
}

std::string number(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return value < 0 && !is_zero ? "−" + text : text;
}

std::string counted(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

}  // namespace zoneplate::lessons
