// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "zoneplate/formats/gltf/accessor.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate {
namespace {

enum class Path { Translation, Rotation, Scale, Weights };
enum class Interpolation { Step, Linear, CubicSpline };

/// The position of a time among the keys: at `first`, plus the fraction `t` of the interval to the next key, which is
/// `span` seconds long.
struct Moment {
  std::size_t first = 0;
  float t = 0, span = 0;
};

Moment find_moment(const std::vector<float>& times, double time) {
  const auto after =
      std::upper_bound(times.begin(), times.end(), time, [](double a, float b) { return a < static_cast<double>(b); });
  if (after == times.begin()) return {};
  const auto first = static_cast<std::size_t>(after - times.begin()) - 1;
  if (after == times.end()) return {first};
  const double begin = static_cast<double>(times[first]), span = static_cast<double>(*after) - begin;
  return {first, static_cast<float>((time - begin) / span), static_cast<float>(span)};
}

std::vector<float> read_times(GltfFile& file, const JsonView& sampler) {
  std::vector<float> times = read_float(file, sampler, "input");
  if (times.empty()) sampler.fail("input has no elements");
  for (std::size_t i = 0; i < times.size(); ++i)
    if (!(times[i] >= 0 && std::isfinite(times[i])) || (i > 0 && !(times[i] > times[i - 1])))
      sampler.fail("input " + std::to_string(i) + " is " + std::to_string(times[i]) +
                   ", expected growing times from 0");
  return times;
}

/// The values of a channel's keys as floats, each value with as many floats as its path has.
std::vector<float> read_values(GltfFile& file, const JsonView& sampler, Path path, ElementRange range) {
  std::vector<float> out;
  if (path == Path::Weights) return read_float(file, sampler, "output", range);
  if (path == Path::Rotation) {
    for (const float4 v : read_float4(file, sampler, "output", range)) out.insert(out.end(), {v.x, v.y, v.z, v.w});
  } else {
    for (const float3 v : read_float3(file, sampler, "output", range)) out.insert(out.end(), {v.x, v.y, v.z});
  }
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
void mix_cubic(const float* key, std::size_t width, const Moment& m, std::vector<float>& out) {
  const float t = m.t, t2 = t * t, t3 = t2 * t;
  for (std::size_t i = 0; i < width; ++i) {
    const float value = key[width + i], leaving = key[2 * width + i] * m.span;
    const float arriving = key[3 * width + i] * m.span, next = key[4 * width + i];
    out[i] =
        (2 * t3 - 3 * t2 + 1) * value + (t3 - 2 * t2 + t) * leaving + (3 * t2 - 2 * t3) * next + (t3 - t2) * arriving;
  }
}

Interpolation read_interpolation(const JsonView& sampler) {
  const std::string word = sampler.text("interpolation", "LINEAR");
  if (word == "STEP") return Interpolation::Step;
  if (word == "LINEAR") return Interpolation::Linear;
  if (word != "CUBICSPLINE")
    sampler.fail("interpolation is " + quoted(word) + ", expected STEP, LINEAR or CUBICSPLINE");
  return Interpolation::CubicSpline;
}

/// The position among the keys of a sampler, and the number of keys.
struct Keys {
  Moment moment;
  std::size_t count = 0;
};

Keys find_keys(GltfFile& file, const JsonView& sampler, double time) {
  const std::vector<float> times = read_times(file, sampler);
  file.budget().give_back(times.size() * sizeof(float));
  return {find_moment(times, time), times.size()};
}

/// The value of a sampler: as many floats as its path has; for weights, as many as a key has.
std::vector<float> evaluate(GltfFile& file, const JsonView& sampler, Path path, const Keys& of_input) {
  const Interpolation kind = read_interpolation(sampler);
  const std::uint64_t parts = kind == Interpolation::CubicSpline ? 3 : 1, keys = of_input.count * parts;
  const std::uint64_t elements = count_elements(file, sampler, "output");
  const std::uint64_t per_key = path == Path::Weights ? elements / keys : 1;
  if (elements < keys || per_key == 0)
    sampler.fail("output has " + std::to_string(elements) + " elements, expected " + std::to_string(keys));

  const Moment m = of_input.moment;
  const std::uint64_t used = (m.t > 0 ? 2 : 1) * parts * per_key;
  const std::vector<float> v = read_values(file, sampler, path, {m.first * parts * per_key, used});
  const std::size_t width = path == Path::Weights ? static_cast<std::size_t>(per_key) : path == Path::Rotation ? 4 : 3;
  if (v.size() < (m.t > 0 ? 2 : 1) * parts * width) sampler.fail("output ends too early");

  const float* const key = v.data();
  std::vector<float> out(width);
  if (m.t == 0 || kind == Interpolation::Step) {
    std::copy_n(key + (kind == Interpolation::CubicSpline ? width : 0), width, out.begin());
  } else if (kind == Interpolation::CubicSpline) {
    mix_cubic(key, width, m, out);
  } else if (path == Path::Rotation) {
    mix_rotations(key, key + width, m.t, out);
  } else {
    mix_linear(key, key + width, m.t, out);
  }
  for (float& x : out)
    if (!std::isfinite(x)) sampler.fail("output is not finite");
  return out;
}

/// The property of a pose that a path names; nothing for an unknown path.
std::optional<Path> find_path_kind(const std::string& word) {
  constexpr const char* words[] = {"translation", "rotation", "scale", "weights"};
  for (std::size_t i = 0; i < std::size(words); ++i)
    if (word == words[i]) return static_cast<Path>(i);
  return std::nullopt;
}

void set(GltfNodePose& pose, Path path, std::vector<float> v) {
  if (path == Path::Translation) pose.translation = float3{v[0], v[1], v[2]};
  if (path == Path::Scale) pose.scale = float3{v[0], v[1], v[2]};
  if (path == Path::Rotation) pose.rotation = Quaternion{v[0], v[1], v[2], v[3]};
  if (path == Path::Weights) pose.weights = std::move(v);
}

/// The minimum and maximum of the accessor, which the specification requires for times; if they are missing, the times
/// are read.
std::pair<float, float> extent(GltfFile& file, const JsonView& sampler) {
  const std::size_t number = sampler.index("input", file.count("accessors"));
  const JsonView accessor = file.root().element("accessors", number, "accessor");
  const std::vector<float> low = accessor.numbers("min", 1), high = accessor.numbers("max", 1);
  if (!low.empty() && !high.empty()) return {low[0], high[0]};
  const std::vector<float> times = read_times(file, sampler);
  file.budget().give_back(times.size() * sizeof(float));
  return {times.front(), times.back()};
}

}  // namespace

std::vector<AnimationSpan> list_animations(GltfFile& file) {
  std::vector<AnimationSpan> out;
  std::map<std::size_t, std::pair<float, float>> extents;  // by the accessor of times
  for (std::size_t i = 0; i < file.count("animations"); ++i) {
    const JsonView json = file.root().element("animations", i, "animation");
    AnimationSpan span{json.text("name"), 0, 0};
    file.budget().take(2 * sizeof(AnimationSpan) + span.name.size());
    for (std::size_t s = 0; s < json.count("samplers"); ++s) {
      file.budget().check_time();
      const JsonView sampler = json.element("samplers", s, "sampler");
      const std::size_t input = sampler.index("input", file.count("accessors"));
      if (!extents.contains(input)) extents[input] = extent(file, sampler);
      const auto [begin, end] = extents[input];
      span.begin = s == 0 ? begin : std::min(span.begin, begin);
      span.end = s == 0 ? end : std::max(span.end, end);
    }
    span.end = std::max(span.end, span.begin);  // the accessors' min and max may be invalid
    out.push_back(std::move(span));
  }
  return out;
}

void pose_nodes(GltfFile& file, std::size_t animation, double time, GltfPoses& poses) {
  const JsonView json = file.root().element("animations", animation, "animation");
  // Many channels may share a sampler, or the accessor of its times: each is evaluated once.
  std::map<std::size_t, Keys> keys;                                   // by accessor
  std::map<std::pair<std::size_t, Path>, std::vector<float>> values;  // by sampler
  for (std::size_t c = 0; c < json.count("channels"); ++c) {
    file.budget().check_time();
    const JsonView channel = json.element("channels", c, "channel"), target = channel.object("target");
    const auto node = target.find_index("node", file.count("nodes"));
    const std::optional<Path> path = find_path_kind(target.text("path"));
    if (!path) file.warn(target.place() + ": path " + quoted(target.text("path")) + " is not supported, ignored");
    if (!node || !path) continue;
    const std::size_t number = channel.index("sampler", json.count("samplers"));
    const JsonView sampler = json.element("samplers", number, "sampler");
    const auto [value, is_new] = values.try_emplace({number, *path});
    if (is_new) {
      const std::size_t input = sampler.index("input", file.count("accessors"));
      if (!keys.contains(input)) keys[input] = find_keys(file, sampler, time);
      value->second = evaluate(file, sampler, *path, keys[input]);
    }
    file.budget().take(sizeof(GltfNodePose) + value->second.size() * sizeof(float));
    set(poses[*node], *path, value->second);
  }
}

}  // namespace zoneplate
