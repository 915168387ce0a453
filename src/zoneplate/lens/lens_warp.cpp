// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/lens/lens_warp.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate {
namespace {

/// The lens at a direction: where it shows it, and the derivative of that.
struct Distortion {
  LensPoint at;
  double xx, xy, yx, yy;
  double determinant() const { return xx * yy - xy * yx; }
};

Distortion distortion(const Lens& l, LensPoint p) {
  const double x = p.x, y = p.y, r2 = x * x + y * y;
  const double above = 1 + r2 * (l.k1 + r2 * (l.k2 + r2 * l.k3)), below = 1 + r2 * (l.k4 + r2 * (l.k5 + r2 * l.k6));
  const double radial = above / below;
  // The derivative by r².
  const double slope =
      ((l.k1 + r2 * (2 * l.k2 + r2 * 3 * l.k3)) - radial * (l.k4 + r2 * (2 * l.k5 + r2 * 3 * l.k6))) / below;
  Distortion out;
  out.at = {x * radial + 2 * l.p1 * x * y + l.p2 * (r2 + 2 * x * x),
            y * radial + l.p1 * (r2 + 2 * y * y) + 2 * l.p2 * x * y};
  out.xx = radial + 2 * x * x * slope + 2 * l.p1 * y + 6 * l.p2 * x;
  out.xy = 2 * x * y * slope + 2 * l.p1 * x + 2 * l.p2 * y;
  out.yx = out.xy;
  out.yy = radial + 2 * y * y * slope + 6 * l.p1 * y + 2 * l.p2 * x;
  return out;
}

constexpr int max_frame_side = 32768;
constexpr double frame_pixels_per_pixel = 2;

}  // namespace

LensPoint distorted(const Lens& lens, LensPoint undistorted) { return distortion(lens, undistorted).at; }

std::optional<LensPoint> undistorted(const Lens& lens, LensPoint wanted) {
  constexpr int max_steps = 100;
  const auto error_of = [&](const Distortion& d) {
    return std::max(std::abs(d.at.x - wanted.x), std::abs(d.at.y - wanted.y));
  };
  const double tolerance = 1e-14 * (1 + std::max(std::abs(wanted.x), std::abs(wanted.y)));
  LensPoint p = wanted;
  Distortion d = distortion(lens, p);
  for (int step = 0; step < max_steps && error_of(d) > tolerance; ++step) {
    const double determinant = d.determinant();
    if (!(determinant > 0)) return std::nullopt;
    const double ex = wanted.x - d.at.x, ey = wanted.y - d.at.y;
    const double dx = (d.yy * ex - d.xy * ey) / determinant, dy = (d.xx * ey - d.yx * ex) / determinant;
    // A step that leads farther away is halved.
    double part = 1;
    LensPoint next{p.x + dx, p.y + dy};
    Distortion there = distortion(lens, next);
    while (part > 1e-3 && !(error_of(there) < error_of(d) && there.determinant() > 0)) {
      part /= 2;
      next = {p.x + dx * part, p.y + dy * part};
      there = distortion(lens, next);
    }
    if (!(error_of(there) < error_of(d))) break;  // rounding
    p = next, d = there;
  }
  if (!(error_of(d) <= 1e-10 * (1 + std::max(std::abs(wanted.x), std::abs(wanted.y)))) || !(d.determinant() > 0))
    return std::nullopt;
  return p;
}

Lens scaled_to(const Lens& lens, int width, int height) {
  const double scale = std::min(1.0 * width / lens.width, 1.0 * height / lens.height);
  Lens out = lens;
  out.width = width, out.height = height;
  out.fx *= scale, out.fy *= scale;
  out.cx = (lens.cx + 0.5) * scale + (width - lens.width * scale) / 2 - 0.5;
  out.cy = (lens.cy + 0.5) * scale + (height - lens.height * scale) / 2 - 0.5;
  return out;
}

/// The direction at a position of the image, in pixels from its corner.
LensPoint LensWarp::in_image(double x, double y) const {
  const std::optional<LensPoint> found =
      undistorted(lens_, {(x - 0.5 - lens_.cx) / lens_.fx, (y - 0.5 - lens_.cy) / lens_.fy});
  if (!found)
    throw Error(ErrorKind::Usage,
                fmt::format("the lens's distortion has no inverse at pixel ({:.0f}, {:.0f}) of the image of {} × {}",
                            std::floor(x), std::floor(y), lens_.width, lens_.height));
  return *found;
}

