// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "zoneplate/formats/import/file_stream.h"
#include "zoneplate/job/job_sink.h"
#include "zoneplate/job/picture.h"

namespace zoneplate {

/// The file of a still image whose scene would take more memory than the job's limit, to be read in parts; null if it
/// may fit, or if its format is not read in parts. `request`: that of the job's method.
///
/// Errors    ErrorKind::Usage or ErrorKind::Input naming what needs the whole scene in memory, where that is too small.
std::unique_ptr<FileStream> open_streamed(const Job& job, const Request& request);

/// Reads, renders and encodes a still image whose triangles are read in parts (render/streamed_backend.h).
///
/// Exact     the files of the same job with all triangles in memory.
/// Errors    those of open_streamed.
void render_streamed(Job job, std::unique_ptr<Resolver> method, std::unique_ptr<FileStream> stream, JobSink& out,
                     Summary& summary);

}  // namespace zoneplate
