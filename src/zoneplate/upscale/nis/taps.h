// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/upscale/nis/directional.h"

namespace zoneplate {

/// The filters of NIS: of six taps, by the phase between two pixels in 64ths. The rows of `scale` have the sum 1 within
/// 1e-4, those of `sharpening` 0 within 6e-4.
///
/// Source    NVIDIA Image Scaling SDK 1.0.3, NIS_Config.h: coef_scale, coef_usm.
NisTaps nis_taps();

}  // namespace zoneplate
