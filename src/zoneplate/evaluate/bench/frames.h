// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/base/loop_times.h"
#include "zoneplate/render/render.h"

namespace zoneplate {

/// The measured frames, and the time budget.
struct BenchWork {
  std::string scene;
  int samples = 1;
  int2 size{1920, 1080};
  int anisotropy = 0;  ///< anisotropy of the base colours' texture filters; 0: the scene's own
  int frames = 30, warm_up = 2;
  double budget_ms = 4000;  ///< no frame starts after this time, except the first three
};

/// The times of frames of one scene.
struct BenchTiming {
  std::vector<double> frame_ms;
  double first_ms = 0;                   ///< time of the first frame, which includes page faults
  double processor_ms = 0;               ///< CPU time of all threads, per frame
  double others_busy = 0;                ///< mean number of processors that other programs used
  double geometry_ms = 0, tiles_ms = 0;  ///< minima
  double encode_ms = 0;                  ///< PNG encoding, the minimum of three
  int anisotropy = 1;                    ///< maximum anisotropy of the base colours' texture filters
  RenderCounts best;                     ///< of the fastest frame
};

/// Measures frames from the prepared scene to the 8-bit image in memory, on the threads of the innermost
/// `with_threads`, with the kernels of the innermost `with_isa`.
///
/// Errors    ErrorKind::Input for an unknown built-in scene.
BenchTiming time_frames(const BenchWork& work);

/// The loops of the fastest of several frames on one thread, for simulated schedules.
///
/// Errors    as time_frames.
WorkTimes time_frame_loops(const BenchWork& work);

double least(const std::vector<double>& v);
double median(std::vector<double> v);
double mean(const std::vector<double>& v);

}  // namespace zoneplate
