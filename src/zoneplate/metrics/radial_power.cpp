// The radial power spectrum of the error: at what size of detail a picture is wrong.
//
// Coarse errors are seen, fine ones much less; a method that moves its error upward is better at the same mean square.
// Direction is lost: a picture that is wrong along one axis looks as one that is half as wrong along both.
#include "zoneplate/metrics/radial_power.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/rows.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

std::vector<double> hann(int n) {
  std::vector<double> window;
  for (int i = 0; i < n; ++i) window.push_back(0.5 - 0.5 * cos_pi((2.0 * i + 1) / n));
  return window;
}

/// |f| of a bin of the half spectrum, in cycles per pixel.
double frequency_of(const Spectrum& spectrum, int kx, int ky) {
  const double fx = bin_frequency(kx, spectrum.width), fy = bin_frequency(ky, spectrum.height());
  return std::sqrt(fx * fx + fy * fy);
}

/// How many bins of the whole spectrum a bin of the half one stands for.
double multiplicity(const Spectrum& spectrum, int kx) { return kx == 0 || 2 * kx == spectrum.width ? 1 : 2; }

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
  const Plane<double> wanted = luma_plane(reference), found = luma_plane(test);
  const Spectrum error = windowed_spectrum(difference(found, wanted));
  const auto rms = [&](double low, double high) { return std::sqrt(band_power(error, low, high)); };
  constexpr double corner = 1;  // past the greatest |f|, √½
  Score score;
  score.value = rms(0, 0.125);
  score.more = {{"below_1/16", rms(0, 0.0625), "code"},
                {"1/16_to_1/8", rms(0.0625, 0.125), "code"},
                {"1/8_to_1/4", rms(0.125, 0.25), "code"},
                {"1/4_to_1/2", rms(0.25, 0.5), "code"},
                {"above_1/2", rms(0.5, corner), "code"}};
  score.curves = {curve_of("reference", windowed_spectrum(wanted)), curve_of("test", windowed_spectrum(found)),
                  curve_of("error", error)};
  return score;
}

}  // namespace

Spectrum windowed_spectrum(const Plane<double>& plane) {
  const std::vector<double> across = hann(plane.width()), down = hann(plane.height());
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
  const int shorter = std::min(spectrum.width, spectrum.height());
  RadialPower out;
  std::vector<double> counts(static_cast<std::size_t>(shorter / 2) + 1, 0.0);
  out.power.resize(counts.size(), 0.0);
  for (int ky = 0; ky < spectrum.height(); ++ky) {
    for (int kx = 0; kx < spectrum.half.width(); ++kx) {
      const auto ring = static_cast<std::size_t>(frequency_of(spectrum, kx, ky) * shorter + 0.5);
      if (ring >= counts.size()) continue;
      counts[ring] += multiplicity(spectrum, kx);
      out.power[ring] += multiplicity(spectrum, kx) * std::norm(spectrum.half(kx, ky));
    }
  }
  for (std::size_t ring = 0; ring < counts.size(); ++ring) {
    out.frequency.push_back(static_cast<double>(ring) / shorter);
    if (counts[ring] > 0) out.power[ring] /= counts[ring];
  }
  return out;
}

double band_power(const Spectrum& spectrum, double low, double high) {
  const double sum = sum_rows(spectrum.height(), [&](int ky) {
    double row = 0;
    for (int kx = 0; kx < spectrum.half.width(); ++kx) {
      const double f = frequency_of(spectrum, kx, ky);
      if (f > low && f <= high) row += multiplicity(spectrum, kx) * std::norm(spectrum.half(kx, ky));
    }
    return row;
  });
  return sum / (static_cast<double>(spectrum.width) * spectrum.height());
}

Metric radial_power() {
  return {.name = "radial_power",
          .summary = "root mean square error of luma below 1/8 cycle per pixel, and the radial power spectra",
          .source = "the definition; Hann window",
          .unit = "code",
          .is_default = false,
          .smallest = 16,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            return measure(reference[0].display, test[0].display);
          },
          .pool = root_mean_square_of};
}

}  // namespace zoneplate::metrics
