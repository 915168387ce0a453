#pragma once

#include <vector>

#include "zoneplate/image/rgb.h"
#include "zoneplate/scene/camera.h"

namespace zoneplate::cli {

/// The built-in wheel, rendered at every `1 / steps` of a spoke: any film of it is made of these pictures, because one
/// spoke further it looks the same.
///
/// Units     turns in steps; positive is clockwise, as a wheel that rolls to the right.
struct WheelFilm {
  int spokes = 12, steps = 40;
  Camera camera;
  std::vector<LinearImage> instants;  ///< opaque, linear light

  const LinearImage& at(int step) const;
};

WheelFilm film_wheel(int spokes, int steps, int side);

/// The picture of a shutter that opens at `first` and closes `count` steps later: the mean of that many instants, in
/// the middles of the steps but for half a step, which changes no frame against another.
LinearImage exposed(const WheelFilm& film, int first, int count);

/// The mean luminance of a picture over the rings between hub and rim, as a function of the place within a spoke's
/// share of the circle, clockwise: what is there `spokes` times, and nothing else.
std::vector<double> spoke_profile(const WheelFilm& film, const LinearImage& picture);

/// How far profile `b` lies ahead of `a`, in spokes in (-½, ½]: the peak of their correlation.
double displacement(const std::vector<double>& a, const std::vector<double>& b);

/// The amplitude of the profile's wave of one period a spoke.
double fundamental(const std::vector<double>& profile);

}  // namespace zoneplate::cli
