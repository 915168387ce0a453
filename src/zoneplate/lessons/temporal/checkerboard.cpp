// SPDX-License-Identifier: Apache-2.0
// Checkerboard rendering: half of the pixels are shaded in each frame, and the others come from the last frame or from
// their neighbours.
//
// Source: El Mansouri, Rendering Rainbow Six Siege, GDC 2016, for the idea; the tests are those of object ids and of
// the colours around, and shading is at pixel centres, without the two samples of a quarter of the pixels that GPUs
// use.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/image/tonemap.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/lessons/temporal/moving_film.h"
#include "zoneplate/metrics/mse.h"

namespace zoneplate::lessons {
namespace checkerboard_lesson {
namespace {

constexpr int factor = 4;
constexpr Param params[] = {
    {.name = "frames", .meaning = "of the film; the last one is displayed", .value = 9, .low = 2, .high = 24}};

/// Where the pixels of a frame that are not shaded come from.
enum class Fill { Nothing, FourNeighbours, SmoothPair, LastFrame };

class Checkerboard : public Resolver {
 public:
  explicit Checkerboard(Fill fill) : fill_(fill) {}

  Request request(const FrameContext& context) override {
    context_ = context;
    Request request;
    request.pixel_mask = Plane<std::uint8_t>(context.image.width, context.image.height);
    for (int y = 0; y < context.image.height; ++y)
      for (int x = 0; x < context.image.width; ++x) request.pixel_mask(x, y) = is_shaded(x, y) ? 1 : 0;
    request.planes.depth = request.planes.motion = request.planes.object_id = true;
    return request;
  }

  LinearImage resolve(Frame& frame) override {
    LinearImage out = frame.color;
    Plane<std::uint32_t> ids = frame.object_id;
    if (fill_ != Fill::Nothing)
      for (int y = 0; y < out.height(); ++y)
        for (int x = 0; x < out.width(); ++x)
          if (!is_shaded(x, y)) out(x, y) = filled(frame, x, y, ids(x, y));
    last_ = out, last_ids_ = std::move(ids);
    return out;
  }

 private:
  struct Place {
    int x, y;
  };

  bool is_shaded(int x, int y) const { return (x + y + context_.index) % 2 == 0; }

  /// The shaded neighbours: left, right, above, below. Beyond the border, the opposite one.
  static std::array<Place, 4> neighbours(const LinearImage& image, int x, int y) {
    const int right = image.width() - 1, bottom = image.height() - 1;
    return {{{x > 0 ? x - 1 : x + 1, y},
             {x < right ? x + 1 : x - 1, y},
             {x, y > 0 ? y - 1 : y + 1},
             {x, y < bottom ? y + 1 : y - 1}}};
  }

  /// The colour of a pixel that is not shaded; sets the number of its object.
  Linear filled(const Frame& frame, int x, int y, std::uint32_t& id) const {
    const LinearImage& color = frame.color;
    const std::array<Place, 4> around = neighbours(color, x, y);
    const Place nearest = *std::ranges::min_element(around, {}, [&](Place p) { return frame.depth(p.x, p.y); });
    id = frame.object_id(nearest.x, nearest.y);
    const Linear left = color(around[0].x, around[0].y), right = color(around[1].x, around[1].y);
    const Linear above = color(around[2].x, around[2].y), below = color(around[3].x, around[3].y);
    if (fill_ == Fill::FourNeighbours) return ((left + right) + (above + below)) * 0.25f;
    if (fill_ == Fill::LastFrame && !context_.is_first) {
      const float2 motion = frame.motion(nearest.x, nearest.y);
      const int from_x = x - static_cast<int>(std::lround(motion.x)),
                from_y = y - static_cast<int>(std::lround(motion.y));
      const bool is_inside = from_x >= 0 && from_y >= 0 && from_x < color.width() && from_y < color.height();
      if (is_inside && last_ids_(from_x, from_y) == id) {
        const bool rests = motion.x == 0 && motion.y == 0;
        return rests ? last_(from_x, from_y) : clamped(last_(from_x, from_y), {left, right, above, below});
      }
    }
    const auto contrast = [](const Linear& a, const Linear& b) { return std::abs(a.g - b.g); };
    return contrast(left, right) < contrast(above, below) ? (left + right) * 0.5f : (above + below) * 0.5f;
  }

