// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/scene/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "zoneplate/math/angle.h"

namespace zoneplate {
namespace {

// The fit is computed in double, so that boxes of any size representable in float use the same formulas.
struct Point {
  double x = 0, y = 0, z = 0;
};

Point to_point(float3 p) { return {p.x, p.y, p.z}; }
Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point operator*(Point a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point cross(Point a, Point b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Point normalize(Point a) {
  const double n = std::sqrt(dot(a, a));
  return {a.x / n, a.y / n, a.z / n};
}
float3 to_float3(Point p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

/// The camera's axes: +X to the right, +Y up, +Z towards the eye.
struct Axes {
  Point right, above, back;
};

Axes view_axes(const AutoFit& fit) {
  // The front of a model is +Z; if +Z is up, the front is -Y (if -Z is up, +Y), as if the model had been rotated
  // upright.
  Point up = to_point(fit.up);
  up = dot(up, up) > 0 ? normalize(up) : Point{0, 1, 0};
  const Point towards = std::abs(up.z) > 0.999 ? Point{0, up.z > 0 ? -1.0 : 1.0, 0} : Point{0, 0, 1};
  const Point front = normalize(towards - up * dot(towards, up));
  const Point side = cross(up, front);

  const SineCosine a = sine_cosine(static_cast<double>(fit.azimuth));
  const SineCosine e = sine_cosine(static_cast<double>(fit.elevation));
  const Point back = (front * a.cosine + side * a.sine) * e.cosine + up * e.sine;
  const Point right = side * a.cosine - front * a.sine;
  return {right, cross(back, right), back};
}

/// The coordinates of points along the camera's axes, relative to the centre of their box.
struct Places {
  std::vector<double> x, y, z;
};

/// The coordinate of the eye for which the slopes (v - e) / (distance - z) have equal maxima on both sides.
///
/// The sum of the greatest and the least slope is strictly decreasing in e; it is solved by bisection to the last
/// significant bit.
double centred(std::span<const double> v, std::span<const double> z, double distance) {
  const auto lopsided = [&](double e) {
    double low = (v[0] - e) / (distance - z[0]), high = low;
    for (std::size_t i = 1; i < v.size(); ++i) {
      const double slope = (v[i] - e) / (distance - z[i]);
      low = std::min(low, slope), high = std::max(high, slope);
    }
    return low + high;
  };
  double left = *std::min_element(v.begin(), v.end()), right = *std::max_element(v.begin(), v.end());
  for (int step = 0; step < 100; ++step) {
    const double middle = (left + right) / 2;
    (lopsided(middle) > 0 ? left : right) = middle;
  }
  return (left + right) / 2;
}

/// The least distance at which the slopes of all points can be within ±`slope` of the axis.
double distance_for(std::span<const double> v, std::span<const double> z, double slope) {
  double right = v[0] + slope * z[0], left = -v[0] + slope * z[0];
  for (std::size_t i = 1; i < v.size(); ++i) {
    right = std::max(right, v[i] + slope * z[i]);
    left = std::max(left, -v[i] + slope * z[i]);
  }
  return (right + left) / (2 * slope);
}

/// Moves the camera to `eye`, which is relative to `origin` and along the camera's own axes.
void place(Camera& camera, const Axes& axes, Point origin, Point eye) {
  const Point at = origin + axes.right * eye.x + axes.above * eye.y + axes.back * eye.z;
  const float3 r = to_float3(axes.right), a = to_float3(axes.above), b = to_float3(axes.back), t = to_float3(at);
  camera.world_from_camera = {
      {float4{r.x, r.y, r.z, 0}, float4{a.x, a.y, a.z, 0}, float4{b.x, b.y, b.z, 0}, float4{t.x, t.y, t.z, 1}}};
}

/// The projection of a lens without its distortion: in an image of another aspect the calibrated one is centred, and
/// touches two of its sides.
float4x4 through_lens(const Lens& lens, float picture_aspect, float near, float far) {
  const double wider = static_cast<double>(picture_aspect) * lens.height / lens.width;
  const double x = wider > 1 ? 1 / wider : 1, y = wider < 1 ? wider : 1;
  float4x4 m = perspective(1, 1, near, far);
  m.column[0].x = static_cast<float>(x * 2 * lens.fx / lens.width);
  m.column[1].y = static_cast<float>(y * 2 * lens.fy / lens.height);
  m.column[2].x = static_cast<float>(x * (1 - 2 * (lens.cx + 0.5) / lens.width));
  m.column[2].y = static_cast<float>(y * (2 * (lens.cy + 0.5) / lens.height - 1));
  return m;
}

}  // namespace

float4x4 Camera::clip_from_camera(float picture_aspect) const {
  // The image contains the file's own frame: a wider image adds pixels at the sides, a narrower one above and below.
  const bool narrower = aspect > 0 && picture_aspect < aspect;
  if (is_orthographic) {
    const float height = narrower ? half_height * aspect / picture_aspect : half_height;
    return orthographic(height * picture_aspect, height, near, far);
  }
  if (lens) return through_lens(*lens, picture_aspect, near, far);
  float4x4 m = perspective(vertical_fov, narrower ? aspect : picture_aspect, near, far);
  if (narrower) m.column[1].y = m.column[0].x * picture_aspect;
  return m;
}

Camera fit_camera(std::span<const float3> points, float picture_aspect, const AutoFit& fit) {
  Camera camera;
  camera.name = "fit";
  camera.is_orthographic = fit.is_orthographic;
  camera.vertical_fov = fit.vertical_fov;
  const Axes axes = view_axes(fit);
  Box box;
  for (const float3 point : points) box.add(point);
  const Point low = to_point(box.low), high = to_point(box.high);
  const Point origin = box.empty() ? Point{} : (low + high) * 0.5;
  const double diagonal = box.empty() ? 0 : std::sqrt(dot(high - low, high - low));
  if (!(diagonal > 0)) {
    place(camera, axes, origin, {0, 0, 1});
    camera.near = 0.5f, camera.far = 2;
    return camera;
  }

  Places at;
  for (const float3 point : points) {
    const Point p = to_point(point) - origin;
    at.x.push_back(dot(p, axes.right)), at.y.push_back(dot(p, axes.above)), at.z.push_back(dot(p, axes.back));
  }
  const auto [farthest, nearest] = std::minmax_element(at.z.begin(), at.z.end());
  const double share = 1 - 2 * static_cast<double>(fit.margin);
  const double aspect = picture_aspect;

  // Points without extent across the view (a line parallel to the view axis) would give a distance or height of 0: the
  // minimum is a thousandth of their size.
  const double least = diagonal / 1000;
  Point eye;
  if (fit.is_orthographic) {
    const auto [left, right] = std::minmax_element(at.x.begin(), at.x.end());
    const auto [bottom, top] = std::minmax_element(at.y.begin(), at.y.end());
    camera.half_height =
        static_cast<float>(std::max({(*top - *bottom) / 2, (*right - *left) / 2 / aspect, least}) / share);
    eye = {(*left + *right) / 2, (*bottom + *top) / 2, *nearest + diagonal};
  } else {
    const SineCosine half_fov = sine_cosine(static_cast<double>(fit.vertical_fov) / 2);
    const double slope = half_fov.sine / half_fov.cosine * share;
    eye.z = std::max({distance_for(at.x, at.z, slope * aspect), distance_for(at.y, at.z, slope), *nearest + least});
    eye.x = centred(at.x, at.z, eye.z);
    eye.y = centred(at.y, at.z, eye.z);
  }
  place(camera, axes, origin, eye);
  camera.near = static_cast<float>((eye.z - *nearest) / 2);
  camera.far = static_cast<float>((eye.z - *farthest) * 1.5);
  return camera;
}

Camera fit_camera(const Box& box, float picture_aspect, const AutoFit& fit) {
  std::array<float3, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) corners[i] = box.corner(static_cast<int>(i));
  return fit_camera(std::span<const float3>(corners.data(), box.empty() ? 0 : 8), picture_aspect, fit);
}

}  // namespace zoneplate
