// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/reduce.h"

#include "zoneplate/imaging/signal/alpha.h"
#include "zoneplate/signal/filter/kernel.h"
#include "zoneplate/signal/filter/resample.h"

namespace zoneplate {

LinearImage resampled(const LinearImage& image, int width, int height, const std::string& kernel, Border border) {
  if (kernel == "nearest") return resample_nearest(image, width, height);
  if (kernel != "ideal") {
    const Kernel weights = make_kernel(kernel);
    LinearImage out = resample(image, width, height, weights, {.border = border});
    if (border == Border::Zero)
      set_alpha(out, resample(alpha_of(image), width, height, weights, {.border = Border::Clamp}));
    return out;
  }
  LinearImage out(width, height);
  for (float Linear::*channel : {&Linear::r, &Linear::g, &Linear::b, &Linear::a}) {
    Plane<float> plane(image.width(), image.height());
    for (std::size_t i = 0; i < plane.values().size(); ++i) plane.values()[i] = image.values()[i].*channel;
    plane = resample_ideal(plane, width, height);
    for (std::size_t i = 0; i < plane.values().size(); ++i) out.values()[i].*channel = plane.values()[i];
  }
  return out;
}

void check_reduction(const std::string& kernel) {
  if (kernel != "nearest" && kernel != "ideal") make_kernel(kernel);
}

}  // namespace zoneplate
