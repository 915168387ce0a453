// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/taau/sample_mean.h"
#include "zoneplate/upscale/table/filter_table.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {

/// The groups of tables over frames: by the number of samples that a pixel of SampleMean rests on.
struct CountGroups {
  /// All of them are reached often in films of 24 frames, of which the table is made.
  static constexpr float bounds[] = {0.6f, 1.2f, 2, 3.2f};
  static constexpr FilterTable::Form form{5, 3};

  static Plane<std::uint8_t> of(const Plane<float>& counts);
};

/// A SampleMean, whose images a table filters by CountGroups; its history is not filtered.
///
/// Exact     as `filtered`.
template <class Mean, const FilterTable& (*table)()>
class FilteredMean {
 public:
  static constexpr int settling_periods = Mean::settling_periods, grain = Mean::grain;

  FilteredMean(int width, int height) : mean_(width, height) {}
  /// The image takes `memory` if that has its size.
  LinearImage accumulate(const TaauInput& frame, LinearImage memory = {}) {
    const LinearImage& image = mean_.accumulate(frame);
    return filtered(image, table(), CountGroups::of(mean_.counts()), std::move(memory));
  }

 private:
  Mean mean_;
};

/// That of `learned-table`.
const FilterTable& table_of_counts();
using TableMean = FilteredMean<SampleMean, table_of_counts>;

/// The groups of `learned-table-still`: on which side of the nearest input pixel's centre an output pixel is.
struct PhaseGroups {
  static constexpr FilterTable::Form form{4, 5};
};

/// An image in linear light, upscaled by bilinear interpolation, and the group of each output pixel.
struct Interpolated {
  LinearImage image;
  Plane<std::uint8_t> group;
};
Interpolated interpolated(const LinearImage& image, const UpscaleGrid& grid);

}  // namespace zoneplate::upscale
