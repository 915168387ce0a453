// SPDX-License-Identifier: Apache-2.0
// The radial power spectrum of the error: the error as a function of the size of details.
//
// Coarse errors are more visible than fine ones: of two methods with the same mean square, the one with errors at
// higher frequencies is better. Weakness: direction is lost; an error along one axis has the same spectrum as half the
// power along both.
#include "zoneplate/metrics/spectrum/radial_power.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/fourier/spectrum.h"
#include "zoneplate/signal/fourier/window.h"

namespace zoneplate::metrics {
namespace {

double pixels_of(const Spectrum& spectrum) { return static_cast<double>(spectrum.width) * spectrum.height(); }

Plane<double> difference(Plane<double> a, const Plane<double>& b) {
  for (std::size_t i = 0; i < a.values().size(); ++i) a.values()[i] -= b.values()[i];
  return a;
}

Curve curve_of(std::string name, const Spectrum& spectrum) {
  RadialPower radial = radial_power_of(spectrum);
  return {std::move(name), "frequency (cycles/pixel)", "power (code²)", std::move(radial.frequency),
          std::move(radial.power)};
}

Score measure(const DisplayImage& reference, const DisplayImage& test) {
  const Plane<double> expected = luma_plane(reference), found = luma_plane(test);
  const Spectrum error = windowed_spectrum(difference(found, expected));
  const auto rms = [&](double low, double high) { return std::sqrt(band_power(error, low, high)); };
  constexpr double corner = 1;  // greater than the greatest |f|, √½
  Score score;
  score.value = rms(0, 0.125);
  score.more = {{"below_1/16", rms(0, 0.0625), "code"},
                {"1/16_to_1/8", rms(0.0625, 0.125), "code"},
                {"1/8_to_1/4", rms(0.125, 0.25), "code"},
                {"1/4_to_1/2", rms(0.25, 0.5), "code"},
                {"above_1/2", rms(0.5, corner), "code"}};
  score.curves = {curve_of("reference", windowed_spectrum(expected)), curve_of("test", windowed_spectrum(found)),
                  curve_of("error", error)};
  return score;
}

}  // namespace

Spectrum windowed_spectrum(const Plane<double>& plane) {
  const Window hann = make_window("hann");
  const std::vector<double> across = sampled(hann, plane.width()), down = sampled(hann, plane.height());
  const auto at = [](const std::vector<double>& window, int i) { return window[static_cast<std::size_t>(i)]; };
  const auto weighted_sum = [&](const auto& term) {
    return sum_rows(plane.height(), [&](int y) {
      double row = 0;
      for (int x = 0; x < plane.width(); ++x) row += term(at(across, x) * at(down, y), plane(x, y));
      return row;
    });
  };
  const double weights = weighted_sum([](double w, double) { return w; });
  const double mean = weighted_sum([](double w, double v) { return w * v; }) / weights;
  const double scale = std::sqrt(weighted_sum([](double w, double) { return w * w; }));

  Plane<double> windowed(plane.width(), plane.height());
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) {
      windowed(x, y) = (plane(x, y) - mean) * (at(across, x) * at(down, y)) / scale;
    }
  }
  return fourier(windowed);
}

RadialPower radial_power_of(const Spectrum& spectrum) {
  const RadialProfile profile = radial_profile(spectrum, std::min(spectrum.width, spectrum.height()) / 2);
  RadialPower out;
  for (std::size_t ring = 0; ring < profile.power.size(); ++ring) {
    if (profile.bins[ring] == 0) continue;
    out.frequency.push_back((static_cast<double>(ring) + 0.5) * profile.ring_width);
    out.power.push_back(profile.power[ring] * pixels_of(spectrum) * pixels_of(spectrum));
  }
  return out;
}

double band_power(const Spectrum& spectrum, double low, double high) {
  return energy_between(spectrum, low, high) * pixels_of(spectrum);
}

Metric radial_power() {
  return {.name = "radial_power",
          .summary = "root mean square error of luma below 1/8 cycle per pixel, and the radial power spectra",
          .source = "the definition; Hann window",
          .unit = "code",
          .is_default = false,
          .needs_whole_image = true,
          .smallest = 16,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            return measure(reference[0].display, test[0].display);
          },
          .pool = root_mean_square_of};
}

}  // namespace zoneplate::metrics
