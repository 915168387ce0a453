// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/antialias/reference/analytic/fragments.h"
#include "zoneplate/raster/fragment/fragment_batcher.h"

namespace zoneplate::antialias {

/// The sides of texture footprints, in pixels.
struct Footprints {
  float part = 1;  ///< of most fragments: the side of a part of the pixel
  /// The side for fragments in a part of the finer grid for alpha-tested surfaces: half of the part's side.
  float fine = 1;
  float alpha = 1;       ///< of alpha tests at a point
  float alpha_part = 1;  ///< of alpha tests for a whole part of the finer grid
};

/// Computes the colours of fragments: shades their layers and composites them from far to near.
class AreaFragmentColors {
 public:
  AreaFragmentColors(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target,
                     Footprints footprints);

  void find(const AreaFragmentTable& table);

  /// The colour of fragment i of the table that was passed to `find`.
  Linear color(std::size_t i) const { return colors_[i]; }

  std::uint64_t shaded() const { return parts_.shader.shaded() + fine_.shader.shaded(); }

 private:
  /// Fragments of one footprint, with the indices of their colours.
  struct Group {
    Group(const ProjectedDraws& projected, const FragmentShader& point_shader, Target of, float spacing);
    Group(const Group&) = delete;  // the shader stores a reference to this target
    Target target;
    FragmentBatcher shader;
    std::vector<Fragment> fragments;
    std::vector<std::size_t> place;
    std::vector<Linear> colors;
  };
  /// A layer of a fragment.
  struct Seen {
    std::size_t fragment;
    bool is_surface;  ///< opaque or alpha-tested: hides all layers behind it
    Linear color;
  };

  void shade(Group& group);

  Group parts_, fine_;
  std::vector<Seen> seen_;      ///< fragment by fragment, near to far
  std::vector<Linear> colors_;  ///< by fragment
};

}  // namespace zoneplate::antialias
