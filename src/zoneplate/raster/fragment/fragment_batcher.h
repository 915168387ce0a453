// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/raster/fragment/fragment_list.h"
#include "zoneplate/raster/fragment/interpolate.h"
#include "zoneplate/raster/geometry/draw.h"
#include "zoneplate/raster/geometry/triangle_facing.h"
#include "zoneplate/raster/types/fragment_shader.h"
#include "zoneplate/raster/types/target.h"

namespace zoneplate {

/// A fragment to be shaded: a position of a triangle on the screen, and the samples that take its colour.
struct Fragment {
  std::int32_t x, y;      ///< 1/256 pixel from the image's top-left corner
  std::int32_t id;        ///< triangle
  std::uint32_t pixel;    ///< within the tile
  std::uint64_t samples;  ///< the samples of the pixel that take its colour; 0: the pixel has none
};

/// Eight fragments of one triangle in neighbouring pixels of a row, at the same position in each pixel.
struct FragmentSpan {
  std::int32_t x, y;    ///< position of the first fragment; the others follow a pixel apart
  std::int32_t id;      ///< triangle
  std::uint32_t pixel;  ///< of the first fragment, within the tile
};

/// Results of shading other than colour, by fragment (OutputMask).
struct FragmentData {
  std::vector<float3> normal, albedo;
  std::vector<float2> uv;
  std::vector<float2> footprint;  ///< mip level, anisotropy
};

/// Shades lists of fragments in batches of one material.
class FragmentBatcher {
 public:
  FragmentBatcher(const ProjectedDraws& projected, const FragmentShader& shader, const Target& target);
  FragmentBatcher(const FragmentBatcher&) = delete;  // has pointers to its own members

  /// The colours of the fragments, in their order. `data`, if not null, receives
  /// the data for which the target has planes.
  void shade(std::span<const Fragment> fragments, std::vector<Linear>& colors, FragmentData* data);
  /// Computes the data only: materials and lights are not evaluated.
  void shade_data(std::span<const Fragment> fragments, FragmentData& data);

  /// Shades spans: use(numbers, shaded) is called for parts of the list, with the indices of their spans; the colours
  /// of these spans follow each other in `shaded`.
  template <class Use>
  void shade(std::span<const FragmentSpan> rows, Use use) {
    shade(
        rows, [](std::span<const std::uint32_t>) {}, use);
  }
  /// The same; begin(numbers) is called before these spans are shaded.
  template <class Begin, class Use>
  void shade(std::span<const FragmentSpan> rows, Begin begin, Use use);

  /// Shades spans in the order of the list: use(shaded, first, count) is called for consecutive parts of `count` spans
  /// from span `first` on, whose colours begin at entry 0 of `shaded`.
  template <class Use>
  void shade_in_order(std::span<const FragmentSpan> rows, Use use);

  /// Shades a list: use(shaded, first, count) is called for consecutive parts of `count` fragments from fragment
  /// `first` on, whose colours begin at entry 0 of `shaded`.
  template <class Use>
  void shade(const FragmentList& list, Use use);

  /// Tests alpha: is_there[i] is 1 if the alpha of fragment i is at least the cutoff, otherwise 0.
  void test_alpha(std::span<const Fragment> fragments, std::vector<std::uint8_t>& is_there);

  /// The differences of the fragments' alpha and the cutoff; a surface is present where its margin is not negative.
  void evaluate_alpha_margins(std::span<const Fragment> fragments, std::vector<float>& margins);

  std::uint64_t shaded() const { return shaded_; }
  /// The number of fragments whose data were evaluated without shading.
  std::uint64_t evaluated() const { return evaluated_; }

 private:
  /// The draw of the last triangle.
  struct CurrentDraw {
    const Draw* draw = nullptr;
    const ScreenVertex* screen = nullptr;  ///< null if they are not stored
    std::size_t number = 0;
    std::int32_t begin = 0, end = 0;  ///< its triangles
  };
  /// The last triangle that needed clipping.
  struct CurrentClipped {
    std::int32_t id = -1;
    TriangleFacing facing;
  };

