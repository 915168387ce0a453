// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/antialias/post/dlaa/blur.h"

/// DlaaKernels::blur_row over a function that blurs one pixel: blur_pixel(codes, stride, level_mask, upright_mask,
/// out).
namespace zoneplate::stages {

/// The weight of a long edge at a pixel, from the sum of the sixteen edge codes around.
[[gnu::always_inline]] inline float dlaa_mask(int sum) {
  return 2 * sum <= DlaaConstants::whole ? 0 : static_cast<float>(2 * sum) / DlaaConstants::whole - 1;
}

template <auto blur_pixel>
void dlaa_blur_row(const DlaaRows& rows, const std::uint8_t* seen, std::uint8_t* out, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    if (seen[i])
      blur_pixel(rows.codes + 4 * i, rows.stride, dlaa_mask(rows.level[i] - rows.edges[i]),
                 dlaa_mask(rows.upright[i] - rows.edges[i]), out + 4 * i);
}

}  // namespace zoneplate::stages
