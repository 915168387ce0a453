// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_layer.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/base/lower_case.h"
#include "zoneplate/base/utf8.h"

namespace zoneplate {
namespace {

/// The channels of a part that have a prefix.
struct Group {
  std::string prefix;
  std::vector<std::string> names;  ///< without it
};

std::string prefix_of(const std::string& channel) { return channel.substr(0, channel.rfind('.') + 1); }

/// In the order of the prefixes' first channels.
std::vector<Group> groups_of(const ExrPart& part) {
  std::vector<Group> groups;
  std::map<std::string, std::size_t> index;
  for (const ExrPartChannel& channel : part.channels) {
    const std::string prefix = prefix_of(channel.name);
    const auto [at, is_new] = index.emplace(prefix, groups.size());
    if (is_new) groups.push_back({prefix, {}});
    groups[at->second].names.push_back(channel.name.substr(prefix.size()));
  }
  return groups;
}

bool has(const Group& group, std::string_view name) {
  return std::ranges::find(group.names, name) != group.names.end();
}

/// The layers of a group, and those of its channels that are none of its colours.
class LayerMaker {
 public:
  LayerMaker(int part, const std::string& part_name, const Group& group) : group_(group) {
    layer_.part = part;
    layer_.prefix = group.prefix;
    layer_.name = part_name;
    if (const std::string own = group.prefix.substr(0, group.prefix.size() - !group.prefix.empty()); !own.empty())
      layer_.name += (part_name.empty() ? "" : ".") + own;
  }

  void add_to(std::vector<ExrLayer>& layers) {
    if (take_colors()) {
      layers.push_back(layer_);
      if (layers.back().name.empty()) layers.back().name = "RGBA";
    }
    std::vector<std::string> rest;
    for (const std::string& name : group_.names)
      if (std::ranges::find(layer_.channels, group_.prefix + name) == layer_.channels.end()) rest.push_back(name);
    const bool are_one = rest.size() == group_.names.size() && rest.size() <= 4 && !layer_.name.empty();
    if (are_one) return layers.push_back(data_layer(layer_.name, std::move(rest)));
    for (const std::string& name : rest)
      layers.push_back(data_layer(layer_.name + (layer_.name.empty() ? "" : ".") + name, {name}));
  }

 private:
  /// Of luminance without a prefix, X may be another channel; elsewhere X and Y are coordinates.
  bool take_colors() {
    const auto take = [&](const std::array<std::string_view, 4>& names, Kind kind) {
      layer_.kind = kind;
      for (std::size_t i = 0; i < names.size(); ++i)
        if (!names[i].empty() && has(group_, names[i])) layer_.channels[i] = group_.prefix + std::string(names[i]);
      return true;
    };
    if (has(group_, "R") || has(group_, "G") || has(group_, "B")) return take({"R", "G", "B", "A"}, Kind::Colors);
    if (has(group_, "r") || has(group_, "g") || has(group_, "b")) return take({"r", "g", "b", "a"}, Kind::Colors);
    if (!has(group_, "Y") || (!group_.prefix.empty() && has(group_, "X"))) return false;
    if (has(group_, "RY") || has(group_, "BY")) return take({"RY", "Y", "BY", "A"}, Kind::Chroma);
    return take({"Y", "", "", "A"}, Kind::Grey);
  }

  /// Coordinates in their order, and alpha last; others in that of the file.
  ExrLayer data_layer(const std::string& name, std::vector<std::string> channels) const {
    const auto rank = [](const std::string& channel) {
      constexpr std::string_view order = "xyzuvw";
      const std::string lower = lower_case(channel);
      if (lower == "a") return std::size_t{256};
      return lower.size() == 1 ? std::min(order.find(lower), order.size()) : order.size();
    };
    std::ranges::stable_sort(channels, std::less<>(), rank);
    ExrLayer out = layer_;
    out.name = name;
    out.channels = {};
    out.has_colors = false;
    out.kind = channels.size() == 1 ? Kind::Grey : Kind::Colors;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const bool is_alpha = channels.size() > 1 && lower_case(channels[i]) == "a";
      out.channels[is_alpha ? 3 : i] = group_.prefix + channels[i];
    }
    return out;
  }

