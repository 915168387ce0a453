// SPDX-License-Identifier: Apache-2.0
// FLIPQUAD: four samples on a pixel's sides, each shared with the neighbour: two samples per pixel on average.
//
// The four samples of the rotated grid moved to the pixel's sides, with the pattern mirrored from pixel to pixel so
// that neighbours share samples. Five levels of coverage near the axes at the cost of two samples; softer than four
// samples inside the pixel. A surface is shaded once for a pixel's samples on the upper and the left side, at their
// mean, so that with those of its neighbours textures stay where they are.
//
// Source: Akenine-Möller, An Extremely Inexpensive Multisampling Scheme, Chalmers 2003 (after his FLIPQUAD of 2002);
// the positions on the sides are those of the rotated grid, 3/8 and 5/8. The renderer uses one pattern for all pixels:
// it samples both mirror images on the upper and the left side, and the resolve uses one of them.
#include "zoneplate/antialias/post/encoded.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

constexpr std::uint8_t near = 96, far = 160;  // 3/8 and 5/8

class FlipQuad : public Resolver {
 public:
  Request request(const FrameContext&) override {
    Request request{.samples = {{near, 0}, {far, 0}, {0, far}, {0, near}},
                    .rate = Rate::Surface,
                    .weights = {},
                    .planes = {},
                    .pixel_mask = {}};
    request.centroid = Centroid::MeanOfAll;
    request.planes.sample_colors = true;
    request.halo = 1;
    request.ends_in_light = true;
    return request;
  }
  /// The last column and row have no samples on their far sides.
  LinearImage resolve(Frame& frame) override {
    LinearImage out(frame.color.width(), frame.color.height());
    // Across a side the pattern is mirrored: the pixel's lower side is the upper one of the pixel below.
    const auto upper = [&](int x, int y) { return frame.sample_color[odd(frame, x, y) ? 1 : 0](x, y); };
    const auto left = [&](int x, int y) { return frame.sample_color[odd(frame, x, y) ? 3 : 2](x, y); };
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) {
        Linear sum = upper(x, y) + left(x, y);
        int count = 2;
        if (y + 1 < out.height()) sum = sum + upper(x, y + 1), ++count;
        if (x + 1 < out.width()) sum = sum + left(x + 1, y), ++count;
        out(x, y) = sum * (1 / static_cast<float>(count));
      }
    });
    return out;
  }

 private:
  static bool odd(const Frame& frame, int x, int y) { return ((x + frame.x) + (y + frame.y)) % 2 != 0; }
};

}  // namespace

Method flipquad() {
  return {.name = "flipquad",
          .summary = "four samples on the pixel's sides, shared by neighbours",
          .source = "Akenine-Möller 2003",
          .make = [](const Settings&) -> std::unique_ptr<Resolver> { return std::make_unique<FlipQuad>(); },
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
