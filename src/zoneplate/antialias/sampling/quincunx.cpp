// SPDX-License-Identifier: Apache-2.0
// Quincunx: two samples per pixel, its centre and a corner; corner samples are shared by four pixels.
//
// Five samples at the cost of two, with a blur over three by three half-pixels: edges are smooth but textures soft,
// which is why hardware abandoned it. A surface is shaded once for both samples of a pixel, at their mean, a quarter of
// a pixel from the centre: the corners that a pixel takes from its neighbours lie as far on the other side, so that
// textures stay where they are. (Shading at the centre would move them by a quarter of a pixel.)
//
// Source: NVIDIA, HRAA: High-Resolution Antialiasing through Multisampling, 2001: the centre has weight ½, each corner
// ⅛.
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

class Quincunx : public Resolver {
 public:
  Request request(const FrameContext&) override {
    Request request{
        .samples = {{128, 128}, {0, 0}}, .rate = Rate::Surface, .weights = {}, .planes = {}, .pixel_mask = {}};
    request.centroid = Centroid::MeanOfAll;
    request.planes.sample_colors = true;
    request.halo = 1;
    request.ends_in_light = true;
    return request;
  }
  /// Pixels at the image's right and lower side lack corners; the weights of the others are increased.
  LinearImage resolve(Frame& frame) override {
    const LinearImage &centre = frame.sample_color[0], &corner = frame.sample_color[1];
    LinearImage out(centre.width(), centre.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) {
        Linear sum = centre(x, y) * 0.5f;
        float weight = 0.5f;
        for (int j = y; j <= std::min(y + 1, out.height() - 1); ++j)
          for (int i = x; i <= std::min(x + 1, out.width() - 1); ++i)
            sum = sum + corner(i, j) * 0.125f, weight += 0.125f;
        out(x, y) = sum * (1 / weight);
      }
    });
    return out;
  }
};

}  // namespace

Method quincunx() {
  return {.name = "quincunx",
          .summary = "the centre and four corners, which neighbouring pixels share",
          .source = "NVIDIA 2001",
          .make = [](const Settings&) -> std::unique_ptr<Resolver> { return std::make_unique<Quincunx>(); },
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
