// FLIPQUAD: four samples on a pixel's sides, each shared with the pixel beyond that side: two a pixel.
//
// The rotated grid's four samples pushed out to the sides, the pattern mirrored from pixel to pixel so that
// neighbours meet in one sample. Five levels of coverage near the axes for the price of two samples; softer than
// four samples of a pixel's own, because none is.
//
// Source: Akenine-Möller, An Extremely Inexpensive Multisampling Scheme, Chalmers 2003 (after his FLIPQUAD of 2002);
// the places on the sides are those of the rotated grid, 3/8 and 5/8. The renderer, whose pixels are all alike, is
// asked for both mirror images on the upper and the left side, and one of them is taken.
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
    request.planes.sample_colors = true;
    request.halo = 1;
    return request;
  }
  /// The sides that a picture's last column and row would share with pixels beyond it are not there.
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
          .summary = "four samples on the sides, shared by neighbours",
          .source = "Akenine-Möller 2003",
          .make = [](const Settings&) -> std::unique_ptr<Resolver> { return std::make_unique<FlipQuad>(); },
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