  static Linear clamped(const Linear& c, const std::array<Linear, 4>& around) {
    const auto limit = [&](float Linear::*channel) {
      const auto [low, high] = std::ranges::minmax(around, {}, channel);
      return std::clamp(c.*channel, low.*channel, high.*channel);
    };
    return {limit(&Linear::r), limit(&Linear::g), limit(&Linear::b), limit(&Linear::a)};
  }

  Fill fill_;
  FrameContext context_;
  LinearImage last_;
  Plane<std::uint32_t> last_ids_;
};

struct Way {
  Fill fill;
  const char *heading, *words;
};
constexpr std::array<Way, 4> ways = {
    {{Fill::Nothing, "Half of the pixels", "The other half is shaded in the next frame."},
     {Fill::FourNeighbours, "The mean of four neighbours", "Every edge has a zipper, and detail is lost."},
     {Fill::SmoothPair, "The smoother pair of neighbours",
      "Straight edges near the axes are whole again; corners and "
      "thin lines are not."},
     {Fill::LastFrame, "The last frame, or the smoother pair",
      "What rests is exact. Where an object moves or has left, its edges are combs for a frame."}}};

double error_of(const LinearImage& reference, const LinearImage& test) {
  return 100 * std::sqrt(metrics::mean_squared_error(make_display(reference, {}), make_display(test, {})));
}

/// A scene, and the middle of the crop in parts of the image.
struct Shot {
  const char *scene, *heading;
  double x, y;
};
constexpr std::array<Shot, 2> shots = {
    {{"teleport", "a wheel that turns", 0.5, 0.41}, {"disocclusion", "a wall of noise behind a board", 0.24, 0.5}}};

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel, height = side * 3 / 4, frames = settings.integer("frames");
  Figure figure{.title = "Checkerboard rendering: half of the pixels in each frame", .rows = {{}, {}}};
  Table table{{"pixels that are not shaded"}, {}};
  for (const Way& way : ways)
    if (way.fill != Fill::Nothing) table.rows.push_back({way.heading});
  for (std::size_t row = 0; row < shots.size(); ++row) {
    const Shot& shot = shots[row];
    const std::vector<LinearImage> whole = film_of_scene(shot.scene, "none", frames, side, height);
    table.head.push_back(fmt::format("error, {}", shot.heading));
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const Way& way = ways[i];
      const LinearImage last =
          film_of_scene(shot.scene, std::make_unique<Checkerboard>(way.fill), frames, side, height).back();
      if (i > 0) table.rows[i - 1].push_back(number(error_of(whole.back(), last), 2) + "\u00a0%");
      const int x = static_cast<int>(shot.x * side), y = static_cast<int>(shot.y * height);
      figure.rows[row].push_back({crop_of(shown(last), x, y, factor, side),
                                  row == 0 ? fmt::format("{}\n{}", way.heading, way.words) : std::string()});
    }
  }
  figure.rows.push_back({{table_picture(table, size.style(), 4 * size.panel + 3 * size.style().gap_px), ""}});
  figure.text =
      "Above a wheel that turns, below a board that moves to the right before a wall at rest, whose squares are a few "
      "pixels wide; enlarged. The pixels of one colour of a checkerboard are shaded in even frames, the others in "
      "odd ones. A pixel that is not shaded takes the colour that its surface had in the last frame, if that pixel "
      "showed the same object; otherwise the mean of the left and right or of the upper and lower neighbours, "
      "whichever "
      "differ less. History restores detail that no neighbour has, at the price of combs at edges that move. Error: "
      "root "
      "mean square difference of sRGB values from the image of which all pixels are shaded; white is 100 %.";
  return {.frames = {figure}, .tables = {table}};
}

}  // namespace
}  // namespace checkerboard_lesson

Demo demo_checkerboard() {
  return {"checkerboard", "half of the pixels in each frame, and where the other half comes from",
          checkerboard_lesson::make, checkerboard_lesson::params};
}

}  // namespace zoneplate::lessons
