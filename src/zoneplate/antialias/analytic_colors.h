#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/antialias/analytic_fragments.h"
#include "zoneplate/raster/points.h"

namespace zoneplate::antialias {

/// How large a fragment is for its shader: the side of its part of the pixel, in pixels.
struct Footprints {
  float part = 1;    ///< of most
  float masked = 1;  ///< of those with a masked layer, whose parts are finer
};

/// Gives fragments their colours: asks which masked layers are there, shades what is seen, lays it over from far to
/// near.
class FragmentColors {
 public:
  FragmentColors(const ProjectedDraws& projected, const PointShader& shader, Isa isa, const Target& target,
                 Footprints footprints);

  void find(const FragmentList& list);

  /// Of fragment number i of that list.
  Linear color(std::size_t i) const { return colors_[i]; }
  /// True if a surface that hides what is behind it is seen.
  bool is_closed(std::size_t i) const { return is_closed_[i]; }

  std::uint64_t shaded() const { return parts_.shader.shaded() + masked_.shader.shaded(); }

 private:
  /// Points of one footprint, with the places of their colours among all.
  struct Group {
    Group(const ProjectedDraws& projected, const PointShader& point_shader, Isa isa, Target of, float spacing);
    Group(const Group&) = delete;  // the shader looks at this target
    Target target;
    PointBatcher shader;
    std::vector<Point> points;
    std::vector<std::size_t> place;
    std::vector<Linear> colors;
  };
  /// A layer that is seen.
  struct Seen {
    std::size_t fragment;
    bool is_surface;
    Linear color;
  };

  void test_masks(const FragmentList& list);
  void find_seen(const FragmentList& list);
  void shade(Group& group);

  Group parts_, masked_;
  std::vector<std::uint8_t> is_there_;  ///< by masked layer, in the order of the fragments
  std::vector<Seen> seen_;              ///< fragment by fragment, near to far
  std::vector<Linear> colors_;          ///< by fragment
  std::vector<std::uint8_t> is_closed_;
};

}  // namespace zoneplate::antialias