LensWarp::Footprint LensWarp::footprint(double x, double y) const {
  const LensPoint p = in_image(x, y);
  const Distortion d = distortion(lens_, p);
  const double determinant = d.determinant();
  // From pixels of the image to directions, and to pixels of the frame.
  const double xx = d.yy / determinant / lens_.fx, xy = -d.xy / determinant / lens_.fy;
  const double yx = -d.yx / determinant / lens_.fx, yy = d.xx / determinant / lens_.fy;
  const auto single = [](double v) { return static_cast<float>(v); };
  return {single(frame_.fx * p.x + frame_.cx + 0.5),
          single(frame_.fy * p.y + frame_.cy + 0.5),
          single(frame_.fx * xx),
          single(frame_.fx * xy),
          single(frame_.fy * yx),
          single(frame_.fy * yy)};
}

LensWarp::LensWarp(const Lens& lens, int width, int height, int x, int y, int part_width, int part_height)
    : lens_(scaled_to(lens, width, height)), width_(part_width), height_(part_height) {
  // The frame's scale and bounds come from a grid over the whole image, which has its corners and sides.
  constexpr int cells = 64;
  double left = std::numeric_limits<double>::infinity(), right = -left, top = left, bottom = -left, magnified = 0;
  frame_ = lens_;
  double reach = 0;  // of a footprint, in pixels of a frame of scale 1
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double px = 1.0 * width * i / cells, py = 1.0 * height * j / cells;
      const LensPoint p = in_image(px, py);
      left = std::min(left, p.x), right = std::max(right, p.x), top = std::min(top, p.y),
      bottom = std::max(bottom, p.y);
      const Footprint f = footprint(px, py);
      reach = std::max({reach, 1.0 * std::abs(f.xx) + std::abs(f.xy), 1.0 * std::abs(f.yx) + std::abs(f.yy)});
      // The least singular value of the derivative.
      const double sum = 1.0 * f.xx * f.xx + 1.0 * f.xy * f.xy + 1.0 * f.yx * f.yx + 1.0 * f.yy * f.yy;
      const double determinant = 1.0 * f.xx * f.yy - 1.0 * f.xy * f.yx;
      const double least =
          std::sqrt(std::max(0.0, sum / 2 - std::sqrt(std::max(0.0, sum * sum / 4 - determinant * determinant))));
      magnified = std::max(magnified, 1 / least);
    }
  scale_ = frame_pixels_per_pixel * magnified;
  const double margin = std::ceil(reach * scale_ * 1.1) + 4;  // sides curve between the points of the grid
  frame_.fx = lens_.fx * scale_, frame_.fy = lens_.fy * scale_;
  const double columns = std::ceil((right - left) * frame_.fx) + 2 * margin;
  const double rows = std::ceil((bottom - top) * frame_.fy) + 2 * margin;
  if (!(columns <= max_frame_side && rows <= max_frame_side))
    throw Error(ErrorKind::Usage,
                fmt::format("the lens needs a frame of {:.0f} × {:.0f} pixels without distortion, which is more than "
                            "{} a side",
                            columns, rows, max_frame_side));
  frame_ = {.width = static_cast<int>(columns),
            .height = static_cast<int>(rows),
            .fx = frame_.fx,
            .fy = frame_.fy,
            .cx = margin - left * frame_.fx - 0.5,
            .cy = margin - top * frame_.fy - 0.5};

  footprints_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  parallel_for(static_cast<std::size_t>(height_), [&](std::size_t j) {
    for (int i = 0; i < width_; ++i)
      footprints_[j * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i)] =
          footprint(x + i + 0.5, y + static_cast<double>(j) + 0.5);
  });
  float first_x = std::numeric_limits<float>::infinity(), last_x = -first_x, first_y = first_x, last_y = -first_x;
  for (const Footprint& f : footprints_) {
    const float across = std::abs(f.xx) + std::abs(f.xy), down = std::abs(f.yx) + std::abs(f.yy);
    first_x = std::min(first_x, f.x - across), last_x = std::max(last_x, f.x + across);
    first_y = std::min(first_y, f.y - down), last_y = std::max(last_y, f.y + down);
  }
  part_.x = std::max(0, static_cast<int>(std::floor(first_x)) - 1);
  part_.y = std::max(0, static_cast<int>(std::floor(first_y)) - 1);
  part_.width = std::min(frame_.width, static_cast<int>(std::ceil(last_x)) + 1) - part_.x;
  part_.height = std::min(frame_.height, static_cast<int>(std::ceil(last_y)) + 1) - part_.y;
}

