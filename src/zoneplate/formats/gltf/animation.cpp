// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "zoneplate/formats/gltf/accessor.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate {
namespace {

enum class Path { Translation, Rotation, Scale, Weights };

/// The kind of value that a channel animates.
struct ValueShape {
  std::size_t width = 1;     ///< floats of one value
  bool is_list = false;      ///< a key has as many values as the output has elements for it
  bool is_rotation = false;  ///< interpolated along great circles
  auto operator<=>(const ValueShape&) const = default;
};

ValueShape shape_of(Path path) {
  if (path == Path::Weights) return {.is_list = true};
  return {.width = path == Path::Rotation ? 4u : 3u, .is_rotation = path == Path::Rotation};
}

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

/// A channel's values as a list of floats, `width` to a value.
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

/// The value of a sampler; `width` floats, or for a list as many as a key has.
std::vector<float> evaluate(GltfFile& file, const JsonView& sampler, const ValueShape& shape, const Keys& of_input) {
  const Interpolation kind = read_interpolation(sampler);
  const std::uint64_t parts = kind == Interpolation::CubicSpline ? 3 : 1, keys = of_input.count * parts;
  const std::uint64_t elements = count_elements(file, sampler, "output");
  const std::uint64_t per_key = shape.is_list ? elements / keys : 1;
  if (elements < keys || per_key == 0)
    sampler.fail("output has " + std::to_string(elements) + " elements, expected " + std::to_string(keys));

  const Moment m = of_input.moment;
  const std::uint64_t used = (m.t > 0 ? 2 : 1) * parts * per_key;
  const std::vector<float> v = read_values(file, sampler, shape.width, {m.first * parts * per_key, used});
  const std::size_t width = shape.is_list ? static_cast<std::size_t>(per_key) : shape.width;
  if (v.size() < (m.t > 0 ? 2 : 1) * parts * width) sampler.fail("output ends too early");

  const float* const key = v.data();
  std::vector<float> out(width);
  if (m.t == 0 || kind == Interpolation::Step) {
    std::copy_n(key + (kind == Interpolation::CubicSpline ? width : 0), width, out.begin());
  } else if (kind == Interpolation::CubicSpline) {
    mix_cubic(key, width, m, out);
  } else if (shape.is_rotation) {
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

/// The last name of a JSON pointer; numbers, which are indices of elements, do not count.
std::string_view property_of(std::string_view pointer) {
  for (;;) {
    const std::size_t slash = pointer.rfind('/');
    if (slash == pointer.npos) return {};
    const std::string_view last = pointer.substr(slash + 1);
    if (last.find_first_not_of("0123456789") != last.npos) return last;
    pointer = pointer.substr(0, slash);
  }
}

/// The properties that glTF's object model and the extensions that are read declare mutable.
constexpr std::string_view mutable_properties[] = {
    "translation", "rotation", "scale", "weights", "visible",
    // cameras and lights
    "xmag", "ymag", "yfov", "aspectRatio", "znear", "zfar", "color", "intensity", "range", "innerConeAngle",
    "outerConeAngle",
    // materials and the transforms of their textures
    "offset", "strength", "alphaCutoff", "emissiveFactor", "baseColorFactor", "metallicFactor", "roughnessFactor",
    "emissiveStrength", "ior", "specularFactor", "specularColorFactor", "clearcoatFactor", "clearcoatRoughnessFactor",
    "sheenColorFactor", "sheenRoughnessFactor", "anisotropyStrength", "anisotropyRotation", "iridescenceFactor",
    "iridescenceIor", "iridescenceThicknessMinimum", "iridescenceThicknessMaximum", "transmissionFactor",
    "thicknessFactor", "attenuationDistance", "attenuationColor", "dispersion", "diffuseTransmissionFactor",
    "diffuseTransmissionColorFactor"};

bool is_mutable(std::string_view pointer) {
  constexpr std::string_view owners[] = {"/nodes/", "/meshes/", "/materials/", "/cameras/",
                                         "/extensions/KHR_lights_punctual/lights/"};
  const std::string_view property = property_of(pointer);
  return std::any_of(std::begin(owners), std::end(owners), [&](auto owner) { return pointer.starts_with(owner); }) &&
         std::find(std::begin(mutable_properties), std::end(mutable_properties), property) !=
             std::end(mutable_properties);
}

/// The shape of the values that a pointer's channel has: its accessor's, unless the property is a list of numbers.
ValueShape shape_of(GltfFile& file, const JsonView& sampler, std::string_view pointer) {
  const std::size_t number = sampler.index("output", file.count("accessors"));
  const std::string type = file.root().element("accessors", number, "accessor").text("type");
  if (type == "SCALAR") return {.is_list = pointer.ends_with("/weights")};
  if (type != "VEC2" && type != "VEC3" && type != "VEC4")
    sampler.fail("output is of type " + quoted(type) + ", expected SCALAR, VEC2, VEC3 or VEC4");
  const auto width = static_cast<std::size_t>(type[3] - '0');
  const bool is_node = pointer.starts_with("/nodes/");
  return {.width = width, .is_rotation = width == 4 && is_node && pointer.ends_with("/rotation")};
}

/// A property's value in the file.
JsonValue json_of(const std::vector<float>& values, const ValueShape& shape, std::string_view pointer) {
  const auto number = [](float x) {
    return JsonValue{.kind = JsonValue::Kind::Number, .number = static_cast<double>(x)};
  };
  if (pointer.ends_with("/visible")) return {.kind = JsonValue::Kind::Boolean, .boolean = values[0] != 0};
  if (shape.width == 1 && !shape.is_list) return number(values[0]);
  JsonValue list{.kind = JsonValue::Kind::List};
  for (const float x : values) list.items.push_back(number(x));
  return list;
}

/// The accessor's stated extent, which the specification requires for times; read where it is missing.
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

namespace {

/// The samplers of one animation at one time. Many channels may share the times of their keys, and a sampler: each is
/// evaluated once.
class Samplers {
 public:
  Samplers(GltfFile& file, const JsonView& animation, double time) : file_(file), animation_(animation), time_(time) {}

  JsonView of(const JsonView& channel) const { return animation_.element("samplers", number_of(channel), "sampler"); }
  const std::vector<float>& value(const JsonView& channel, const ValueShape& shape) {
    const auto [value, is_new] = values_.try_emplace({number_of(channel), shape});
    if (is_new) {
      const JsonView sampler = of(channel);
      const std::size_t input = sampler.index("input", file_.count("accessors"));
      if (!keys_.contains(input)) keys_[input] = find_keys(file_, sampler, time_);
      value->second = evaluate(file_, sampler, shape, keys_[input]);
    }
    file_.budget().take(sizeof(GltfNodePose) + value->second.size() * sizeof(float));
    return value->second;
  }

 private:
  std::size_t number_of(const JsonView& channel) const {
    return channel.index("sampler", animation_.count("samplers"));
  }

  GltfFile& file_;
  const JsonView& animation_;
  double time_;
  std::map<std::size_t, Keys> keys_;                                         // by accessor
  std::map<std::pair<std::size_t, ValueShape>, std::vector<float>> values_;  // by sampler
};

/// KHR_animation_pointer: the property that a channel names takes its value in the file's JSON, from which all readers
/// take it.
void edit_property(GltfFile& file, const JsonView& channel, const JsonView& target, Samplers& samplers) {
  const auto extension = target.extension("KHR_animation_pointer");
  if (!extension) return;
  const std::string pointer = extension->text("pointer");
  const auto ignore = [&](const char* cause) {
    file.warn(target.place() + ": pointer " + quoted(pointer) + " " + cause + ", ignored");
  };
  if (!is_mutable(pointer)) return ignore("is no property that can be animated");
  // An index of refraction of 0 is a mode of the material, which animations leave as it is.
  const JsonValue* const before = file.edits().find(pointer);
  if (pointer.ends_with("/ior") && before != nullptr && before->number == 0) return;
  const ValueShape shape = shape_of(file, samplers.of(channel), pointer);
  JsonValue value = json_of(samplers.value(channel, shape), shape, pointer);
  if (before != nullptr && before->kind != value.kind) return ignore("has values of another kind");
  file.budget().take(sizeof(JsonValue) * (2 + value.items.size()) + 2 * pointer.size());
  if (!file.edits().set(pointer, std::move(value))) ignore("leads to nothing");
}

}  // namespace

void animate(GltfFile& file, std::size_t animation, double time, GltfPoses& poses) {
  const JsonView json = file.root().element("animations", animation, "animation");
  Samplers samplers(file, json, time);
  for (std::size_t c = 0; c < json.count("channels"); ++c) {
    file.budget().check_time();
    const JsonView channel = json.element("channels", c, "channel"), target = channel.object("target");
    const std::string word = target.text("path");
    if (word == "pointer") {
      edit_property(file, channel, target, samplers);
      continue;
    }
    const auto node = target.find_index("node", file.count("nodes"));
    const std::optional<Path> path = find_path_kind(word);
    if (!path) file.warn(target.place() + ": path " + quoted(word) + " is not supported, ignored");
    if (node && path) set(poses[*node], *path, samplers.value(channel, shape_of(*path)));
  }
}

}  // namespace zoneplate
