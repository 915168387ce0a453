// SPDX-License-Identifier: Apache-2.0
// Geometry buffer antialiasing: each pixel stores the distance to the nearest edge of its triangle along its row or
// column. If that edge, or an edge stored by a neighbour, crosses the pixel, the pixel is blended with the neighbour's
// colour by the fraction beyond the edge.
//
// One shaded sample and two stored numbers per pixel. Exact for straight horizontal or vertical edges up to the
// rounding of 16-bit floats, within an eighth of a pixel for oblique ones, for any contrast. Weaknesses: small
// triangles, because a pixel stores only one edge; of objects thinner than a pixel, only one side is smoothed. Near an
// outline the nearest edge may be inside the surface, so that outlines of fine meshes are mottled; so are outlines near
// hidden or intersecting triangles (which `axial` handles correctly).
//
// Source: Persson, Geometry Buffer Anti-Aliasing, SIGGRAPH 2011 course, and his demo of July 2011 (humus.name),
// GBAA.shd: the neighbours' order, comparisons and the bilinear fetch are the demo's. Its fetch interpolates linear
// light, as here.
#include "zoneplate/antialias/geometric/gbaa.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/geometric/color_then_data.h"
#include "zoneplate/antialias/post/encoded.h"

namespace zoneplate::antialias {

float2 gbaa_offset(const Plane<float2>& distance, int x, int y) {
  constexpr float none = Frame::no_edge;
  const auto at = [&](int i, int j) {
    return distance(std::clamp(i, 0, distance.width() - 1), std::clamp(j, 0, distance.height() - 1));
  };
  float2 offset = distance(x, y);
  if (std::min(std::abs(offset.x), std::abs(offset.y)) < none) return offset;
  // A background pixel stores no distance to the edge in front of it; the pixel on the other side of the edge does.
  const float left = at(x - 1, y).x, right = at(x + 1, y).x, above = at(x, y - 1).y, below = at(x, y + 1).y;
  offset = {none, none};
  if (std::abs(left - 0.75f) < 0.25f) offset = {left - 1, none};
  if (std::abs(right + 0.75f) < 0.25f) offset = {right + 1, none};
  if (std::abs(above - 0.75f) < 0.25f) offset = {none, above - 1};
  if (std::abs(below + 0.75f) < 0.25f) offset = {none, below + 1};
  return offset;
}

namespace {

/// The neighbour with which a pixel is blended, and its weight.
struct Step {
  int towards;
  float share;
};

Step step_of(float offset) {
  if (std::abs(offset) >= Frame::no_edge) return {0, 0};
  return offset >= 0 ? Step{1, 0.5f - offset} : Step{-1, 0.5f + offset};
}

/// At most one axis has an edge. The outermost pixels are repeated beyond the image's sides.
Linear mixed_pixel(const LinearImage& color, const Plane<float2>& distance, int x, int y) {
  const float2 offset = gbaa_offset(distance, x, y);
  const Step across = step_of(offset.x), down = step_of(offset.y);
  const float share = across.share + down.share;
  if (share == 0) return color(x, y);
  const Linear& other =
      color(std::clamp(x + across.towards, 0, color.width() - 1), std::clamp(y + down.towards, 0, color.height() - 1));
  return color(x, y) * (1 - share) + other * share;
}

class Gbaa : public ColorThenData {
  Request data_request() const override {
    Request request;
    request.content = Content::EdgeDistances;
    return request;
  }
  LinearImage combined(const LinearImage& color, const Frame& data) const override {
    LinearImage out(color.width(), color.height());
    for_rows(out.height(), [&](int y) {
      for (int x = 0; x < out.width(); ++x) out(x, y) = mixed_pixel(color, data.edge_distance, x, y);
    });
    return out;
  }
};

}  // namespace

Method gbaa() {
  return {.name = "gbaa",
          .summary = "one shaded sample per pixel, and the stored distance to its triangle's nearest edge",
          .source = "Persson 2011",
          .make = [](const Settings&) -> std::unique_ptr<Resolver> { return std::make_unique<Gbaa>(); },
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