int LensWarp::column(int x, int y) const {
  return std::clamp(static_cast<int>(std::floor(at(x, y).x)) - part_.x, 0, part_.width - 1);
}
int LensWarp::row(int x, int y) const {
  return std::clamp(static_cast<int>(std::floor(at(x, y).y)) - part_.y, 0, part_.height - 1);
}

LinearImage LensWarp::warped(const LinearImage& image) const {
  LinearImage out(width_, height_);
  parallel_for(static_cast<std::size_t>(height_), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < width_; ++x) {
      const Footprint& f = at(x, y);
      const float across = std::abs(f.xx) + std::abs(f.xy), down = std::abs(f.yx) + std::abs(f.yy);
      const float determinant = f.xx * f.yy - f.xy * f.yx;
      const int left = std::max(0, static_cast<int>(std::floor(f.x - across)) - part_.x);
      const int right = std::min(image.width() - 1, static_cast<int>(std::ceil(f.x + across)) - part_.x);
      const int top = std::max(0, static_cast<int>(std::floor(f.y - down)) - part_.y);
      const int bottom = std::min(image.height() - 1, static_cast<int>(std::ceil(f.y + down)) - part_.y);
      double sum[4] = {0, 0, 0, 0}, weights = 0;
      for (int j = top; j <= bottom; ++j)
        for (int i = left; i <= right; ++i) {
          const float dx = static_cast<float>(part_.x + i) + 0.5f - f.x,
                      dy = static_cast<float>(part_.y + j) + 0.5f - f.y;
          const float u = (f.yy * dx - f.xy * dy) / determinant, v = (f.xx * dy - f.yx * dx) / determinant;
          const float weight = std::max(0.0f, 1 - std::abs(u)) * std::max(0.0f, 1 - std::abs(v));
          if (weight == 0) continue;
          const Linear& c = image(i, j);
          sum[0] += 1.0 * weight * c.r, sum[1] += 1.0 * weight * c.g, sum[2] += 1.0 * weight * c.b;
          sum[3] += 1.0 * weight * c.a;
          weights += weight;
        }
      const auto mean = [&](int k) { return static_cast<float>(sum[k] / weights); };
      out(x, y) = {mean(0), mean(1), mean(2), mean(3)};
    }
  });
  return out;
}

DisplayImage LensWarp::warped(const Rgba16Image& image, bool is_raw) const {
  std::vector<float> light = decoded_srgb16();
  if (is_raw)
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = static_cast<float>(i) / 65535;
  LinearImage linear(image.width(), image.height());
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    const Rgba16& c = image.values()[i];
    const float alpha = static_cast<float>(c.a) / 65535;
    linear.values()[i] = {light[c.r] * alpha, light[c.g] * alpha, light[c.b] * alpha, alpha};
  }
  linear = warped(linear);
  DisplayImage out(width_, height_);
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    const Linear& c = linear.values()[i];
    const auto code = [&](float v) { return is_raw ? v / c.a : encode_srgb(v / c.a); };
    out.values()[i] = c.a > 0 ? Display{code(c.r), code(c.g), code(c.b), c.a} : Display{0, 0, 0, 0};
  }
  return out;
}

Plane<float2> LensWarp::nearest_steps(const Plane<float2>& frame, float begin, float end) const {
  if (frame.empty()) return {};
  const auto in_pixels = [&](double x, double y) {
    const LensPoint p = distorted(lens_, {(x - 0.5 - frame_.cx) / frame_.fx, (y - 0.5 - frame_.cy) / frame_.fy});
    return LensPoint{lens_.fx * p.x, lens_.fy * p.y};
  };
  Plane<float2> out(width_, height_);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const float2 step = frame(column(x, y), row(x, y));
      const Footprint& f = at(x, y);
      const LensPoint from = in_pixels(f.x + begin * step.x, f.y + begin * step.y);
      const LensPoint to = in_pixels(f.x + end * step.x, f.y + end * step.y);
      out(x, y) = {static_cast<float>(to.x - from.x), static_cast<float>(to.y - from.y)};
    }
  return out;
}

}  // namespace zoneplate
