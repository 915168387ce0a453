// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/image/rgb.h"
#include "zoneplate/signal/border.h"

namespace zoneplate {

/// Resamples the image with a kernel's name, "nearest" or "ideal" (signal/filter/resample.h).
LinearImage resampled(const LinearImage& image, int width, int height, const std::string& kernel, Border border);

/// Errors    ErrorKind::Usage for an unknown name.
void check_reduction(const std::string& kernel);

}  // namespace zoneplate
