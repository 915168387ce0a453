// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/sdf/field/field_image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/sdf/boundary.h"
#include "zoneplate/sdf/draw.h"

namespace zoneplate::sdf {
namespace {

constexpr unsigned red = 1, green = 2, blue = 4, all_channels = 7;

float median(float a, float b, float c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); }

Point unit(Point p) {
  const double n = length(p);
  return n > 0 ? p * (1 / n) : Point{};
}

/// A turn of more than about 8° is a corner.
bool is_corner(Point before, Point after) {
  constexpr double sine = 0.1411;  // of 3 radians, the limit of msdfgen
  return dot(before, after) <= 0 || std::abs(cross(before, after)) > sine;
}

/// A segment with its channels.
struct Edge {
  Segment segment;
  unsigned channels;
  Bounds bounds;
};

/// A signed distance; of two equal ones the one whose edge meets the point at the greater angle is nearer.
struct EdgeDistance {
  double distance = 1e30;  ///< positive inside
  double alignment = 1;    ///< |cosine| of the angle between the offset and the tangent; 0 for a perpendicular
  const Edge* edge = nullptr;
  double t = 0;

  bool is_nearer_than(const EdgeDistance& other) const {
    const double a = std::abs(distance), b = std::abs(other.distance);
    constexpr double tie = 1e-9;
    return a < b - tie || (a <= b + tie && alignment < other.alignment);
  }
};

EdgeDistance distance_to(const Edge& edge, Point p) {
  const Segment& s = edge.segment;
  EdgeDistance out{.edge = &edge, .t = nearest_parameter(s, p)};
  const Point offset = p - s.at(out.t);
  const Point tangent = unit(out.t <= 0   ? s.direction_at_start()
                             : out.t >= 1 ? s.direction_at_end()
                                          : s.velocity(out.t));
  out.distance = std::copysign(length(offset), cross(tangent, offset));
  out.alignment = out.t > 0 && out.t < 1 ? 0 : std::abs(dot(tangent, unit(offset)));
  return out;
}

/// The distance to an edge that is extended along its tangents.
double pseudo_distance(const EdgeDistance& d, Point p) {
  const Segment& s = d.edge->segment;
  if (d.t > 0 && d.t < 1) return d.distance;
  const Point tangent = unit(d.t <= 0 ? s.direction_at_start() : s.direction_at_end());
  const Point offset = p - (d.t <= 0 ? s.first() : s.last());
  const double along = dot(offset, tangent), across = cross(tangent, offset);
  const bool is_beyond = d.t <= 0 ? along < 0 : along > 0;
  return is_beyond && std::abs(across) <= std::abs(d.distance) ? across : d.distance;
}

double distance_to(const Bounds& b, Point p) {
  return length(Point{std::max({b.low.x - p.x, p.x - b.high.x, 0.0}), std::max({b.low.y - p.y, p.y - b.high.y, 0.0})});
}

float3 multi_distance(const std::vector<Edge>& edges, Point p, double sign) {
  std::array<EdgeDistance, 3> nearest;
  for (const Edge& edge : edges) {
    double reach = 0;
    for (unsigned c = 0; c < 3; ++c)
      if (edge.channels >> c & 1) reach = std::max(reach, std::abs(nearest[c].distance));
    if (distance_to(edge.bounds, p) > reach + 1e-6) continue;
    const EdgeDistance d = distance_to(edge, p);
    for (unsigned c = 0; c < 3; ++c)
      if ((edge.channels >> c & 1) && d.is_nearer_than(nearest[c])) nearest[c] = d;
  }
  const auto of = [&](const EdgeDistance& d) {
    return static_cast<float>(d.edge == nullptr ? -1e6 : sign * pseudo_distance(d, p));
  };
  return {of(nearest[0]), of(nearest[1]), of(nearest[2])};
}

/// Replaces the channels of texels by their median where the interpolated median has the wrong sign: the nearest texel
/// that still has different channels, until no sign is wrong.
void correct(FieldImage& field, const ShapePtr& shape) {
  constexpr int steps = 8;            // positions per texel along each axis
  constexpr float negligible = 0.3f;  // of a texel: closer to the boundary, the sign is a matter of rounding
  constexpr int rounds = 8;
  const int w = field.distances.width(), h = field.distances.height();
  const double first = 0.5 - 0.5 / steps;  // so that position 0 is the centre of texel 0
  const DistanceField fine = distance_field(shape, {steps * (w - 1) + 1, steps * (h - 1) + 1, {first, first}, steps});
  for (int round = 0; round < rounds; ++round) {
    Plane<std::uint8_t> is_wrong(w, h);
    bool is_done = true;
    for (int y = 0; y < fine.distance.height(); ++y)
      for (int x = 0; x < fine.distance.width(); ++x) {
        const float distance = -fine.distance(x, y);
        const double u = 0.5 + static_cast<double>(x) / steps, v = 0.5 + static_cast<double>(y) / steps;
        if (std::abs(distance) <= negligible || (field.at(u, v) > 0) == (distance > 0)) continue;
        // The four texels around the position, the nearest first.
        const int i = (x + steps / 2) / steps, j = (y + steps / 2) / steps;
        const int di = i * steps < x ? 1 : i > 0 ? -1 : 0, dj = j * steps < y ? 1 : j > 0 ? -1 : 0;
        for (const auto& [column, row] : {std::pair{i, j}, {i + di, j}, {i, j + dj}, {i + di, j + dj}}) {
          const float4& c = field.distances(std::min(column, w - 1), std::min(row, h - 1));
          if (c.x == c.y && c.y == c.z) continue;
          is_wrong(std::min(column, w - 1), std::min(row, h - 1)) = 1;
          is_done = false;
          break;
        }
      }
    if (is_done) return;
    for (std::size_t i = 0; i < is_wrong.values().size(); ++i) {
      float4& c = field.distances.values()[i];
      if (is_wrong.values()[i] != 0) c.x = c.y = c.z = median(c.x, c.y, c.z);
    }
  }
}

}  // namespace

