#pragma once

#include <string>
#include <vector>

#include "zoneplate/render/render.h"

namespace zoneplate::cli {

/// What is timed, and for how long.
struct BenchWork {
  std::string scene;
  int samples = 1;
  int2 size{1920, 1080};
  int anisotropy = 0;  ///< of base colours' filters; 0: the scene's own
  int frames = 30, warm_up = 2;
  double budget_ms = 4000;  ///< no new frame after this time; three are drawn in any case
};

/// What frames of one scene took.
struct BenchTiming {
  std::vector<double> frame_ms;
  double first_ms = 0;                   ///< of the very first frame, which finds its memory
  double processor_ms = 0;               ///< of all threads, a frame
  double others_busy = 0;                ///< processors that others kept busy meanwhile
  double geometry_ms = 0, tiles_ms = 0;  ///< the least
  double encode_ms = 0;                  ///< the picture as PNG, the least of three
  int anisotropy = 1;                    ///< the greatest of a base colour's filters
  RenderCounts best;                     ///< of the frame that took least
};

/// A frame is everything from a scene that is ready to its 8-bit picture in memory, on the threads of the innermost
/// `with_threads`, with the kernels of the innermost `with_isa`.
///
/// Errors    ErrorKind::Input: no such built-in scene.
BenchTiming time_frames(const BenchWork& work);

double least(const std::vector<double>& v);
double median(std::vector<double> v);
double mean(const std::vector<double>& v);

}  // namespace zoneplate::cli
