// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/gltf/key_times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/formats/gltf/nodes.h"
#include "zoneplate/formats/gltf/sampler.h"
#include "zoneplate/math/spread_order.h"

namespace zoneplate {
namespace {

constexpr std::size_t max_times = 1024;
/// Rotations and cubic splines leave the straight way between two keys: times at these parts of it count too.
constexpr std::array inner_parts = {0.25, 0.5, 0.75};

/// A key at which a component of a channel is least or greatest, and the range of that component.
struct Extreme {
  float range = 0;
  double time = 0;
};

/// What a channel changes; nothing for a property that does not change the shape of the scene. Its visibility does.
struct Target {
  std::optional<GltfPath> path;
  bool is_visibility = false;
};

Target target_of(const JsonView& target) {
  const std::string word = target.text("path");
  if (word != "pointer") return {find_path(word)};
  const auto extension = target.extension("KHR_animation_pointer");
  const std::string pointer = extension ? extension->text("pointer") : "";
  if (!pointer.starts_with("/nodes/") && !pointer.starts_with("/meshes/")) return {};
  const std::string property = pointer.substr(pointer.rfind('/') + 1);
  return {find_path(property), property == "visible"};
}

class KeyTimes {
 public:
  explicit KeyTimes(GltfFile& file) : file_(file) {}
  ~KeyTimes() { file_.budget().give_back(all_.capacity() * sizeof(double)); }
  KeyTimes(const KeyTimes&) = delete;
  KeyTimes& operator=(const KeyTimes&) = delete;

  void add(const JsonView& sampler, const Target& target) {
    const std::vector<float> times = read_times(file_, sampler);
    file_.budget().give_back(times.size() * sizeof(float));
    const bool is_cubic = target.path && read_interpolation(sampler) == GltfInterpolation::CubicSpline;
    const bool is_curved =
        is_cubic || (target.path == GltfPath::Rotation && read_interpolation(sampler) == GltfInterpolation::Linear);
    const std::size_t input = sampler.index("input", file_.count("accessors"));
    if (known_inputs_.insert({input, is_curved}).second) add_times(times, is_curved);
    if (target.path) add_extremes(sampler, *target.path, times, is_cubic);
  }

  /// All times in the order of their importance.
  std::vector<double> in_order() {
    std::vector<double> out;
    std::set<double> known;
    const auto add = [&](double time) {
      if (out.size() < max_times && known.insert(time).second) out.push_back(time);
    };
    std::size_t longest = 0;
    for (std::vector<Extreme>& of_path : extremes_) {
      std::stable_sort(of_path.begin(), of_path.end(),
                       [](const Extreme& a, const Extreme& b) { return a.range > b.range; });
      longest = std::max(longest, of_path.size());
    }
    // Ranges of translations, rotations, scales and weights have no common unit: their extremes take turns.
    for (std::size_t i = 0; i < std::min(longest, max_times / 4); ++i)
      for (const std::vector<Extreme>& of_path : extremes_)
        if (i < of_path.size()) add(of_path[i].time);
    std::sort(all_.begin(), all_.end());
    const auto end = std::unique(all_.begin(), all_.end());
    for (const std::size_t i : spread_order(static_cast<std::size_t>(end - all_.begin()), max_times)) add(all_[i]);
    return out;
  }

 private:
  /// Many samplers may share the times of their keys: each accessor is added once, or again with the parts between.
  void add_times(const std::vector<float>& times, bool is_curved) {
    const std::size_t more = times.size() * (is_curved ? 1 + inner_parts.size() : 1);
    file_.budget().check_time();
    const std::size_t before = all_.capacity();
    if (all_.size() + more > before) {
      const std::size_t after = std::max(2 * before, all_.size() + more);
      file_.budget().take((after - before) * sizeof(double));
      all_.reserve(after);
    }
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double end = static_cast<double>(times[i]);
      all_.push_back(end);
      if (!is_curved || i == 0) continue;
      const double begin = static_cast<double>(times[i - 1]);
      for (const double part : inner_parts) all_.push_back(begin + part * (end - begin));
    }
  }

  void add_extremes(const JsonView& sampler, GltfPath path, const std::vector<float>& times, bool is_cubic) {
    const GltfValueShape shape = shape_of(path);
    if (read_shape(file_, sampler, "output").components != shape.width) return;  // animate() reports or ignores it
    const std::size_t width = values_per_key(file_, sampler, shape, times.size()) * shape.width;
    const std::vector<float> values = read_values(file_, sampler, shape.width);
    file_.budget().give_back(values.size() * sizeof(float));
    const std::size_t step = is_cubic ? 3 * width : width, first = is_cubic ? width : 0;
    for (std::size_t c = 0; c < width; ++c) {
      const auto value = [&](std::size_t key) { return values[key * step + first + c]; };
      std::size_t least = 0, most = 0;
      for (std::size_t key = 1; key < times.size(); ++key) {
        if (value(key) < value(least)) least = key;
        if (value(key) > value(most)) most = key;
      }
      const float range = value(most) - value(least);
      if (!(range > 0 && std::isfinite(range))) continue;
      std::vector<Extreme>& out = extremes_[static_cast<std::size_t>(path)];
      for (const std::size_t key : {least, most}) out.push_back({range, static_cast<double>(times[key])});
    }
  }

  GltfFile& file_;
  std::vector<double> all_;
  std::set<std::pair<std::size_t, bool>> known_inputs_;  // accessors of times, and whether with the parts between
  std::array<std::vector<Extreme>, 4> extremes_;         // by GltfPath
};

}  // namespace

std::vector<double> key_times(GltfFile& file, const SceneChoice& choice) {
  KeyTimes out(file);
  for (const std::size_t i : chosen_animations(file, choice)) {
    const JsonView animation = file.root().element("animations", i, "animation");
    std::set<std::size_t> known;  // samplers that several channels share
    for (std::size_t c = 0; c < animation.count("channels"); ++c) {
      file.budget().check_time();
      file.read_optional([&] {
        const JsonView channel = animation.element("channels", c, "channel");
        const Target target = target_of(channel.object("target"));
        if (!target.path && !target.is_visibility) return;
        const std::size_t sampler = channel.index("sampler", animation.count("samplers"));
        if (known.insert(sampler).second) out.add(animation.element("samplers", sampler, "sampler"), target);
      });
    }
  }
  return out.in_order();
}

}  // namespace zoneplate
