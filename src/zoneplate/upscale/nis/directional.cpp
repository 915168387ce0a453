// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/nis/directional.h"

#include <algorithm>

#include "zoneplate/math/lanes.h"
#include "zoneplate/upscale/nis/directional_lanes.h"

namespace zoneplate {

NisConstants::NisConstants(float sharpness) {
  const float slider = sharpness - 0.5f;
  const float most = slider >= 0 ? 1.25f : 1.75f, least = slider >= 0 ? 1.25f : 1.0f;
  detect_ratio = 2 * 1127.0f / 1024, detect_threshold = 64.0f / 1024;
  min_contrast = 2, contrast_scale = 1.0f / (10 - 2);
  first_luma = 0.45f, luma_scale = 1 / (0.9f - 0.45f);
  strength = std::max(0.0f, 0.4f + slider * least * 1.2f);
  strength_scale = 1.6f + slider * most * 1.8f - strength;
  limit = std::max(0.1f, 0.14f + slider * least * 0.32f);
  limit_scale = 0.5f + slider * least * 0.6f - limit;
}

template <>
const NisKernels PerIsa<NisKernels>::scalar = stages::nis<scalar::Float, scalar::OneFloat>();

}  // namespace zoneplate
