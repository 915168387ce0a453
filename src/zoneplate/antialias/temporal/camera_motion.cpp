// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/temporal/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace zoneplate::antialias {

CameraMotion::Lens CameraMotion::lens_of(const Camera& camera, float aspect) {
  const float4x4 clip = camera.clip_from_camera(aspect);
  return {clip.column[0].x, clip.column[1].y, camera.is_orthographic};
}

CameraMotion::CameraMotion(const Camera& now, const Camera& last, float aspect, int width, int height)
    : width_(width), height_(height), now_(lens_of(now, aspect)), last_(lens_of(last, aspect)), turn_{} {
  // The cameras' matrices are rigid: the inverse is the transpose.
  const auto component = [](float4 v, std::size_t k) -> double {
    return k == 0 ? v.x : k == 1 ? v.y : k == 2 ? v.z : v.w;
  };
  const auto& a = now.world_from_camera.column;
  const auto& b = last.world_from_camera.column;
  is_at_rest_ = now_ == last_;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 4; ++column) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double offset = column == 3 ? component(b[3], k) : 0;
        sum += component(b[row], k) * (component(a[column], k) - offset);
        is_at_rest_ = is_at_rest_ && component(a[column], k) == component(b[column], k);
      }
      turn_[row][column] = sum;
    }
}

float2 CameraMotion::at(double x, double y, double distance) const {
  if (is_at_rest_) return {0, 0};
  const bool is_far = std::isinf(distance);
  const double u = (2 * x / width_ - 1) / now_.scale_x;
  const double v = (1 - 2 * y / height_) / now_.scale_y;
  if (is_far && (now_.is_orthographic || last_.is_orthographic)) return {0, 0};
  // A point at infinity is its direction.
  const double depth = is_far ? 1 : distance, across = now_.is_orthographic ? 1 : depth, weight = is_far ? 0 : 1;
  const double p[4] = {u * across, v * across, -depth, weight};
  double q[3];
  for (std::size_t row = 0; row < 3; ++row)
    q[row] = ((turn_[row][0] * p[0] + turn_[row][1] * p[1]) + turn_[row][2] * p[2]) + turn_[row][3] * p[3];
  const double divisor = last_.is_orthographic ? 1 : -q[2];
  if (!(divisor > 0)) return {0, 0};
  const double last_x = (q[0] / divisor * last_.scale_x + 1) * width_ / 2;
  const double last_y = (1 - q[1] / divisor * last_.scale_y) * height_ / 2;
  return {static_cast<float>(x - last_x), static_cast<float>(y - last_y)};
}

CameraMotion::Row CameraMotion::row_of(double y) const {
  const double scale[3] = {last_.scale_x * width_ / 2, -last_.scale_y * height_ / 2, -1};
  const double v = (1 - 2 * y / height_) / now_.scale_y;
  Row out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.slope[k] = scale[k] * turn_[k][0] * 2 / (width_ * now_.scale_x);
    out.start[k] = scale[k] * (turn_[k][1] * v - turn_[k][2] - turn_[k][0] / now_.scale_x);
    out.way[k] = scale[k] * turn_[k][3];
  }
  return out;
}

void CameraMotion::of_background(double x, double y, int n, float* motion_x, float* motion_y) const {
  if (is_at_rest_ || now_.is_orthographic || last_.is_orthographic) {
    std::fill_n(motion_x, n, 0.0f), std::fill_n(motion_y, n, 0.0f);
    return;
  }
  const Row row = row_of(y);
  for (int i = 0; i < n; ++i) {
    const double place = x + i, divisor = row.slope[2] * place + row.start[2];
    const double part = 1 / divisor;
    const double last_x = (row.slope[0] * place + row.start[0]) * part + width_ / 2;
    const double last_y = (row.slope[1] * place + row.start[1]) * part + height_ / 2;
    const bool is_visible = divisor > 0;
    motion_x[i] = is_visible ? static_cast<float>(place - last_x) : 0;
    motion_y[i] = is_visible ? static_cast<float>(y - last_y) : 0;
  }
}

void CameraMotion::along_row(double x, double y, std::span<const float> distances, float* motion_x,
                             float* motion_y) const {
  if (is_at_rest_ || now_.is_orthographic || last_.is_orthographic) {
    for (std::size_t i = 0; i < distances.size(); ++i) {
      const float2 motion = at(x + static_cast<double>(i), y, static_cast<double>(distances[i]));
      motion_x[i] = motion.x, motion_y[i] = motion.y;
    }
    return;
  }
  const Row row = row_of(y);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    // A point at infinity is its direction.
    const bool is_far = distances[i] > std::numeric_limits<float>::max();
    const double distance = is_far ? 1.0 : static_cast<double>(distances[i]), weight = is_far ? 0.0 : 1.0;
    const double place = x + static_cast<double>(i);
    const auto coordinate = [&](int k) {
      return distance * (row.slope[k] * place + row.start[k]) + weight * row.way[k];
    };
    const double divisor = coordinate(2), part = 1 / divisor;
    const double last_x = coordinate(0) * part + width_ / 2, last_y = coordinate(1) * part + height_ / 2;
    const bool is_visible = divisor > 0;
    motion_x[i] = is_visible ? static_cast<float>(place - last_x) : 0;
    motion_y[i] = is_visible ? static_cast<float>(y - last_y) : 0;
  }
}

}  // namespace zoneplate::antialias
