// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "zoneplate/formats/font/font.h"
#include "zoneplate/image/rgb.h"
#include "zoneplate/sdf/draw.h"

namespace zoneplate::lessons {

/// A drawing of lines, areas and labels, antialiased from distances, for the figures of lessons.
///
/// Units     pixels of the image; line widths and text sizes too.
class Diagram {
 public:
  enum class Align { Left, Centre, Right };

  Diagram(int width, int height, Rgba8 paper = {255, 255, 255, 255});

  void fill(const sdf::ShapePtr& shape, Rgba8 color);
  void stroke(const sdf::ShapePtr& shape, double width, Rgba8 color);
  void line(sdf::Point a, sdf::Point b, double width, Rgba8 color);
  void dashed(sdf::Point a, sdf::Point b, double width, Rgba8 color);
  /// A line with a filled head at b.
  void arrow(sdf::Point a, sdf::Point b, double width, Rgba8 color);
  void polyline(std::span<const sdf::Point> points, double width, Rgba8 color);
  void polygon(std::span<const sdf::Point> points, Rgba8 color);
  void dot(sdf::Point at, double radius, Rgba8 color);
  void circle(sdf::Point at, double radius, double width, Rgba8 color);
  /// A line of text whose capitals are centred on the height of `at`.
  void text(sdf::Point at, std::string_view words, double px, Rgba8 color, Align align = Align::Centre);

  Rgba8Image take() const;

 private:
  int width_, height_;
  Linear paper_;
  sdf::Drawing drawing_;
  std::shared_ptr<const Font> font_;
};

/// Colours of lessons: Okabe's and Ito's for colour-blind readers, ink and greys.
namespace hue {
inline constexpr Rgba8 ink{32, 32, 32, 255}, grey{120, 120, 120, 255}, light{205, 205, 205, 255},
    white{255, 255, 255, 255};
inline constexpr Rgba8 blue{0, 114, 178, 255}, vermilion{213, 94, 0, 255}, green{0, 158, 115, 255},
    orange{230, 159, 0, 255}, purple{204, 121, 167, 255}, sky{86, 180, 233, 255};
}  // namespace hue

/// The colour with this opacity.
constexpr Rgba8 faded(Rgba8 c, int alpha) { return {c.r, c.g, c.b, static_cast<std::uint8_t>(alpha)}; }

}  // namespace zoneplate::lessons
