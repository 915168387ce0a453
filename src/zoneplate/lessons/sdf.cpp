// SPDX-License-Identifier: Apache-2.0
// Signed distance fields: shapes from distances, and text from fields of one and of three channels.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/image/transfer.h"
#include "zoneplate/imaging/sdf/atlas_file.h"
#include "zoneplate/imaging/sdf/show_field.h"
#include "zoneplate/imaging/sdf/text_error.h"
#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/diagram.h"
#include "zoneplate/lessons/picture.h"

namespace zoneplate::lessons {
namespace sdf_lesson {
namespace {

using sdf::Point;
using sdf::Shape;

constexpr Param params[] = {
    {.name = "soft", .meaning = "reach of the soft union of the cloud", .value = 26, .low = 0, .high = 80},
    {.name = "texels", .meaning = "per em of the fields of letters", .value = 32, .low = 12, .high = 64},
};
constexpr int plot_width = 480;  // for which the letters of the plot are designed

/// A ring, a star and a soft union, in 360 × 270 units.
sdf::ShapePtr emblem(double soft) {
  std::vector<Point> star;
  for (const Point p :
       {Point{0, -60}, {16, -20}, {58, -19}, {25, 7}, {36, 48}, {0, 24}, {-36, 48}, {-25, 7}, {-58, -19}, {-16, -20}})
    star.push_back(p);
  const sdf::ShapePtr badge = sdf::moved(
      {125, 130},
      combined(Shape::Kind::Union, {modified(Shape::Kind::Border, 12, sdf::circle(84)), region(sdf::polygon(star))}));
  const sdf::ShapePtr cloud =
      combined(Shape::Kind::SmoothUnion,
               {sdf::moved({240, 178}, sdf::circle(38)), sdf::moved({292, 165}, sdf::ellipse(46, 30)),
                sdf::moved({276, 202}, rotated(-12, sdf::rectangle(120, 26)))},
               soft);
  return combined(Shape::Kind::Union, {badge, cloud});
}

/// The middle part of an image, or the image on white if it is smaller.
Rgba8Image fitted_to(const Rgba8Image& image, int width, int height) {
  Rgba8Image out(width, height, Rgba8{255, 255, 255, 255});
  const int dx = (image.width() - width) / 2, dy = (image.height() - height) / 2;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (x + dx >= 0 && y + dy >= 0 && x + dx < image.width() && y + dy < image.height())
        out(x, y) = image(x + dx, y + dy);
  return out;
}

/// The errors of text from a field, by the size at which it is drawn.
Plot error_plot(const Font& font, const std::string& words, const sdf::Atlas& single, const sdf::Atlas& multi,
                double texels) {
  Plot plot{.title = number(texels, 0) + " texels per em",
            .x = {"pixels per em", 16, 256, true},
            .y = {"error along edges (%)", 0, 0},
            .curves = {{.name = "one channel", .points = {}, .mark = Curve::Mark::LineAndPoints},
                       {.name = "three channels", .points = {}, .mark = Curve::Mark::LineAndPoints}}};
  for (const int px : {16, 24, 32, 48, 64, 96, 128, 192, 256}) {
    const TextLine line(font, words, px);
    const Plane<float> exact = line.exact();
    plot.curves[0].points.emplace_back(px, 100 * error_of(line.from_atlas(single), exact).rms);
    plot.curves[1].points.emplace_back(px, 100 * error_of(line.from_atlas(multi), exact).rms);
  }
  return plot;
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel, height = side * 3 / 4, line_height = side / 2;
  const double scale = side / 360.0;
  const sdf::Raster raster{side, height, {0, 0}, scale};
  const sdf::ShapePtr shape = emblem(settings.number("soft"));
  Figure figure{.title = "Signed distance fields: shapes are drawn, grown and joined by one number per point",
                .rows = {{}, {}}};

  const Plane<float> coverage = sdf::coverage_of(shape, raster);
  const CoverageError error = error_of(coverage, sdf::coverage_of(shape, raster, 16));
  figure.rows[0].push_back(
      {black_on_white(coverage),
       fmt::format("Drawn from the distance\nThe coverage of a pixel is the area of the half-plane "
                   "of its distance and gradient. Error along edges: {}\u00a0%.",
                   number(100 * error.rms, 2))});
  figure.rows[0].push_back(
      {show_field(distance_field(shape, raster), FieldView::Field, 10, scale),
       "The field\nBlue inside, orange outside, lines 10 units apart. The minimum of two distances is "
       "a union, the maximum an intersection."});
  const auto grown = [&](double by) { return modified(Shape::Kind::Offset, by, shape); };
  figure.rows[0].push_back(
      {black_on_white(sdf::coverage_of(combined(Shape::Kind::Difference, {grown(14), grown(6)}), raster)),
       "An outline\nThe points at distances from 6 to 14. Outer corners become arcs."});

  const Font font(dejavu_path("DejaVuSans.ttf"));
  const std::string words = "kR4";
  const double texels = settings.number("texels");
  const auto atlas_with = [&](sdf::FieldKind kind) {
    return atlas_of(font, code_points(words), {.kind = kind, .size = texels, .range = 4});
  };
  const sdf::Atlas single = atlas_with(sdf::FieldKind::Single), multi = atlas_with(sdf::FieldKind::Multi);
  figure.rows[0].push_back(plot_panel(
      error_plot(font, words, single, multi, texels), side, height,
      "Errors by size\nRoot mean square difference from exact coverage, for these three letters.", plot_width));

  const TextLine line(font, words, side / 2.4);
  const Plane<float> exact = line.exact();
  const auto add = [&](const Plane<float>& drawn, std::string caption) {
    figure.rows[1].push_back({fitted_to(black_on_white(drawn), side, line_height), std::move(caption)});
  };
  add(exact, fmt::format("Exact coverage\nThe area of the glyphs' outlines in each pixel, {} pixels per em.",
                         number(line.em, 0)));
  const Plane<float> one = line.from_atlas(single), three = line.from_atlas(multi);
  add(one,
      fmt::format("One channel\n{} texels per em: interpolation rounds every corner. Error along edges: {}\u00a0%.",
                  number(texels, 0), number(100 * error_of(one, exact).rms, 1)));
  add(three, fmt::format("Three channels\nThe two edges at a corner are in different channels, whose median keeps it. "
                         "Error: {}\u00a0%.",
                         number(100 * error_of(three, exact).rms, 1)));
  const Rgba8Image texture = atlas_image(multi);
  const int factor = std::max(1, std::min(side / texture.width(), line_height / texture.height()));
  figure.rows[1].push_back(
      {fitted_to(enlarged(texture, factor), side, line_height),
       fmt::format("The texture\n{} × {} texels of 8 bits; a range of 4 texels around the outline.", texture.width(),
                   texture.height())});
  figure.text =
      "A distance changes by one per unit of length, so that it says how far a pixel is from an edge; the area of a "
      "half-plane in a pixel is exact where the edge is straight. Games store distances of glyphs in small textures "
      "and "
      "draw them at any size (zoneplate sdf text, sdf atlas).";
  return {.frames = {figure}};
}

}  // namespace
}  // namespace sdf_lesson

Demo demo_sdf() {
  return {"sdf", "shapes and text from signed distances of one and three channels", sdf_lesson::make,
          sdf_lesson::params};
}

}  // namespace zoneplate::lessons