double half_plane_area(double x, double y, double d) {
  const double norm = std::sqrt(x * x + y * y);
  if (!(norm > 0)) return std::clamp(d + 0.5, 0.0, 1.0);
  const double nx = std::abs(x) / norm, ny = std::abs(y) / norm;
  const double wide = std::max(nx, ny), narrow = std::min(nx, ny), depth = std::abs(d);
  const double rest = std::max((wide + narrow) / 2 - depth, 0.0);
  const double larger =
      depth <= (wide - narrow) / 2 ? 0.5 + depth / wide : 1 - rest * rest / std::max(2 * wide * narrow, 1e-30);
  return d < 0 ? 1 - larger : larger;
}

std::vector<unsigned> color_edges(Contour& contour) {
  std::vector<std::size_t> corners;  // segments that start at one
  for (std::size_t i = 0; i < contour.size(); ++i)
    if (is_corner(unit(contour[(i + contour.size() - 1) % contour.size()].direction_at_end()),
                  unit(contour[i].direction_at_start())))
      corners.push_back(i);
  if (corners.empty()) return std::vector<unsigned>(contour.size(), all_channels);
  std::rotate(contour.begin(), contour.begin() + static_cast<std::ptrdiff_t>(corners[0]), contour.end());

  if (corners.size() == 1) {
    while (contour.size() < 3) {
      Contour halves;
      for (const Segment& s : contour) halves.push_back(s.part(0, 0.5)), halves.push_back(s.part(0.5, 1));
      contour = std::move(halves);
    }
    std::vector<unsigned> out;
    constexpr unsigned thirds[] = {red | blue, all_channels, red | green};
    for (std::size_t i = 0; i < contour.size(); ++i) out.push_back(thirds[3 * i / contour.size()]);
    return out;
  }
  constexpr unsigned cycle[] = {green | blue, red | blue, red | green};
  std::vector<unsigned> out;
  std::size_t part = 0;
  for (std::size_t i = 0; i < contour.size(); ++i) {
    if (part + 1 < corners.size() && corners[part + 1] - corners[0] == i) ++part;
    const bool is_last = part + 1 == corners.size() && corners.size() % 3 == 1;
    out.push_back(cycle[is_last ? 1 : part % 3]);
  }
  return out;
}

