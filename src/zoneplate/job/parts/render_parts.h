// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "zoneplate/base/ranks/ranks.h"
#include "zoneplate/job/job_sink.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/raster/parts/partition.h"
#include "zoneplate/raster/parts/rasterize_parts.h"

namespace zoneplate {

/// A still image that ranks render together.
struct PartsJob {
  Job job;  ///< completed by check_job; its input is the first of `inputs`
  /// One model, which every rank reads and of which each draws a part; or several, which form one scene, and of which
  /// each rank reads some.
  std::vector<std::string> inputs;
  Partition partition = Partition::Index;  ///< of one model
};

/// Reads, renders and encodes the job. Every rank calls it; rank 0 sends the files to `out`, after each rank has done
/// its part.
///
/// `agree` is called where a rank may fail alone, with what may fail; it throws on every rank, or on none.
/// Exact     the files are those of one rank, for any number of ranks; those of one model are those of RenderJobs.
/// Errors    ErrorKind::Usage naming what several ranks, or several files, cannot render exactly.
Summary render_parts(PartsJob parts, Ranks& ranks, const std::function<void(const std::function<void()>&)>& agree,
                     JobSink& out, PartTimes& times);

}  // namespace zoneplate
