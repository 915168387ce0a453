// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/fsr1/rcas.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::upscale {

struct Fsr1Options {
  bool sharpens = true;  ///< the second pass; its reciprocals are those of both passes
  RcasOptions rcas;
};

/// Upscales a display-referred image by FSR 1.
DisplayImage upscale_fsr1(const DisplayImage& image, const UpscaleGrid& grid, const Fsr1Options& options);

}  // namespace zoneplate::upscale
