// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/math/transform.h"

#include <cmath>

#include "zoneplate/math/angle.h"

namespace zoneplate {

float4x4 translation(float3 t) {
  float4x4 m;
  m.column[3] = {t.x, t.y, t.z, 1};
  return m;
}

float4x4 scaling(float3 s) {
  float4x4 m;
  m.column[0].x = s.x, m.column[1].y = s.y, m.column[2].z = s.z;
  return m;
}

float4x4 rotation(Quaternion q) {
  const float n = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(n > 0)) return {};
  const float x = q.x / n, y = q.y / n, z = q.z / n, w = q.w / n;
  return {{float4{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), 0},
           float4{2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x), 0},
           float4{2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y), 0}, float4{0, 0, 0, 1}}};
}

float4x4 rotation(float3 axis, float angle) {
  const float3 a = normalize(axis, {0, 1, 0});
  const SineCosine half = sine_cosine(static_cast<double>(angle) / 2);
  const auto s = static_cast<float>(half.sine), c = static_cast<float>(half.cosine);
  return rotation(Quaternion{a.x * s, a.y * s, a.z * s, c});
}

float4x4 look_at(float3 eye, float3 target, float3 up) {
  const float3 back = normalize(eye - target, {0, 0, 1});
  float3 right = cross(normalize(up, {0, 1, 0}), back);
  if (dot(right, right) < 1e-12f) right = cross({0, 0, 1}, back);
  if (dot(right, right) < 1e-12f) right = cross({1, 0, 0}, back);
  right = normalize(right);
  const float3 above = cross(back, right);
  return {{float4{right.x, above.x, back.x, 0}, float4{right.y, above.y, back.y, 0},
           float4{right.z, above.z, back.z, 0}, float4{-dot(right, eye), -dot(above, eye), -dot(back, eye), 1}}};
}

float4x4 perspective(float vertical_fov, float aspect, float near, float far) {
  const SineCosine half = sine_cosine(static_cast<double>(vertical_fov) / 2);
  const double t = half.sine / half.cosine;
  const double n = near, f = far;
  // z_clip = a z_view + b with z/w = 1 at z_view = -n and 0 at -f; in the limit of an infinite far plane, a = 0 and b =
  // n.
  const double a = std::isinf(f) ? 0.0 : n / (f - n);
  const double b = std::isinf(f) ? n : n * f / (f - n);
  return {{float4{static_cast<float>(1 / (t * static_cast<double>(aspect))), 0, 0, 0},
           float4{0, static_cast<float>(1 / t), 0, 0}, float4{0, 0, static_cast<float>(a), -1},
           float4{0, 0, static_cast<float>(b), 0}}};
}

float4x4 orthographic(float half_width, float half_height, float near, float far) {
  const double n = near, f = far;
  return {{float4{1 / half_width, 0, 0, 0}, float4{0, 1 / half_height, 0, 0},
           float4{0, 0, static_cast<float>(1 / (f - n)), 0}, float4{0, 0, static_cast<float>(f / (f - n)), 1}}};
}

}  // namespace zoneplate
