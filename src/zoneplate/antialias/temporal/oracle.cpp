// SPDX-License-Identifier: Apache-2.0
// Temporal antialiasing by reprojection with exact visibility: history is kept exactly where the last frame's camera
// saw the same surface point. An engine estimates this from depths, ids and colours; here rays to the triangles of the
// last frame decide, and motion is exact.
//
// History of n frames has the weight n - 1 to 1, up to n = `most`. It is rectified (variance clip) only where surfaces
// of different motion meet, since a pixel has one history for all of its surfaces, and where its luma changes beyond
// that of earlier frames. Weaknesses, which therefore are those of reprojection itself: history between pixels is
// filtered in every frame, and edges between surfaces of different motion have few samples.
#include "zoneplate/antialias/temporal/accumulation.h"

namespace zoneplate::antialias {
namespace {

constexpr std::string_view filters[] = {"bilinear", "catmull5", "catmull9"};
constexpr Param params[] = {
    {.name = "history", .meaning = "filter of the history between pixels", .value = 2, .names = filters},
    {.name = "most", .meaning = "frames of which the history is a mean, at most", .value = 64, .low = 2, .high = 4096},
    {.name = "length",
     .meaning = "number of Halton points before the jitter repeats",
     .value = 16,
     .low = 1,
     .high = 1024},
};

std::unique_ptr<Resolver> make(const Settings& s) {
  using Parts = TemporalParts;
  TemporalOptions options{.parts = {.dilation = Parts::Dilation::None,
                                    .filter = static_cast<Parts::Filter>(s.integer("history")),
                                    .rejection = Parts::Rejection::Unseen,
                                    .trusts_rest = true,
                                    .blend = Parts::Blend::Count,
                                    .least_weight = 1 / static_cast<float>(s.integer("most"))},
                          .length = s.integer("length"),
                          .settling_frames = s.integer("most")};
  return std::make_unique<TemporalAccumulation>(options);
}

}  // namespace

Method oracle_taa() {
  return {.name = "oracle-taa",
          .summary = "temporal antialiasing with exact visibility of surface points in the last frame, by rays",
          .source = "Zoneplate",
          .params = params,
          .make = make,
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
