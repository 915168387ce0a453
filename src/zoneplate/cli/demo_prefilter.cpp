// Filter, then sample; or sample, then filter: the same two steps, and only one order works.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/cli/demo.h"
#include "zoneplate/cli/demo_picture.h"
#include "zoneplate/signal/convolve.h"
#include "zoneplate/signal/functions.h"
#include "zoneplate/signal/kernel.h"
#include "zoneplate/signal/resample.h"

namespace zoneplate::cli {
namespace {

constexpr int step = 4;           // every fourth pixel is kept
constexpr double sigma = 0.8;     // of the Gaussian, in pixels of the small picture
constexpr int pictures_crop = 8;  // enlargement
constexpr const char* subject = "wheel:spokes=240";

Plane<float> blurred(const Plane<float>& plane, double sigma_here) {
  const std::vector<double> taps = sampled(make_kernel(fmt::format("gaussian:sigma={}", sigma_here)));
  return convolve_separable(plane, taps, taps, {.border = Border::Wrap});
}

Plane<float> difference(Plane<float> a, const Plane<float>& b) {
  for (std::size_t i = 0; i < a.values().size(); ++i) a.values()[i] -= b.values()[i];
  return a;
}

double rms(const Plane<float>& plane) { return rms_difference(plane, Plane<float>(plane.width(), plane.height())); }

/// The level of the second against the first.
std::string decibels(double first, double second) {
  return number(20 / 2.302585092994046 * (natural_log(second) - natural_log(first)), 1) + " dB";
}

Lesson make(const DemoSize& size) {
  const int side = size.panel, large = step * side;
  const Plane<float> original = luminance_of(shoot(scene_of(subject), "msaa:n=8", large, large));
  const auto taken = [&](const Plane<float>& plane) { return resample_nearest(plane, side, side); };
  const auto both_orders = [&](const Plane<float>& plane) {
    return std::array{taken(plane), blurred(taken(plane), sigma), taken(blurred(plane, sigma * step))};
  };
  const auto results = both_orders(original);

  // Everything here is linear: what the three make of the frequencies that the small picture cannot hold is alias.
  const Plane<float> held = resample_ideal(resample_ideal(original, side, side), large, large);
  const auto aliases = both_orders(difference(original, held));
  const double unfiltered = rms(aliases[0]);

  const int x = side * 44 / 100, y = side * 37 / 100;
  Figure figure{.title = "Filter before you sample: the order decides", .rows = {{}, {}, {}}};
  const char* headings[] = {"Sampled: every 4th pixel", "Sampled, then filtered", "Filtered, then sampled"};
  const std::string words[] = {
      "Spokes break into dashes, and dashes join to curves that no wheel has.",
      fmt::format("The false curves stay: a blur cannot know which waves are false. Aliases {}.",
                  decibels(unfiltered, rms(aliases[1]))),
      fmt::format("The same blur, before: what is too fine is gone before it can fold back. Aliases {}.",
                  decibels(unfiltered, rms(aliases[2])))};
  const char* spectra[] = {"Its spectrum\nCopies of the original’s spectrum overlap: aliases all over.",
                           "Its spectrum\nDarker outside, but the aliases near the centre have stayed.",
                           "Its spectrum\nThe centre is the original’s own."};
  for (std::size_t i = 0; i < 3; ++i) {
    const Rgba8Image picture = shown(results[i]);
    figure.rows[0].push_back(
        {marked(picture, x, y, pictures_crop, side), fmt::format("{}\n{}", headings[i], words[i])});
    figure.rows[1].push_back({crop_of(picture, x, y, pictures_crop, side), ""});
    figure.rows[2].push_back({spectrum_picture(fourier(results[i])), spectra[i]});
  }
  figure.text = fmt::format(
      "A wheel of 240 spokes, {} × {} pixels, made {} times smaller; the filter is a Gaussian of σ = {} pixels of the "
      "small picture. The frames mark what is shown 8 times enlarged. Aliases: what the steps make of frequencies "
      "above the small picture’s Nyquist frequency, against "
      "sampling alone ({} % of white, root mean square).",
      large, large, step, number(sigma, 1), number(100 * unfiltered, 2));
  return {.frames = {figure}};
}

}  // namespace

Demo demo_prefilter() { return {"prefilter", "filter then sample against sample then filter", make}; }

}  // namespace zoneplate::cli
