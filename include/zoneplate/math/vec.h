// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#pragma GCC visibility push(default)
namespace zoneplate {

/// Two floats: a texture coordinate, or a position or displacement in the image plane.
struct float2 {
  float x = 0, y = 0;  ///< components
  bool operator==(const float2&) const = default;
};

/// Three floats: a position or direction in space, or a linear colour (x: red, y: green, z: blue).
struct float3 {
  float x = 0, y = 0, z = 0;  ///< components
  bool operator==(const float3&) const = default;
};

/// Four floats: a homogeneous position, a tangent with its sign, or a colour with alpha (w).
struct float4 {
  float x = 0, y = 0, z = 0, w = 0;  ///< components
  bool operator==(const float4&) const = default;
};

/// Three doubles: a position in the coordinates of a file, which may be far from their origin.
struct double3 {
  double x = 0, y = 0, z = 0;  ///< components
  bool operator==(const double3&) const = default;
};

/// Two integers: a pixel, or the width and height of an image.
struct int2 {
  int x = 0, y = 0;  ///< components
  bool operator==(const int2&) const = default;
};

///@{
/// Arithmetic by component; a scalar multiplies every component.
constexpr float2 operator+(float2 a, float2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr float2 operator-(float2 a, float2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr float2 operator*(float2 a, float2 b) { return {a.x * b.x, a.y * b.y}; }
constexpr float2 operator*(float2 a, float s) { return {a.x * s, a.y * s}; }
constexpr float2 operator*(float s, float2 a) { return a * s; }

constexpr float3 operator+(float3 a, float3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr float3 operator-(float3 a, float3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr float3 operator-(float3 a) { return {-a.x, -a.y, -a.z}; }
constexpr float3 operator*(float3 a, float3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
constexpr float3 operator*(float3 a, float s) { return {a.x * s, a.y * s, a.z * s}; }
constexpr float3 operator*(float s, float3 a) { return a * s; }
constexpr float3& operator+=(float3& a, float3 b) { return a = a + b; }

constexpr double3 operator+(double3 a, double3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr double3 operator-(double3 a, double3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

constexpr float4 operator+(float4 a, float4 b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
constexpr float4 operator-(float4 a, float4 b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
constexpr float4 operator*(float4 a, float4 b) { return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w}; }
constexpr float4 operator*(float4 a, float s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }
constexpr float4 operator*(float s, float4 a) { return a * s; }
///@}

///@{
/// The dot product, summed in the order x, y, z, w.
constexpr float dot(float2 a, float2 b) { return a.x * b.x + a.y * b.y; }
constexpr float dot(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
constexpr float dot(float4 a, float4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
///@}
/// The cross product: +x × +y = +z.
constexpr float3 cross(float3 a, float3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
///@{
/// The Euclidean length.
inline float length(float2 a) { return std::sqrt(dot(a, a)); }
inline float length(float3 a) { return std::sqrt(dot(a, a)); }
///@}

/// True if no component is infinite or NaN.
inline bool is_finite(float3 a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// The direction of `a`, or `otherwise` where a has no direction (zero length, or a component that is not finite).
inline float3 normalize(float3 a, float3 otherwise = {0, 0, 0}) {
  const float square = dot(a, a);
  if (!(square > 1e-30f && square < 1e30f)) {  // the squares of the components may underflow or overflow
    const float x = std::abs(a.x), y = std::abs(a.y), z = std::abs(a.z);
    const float largest = x > y ? (x > z ? x : z) : (y > z ? y : z);
    if (!(largest > 0) || !is_finite(a)) return otherwise;
    a = {a.x / largest, a.y / largest, a.z / largest};
  }
  const float n = length(a);
  return {a.x / n, a.y / n, a.z / n};
}

/// The same vector in doubles.
constexpr double3 widened(float3 a) { return {a.x, a.y, a.z}; }
/// The nearest vector of floats.
constexpr float3 narrowed(double3 a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

/// The first three components, without a division by w.
constexpr float3 xyz(float4 a) { return {a.x, a.y, a.z}; }

}  // namespace zoneplate
#pragma GCC visibility pop
