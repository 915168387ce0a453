// Geometry buffer antialiasing: each pixel knows how far along its row and its column the nearest edge of its
// triangle is, and takes as much of its neighbour as lies beyond.
//
// One-dimensional coverage: exact for level and upright edges, within an eighth of a pixel for oblique ones, whatever
// the contrast, with one shaded sample a pixel. Weak at corners and on triangles thinner than a pixel, where there is
// more than one edge; blind to alpha tests and to what shading makes of a pixel.
//
// Source: Persson, Geometry Buffer Anti-Aliasing, SIGGRAPH 2011 course. His distances are made from edge equations and
// stored, and the neighbours' are looked at too; here they are found from the triangles that are seen at 32 places
// along either axis, which holds hidden edges and intersections right, and rounds distances to 1/32 pixel.
#include <cmath>

#include "zoneplate/antialias/codes.h"
#include "zoneplate/render/method.h"

namespace zoneplate::antialias {
namespace {

constexpr int places = 32;  // along each axis, those across the row first

class Gbaa : public Resolver {
 public:
  Gbaa() {
    for (int i = 0; i < places; ++i) pattern_.push_back({at(i), 128});
    for (int i = 0; i < places; ++i) pattern_.push_back({128, at(i)});
  }
  Request ask(int) override {
    color_ = {};
    Request request{.samples = {SamplePosition{}}, .rate = Rate::Surface, .weights = {}, .planes = {}, .where = {}};
    request.halo = 1;
    return request;
  }
  /// The picture first, then the triangles.
  std::optional<Request> ask_again(Frame& frame) override {
    if (!color_.empty()) return std::nullopt;
    color_ = std::move(frame.color);
    Request request{.samples = pattern_, .rate = Rate::Surface, .weights = {}, .planes = {}, .where = {}};
    request.planes.samples = true;
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    if (color_.empty()) return std::move(frame.color);
    LinearImage out(color_.width(), color_.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) out(x, y) = pixel(frame, x, y);
    });
    return out;
  }

 private:
  static std::uint8_t at(int place) { return static_cast<std::uint8_t>((2 * place + 1) * 256 / (2 * places)); }

  /// How many places from the centre outwards, on the side of greater (or lesser) coordinates, are the centre's
  /// triangle's: places / 2 where there is no edge.
  static int run(const Frame& frame, int first, int way, int x, int y) {
    const int centre = first + places / 2 - (way < 0 ? 1 : 0);
    const std::uint32_t own = frame.sample_triangle[static_cast<std::size_t>(centre)](x, y);
    int length = 0;
    while (length < places / 2 && frame.sample_triangle[static_cast<std::size_t>(centre + way * length)](x, y) == own)
      ++length;
    return length;
  }

  /// The nearest edge of the four directions decides; of equal ones the first of left, right, up, down.
  Linear pixel(const Frame& frame, int x, int y) const {
    constexpr struct {
      int first, way, dx, dy;
    } directions[] = {{0, -1, -1, 0}, {0, 1, 1, 0}, {places, -1, 0, -1}, {places, 1, 0, 1}};
    int least = places / 2, nx = x, ny = y;
    for (const auto& d : directions) {
      const int length = run(frame, d.first, d.way, x, y), i = x + d.dx, j = y + d.dy;
      if (length >= least || i < 0 || j < 0 || i >= color_.width() || j >= color_.height()) continue;
      least = length, nx = i, ny = j;
    }
    if (least == places / 2) return color_(x, y);
    const float share = static_cast<float>(places / 2 - least) / places;
    return color_(x, y) * (1 - share) + color_(nx, ny) * share;
  }

  SamplePattern pattern_;
  LinearImage color_;
};

}  // namespace

Method gbaa();

Method gbaa() {
  return {.name = "gbaa",
          .summary = "one shaded sample a pixel, and how far its triangle's edges are",
          .source = "Persson 2011",
          .make = [](const Settings&) -> std::unique_ptr<Resolver> { return std::make_unique<Gbaa>(); },
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
