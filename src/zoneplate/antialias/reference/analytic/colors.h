// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/antialias/reference/analytic/fragments.h"
#include "zoneplate/raster/fragment/fragment_batcher.h"

namespace zoneplate::antialias {

/// The texture footprint of fragments: the side of a fragment's part of the pixel, in pixels.
struct Footprints {
  float part = 1;        ///< of most fragments
  float fine = 1;        ///< of fragments in a part of the grid of alpha-tested surfaces: half of its side
  float alpha = 1;       ///< of alpha tests at a point
  float alpha_part = 1;  ///< of alpha tests for a whole part of that grid
};

/// Computes the colours of fragments: shades their layers and composites them from far to near.
class AreaFragmentColors {
 public:
  AreaFragmentColors(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target,
                     Footprints footprints);

  void find(const AreaFragmentTable& table);

  /// The colour of fragment i of that table.
  Linear color(std::size_t i) const { return colors_[i]; }

  std::uint64_t shaded() const { return parts_.shader.shaded() + fine_.shader.shaded(); }

 private:
  /// Fragments of one footprint, with the indices of their colours.
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
    bool is_surface;  ///< opaque: hides all layers behind it
    Linear color;
  };

  void shade(Group& group);

  Group parts_, fine_;
  std::vector<Seen> seen_;      ///< fragment by fragment, near to far
  std::vector<Linear> colors_;  ///< by fragment
};

}  // namespace zoneplate::antialias
