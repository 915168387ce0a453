// SPDX-License-Identifier: Apache-2.0
// Filtering before and after sampling: the same two steps, of which only one order is correct.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/signal/filter/convolve.h"
#include "zoneplate/signal/filter/kernel.h"
#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::lessons {
namespace prefilter_lesson {
namespace {

constexpr int step = 4;    // every fourth pixel is kept
constexpr int factor = 8;  // enlargement
constexpr Param params[] = {
    {.name = "sigma",
     .meaning = "of the Gaussian, in pixels of the small image",
     .value = 0.8,
     .low = 0.2,
     .high = 3,
     .decimals = 1},
    {.name = "spokes", .meaning = "of the wheel", .value = 240, .low = 20, .high = 360},
};

Plane<float> blurred(const Plane<float>& plane, double sigma_here) {
  const std::vector<double> taps = sampled(make_kernel(fmt::format("gaussian:sigma={}", sigma_here)));
  return convolve_separable(plane, taps, taps, {.border = Border::Wrap});
}

Plane<float> difference(Plane<float> a, const Plane<float>& b) {
  for (std::size_t i = 0; i < a.values().size(); ++i) a.values()[i] -= b.values()[i];
  return a;
}

double rms(const Plane<float>& plane) { return rms_difference(plane, Plane<float>(plane.width(), plane.height())); }

/// The level of the second relative to the first.
std::string decibels(double first, double second) {
  return number(20 / 2.302585092994046 * (natural_log(second) - natural_log(first)), 1) + "\u00a0dB";
}

/// A large image reduced in three ways: sampled; sampled, then filtered; filtered, then sampled.
std::array<Plane<float>, 3> made_small(const Plane<float>& large, int side, double sigma) {
  const auto taken = [side](const Plane<float>& plane) { return resample_nearest(plane, side, side); };
  return {taken(large), blurred(taken(large), sigma), taken(blurred(large, sigma * step))};
}

/// The result of each way for the frequencies above the small image's Nyquist limit only. The steps are linear, so that
/// all of it is aliasing.
std::array<double, 3> aliases_of(const Plane<float>& large, int side, double sigma) {
  const Plane<float> held = resample_ideal(resample_ideal(large, side, side), large.width(), large.height());
  const auto rest = made_small(difference(large, held), side, sigma);
  return {rms(rest[0]), rms(rest[1]), rms(rest[2])};
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel, large = step * side, spokes = settings.integer("spokes");
  const double sigma = settings.number("sigma");
  const Scene wheel = scene_of(fmt::format("wheel:spokes={}", spokes));
  const Plane<float> original = luminance_of(shoot(wheel, "msaa:n=8", large, large));
  const auto results = made_small(original, side, sigma);
  const auto aliases = aliases_of(original, side, sigma);

  const std::string captions[] = {
      fmt::format("Sampled: every {}th pixel\nSpokes break into dashes, and the dashes form false curves.", step),
      fmt::format(
          "Sampled, then filtered\nThe false curves remain: a blur does not separate aliases from detail. Aliases {}.",
          decibels(aliases[0], aliases[1])),
      fmt::format("Filtered, then sampled\nThe same blur first: it removes high frequencies before they can fold. "
                  "Aliases {}.",
                  decibels(aliases[0], aliases[2]))};
  const char* spectra[] = {
      "Spectrum of the sampled image\nCopies of the original’s spectrum overlap: aliases everywhere.",
      "Spectrum: sampled, then filtered\nDarker outside, but the aliases near the centre remain.",
      "Spectrum: filtered, then sampled\nThe centre is that of the original."};
  const int x = side * 44 / 100, y = side * 37 / 100;
  Figure figure{.title = "Filter before sampling: the order matters", .rows = {{}, {}, {}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Rgba8Image picture = shown(results[i]);
    figure.rows[0].push_back({marked(picture, x, y, factor, side), captions[i]});
    figure.rows[1].push_back({crop_of(picture, x, y, factor, side), ""});
    figure.rows[2].push_back({spectrum_picture(fourier(results[i])), spectra[i]});
  }
  figure.text = fmt::format(
      "A wheel of {} spokes, {} × {} pixels, reduced by a factor of {}; the filter is a Gaussian of σ = {} pixels of "
      "the "
      "small image. The frames mark the regions that are enlarged {} times. Aliases: the result for frequencies above "
      "the small image’s Nyquist limit, relative to sampling alone ({}\u00a0% of white, root mean square). Spectra: "
      "frequency 0 in the middle, half a "
      "cycle per pixel at the borders; bright is strong, from 0\u00a0dB (pale) to −100\u00a0dB (black).",
      spokes, large, large, step, number(sigma, 1), factor, number(100 * aliases[0], 2));
  return {.frames = {figure}};
}

}  // namespace
}  // namespace prefilter_lesson

Demo demo_prefilter() {
  return {"prefilter", "filtering before sampling against filtering after it", prefilter_lesson::make,
          prefilter_lesson::params};
}

}  // namespace zoneplate::lessons
