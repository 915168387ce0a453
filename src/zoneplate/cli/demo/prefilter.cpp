// Filter, then sample; or sample, then filter: the same two steps, and only one order works.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/cli/demo/demo.h"
#include "zoneplate/cli/demo/picture.h"
#include "zoneplate/signal/filter/convolve.h"
#include "zoneplate/signal/filter/kernel.h"
#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::cli {
namespace {

constexpr int step = 4;        // every fourth pixel is kept
constexpr double sigma = 0.8;  // of the Gaussian, in pixels of the small picture
constexpr int factor = 8;      // enlargement
constexpr int spokes = 240;

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
  return number(20 / 2.302585092994046 * (natural_log(second) - natural_log(first)), 1) + "\u00a0dB";
}

/// A large picture made small: sampled; sampled, then filtered; filtered, then sampled.
std::array<Plane<float>, 3> made_small(const Plane<float>& large, int side) {
  const auto taken = [side](const Plane<float>& plane) { return resample_nearest(plane, side, side); };
  return {taken(large), blurred(taken(large), sigma), taken(blurred(large, sigma * step))};
}

/// What each way makes of the frequencies that the small picture cannot hold; all of it is alias, as all is linear.
std::array<double, 3> aliases_of(const Plane<float>& large, int side) {
  const Plane<float> held = resample_ideal(resample_ideal(large, side, side), large.width(), large.height());
  const auto rest = made_small(difference(large, held), side);
  return {rms(rest[0]), rms(rest[1]), rms(rest[2])};
}

Lesson make(const DemoSize& size) {
  const int side = size.panel, large = step * side;
  const Scene wheel = scene_of(fmt::format("wheel:spokes={}", spokes));
  const Plane<float> original = luminance_of(shoot(wheel, "msaa:n=8", large, large));
  const auto results = made_small(original, side);
  const auto aliases = aliases_of(original, side);

  const std::string captions[] = {
      fmt::format("Sampled: every {}th pixel\nSpokes break into dashes, and dashes join to curves that no wheel has.",
                  step),
      fmt::format(
          "Sampled, then filtered\nThe false curves stay: a blur cannot know which waves are false. Aliases {}.",
          decibels(aliases[0], aliases[1])),
      fmt::format("Filtered, then sampled\nThe same blur, before: what is too fine is gone before it can fold back. "
                  "Aliases {}.",
                  decibels(aliases[0], aliases[2]))};
  const char* spectra[] = {"Its spectrum\nCopies of the original’s spectrum overlap: aliases all over.",
                           "Its spectrum\nDarker outside, but the aliases near the centre have stayed.",
                           "Its spectrum\nThe centre is the original’s own."};
  const int x = side * 44 / 100, y = side * 37 / 100;
  Figure figure{.title = "Filter before you sample: the order decides", .rows = {{}, {}, {}}};
  for (std::size_t i = 0; i < 3; ++i) {
    const Rgba8Image picture = shown(results[i]);
    figure.rows[0].push_back({marked(picture, x, y, factor, side), captions[i]});
    figure.rows[1].push_back({crop_of(picture, x, y, factor, side), ""});
    figure.rows[2].push_back({spectrum_picture(fourier(results[i])), spectra[i]});
  }
  figure.text = fmt::format(
      "A wheel of {} spokes, {} × {} pixels, made {} times smaller; the filter is a Gaussian of σ = {} pixels of the "
      "small picture. The frames mark what is shown {} times enlarged. Aliases: what the steps make of frequencies "
      "above "
      "the small picture’s Nyquist frequency, against sampling alone ({}\u00a0% of white, root mean square).",
      spokes, large, large, step, number(sigma, 1), factor, number(100 * aliases[0], 2));
  return {.frames = {figure}};
}

}  // namespace

Demo demo_prefilter() { return {"prefilter", "filter then sample against sample then filter", make}; }

}  // namespace zoneplate::cli