  using Kind = ExrLayer::Kind;
  const Group& group_;
  ExrLayer layer_;
};

/// The part of a channel name or layer name after its last full stop.
std::string last_component(const std::string& name) { return name.substr(name.rfind('.') + 1); }

/// The layer that a viewer would choose; nothing if none stands out.
std::optional<ExrLayer> find_obvious(std::span<const ExrLayer> layers) {
  std::vector<ExrLayer> colors;
  for (const ExrLayer& layer : layers)
    if (layer.has_colors) colors.push_back(layer);
  for (const ExrLayer& layer : colors)
    if (layer.prefix.empty()) return layer;
  if (colors.size() == 1) return colors[0];
  // The names of Blender, Arnold and RenderMan, Nuke, Cycles, V-Ray, and others.
  for (const std::string_view name : {"combined", "beauty", "rgba", "rgb", "color", "colour", "image", "composite"})
    for (const ExrLayer& layer : colors)
      if (lower_case(last_component(layer.name)) == name) return layer;
  if (colors.empty() && layers.size() == 1) return layers[0];
  return std::nullopt;
}

/// The layers with a name by the first of these readings that any has.
std::vector<ExrLayer> layers_named(std::span<const ExrPart> parts, std::span<const ExrLayer> layers,
                                   std::string_view name) {
  const std::string prefix = std::string(name) + '.', suffix = '.' + std::string(name);
  std::vector<ExrLayer> found;
  const auto keep = [&](const auto& fits) {
    if (found.empty()) std::ranges::copy_if(layers, std::back_inserter(found), fits);
  };
  keep([&](const ExrLayer& l) { return l.name == name; });
  keep([&](const ExrLayer& l) { return l.prefix == prefix; });
  if (!found.empty()) return found;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].name != name) continue;
    keep([&](const ExrLayer& l) { return l.part == static_cast<int>(i); });
    if (const std::optional<ExrLayer> obvious = find_obvious(found)) return {*obvious};
  }
  keep([&](const ExrLayer& l) { return l.name.ends_with(suffix); });
  if (!found.empty()) return found;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const ExrPartChannel& channel : parts[i].channels) {
      const bool has_part = parts.size() > 1 && parts[i].name + '.' + channel.name == name;
      if (channel.name != name && !has_part) continue;
      found.push_back({.part = static_cast<int>(i),
                       .name = std::string(name),
                       .prefix = prefix_of(channel.name),
                       .kind = ExrLayer::Kind::Grey,
                       .has_colors = false,
                       .channels = {channel.name}});
    }
  return found;
}

}  // namespace

std::vector<ExrLayer> exr_layers(std::span<const ExrPart> parts) {
  std::vector<ExrLayer> layers;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string name = parts.size() == 1 ? "" : parts[i].name.empty() ? std::to_string(i + 1) : parts[i].name;
    for (const Group& group : groups_of(parts[i])) LayerMaker(static_cast<int>(i), name, group).add_to(layers);
  }
  return layers;
}

std::string listed_exr_layers(std::span<const ExrLayer> layers) {
  constexpr std::size_t most = 40;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, layers.size()); ++i)
    text += (i == 0 ? "" : ", ") + printable(layers[i].name);
  return layers.size() > most ? fmt::format("{} and {} more", text, layers.size() - most) : text;
}

ExrLayer choose_exr_layer(std::span<const ExrPart> parts, std::string_view name, const std::string& file) {
  const std::vector<ExrLayer> layers = exr_layers(parts);
  const auto fail = [&](ErrorKind kind, const std::string& cause, std::span<const ExrLayer> listed) -> Error {
    return {kind, fmt::format("{}: EXR: {}: {}", file, cause, listed.empty() ? "none" : listed_exr_layers(listed))};
  };
  if (!name.empty()) {
    const std::vector<ExrLayer> named = layers_named(parts, layers, name);
    if (named.size() == 1) return named[0];
    if (named.empty()) throw fail(ErrorKind::Usage, fmt::format("has no layer '{}', only", name), layers);
    throw fail(ErrorKind::Usage, fmt::format("has several layers '{}'", name), named);
  }
  // Deep parts are refused by their kind, where there is nothing else.
  std::vector<ExrLayer> flat;
  std::ranges::copy_if(layers, std::back_inserter(flat),
                       [&](const ExrLayer& l) { return !parts[static_cast<std::size_t>(l.part)].is_deep; });
  if (const std::optional<ExrLayer> obvious = find_obvious(flat.empty() ? layers : flat)) return *obvious;
  throw fail(ErrorKind::Input, "has no channel R, G, B or Y, and which of its layers is the image is not stated",
             layers);
}

}  // namespace zoneplate
