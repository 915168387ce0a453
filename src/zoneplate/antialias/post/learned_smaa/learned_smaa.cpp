// SPDX-License-Identifier: Apache-2.0
// Learned morphological antialiasing of one image: SMAA 1x, of which a network corrects each pixel by a mean of the 3 ×
// 3 pixels before SMAA. The network makes nine weights, and no colours: each pixel is a mean of those around it, in
// linear light. Weights of 0 are SMAA.
//
// It reads colours alone, and so serves images of any renderer. Weaknesses: as for all filters of one image, details
// thinner than a pixel stay broken; it is trained on generated scenes (train/README.md).
//
// Source: the weights that networks predict are of Bako et al., Kernel-Predicting Convolutional Networks for Denoising
// Monte Carlo Renderings, SIGGRAPH 2017; SMAA of Jimenez et al. 2012.
#include "zoneplate/antialias/post/learned_smaa/learned_smaa.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/antialias/post/post_process.h"
#include "zoneplate/network/trained.h"

namespace zoneplate::antialias {
namespace {

constexpr int outputs = 16, taps = 9;  ///< of the outputs the first nine are weights
constexpr float greatest = 4;

const network::Network& trained() {
  static const network::Network network(network::trained_weights(network::Trained::Smaa),
                                        {StillCorrections::features, outputs}, "the program's own");
  return network;
}

/// The mean of a pixel of SMAA and 3 × 3 pixels of the image, with weights.
Rgba8 corrected(const Rgba8Image& image, int x, int y, Rgba8 smooth, const float* weights) {
  float total = 0, weight[taps];
  for (int k = 0; k < taps; ++k) total += weight[k] = std::clamp(weights[k], 0.0f, greatest);
  if (total == 0) return smooth;
  const float scale = 1 / std::max(total, 1.0f);
  Linear sum = decode_pixel(smooth) * (1 - total * scale);
  for (int k = 0; k < taps; ++k) {
    if (weight[k] == 0) continue;
    const Linear c = decode_pixel(
        image(std::clamp(x + k % 3 - 1, 0, image.width() - 1), std::clamp(y + k / 3 - 1, 0, image.height() - 1)));
    sum = sum + c * (weight[k] * scale);
  }
  return encode_pixel(sum);
}

class LearnedSmaa : public Resolver {
 public:
  Request request(const FrameContext&) override { return display_referred_request(learned_smaa_radius()); }
  DisplayImage post_process(DisplayImage image, const Frame& frame) override {
    return filter_encoded(std::move(image), Mixing::Linear,
                          [&](const Rgba8Image& i) { return apply_learned_smaa(i, frame.x, frame.y); });
  }
};

}  // namespace

Rgba8Image apply_learned_smaa(const Rgba8Image& image, int x, int y) {
  if (image.empty()) return image;
  const Rgba8Image smooth = apply_smaa(image, nullptr, SmaaOptions{});
  Rgba8Image out(image.width(), image.height());
  for (int first = 0; first < image.height(); first += StillCorrections::band) {
    const StillCorrections corrections(image, smooth, x, y, first, trained(), outputs);
    for_rows(std::min(StillCorrections::band, image.height() - first), [&](int i) {
      const int row = first + i;
      std::vector<float> weights(static_cast<std::size_t>(image.width()) * outputs);
      corrections.write_row(row, weights.data());
      for (int column = 0; column < image.width(); ++column)
        out(column, row) =
            corrected(image, column, row, smooth(column, row), weights.data() + std::ptrdiff_t{outputs} * column);
    });
  }
  return out;
}

Method learned_smaa() {
  return {.name = "learned-smaa",
          .summary = "smaa, whose pixels a small network corrects by weights of 3 x 3 pixels",
          .source = "Zoneplate, train/",
          .make = [](const Settings&) -> std::unique_ptr<Resolver> { return std::make_unique<LearnedSmaa>(); },
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
