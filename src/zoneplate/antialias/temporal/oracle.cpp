// SPDX-License-Identifier: Apache-2.0
// Temporal antialiasing by what only a renderer knows: which objects a pixel has and how much of it each covers, how
// their points move, and which of them the last frame's camera saw. An engine estimates this from one sample per pixel,
// its depth and its colours. The shaded samples are the same as those of `taa`: one per pixel and frame.
//
// Weaknesses, which therefore are those of averaging over frames itself: history between pixels is filtered in every
// frame, where an object appears it has few samples, and a change of light is noticed by its luma only.
#include "zoneplate/antialias/temporal/surface_history.h"

namespace zoneplate::antialias {
namespace oracle_method {
namespace {

constexpr Param params[] = {
    {.name = "most", .meaning = "frames of which the history is a mean, at most", .value = 64, .low = 2, .high = 4096},
    {.name = "length",
     .meaning = "number of Halton points before the jitter repeats",
     .value = 16,
     .low = 1,
     .high = 1024},
    {.name = "coverage", .meaning = "visibility samples per pixel", .value = 16, .low = 1, .high = 64},
};

}  // namespace
}  // namespace oracle_method

Method oracle_taa() {
  return {.name = "oracle-taa",
          .summary =
              "one shaded sample per frame, with history by object and exact visibility, by further samples and rays",
          .source = "Zoneplate",
          .params = oracle_method::params,
          .make = [](const Settings& s) -> std::unique_ptr<Resolver> {
            return std::make_unique<SurfaceHistory>(SurfaceHistory::Options{
                .most = s.integer("most"), .length = s.integer("length"), .coverage = s.integer("coverage")});
          },
          .is_specification_only = true};
}

}  // namespace zoneplate::antialias
