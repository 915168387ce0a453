// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/job/job.h"
#include "zoneplate/scene/camera.h"

namespace zoneplate {

/// The standard attributes of an image in OpenEXR: software, chromaticities, worldToCamera, worldToNDC, the distances
/// of the clip planes (cameraNearClip, cameraFarClip, as V-Ray writes them) and, of a frame of a sequence,
/// framesPerSecond and, up to 30 frames per second, timeCode: without dropped frames, frame 0 at 00:00:00:00, from 0
/// again after a day.
///
/// Space     those of OpenEXR: row vectors; camera space is left-handed and looks along +z; NDC is (0, 0) at the
///           top-left and (1, 1) at the bottom-right corner of the image, or of the crop. The world is that of the
///           file: `origin` is Scene::origin.
/// Source    OpenEXR, Standard Attributes, openexr.com.
ExrAttributes exr_header(const Job& job, const Camera& camera, double3 origin, std::optional<int> frame);

}  // namespace zoneplate
