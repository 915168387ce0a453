// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/taau/sample_mean.h"
#include "zoneplate/upscale/table/filter_table.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {

/// The groups of `learned-table`: by the number of samples that a pixel of SampleMean rests on.
struct CountGroups {
  /// All of them are reached often in films of 24 frames, of which the table is made.
  static constexpr float bounds[] = {0.6f, 1.2f, 2, 3.2f};
  static constexpr int groups = 5;

  static Plane<std::uint8_t> of(const Plane<float>& counts);
};

/// SampleMean, whose images a table filters; its history is not filtered.
class TableMean {
 public:
  static constexpr int settling_periods = SampleMean::settling_periods, grain = SampleMean::grain;

  TableMean(int width, int height) : mean_(width, height) {}
  LinearImage accumulate(const TaauInput& frame);

 private:
  SampleMean mean_;
};

/// The groups of `learned-table-still`: on which side of the nearest input pixel's centre an output pixel is.
struct PhaseGroups {
  static constexpr int groups = 4;
};

/// An image in linear light, upscaled by bilinear interpolation, and the group of each output pixel.
struct Interpolated {
  LinearImage image;
  Plane<std::uint8_t> group;
};
Interpolated interpolated(const LinearImage& image, const UpscaleGrid& grid);

}  // namespace zoneplate::upscale