  void shade_outputs(std::span<const Fragment> fragments, std::vector<Linear>* colors, FragmentData* data);
  template <class T>
  std::span<const std::uint32_t> order_by_material(std::span<const T> list);
  std::size_t same_material(std::span<const std::uint32_t> order, std::size_t first, std::size_t most) const;
  template <class Use>
  void for_batches(std::span<const Fragment> fragments, Use use);
  void number_up_to(std::size_t count);
  void select_draw(std::int32_t id);
  bool are_of_one_draw(const FragmentList& list);
  void shade_mixed(const FragmentList& list);
  int material_of(std::int32_t id);
  void prefetch_triangle(std::int32_t id) const;
  void fill(std::span<const Fragment> fragments, std::span<const std::uint32_t> numbers);
  void fill(std::span<const FragmentSpan> rows, std::span<const std::uint32_t> numbers);
  void fetch_vertices(const FragmentList& list, std::size_t first);
  void fill(const FragmentList& list, std::size_t first, std::size_t count);
  float coverage_of(std::uint64_t samples) const;
  void store_triangle(std::size_t i, std::int32_t id);
  void interpolate();
  const TriangleFacing& clipped_facing(std::int32_t id);
  void store_planes(std::size_t i, const BarycentricPlanes& planes);
  static_assert(FragmentBatch::groups <= 32);  // a bit each
  std::int32_t is_front(std::size_t leader, const TriangleFacing& facing) const;
  int interpolate_clipped_rows(int group, float spacing);
  void interpolate_clipped(std::size_t group, float spacing);
  void weigh_segment_vertices();

  const ProjectedDraws& projected_;
  const FragmentShader& shader_;
  const InterpolateKernels& interpolate_;
  const Target& target_;
  const bool has_segments_;      ///< some draw has lines or points
  const bool has_one_material_;  ///< all draws share theirs
  const bool needs_coverage_;
  std::uint64_t shaded_ = 0, evaluated_ = 0;

  std::vector<std::uint32_t> identity_order_;    ///< 0, 1, 2 ...
  std::vector<std::uint32_t> order_, material_;  ///< of a list with several materials; otherwise empty
  int one_material_ = 0;                         ///< of a list with one material
  CurrentDraw current_;
  CurrentClipped current_clipped_;
  FragmentShader::VertexMemory vertex_memory_;  ///< of the draw of the list
  FragmentBatch batches_[2];
  FragmentBatch *batch_ = &batches_[0],
                *next_ = &batches_[1];  ///< within a list, the vertices of `next_` are prefetched
  BatchTriangles triangles_{};
  ScreenVertex computed_vertices_[3]
                                 [FragmentBatch::padded_capacity];  ///< of draws whose screen vertices are not stored
  ClippedGroup clipped_{};
  FragmentOutputs shaded_batch_;
  std::vector<Fragment> mixed_;           ///< the fragments of a list with several draws
  std::vector<FragmentOutputs> unmixed_;  ///< their colours in the order of the list, a batch's capacity each
};

template <class Begin, class Use>
void FragmentBatcher::shade(std::span<const FragmentSpan> rows, Begin begin, Use use) {
  const auto order = order_by_material(rows);
  shaded_ += rows.size() * FragmentBatch::group;
  for (std::size_t first = 0; first < rows.size();) {
    const std::size_t count = same_material(order, first, FragmentBatch::capacity / FragmentBatch::group);
    const auto numbers = order.subspan(first, count);
    begin(numbers);
    fill(rows, numbers);
    shader_.shade(*batch_, {}, shaded_batch_);
    use(numbers, shaded_batch_);
    first += count;
  }
}

template <class Use>
void FragmentBatcher::shade(const FragmentList& list, Use use) {
  constexpr std::size_t capacity = FragmentBatch::capacity;
  const auto total = static_cast<std::size_t>(list.count);
  shaded_ += total;
  if (are_of_one_draw(list)) {
    if (total > 0) fetch_vertices(list, 0);
    for (std::size_t first = 0; first < total; first += capacity) {
      const std::size_t count = std::min(capacity, total - first);
      fill(list, first, count);
      shader_.shade(*batch_, {}, shaded_batch_);
      use(shaded_batch_, first, count);
    }
    return;
  }
  shade_mixed(list);
  for (std::size_t first = 0; first < total; first += capacity)
    use(unmixed_[first / capacity], first, std::min(capacity, total - first));
}

template <class Use>
void FragmentBatcher::shade_in_order(std::span<const FragmentSpan> rows, Use use) {
  constexpr std::size_t most = FragmentBatch::capacity / FragmentBatch::group;
  number_up_to(rows.size());
  material_.clear();
  shaded_ += rows.size() * FragmentBatch::group;
  for (std::size_t first = 0; first < rows.size();) {
    one_material_ = material_of(rows[first].id);
    std::size_t count = 1;
    const auto is_alike = [&](std::size_t i) {
      return rows[i].id == rows[i - 1].id || material_of(rows[i].id) == one_material_;
    };
    while (first + count < rows.size() && count < most && is_alike(first + count)) ++count;
    fill(rows, std::span<const std::uint32_t>(identity_order_).subspan(first, count));
    shader_.shade(*batch_, {}, shaded_batch_);
    use(shaded_batch_, first, count);
    first += count;
  }
}

}  // namespace zoneplate
