// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/animation.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "zoneplate/formats/gltf/accessor.h"
#include "zoneplate/formats/gltf/sampler.h"

namespace zoneplate {
namespace {

void set(GltfNodePose& pose, GltfPath path, std::vector<float> v) {
  if (path == GltfPath::Translation) pose.translation = float3{v[0], v[1], v[2]};
  if (path == GltfPath::Scale) pose.scale = float3{v[0], v[1], v[2]};
  if (path == GltfPath::Rotation) pose.rotation = Quaternion{v[0], v[1], v[2], v[3]};
  if (path == GltfPath::Weights) pose.weights = std::move(v);
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
GltfValueShape shape_of(GltfFile& file, const JsonView& sampler, std::string_view pointer) {
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
JsonValue json_of(const std::vector<float>& values, const GltfValueShape& shape, std::string_view pointer) {
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
    bool is_first = true;
    for (std::size_t s = 0; s < json.count("samplers"); ++s) {
      file.budget().check_time();
      const JsonView sampler = json.element("samplers", s, "sampler");
      file.read_optional([&] {
        const std::size_t input = sampler.index("input", file.count("accessors"));
        if (!extents.contains(input)) extents[input] = extent(file, sampler);
        const auto [begin, end] = extents[input];
        span.begin = is_first ? begin : std::min(span.begin, begin);
        span.end = is_first ? end : std::max(span.end, end);
        is_first = false;
      });
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
  const std::vector<float>& value(const JsonView& channel, const GltfValueShape& shape) {
    const std::pair key(number_of(channel), shape);
    if (!values_.contains(key)) {
      const JsonView sampler = of(channel);
      const std::size_t input = sampler.index("input", file_.count("accessors"));
      if (!keys_.contains(input)) keys_[input] = find_keys(file_, sampler, time_);
      values_[key] = evaluate(file_, sampler, shape, keys_[input]);
    }
    const std::vector<float>& value = values_.at(key);
    file_.budget().take(sizeof(GltfNodePose) + value.size() * sizeof(float));
    return value;
  }

 private:
  std::size_t number_of(const JsonView& channel) const {
    return channel.index("sampler", animation_.count("samplers"));
  }

  GltfFile& file_;
  const JsonView& animation_;
  double time_;
  std::map<std::size_t, GltfKeys> keys_;                                         // by accessor
  std::map<std::pair<std::size_t, GltfValueShape>, std::vector<float>> values_;  // by sampler
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
  const GltfValueShape shape = shape_of(file, samplers.of(channel), pointer);
  JsonValue value = json_of(samplers.value(channel, shape), shape, pointer);
  if (before != nullptr && before->kind != value.kind) return ignore("has values of another kind");
  file.budget().take(sizeof(JsonValue) * (2 + value.items.size()) + 2 * pointer.size());
  if (!file.edits().set(pointer, std::move(value))) ignore("leads to nothing");
}

void apply_channel(GltfFile& file, const JsonView& channel, Samplers& samplers, GltfPoses& poses) {
  const JsonView target = channel.object("target");
  const std::string word = target.text("path");
  if (word == "pointer") return edit_property(file, channel, target, samplers);
  const auto node = target.find_index("node", file.count("nodes"));
  const std::optional<GltfPath> path = find_path(word);
  if (!path) file.warn(target.place() + ": path " + quoted(word) + " is not supported, ignored");
  if (node && path) set(poses[*node], *path, samplers.value(channel, shape_of(*path)));
}

}  // namespace

void animate(GltfFile& file, std::size_t animation, double time, GltfPoses& poses) {
  const JsonView json = file.root().element("animations", animation, "animation");
  Samplers samplers(file, json, time);
  for (std::size_t c = 0; c < json.count("channels"); ++c) {
    file.budget().check_time();
    file.read_optional([&] { apply_channel(file, json.element("channels", c, "channel"), samplers, poses); });
  }
}

}  // namespace zoneplate
