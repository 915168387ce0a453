// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/antialias/reference/analytic/colors.h"

#include <algorithm>
#include <cmath>

namespace zoneplate::antialias {
namespace {

Fragment point_of(const AreaFragment& f, std::int32_t id) {
  // The centroid of a sliver with numerically no area may be outside the pixel, and is clamped.
  const AreaMoments& m = f.moments;
  const auto within = [&](double moment) {
    const double at = m.area > 0 ? moment / m.area : 0.5;
    return static_cast<std::int32_t>(std::floor((at > 0 ? at < 1 ? at : 1.0 : 0.0) * 256 + 0.5));
  };
  return {f.x * 256 + within(m.x), f.y * 256 + within(m.y), id, 0, 0};
}

}  // namespace

AreaFragmentColors::Group::Group(const ProjectedDraws& projected, const FragmentShader& point_shader, Target of,
                                 float spacing)
    : target(std::move(of)), shader(projected, point_shader, target) {
  target.spacing = spacing;
}

AreaFragmentColors::AreaFragmentColors(const ProjectedDraws& projected, const FragmentShader& shader,
                                       const Target& target, Footprints footprints)
    : parts_(projected, shader, target, footprints.part), fine_(projected, shader, target, footprints.fine) {}

void AreaFragmentColors::find(const AreaFragmentTable& table) {
  seen_.clear();
  for (Group* group : {&parts_, &fine_}) group->fragments.clear(), group->place.clear();
  for (std::size_t i = 0; i < table.fragments().size(); ++i) {
    const AreaFragment& f = table.fragments()[i];
    Group& group = f.is_fine ? fine_ : parts_;
    for (const Layer& layer : table.layers_of(f)) {
      group.fragments.push_back(point_of(f, layer.id));
      group.place.push_back(seen_.size());
      seen_.push_back({i, layer.alpha_mode != AlphaMode::Blend, {}});
    }
  }
  shade(parts_);
  shade(fine_);
  colors_.assign(table.fragments().size(), Linear{0, 0, 0, 0});
  for (std::size_t i = seen_.size(); i-- > 0;) {
    const Seen& layer = seen_[i];
    Linear& color = colors_[layer.fragment];
    color = layer.is_surface ? layer.color : layer.color + color * (1 - layer.color.a);
  }
}

void AreaFragmentColors::shade(Group& group) {
  group.shader.shade(group.fragments, group.colors, nullptr);
  for (std::size_t i = 0; i < group.fragments.size(); ++i) seen_[group.place[i]].color = group.colors[i];
}

}  // namespace zoneplate::antialias
