#include "zoneplate/antialias/analytic_colors.h"

#include <algorithm>
#include <cmath>

namespace zoneplate::antialias {
namespace {

bool is_masked(const Layer& layer) { return layer.surface == Surface::Masked; }

Point point_of(const Fragment& f, std::int32_t id) {
  // A sliver too thin for its own area has its centroid anywhere in the pixel.
  const AreaMoments& m = f.moments;
  const auto within = [&](double moment) {
    const double at = m.area > 0 ? moment / m.area : 0.5;
    return static_cast<std::int32_t>(std::floor((at > 0 ? at < 1 ? at : 1.0 : 0.0) * 256 + 0.5));
  };
  return {f.x * 256 + within(m.x), f.y * 256 + within(m.y), id, 0, 0};
}

}  // namespace

FragmentColors::Group::Group(const ProjectedDraws& projected, const PointShader& point_shader, Isa isa, Target of,
                             float spacing)
    : target(std::move(of)), shader(projected, point_shader, isa, target) {
  target.spacing = spacing;
}

FragmentColors::FragmentColors(const ProjectedDraws& projected, const PointShader& shader, Isa isa,
                               const Target& target, Footprints footprints)
    : parts_(projected, shader, isa, target, footprints.part),
      masked_(projected, shader, isa, target, footprints.masked) {}

void FragmentColors::find(const FragmentList& list) {
  test_masks(list);
  find_seen(list);
  shade(parts_);
  shade(masked_);
  colors_.assign(list.fragments().size(), Linear{0, 0, 0, 0});
  for (std::size_t i = seen_.size(); i-- > 0;) {
    const Seen& layer = seen_[i];
    Linear& color = colors_[layer.fragment];
    color = layer.is_surface ? layer.color : layer.color + color * (1 - layer.color.a);
  }
}

void FragmentColors::test_masks(const FragmentList& list) {
  masked_.points.clear();
  for (const Fragment& f : list.fragments())
    for (const Layer& layer : list.layers_of(f))
      if (is_masked(layer)) masked_.points.push_back(point_of(f, layer.id));
  is_there_.clear();
  if (!masked_.points.empty()) masked_.shader.test_alpha(masked_.points, is_there_);
}

void FragmentColors::find_seen(const FragmentList& list) {
  seen_.clear();
  is_closed_.assign(list.fragments().size(), 0);
  for (Group* group : {&parts_, &masked_}) group->points.clear(), group->place.clear();
  std::size_t mask = 0;
  for (std::size_t i = 0; i < list.fragments().size(); ++i) {
    const Fragment& f = list.fragments()[i];
    const auto layers = list.layers_of(f);
    Group& group = std::any_of(layers.begin(), layers.end(), is_masked) ? masked_ : parts_;
    for (const Layer& layer : layers) {
      const bool is_there = !is_masked(layer) || is_there_[mask++];
      if (is_closed_[i] || !is_there) continue;
      is_closed_[i] = layer.surface != Surface::Blended;
      group.points.push_back(point_of(f, layer.id));
      group.place.push_back(seen_.size());
      seen_.push_back({i, is_closed_[i] != 0, {}});
    }
  }
}

void FragmentColors::shade(Group& group) {
  group.shader.shade(group.points, group.colors, nullptr);
  for (std::size_t i = 0; i < group.points.size(); ++i) seen_[group.place[i]].color = group.colors[i];
}

}  // namespace zoneplate::antialias
