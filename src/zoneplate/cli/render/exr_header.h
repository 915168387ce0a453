// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/cli/render/args.h"
#include "zoneplate/codec/exr_encode.h"
#include "zoneplate/scene/camera.h"

namespace zoneplate::cli {

/// The standard attributes of an image in OpenEXR: software, chromaticities, worldToCamera, worldToNDC and, of a
/// sequence, framesPerSecond.
///
/// Space     those of OpenEXR: row vectors; camera space is left-handed and looks along +z; NDC is (0, 0) at the
///           top-left and (1, 1) at the bottom-right corner of the image, or of the crop.
/// Source    OpenEXR, Standard Attributes, openexr.com.
ExrAttributes exr_header(const RenderArgs& args, const Camera& camera);

}  // namespace zoneplate::cli
