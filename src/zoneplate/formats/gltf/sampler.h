// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <optional>
#include <string_view>
#include <vector>

#include "zoneplate/formats/gltf/accessor.h"
#include "zoneplate/formats/gltf/file.h"

namespace zoneplate {

/// What a channel of an animation changes of a node.
enum class GltfPath { Translation, Rotation, Scale, Weights };
/// The path of this name; nothing for an unknown one.
std::optional<GltfPath> find_path(std::string_view name);

/// The kind of value that a channel animates.
struct GltfValueShape {
  std::size_t width = 1;     ///< floats of one value
  bool is_list = false;      ///< a key has as many values as the output has elements for it
  bool is_rotation = false;  ///< interpolated along great circles
  auto operator<=>(const GltfValueShape&) const = default;
};
GltfValueShape shape_of(GltfPath path);

enum class GltfInterpolation { Step, Linear, CubicSpline };
GltfInterpolation read_interpolation(const JsonView& sampler);

/// The times of a sampler's keys, in seconds. The specification requires them to grow strictly from 0, but exporters
/// write negative ones, and a jump as two keys of one time, of which the later holds from there on.
///
/// Errors    ErrorKind::Input for times that are not finite or decrease.
std::vector<float> read_times(GltfFile& file, const JsonView& sampler);

/// A sampler's output as a list of floats, `width` to a value.
std::vector<float> read_values(GltfFile& file, const JsonView& sampler, std::size_t width, ElementRange range = {});

/// The values that a sampler's output has for each of its keys: tangents of cubic splines do not count.
///
/// Errors    ErrorKind::Input unless there is at least one for each.
std::size_t values_per_key(GltfFile& file, const JsonView& sampler, const GltfValueShape& shape, std::uint64_t keys);

/// The position of a time among the keys of a sampler: at `first`, plus the fraction `t` of the interval to the next
/// key, which is `span` seconds long.
struct GltfKeys {
  std::size_t first = 0;
  float t = 0, span = 0;
  std::size_t count = 0;  ///< of all keys
};
GltfKeys find_keys(GltfFile& file, const JsonView& sampler, double time);

/// The value of a sampler between its keys; `width` floats, or for a list as many as a key has.
std::vector<float> evaluate(GltfFile& file, const JsonView& sampler, const GltfValueShape& shape, const GltfKeys& keys);

}  // namespace zoneplate
