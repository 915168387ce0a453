// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/lessons/diagram.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/image/transfer.h"
#include "zoneplate/lessons/picture.h"

namespace zoneplate::lessons {
namespace {

Linear light_of(Rgba8 c) {
  const float alpha = static_cast<float>(c.a) / 255;
  return {decode_srgb8(c.r) * alpha, decode_srgb8(c.g) * alpha, decode_srgb8(c.b) * alpha, alpha};
}

sdf::ShapePtr segment(sdf::Point a, sdf::Point b, double width) {
  const sdf::Point along = b - a;
  const double n = length(along);
  if (!(n > 0)) return sdf::moved(a, sdf::circle(width / 2));
  return sdf::mapped({.cosine = along.x / n, .sine = along.y / n, .move = (a + b) * 0.5}, sdf::rectangle(n, width));
}

}  // namespace

Diagram::Diagram(int width, int height, Rgba8 paper)
    : width_(width),
      height_(height),
      paper_(light_of(paper)),
      font_(std::make_shared<const Font>(dejavu_path("DejaVuSans.ttf"))) {}

void Diagram::fill(const sdf::ShapePtr& shape, Rgba8 color) { drawing_.fill(shape, light_of(color)); }
void Diagram::stroke(const sdf::ShapePtr& shape, double width, Rgba8 color) {
  fill(sdf::modified(sdf::Shape::Kind::Border, width, shape), color);
}
void Diagram::line(sdf::Point a, sdf::Point b, double width, Rgba8 color) { fill(segment(a, b, width), color); }

void Diagram::dashed(sdf::Point a, sdf::Point b, double width, Rgba8 color) {
  const double n = length(b - a), dash = 4 * width;
  if (!(n > 0)) return;
  const sdf::Point step = (b - a) * (1 / n);
  for (double t = 0; t < n; t += 2 * dash) line(a + step * t, a + step * std::min(t + dash, n), width, color);
}

void Diagram::arrow(sdf::Point a, sdf::Point b, double width, Rgba8 color) {
  const double n = length(b - a), head = std::min(5 * width, n);
  if (!(n > 0)) return;
  const sdf::Point along = (b - a) * (1 / n), across{-along.y, along.x}, neck = b - along * head;
  line(a, neck + along * (head / 4), width, color);
  const sdf::Point corners[] = {b, neck + across * (head * 0.4), neck - across * (head * 0.4)};
  polygon(corners, color);
}

void Diagram::polyline(std::span<const sdf::Point> points, double width, Rgba8 color) {
  std::vector<sdf::ShapePtr> parts;
  for (std::size_t i = 1; i < points.size(); ++i) parts.push_back(segment(points[i - 1], points[i], width));
  for (const sdf::Point& p : points) parts.push_back(sdf::moved(p, sdf::circle(width / 2)));
  if (!parts.empty()) fill(sdf::combined(sdf::Shape::Kind::Union, std::move(parts)), color);
}
void Diagram::polygon(std::span<const sdf::Point> points, Rgba8 color) {
  fill(sdf::region(sdf::polygon(points)), color);
}
void Diagram::dot(sdf::Point at, double radius, Rgba8 color) { fill(sdf::moved(at, sdf::circle(radius)), color); }
void Diagram::circle(sdf::Point at, double radius, double width, Rgba8 color) {
  stroke(sdf::moved(at, sdf::circle(radius)), width, color);
}

void Diagram::text(sdf::Point at, std::string_view words, double px, Rgba8 color, Align align) {
  constexpr double cap_height = 0.729;  // of DejaVu Sans, in em
  const double width = text_width(*font_, words, px);
  const double left = align == Align::Left ? 0 : align == Align::Centre ? width / 2 : width;
  const sdf::Outline outline = text_outline(*font_, words, px);
  if (outline.contours.empty()) return;
  fill(sdf::moved({at.x - left, at.y + cap_height * px / 2}, sdf::region(outline)), color);
}

Rgba8Image Diagram::take() const {
  constexpr int grid = 3;  // strokes of letters are little wider than a pixel
  return shown(sdf::draw(drawing_, {width_, height_, {}, 1}, paper_, grid));
}

}  // namespace zoneplate::lessons
