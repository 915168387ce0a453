// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/fourier/periodic_smooth.h"

#include "zoneplate/signal/fourier/fourier.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {

PeriodicSmooth split_periodic_smooth(const Plane<float>& plane) {
  const int w = plane.width(), h = plane.height();
  if (plane.empty()) return {plane, plane};

  // The jumps: each edge pixel gets the difference of its neighbour across the periodic edge and itself.
  Plane<double> jump(w, h);
  const auto add = [&](int x, int y, int other_x, int other_y) {
    const double d = static_cast<double>(plane(other_x, other_y)) - static_cast<double>(plane(x, y));
    jump(x, y) += d, jump(other_x, other_y) -= d;
  };
  for (int y = 0; y < h; ++y) add(0, y, w - 1, y);
  for (int x = 0; x < w; ++x) add(x, 0, x, h - 1);

  Spectrum spectrum = fourier(jump);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < spectrum.half.width(); ++x) {
      // The periodic Laplacian multiplies bin (x, y) by this factor; the mean remains in the periodic part.
      const auto cosine = [](int k, int n) {
        return unit_root(static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(n)).cosine;
      };
      const double laplacian = 2 * cosine(x, w) + 2 * cosine(y, h) - 4;
      spectrum.half(x, y) = x == 0 && y == 0 ? Complex{} : spectrum.half(x, y) * (1 / laplacian);
    }
  const Plane<double> smooth = inverse_fourier_double(spectrum);

  PeriodicSmooth out{plane, plane};
  for (std::size_t i = 0; i < smooth.values().size(); ++i) {
    out.periodic.values()[i] = static_cast<float>(static_cast<double>(plane.values()[i]) - smooth.values()[i]);
    out.smooth.values()[i] = static_cast<float>(smooth.values()[i]);
  }
  return out;
}

}  // namespace zoneplate
