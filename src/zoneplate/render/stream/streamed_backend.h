// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "zoneplate/render/backend.h"
#include "zoneplate/scene/stream/triangle_stream.h"

namespace zoneplate {

/// How many triangles of a stream are in memory at once. Capacities change the time, but no bit of an image.
struct StreamCapacity {
  std::size_t part = std::size_t{1} << 20;     ///< of which the visible ones are searched
  std::size_t visible = std::size_t{1} << 22;  ///< visible ones that are shaded
};

/// Errors    ErrorKind::Usage naming what depends on triangles that own no sample: shadows and occlusion, lines along
///           edges, methods that draw for themselves or have a history, patterns of more than 64 samples.
void check_streamed(const Request& request, const RenderOptions& options);

/// Renders scenes whose triangles do not fit into memory: for each frame the rasterizer on the CPU draws the triangles
/// of the stream that own a sample, of which there are at most as many as samples, and the alpha-tested and blended
/// ones before them. The scene that `render` takes is that of TriangleStream::head, with the same lights and materials;
/// its camera has to be chosen by all triangles.
///
/// Exact     the bits of make_cpu_backend for a scene with all triangles.
/// Errors    those of check_streamed; ErrorKind::Usage for surfaces that transmit light.
std::unique_ptr<Backend> make_streamed_backend(std::shared_ptr<const TriangleStream> stream,
                                               StreamCapacity capacity = {});

}  // namespace zoneplate
