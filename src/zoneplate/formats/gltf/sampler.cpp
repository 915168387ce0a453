// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/sampler.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "zoneplate/math/elementary.h"

namespace zoneplate {
namespace {

GltfKeys position_of(const std::vector<float>& times, double time) {
  GltfKeys out{.count = times.size()};
  const auto after =
      std::upper_bound(times.begin(), times.end(), time, [](double a, float b) { return a < static_cast<double>(b); });
  if (after == times.begin()) return out;
  out.first = static_cast<std::size_t>(after - times.begin()) - 1;
  if (after == times.end()) return out;
  const double begin = static_cast<double>(times[out.first]), span = static_cast<double>(*after) - begin;
  out.t = static_cast<float>((time - begin) / span), out.span = static_cast<float>(span);
  return out;
}

/// Interpolates linearly between two values.
void mix_linear(const float* a, const float* b, float t, std::vector<float>& out) {
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] + (b[i] - a[i]) * t;
}

/// Interpolates along the shorter great circle; linearly if the two rotations are nearly equal.
void mix_rotations(const float* a, const float* b, float t, std::vector<float>& out) {
  float d = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const float sign = d < 0 ? -1.0f : 1.0f;
  d = std::min(d * sign, 1.0f);
  float from = 1 - t, to = t;
  if (d < 0.9995f) {
    const float angle = acos(d), whole = sin(angle);
    from = sin((1 - t) * angle) / whole;
    to = sin(t * angle) / whole;
  }
  for (std::size_t i = 0; i < 4; ++i) out[i] = a[i] * from + b[i] * (to * sign);
}

/// The cubic Hermite spline through value and out-tangent of one key, in-tangent and value of the next (glTF 2.0,
/// appendix C.5).
void mix_cubic(const float* key, std::size_t width, const GltfKeys& m, std::vector<float>& out) {
  const float t = m.t, t2 = t * t, t3 = t2 * t;
  for (std::size_t i = 0; i < width; ++i) {
    const float value = key[width + i], leaving = key[2 * width + i] * m.span;
    const float arriving = key[3 * width + i] * m.span, next = key[4 * width + i];
    out[i] =
        (2 * t3 - 3 * t2 + 1) * value + (t3 - 2 * t2 + t) * leaving + (3 * t2 - 2 * t3) * next + (t3 - t2) * arriving;
  }
}

}  // namespace

std::optional<GltfPath> find_path(std::string_view name) {
  constexpr std::string_view names[] = {"translation", "rotation", "scale", "weights"};
  for (std::size_t i = 0; i < std::size(names); ++i)
    if (name == names[i]) return static_cast<GltfPath>(i);
  return std::nullopt;
}

GltfValueShape shape_of(GltfPath path) {
  if (path == GltfPath::Weights) return {.is_list = true};
  return {.width = path == GltfPath::Rotation ? 4u : 3u, .is_rotation = path == GltfPath::Rotation};
}

std::vector<float> read_times(GltfFile& file, const JsonView& sampler) {
  std::vector<float> times = read_float(file, sampler, "input");
  if (times.empty()) sampler.fail("input has no elements");
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!std::isfinite(times[i]) || (i > 0 && times[i] < times[i - 1]))
      sampler.fail("input " + std::to_string(i) + " is " + std::to_string(times[i]) + ", expected growing times");
  return times;
}

std::vector<float> read_values(GltfFile& file, const JsonView& sampler, std::size_t width, ElementRange range) {
  std::vector<float> out;
  if (width == 1) return read_float(file, sampler, "output", range);
  if (width == 2)
    for (const float2 v : read_float2(file, sampler, "output", range)) out.insert(out.end(), {v.x, v.y});
  if (width == 3)
    for (const float3 v : read_float3(file, sampler, "output", range)) out.insert(out.end(), {v.x, v.y, v.z});
  if (width == 4)
    for (const float4 v : read_float4(file, sampler, "output", range)) out.insert(out.end(), {v.x, v.y, v.z, v.w});
  return out;
}

GltfInterpolation read_interpolation(const JsonView& sampler) {
  const std::string word = sampler.text("interpolation", "LINEAR");
  if (word == "STEP") return GltfInterpolation::Step;
  if (word == "LINEAR") return GltfInterpolation::Linear;
  if (word != "CUBICSPLINE")
    sampler.fail("interpolation is " + quoted(word) + ", expected STEP, LINEAR or CUBICSPLINE");
  return GltfInterpolation::CubicSpline;
}

std::size_t values_per_key(GltfFile& file, const JsonView& sampler, const GltfValueShape& shape, std::uint64_t keys) {
  const std::uint64_t needed = keys * (read_interpolation(sampler) == GltfInterpolation::CubicSpline ? 3 : 1);
  const std::uint64_t elements = count_elements(file, sampler, "output"), each = shape.is_list ? elements / needed : 1;
  if (elements < needed || each == 0)
    sampler.fail("output has " + std::to_string(elements) + " elements, expected " + std::to_string(needed));
  return static_cast<std::size_t>(each);
}

GltfKeys find_keys(GltfFile& file, const JsonView& sampler, double time) {
  const std::vector<float> times = read_times(file, sampler);
  file.budget().give_back(times.size() * sizeof(float));
  return position_of(times, time);
}

std::vector<float> evaluate(GltfFile& file, const JsonView& sampler, const GltfValueShape& shape,
                            const GltfKeys& keys) {
  const GltfInterpolation kind = read_interpolation(sampler);
  const std::size_t parts = kind == GltfInterpolation::CubicSpline ? 3 : 1;
  const std::size_t per_key = values_per_key(file, sampler, shape, keys.count);
  const std::size_t used = (keys.t > 0 ? 2 : 1) * parts * per_key;
  const std::vector<float> v = read_values(file, sampler, shape.width, {keys.first * parts * per_key, used});
  const std::size_t width = shape.is_list ? per_key : shape.width;
  if (v.size() < (keys.t > 0 ? 2 : 1) * parts * width) sampler.fail("output ends too early");

  const float* const key = v.data();
  std::vector<float> out(width);
  if (keys.t == 0 || kind == GltfInterpolation::Step) {
    std::copy_n(key + (kind == GltfInterpolation::CubicSpline ? width : 0), width, out.begin());
  } else if (kind == GltfInterpolation::CubicSpline) {
    mix_cubic(key, width, keys, out);
  } else if (shape.is_rotation) {
    mix_rotations(key, key + width, keys.t, out);
  } else {
    mix_linear(key, key + width, keys.t, out);
  }
  for (float& x : out)
    if (!std::isfinite(x)) sampler.fail("output is not finite");
  return out;
}

}  // namespace zoneplate
