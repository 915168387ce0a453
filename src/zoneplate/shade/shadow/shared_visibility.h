// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "zoneplate/shade/shadow/light_visibility.h"
#include "zoneplate/shade/shadow/traced_visibility.h"
#include "zoneplate/shade/shadow/visibility_grid.h"

namespace zoneplate {

/// Sets entry i of `out` to what the centre of pixels[i] shows, and found[i]; false where that is nothing. At most
/// FragmentBatch::capacity pixels.
using ReceiversOfPixels =
    std::function<void(std::span<const PixelPosition> pixels, Receivers& out, std::span<bool> found)>;

/// Visibility by rays of some points of each surface, interpolated between them where it is smooth.
///
/// Each light, and the environment, has grids of ever smaller steps (visibility_grid.h), from its option's spacing by
/// halves down to 3, and one of all pixels, each with half of the rays. A fragment takes the value of the first
/// grid that determines one, else it has its own rays: at edges of surfaces and of shadows. Their number is in
/// proportion to the part of the pixel that the fragment covers: the pixel's error is then about that of a single
/// fragment with all rays.
/// Exact     the same bits for any number of threads, any instruction set and any crop.
class SharedVisibility : public LightVisibility {
 public:
  /// The size of the image, and what its pixels show of surfaces and of the ground.
  struct Image {
    int width = 0, height = 0;
    ReceiversOfPixels surfaces, ground;
  };

  /// `lights`: how many. Requires: `rays` and what `image` refers to outlive this object.
  SharedVisibility(const TracedVisibility& rays, int lights, const ShadowOptions& shadows,
                   const OcclusionOptions& occlusion, Image image);

  void of_light(int k, const Receivers& receivers, float* visible) const override;
  bool needs_footprint() const override { return rays_.needs_footprint(); }
  bool needs_coverage() const override { return true; }
  bool has_occlusion() const override { return rays_.has_occlusion(); }
  void of_environment(const Receivers& receivers, float* visible) const override;

 private:
  using Grids = std::vector<std::unique_ptr<VisibilityGrid>>;  ///< the coarsest first
  struct Query {
    Grids surfaces, ground;
  };
  /// What the rays give, and whether they give anything at receiver i.
  struct Rays {
    std::function<void(const Receivers& receivers, float* visible)> trace;
    std::function<bool(const Receivers& receivers, int i)> is_lit;
  };
  /// Without grids if there are few samples.
  Query make_query(int spacing, int samples) const;
  void share(const Query& query, const Receivers& receivers, const Rays& rays, float* visible) const;
  void evaluate(bool is_ground, std::uint8_t times, std::span<const PixelPosition> pixels, const Rays& rays,
                VisibilityGrid::Value* values) const;

  const TracedVisibility& rays_;
  Image image_;
  std::vector<Query> lights_;  ///< empty: every fragment has its own rays
  Query environment_;
};

}  // namespace zoneplate
