// SPDX-License-Identifier: Apache-2.0
// Learned super-sampling of one image: SMAA and bilinear interpolation in linear light, of which a network corrects the
// weights of the 3 × 3 nearest pixels of SMAA for each output pixel. It makes no colours. Corrections of 0 are
// bilinear.
//
// It reads colours alone. Weaknesses: it is trained for twice the size, whose corrections it also takes for others, on
// generated scenes (train/README.md); it draws no detail that the samples have missed, and a mean of pixels does not
// sharpen.
#include <algorithm>
#include <cmath>
#include <vector>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/learned_smaa/learned_smaa.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/network/trained.h"
#include "zoneplate/upscale/alpha.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {
namespace {

constexpr int outputs = 40, taps = 9;  ///< nine weights for each of four output pixels, and four that do not count
constexpr float greatest = 4;
constexpr Param params[] = {real_param(scale_param.name, scale_param.meaning, 2, scale_param.low, scale_param.high)};

const network::Network& trained() {
  static const network::Network network(network::trained_weights(network::Trained::Still),
                                        {antialias::StillCorrections::features, outputs}, "the program's own");
  return network;
}

/// The nearest input pixel of each output pixel along one axis, on which side of its centre it is, and the weights of
/// that pixel and its neighbours in linear interpolation.
struct NearestPixels {
  struct Place {
    int pixel, half;
    float weights[3];
    float distance;  ///< from that pixel's centre, in input pixels
  };
  std::vector<Place> places;

  /// Output pixels first to first + count - 1 of `to`, from `from` input pixels.
  NearestPixels(int first, int count, int to, int from) {
    for (int o = first; o < first + count; ++o) {
      const float place = (static_cast<float>(o) + 0.5f) * static_cast<float>(from) / static_cast<float>(to);
      const int pixel = std::clamp(static_cast<int>(std::floor(place)), 0, from - 1);
      const float offset = place - static_cast<float>(pixel) - 0.5f;
      places.push_back({pixel,
                        offset < 0 ? 0 : 1,
                        {std::max(-offset, 0.0f), 1 - std::abs(offset), std::max(offset, 0.0f)},
                        std::abs(offset)});
    }
  }
};

/// The display-referred pixels in linear light.
LinearImage decoded(const DisplayImage& image) {
  LinearImage out(image.width(), image.height());
  antialias::for_rows(image.height(), [&](int y) {
    std::ranges::transform(image.row(y), out.row(y).begin(), [](const Display& c) {
      return Linear{decode_srgb(c.r), decode_srgb(c.g), decode_srgb(c.b), c.a};
    });
  });
  return out;
}

DisplayImage upscale_opaque(const DisplayImage& image, const UpscaleGrid& grid) {
  const Rgba8Image codes = quantize8(image), smooth_codes = antialias::apply_smaa(codes, nullptr, {});
  const LinearImage smooth = decoded(
      antialias::filter_encoded(image, antialias::Mixing::Linear, [&](const Rgba8Image&) { return smooth_codes; }));
  const Crop made = grid.made();
  const NearestPixels columns(made.x, made.width, grid.to.width, grid.width),
      rows(made.y, made.height, grid.to.height, grid.height);
  DisplayImage out(made.width, made.height);
  const auto row_of = [&](int o) { return rows.places[static_cast<std::size_t>(o)].pixel - grid.y; };
  const auto make_row = [&](const antialias::StillCorrections& corrections, int o) {
    const NearestPixels::Place& down = rows.places[static_cast<std::size_t>(o)];
    const int y = row_of(o);
    std::vector<float> of_row(static_cast<std::size_t>(image.width()) * outputs);
    corrections.write_row(y, of_row.data());
    for (int p = 0; p < made.width; ++p) {
      const NearestPixels::Place& across = columns.places[static_cast<std::size_t>(p)];
      const int x = across.pixel - grid.x;
      const float* const correction =
          of_row.data() + std::ptrdiff_t{outputs} * x + taps * (2 * down.half + across.half);
      Linear sum{0, 0, 0, 0};
      float total = 0;
      // Corrections are those of output pixels a quarter of a pixel away along each axis; a pixel's own centre has
      // none.
      const float part = std::min(4 * std::max(across.distance, down.distance), 1.0f);
      for (int k = 0; k < taps; ++k) {
        const float weight =
            std::clamp(across.weights[k % 3] * down.weights[k / 3] + part * correction[k], 0.0f, greatest);
        total += weight;
        sum = sum + smooth(std::clamp(x + k % 3 - 1, 0, image.width() - 1),
                           std::clamp(y + k / 3 - 1, 0, image.height() - 1)) *
                        weight;
      }
      const Linear light = total > 1e-3f ? sum * (1 / total) : smooth(x, y);
      out(p, o) = {encode_srgb(light.r), encode_srgb(light.g), encode_srgb(light.b), 1};
    }
  };
  for (int o = 0; o < made.height;) {
    const int first = row_of(o), begin = o;
    while (o < made.height && row_of(o) < first + antialias::StillCorrections::band) ++o;
    const antialias::StillCorrections corrections(codes, smooth_codes, grid.x, grid.y, first, trained(), outputs);
    antialias::for_rows(o - begin, [&](int i) { make_row(corrections, begin + i); });
  }
  return out;
}

class LearnedStill : public SpatialUpscaler {
 public:
  int radius() const override { return antialias::learned_smaa_radius() + 1 + continued_radius; }
  DisplayImage upscale(const DisplayImage& image, const UpscaleGrid& grid) const override {
    return filter_with_alpha(
        image, grid, [&](const DisplayImage& values) { return upscale_opaque(values, grid); }, &Display::g);
  }
};

}  // namespace

Upscaler learned_still() {
  return {.name = "learned-still",
          .summary = "SMAA and bilinear weights, which a small network corrects per pixel",
          .source = "Zoneplate, train/",
          .params = params,
          .make_spatial = [](const Settings&) -> std::unique_ptr<SpatialUpscaler> {
            return std::make_unique<LearnedStill>();
          },
          .is_specification_only = true};
}

}  // namespace zoneplate::upscale
