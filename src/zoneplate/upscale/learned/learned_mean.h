// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/upscale/learned/learned_network.h"
#include "zoneplate/upscale/taau/sample_mean.h"
#include "zoneplate/upscale/table/learned_table.h"

namespace zoneplate::upscale {

/// SampleMean of frames of half the output's size, whose weights, count and clamp a network corrects. Corrections of 0
/// leave SampleMean.
///
/// Exact     the same bits for any number of threads and any instruction set; one colour stays that colour.
class LearnedMean : public SampleMean {
 public:
  LearnedMean(int width, int height, const network::Network& network = LearnedNetwork::trained());
  ~LearnedMean() override;

 private:
  void resolve(const Known& known, Output& out) override;

  struct Work;

  const network::Network& network_;
  std::unique_ptr<Work> work_;
};

/// The filters of `learned`, which the program contains.
const FilterTable& learned_filters();
/// The images of `learned`.
using FilteredLearned = FilteredMean<LearnedMean, learned_filters>;

}  // namespace zoneplate::upscale
