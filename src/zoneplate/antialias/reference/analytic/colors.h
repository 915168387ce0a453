#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/antialias/reference/analytic/fragments.h"
#include "zoneplate/raster/fragment/fragment_batcher.h"

namespace zoneplate::antialias {

/// How large a fragment is for its shader: the side of its part of the pixel, in pixels.
struct Footprints {
  float part = 1;        ///< of most
  float fine = 1;        ///< of those in a part of the masked surfaces' grid: half of its side
  float alpha = 1;       ///< of a place where alpha is tested
  float alpha_part = 1;  ///< where alpha is asked for a whole part of that grid
};

/// Gives fragments their colours: shades their layers and lays them over each other from far to near.
class AreaFragmentColors {
 public:
  AreaFragmentColors(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target,
                     Footprints footprints);

  void find(const AreaFragmentTable& table);

  /// Of fragment number i of that table.
  Linear color(std::size_t i) const { return colors_[i]; }

  std::uint64_t shaded() const { return parts_.shader.shaded() + fine_.shader.shaded(); }

 private:
  /// Points of one footprint, with the places of their colours among all.
  struct Group {
    Group(const ProjectedDraws& projected, const FragmentShader& point_shader, Target of, float spacing);
    Group(const Group&) = delete;  // the shader looks at this target
    Target target;
    FragmentBatcher shader;
    std::vector<Fragment> points;
    std::vector<std::size_t> place;
    std::vector<Linear> colors;
  };
  /// A layer of a fragment.
  struct Seen {
    std::size_t fragment;
    bool is_surface;  ///< it hides what is behind it
    Linear color;
  };

  void shade(Group& group);

  Group parts_, fine_;
  std::vector<Seen> seen_;      ///< fragment by fragment, near to far
  std::vector<Linear> colors_;  ///< by fragment
};

}  // namespace zoneplate::antialias
