// SPDX-License-Identifier: Apache-2.0
// Upscaling by a separable kernel: bilinear, bicubic, Lanczos. They know no edges: a bilinear image is soft and shows
// the grid of its input in diagonals, and kernels with negative lobes ring along edges.
//
// Source: Keys, Cubic Convolution Interpolation for Digital Image Processing, IEEE Trans. ASSP 29(6), 1981; Mitchell
// and Netravali, Reconstruction Filters in Computer Graphics, SIGGRAPH 1988; Duchon, Lanczos Filtering in One and Two
// Dimensions, J. Applied Meteorology 18, 1979.
#include <algorithm>
#include <cmath>
#include <utility>

#include "zoneplate/image/transfer.h"
#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/upscale/alpha.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

constexpr std::string_view mixings[] = {"codes", "light"};
constexpr Param mix_param = {.name = "mix",
                             .meaning = "interpolation of sRGB-encoded values (codes) or in linear light",
                             .value = 0,
                             .names = mixings};
constexpr std::string_view cubics[] = {"catmull-rom", "mitchell", "b-spline"};
constexpr Param bilinear_params[] = {scale_param, mix_param};
constexpr Param bicubic_params[] = {
    scale_param, {.name = "kernel", .meaning = "the cubic", .value = 0, .names = cubics}, mix_param};
constexpr Param lanczos_params[] = {
    scale_param, {.name = "lobes", .meaning = "lobes on each side", .value = 3, .low = 2, .high = 8}, mix_param};

/// Applies a transfer curve to the colours of all pixels.
void transfer(DisplayImage& image, float (*curve)(float)) {
  for (Display& c : image.values()) c = {curve(c.r), curve(c.g), curve(c.b), c.a};
}

class KernelUpscaler : public SpatialUpscaler {
 public:
  KernelUpscaler(Kernel kernel, bool mixes_light) : kernel_(std::move(kernel)), mixes_light_(mixes_light) {}
  int radius() const override { return static_cast<int>(std::ceil(kernel_.radius)); }

  DisplayImage upscale(const DisplayImage& image, const UpscaleGrid& grid) const override {
    if (!mixes_light_) return upscale_values(image, grid);
    DisplayImage light = image;
    transfer(light, decode_srgb);
    light = upscale_values(light, grid);
    transfer(light, encode_srgb);
    return light;
  }

  /// All channels are resampled as they are. Alpha overshoots as the colours do, so that straight colours are right;
  /// an opaque image stays opaque.
  std::optional<LinearImage> upscale_light(const LinearImage& image, const UpscaleGrid& grid) const override {
    LinearImage out = resampled(image, grid);
    if (std::ranges::all_of(image.values(), [](const Linear& c) { return c.a == 1; }))
      for (Linear& c : out.values()) c.a = 1;
    return out;
  }

 private:
  LinearImage resampled(const LinearImage& image, const UpscaleGrid& grid) const {
    const Crop made = grid.made();
    return resample(image, made.width, made.height, kernel_,
                    {.step_x = static_cast<double>(grid.width) / grid.to.width,
                     .step_y = static_cast<double>(grid.height) / grid.to.height,
                     .shift_x = -static_cast<double>(grid.x),
                     .shift_y = -static_cast<double>(grid.y),
                     .first_x = made.x,
                     .first_y = made.y});
  }

  DisplayImage upscale_values(const DisplayImage& image, const UpscaleGrid& grid) const {
    LinearImage in(image.width(), image.height());
    std::ranges::transform(image.values(), in.values().begin(), [](const Display& c) {
      return Linear{c.r * c.a, c.g * c.a, c.b * c.a, c.a};
    });
    const bool is_opaque = std::ranges::all_of(in.values(), [](const Linear& c) { return c.a == 1; });
    const LinearImage light = resampled(in, grid);
    DisplayImage out(light.width(), light.height());
    const auto clamped = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
    std::ranges::transform(light.values(), out.values().begin(), [&](const Linear& c) -> Display {
      if (is_opaque) return {clamped(c.r), clamped(c.g), clamped(c.b), 1};
      // Before alpha is clamped: kernels with negative lobes overshoot in it as in the colours.
      return c.a > 0 ? Display{clamped(c.r / c.a), clamped(c.g / c.a), clamped(c.b / c.a), clamped(c.a)}
                     : Display{0, 0, 0, 0};
    });
    if (!is_opaque) keep_visible_colors(out, image, grid, radius());
    return out;
  }

  Kernel kernel_;
  bool mixes_light_;
};

std::unique_ptr<SpatialUpscaler> make(std::string_view kernel, const Settings& s) {
  return std::make_unique<KernelUpscaler>(make_kernel(kernel), s.chosen("mix") == "light");
}

}  // namespace

Upscaler bilinear() {
  return {.name = "bilinear",
          .summary = "linear interpolation along each axis",
          .source = "the tent kernel",
          .params = bilinear_params,
          .make_spatial = [](const Settings& s) { return make("tent", s); }};
}

Upscaler bicubic() {
  return {.name = "bicubic",
          .summary = "a cubic of four pixels along each axis",
          .source = "Keys 1981; Mitchell and Netravali 1988",
          .params = bicubic_params,
          .make_spatial = [](const Settings& s) { return make(s.chosen("kernel"), s); }};
}

Upscaler lanczos() {
  return {
      .name = "lanczos",
      .summary = "a sinc under the middle lobe of a sinc along each axis",
      .source = "Duchon 1979",
      .params = lanczos_params,
      .make_spatial = [](const Settings& s) { return make("lanczos:lobes=" + std::to_string(s.integer("lobes")), s); }};
}

}  // namespace zoneplate::upscale
