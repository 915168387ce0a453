// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "zoneplate/formats/gltf/file.h"
#include "zoneplate/math/vec.h"

namespace zoneplate {

/// The value limited to [low, high], with a warning where it lies outside.
inline float clamped(GltfFile& file, const JsonView& json, const char* key, float value, float low, float high) {
  const float inside = std::clamp(value, low, high);
  if (inside != value) file.warn(json.place() + ": " + key + " is out of range, clamped");
  return inside;
}

/// A number; `otherwise`, with a warning, if the value is none.
inline float read_number(GltfFile& file, const JsonView& json, const char* key, float otherwise) {
  float value = otherwise;
  file.read_optional([&] { value = json.number(key, otherwise); });
  return value;
}

/// `count` numbers; none, with a warning, if the value is another.
inline std::vector<float> read_numbers(GltfFile& file, const JsonView& json, const char* key, std::size_t count) {
  std::vector<float> values;
  file.read_optional([&] { values = json.numbers(key, count); });
  return values;
}

/// A number from 0 to `high`; others are clamped with a warning.
inline float read_factor(GltfFile& file, const JsonView& json, const char* key, float otherwise, float high = 1) {
  return clamped(file, json, key, read_number(file, json, key, otherwise), 0, high);
}

/// Three numbers from 0 to `high`; others are clamped with a warning.
inline float3 read_color_factor(GltfFile& file, const JsonView& json, const char* key, float3 otherwise,
                                float high = 1) {
  const std::vector<float> v = read_numbers(file, json, key, 3);
  if (v.empty()) return otherwise;
  const auto channel = [&](float x) { return clamped(file, json, key, x, 0, high); };
  return {channel(v[0]), channel(v[1]), channel(v[2])};
}

}  // namespace zoneplate
