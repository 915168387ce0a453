// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/scene/camera.h"

namespace zoneplate::lessons {

/// The built-in wheel, rendered at every `1 / steps` of a spoke. All animations use these images, because a turn by one
/// spoke gives the same image.
///
/// Units     turns in steps; positive is clockwise, as of a wheel that rolls to the right.
struct WheelFilm {
  int spokes = 12, steps = 40;
  Camera camera;
  std::vector<LinearImage> instants;  ///< opaque, linear light

  const LinearImage& at(int step) const;
};

WheelFilm film_wheel(int spokes, int steps, int side);

/// The image of a shutter that opens at `first` and closes `count` steps later: the mean of that many instants. All
/// frames are offset by the same half step.
LinearImage exposed(const WheelFilm& film, int first, int count);

/// The mean luminance of an image over the rings between hub and rim, as a function of the angle within one spoke's
/// sector, clockwise: the average over all sectors.
std::vector<double> spoke_profile(const WheelFilm& film, const LinearImage& picture);

/// The displacement of profile `b` relative to `a`, in spokes in (-½, ½]: the peak of their correlation.
double displacement(const std::vector<double>& a, const std::vector<double>& b);

/// The amplitude of the profile's wave with a period of one spoke.
double fundamental(const std::vector<double>& profile);

}  // namespace zoneplate::lessons