float FieldImage::at(double x, double y) const {
  const double u = std::clamp(x - 0.5, 0.0, distances.width() - 1.0);
  const double v = std::clamp(y - 0.5, 0.0, distances.height() - 1.0);
  const int i = std::min(static_cast<int>(u), std::max(0, distances.width() - 2));
  const int j = std::min(static_cast<int>(v), std::max(0, distances.height() - 2));
  const auto s = static_cast<float>(u - i), t = static_cast<float>(v - j);
  const int right = std::min(i + 1, distances.width() - 1), below = std::min(j + 1, distances.height() - 1);
  const float4 top = distances(i, j) * (1 - s) + distances(right, j) * s;
  const float4 bottom = distances(i, below) * (1 - s) + distances(right, below) * s;
  const float4 c = top * (1 - t) + bottom * t;
  return median(c.x, c.y, c.z);
}

void FieldImage::add_coverage(Plane<float>& image, Point corner, double scale) const {
  add_part(image, corner, scale,
           {{0, 0}, {static_cast<double>(distances.width()), static_cast<double>(distances.height())}});
}

void FieldImage::add_part(Plane<float>& image, Point corner, double scale, const Bounds& part) const {
  const auto pixel = [](double v, int most) {
    return static_cast<int>(std::clamp(std::ceil(v - 0.5), 0.0, static_cast<double>(most)));
  };
  const Point end = corner + (part.high - part.low) * scale;
  const int x0 = pixel(corner.x, image.width()), y0 = pixel(corner.y, image.height());
  const int x1 = pixel(end.x, image.width()), y1 = pixel(end.y, image.height());
  const double half = 0.5 / scale;
  parallel_for(static_cast<std::size_t>(std::max(0, y1 - y0)), [&](std::size_t row) {
    const int y = y0 + static_cast<int>(row);
    const auto value = [&](double u, double v) {
      return static_cast<double>(at(std::clamp(u, part.low.x, part.high.x), std::clamp(v, part.low.y, part.high.y)));
    };
    for (int x = x0; x < x1; ++x) {
      const double u = part.low.x + (x + 0.5 - corner.x) / scale, v = part.low.y + (y + 0.5 - corner.y) / scale;
      const double d = value(u, v) * scale;
      constexpr double farthest = 2;  // pixels, beyond which no slope matters
      double area = d > 0 ? 1 : 0;
      if (std::abs(d) < farthest)
        area = half_plane_area(value(u + half, v) - value(u - half, v), value(u, v + half) - value(u, v - half), d);
      image(x, y) = static_cast<float>(std::min(1.0, static_cast<double>(image(x, y)) + area));
    }
  });
}

FieldImage outline_field(const Outline& outline, FieldKind kind, int width, int height, double scale, Point move,
                         double range) {
  FieldImage field{kind, Plane<float4>(width, height)};
  const auto reach = static_cast<float>(range / 2);
  Outline texels = boundary_of(outline).mapped({.scale = scale, .move = move});
  const ShapePtr shape = region(texels);
  const DistanceField single = distance_field(shape, {width, height, {}, 1});
  for (std::size_t i = 0; i < field.distances.values().size(); ++i) {
    const float d = std::clamp(-single.distance.values()[i], -reach, reach);
    field.distances.values()[i] = {d, d, d, d};
  }
  if (kind == FieldKind::Single) return field;

  std::vector<Edge> edges;
  for (Contour& contour : texels.contours) {
    const std::vector<unsigned> channels = color_edges(contour);
    for (std::size_t i = 0; i < contour.size(); ++i) edges.push_back({contour[i], channels[i], contour[i].bounds()});
  }
  const double sign = signed_area(texels) < 0 ? -1 : 1;
  constexpr float negligible = 0.05f;  // of a texel: closer to the boundary, the sign is a matter of rounding
  parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const float3 d = multi_distance(edges, {x + 0.5, y + 0.5}, sign);
      float4& out = field.distances(x, y);
      // Where several corners meet or are near, the median may have the wrong sign.
      if (std::abs(out.w) > negligible && (median(d.x, d.y, d.z) > 0) != (out.w > 0)) continue;
      out = {std::clamp(d.x, -reach, reach), std::clamp(d.y, -reach, reach), std::clamp(d.z, -reach, reach), out.w};
    }
  });
  correct(field, shape);
  return field;
}

}  // namespace zoneplate::sdf
