// SPDX-License-Identifier: Apache-2.0
// Energy above Nyquist: the aliases of frequencies that an image cannot represent.
//
// A sampled image has no frequencies above ½, so that its aliases are determined with a reference n × n times as large,
// in which they are separate. In each ring of frequencies the image is modelled as the reference times one real factor,
// its filter at that frequency; the residual consists of aliases (and noise).
//
// Weaknesses: with an anisotropic filter, the differences between directions count as aliases; and in the few bins of
// the innermost rings, the factor can fit an alias.
// innermost rings, where a factor can fit an alias.
#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/metrics/metric.h"
#include "zoneplate/metrics/power.h"
#include "zoneplate/metrics/spectrum/radial_power.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::metrics {
namespace {

/// e^(-πi f): the phase of a bin of frequency f if positions are relative to the corner of the image and samples are at
/// pixel centres.
Complex half_pixel(double f) {
  const SineCosine turn = sin_cos_pi(f);
  return {turn.cosine, -turn.sine};
}

/// Sums over a ring of frequencies: the power of reference and test, their cross term, and the power of their
/// difference.
struct Ring {
  double reference = 0, test = 0, common = 0, difference = 0;
};

/// The statistics by ring of the bins below ½ cycle per pixel of the test; the reference has n × n times its pixels.
std::vector<Ring> compare_bins(const Spectrum& reference, const Spectrum& test, int n) {
  const int width = test.width, height = test.height(), shorter = std::min(width, height);
  std::vector<Ring> rings(static_cast<std::size_t>(shorter));
  for (int ky = 0; ky < height; ++ky) {
    for (int kx = 0; kx < test.half.width(); ++kx) {
      const double fx = bin_frequency(kx, width), fy = bin_frequency(ky, height);
      if (std::abs(fx) >= 0.5 || std::abs(fy) >= 0.5) continue;
      const Complex found = test.half(kx, ky) * half_pixel(fx) * half_pixel(fy);
      // The spectra differ by the factor n, because the reference has n² times the samples at the same variance.
      const Complex expected =
          reference.at(kx, 2 * ky <= height ? ky : ky - height) * half_pixel(fx / n) * half_pixel(fy / n) / double(n);
      Ring& ring = rings[static_cast<std::size_t>(std::sqrt(fx * fx + fy * fy) * shorter + 0.5)];
      const double weight = kx == 0 ? 1 : 2;
      ring.reference += weight * std::norm(expected);
      ring.test += weight * std::norm(found);
      ring.common += weight * (expected.real() * found.real() + expected.imag() * found.imag());
      ring.difference += weight * std::norm(found - expected);
    }
  }
  return rings;
}

/// The total power of the reference, in the units of the test's bins.
double power_of(const Spectrum& reference, int n) {
  const double pixels = static_cast<double>(reference.width) * reference.height();
  return band_power(reference, 0, 1) * pixels / (static_cast<double>(n) * n);
}

Score measure(const LinearImage& reference, const LinearImage& test) {
  const int n = reference.width() / test.width();
  const Spectrum expected = windowed_spectrum(luminance_plane(reference)),
                 found = windowed_spectrum(luminance_plane(test));

  Ring all;
  double aliases = 0, passed = 0;
  for (const Ring& ring : compare_bins(expected, found, n)) {
    const double factor = ring.reference > 0 ? ring.common / ring.reference : 0;
    aliases += std::max(0.0, ring.test - factor * ring.common);
    passed += factor * factor * ring.reference;
    all.reference += ring.reference;
    all.difference += ring.difference;
  }

  Score score;
  const double whole = power_of(expected, n);
  const auto decibels = [&](double power) { return 10 * decimal_log(power / all.reference); };
  score.value = decibels(aliases);
  score.more = {{"difference", decibels(all.difference), "dB"},
                {"passed", all.reference > 0 ? std::sqrt(passed / all.reference) : 0, ""},
                {"reference_above_nyquist", whole > 0 ? std::max(0.0, 1 - all.reference / whole) : 0, "share"}};
  return score;
}

}  // namespace

Metric above_nyquist() {
  return {.name = "above_nyquist",
          .summary = "power of aliases in linear light, against the power of what the pixels can show",
          .source = "in-band error against a reference of higher resolution, less the part a filter explains",
          .unit = "dB",
          .perfect = -std::numeric_limits<double>::infinity(),
          .is_default = false,
          .needs_whole_image = true,
          .smallest = 16,
          .sizes = Sizes::ReferenceMultiple,
          .measure = [](Frames reference, Frames test, const Settings&) -> std::optional<Score> {
            const auto [low, high] = std::ranges::minmax(luminance_plane(reference[0].linear).values());
            if (!(high > low)) return std::nullopt;
            return measure(reference[0].linear, test[0].linear);
          }};
}

}  // namespace zoneplate::metrics
