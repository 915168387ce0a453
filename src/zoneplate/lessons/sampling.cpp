// SPDX-License-Identifier: Apache-2.0
// Sampling repeats the spectrum at every multiple of the rate; below twice the bandwidth the copies overlap.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/signal/fourier/series.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::lessons {
namespace sampling_lesson {
namespace {

constexpr double bandwidth = 1;                       // Hz
constexpr double shown_seconds = 4, shown_hertz = 5;  // on both sides
constexpr double taken_seconds = 200;                 // on both sides: the remainder is below 3e-6

/// A pulse whose spectrum is a triangle, 1 at frequency 0 and 0 at the bandwidth, low-pass filtered at `limit`.
struct Pulse {
  double limit = bandwidth;

  // The sum of a flat part of height 1 - limit and a smaller triangle on top of it.
  double value(double t) const {
    const double s = sinc(limit * t);
    return 2 * limit * (1 - limit) * sinc(2 * limit * t) + limit * limit * s * s;
  }
  double spectrum(double f) const { return std::abs(f) > limit ? 0 : std::max(0.0, 1 - std::abs(f)); }
};
static_assert(bandwidth == 1, "the pulse is written for it");

/// A way of sampling the pulse.
struct Way {
  double rate;
  bool is_filtered;

  Pulse pulse() const { return {is_filtered ? rate / 2 : bandwidth}; }
};
constexpr Param params[] = {{.name = "rate",
                             .meaning = "samples per second of the lower rows, below twice the bandwidth",
                             .value = 1.3,
                             .low = 0.5,
                             .high = 1.9,
                             .decimals = 1}};
std::array<Way, 4> ways_of(double rate) { return {{{4, false}, {2, false}, {rate, false}, {rate, true}}}; }

struct Samples {
  double rate;
  int first;
  std::vector<double> values;

  double time(std::size_t i) const { return (first + static_cast<int>(i)) / rate; }
};
Samples taken(const Way& way) {
  const int last = static_cast<int>(taken_seconds * way.rate);
  Samples samples{way.rate, -last, {}};
  for (int k = -last; k <= last; ++k) samples.values.push_back(way.pulse().value(k / way.rate));
  return samples;
}

/// The samples' spectrum, computed as a sum; the samples are symmetric.
double spectrum_of(const Samples& samples, double f) {
  double sum = 0;
  for (std::size_t i = 0; i < samples.values.size(); ++i) sum += samples.values[i] * cos_pi(2 * f * samples.time(i));
  return sum / samples.rate;
}

/// The only function with these samples and without frequencies above half the rate.
double rebuilt(const Samples& samples, double t) {
  double sum = 0;
  for (std::size_t i = 0; i < samples.values.size(); ++i)
    sum += samples.values[i] * sinc(samples.rate * (t - samples.time(i)));
  return sum;
}

template <class Function>
Curve curve(std::string name, double reach, int points, Function value) {
  Curve c{.name = std::move(name)};
  for (int i = 0; i <= points; ++i) {
    const double x = reach * (2.0 * i / points - 1);
    c.points.emplace_back(x, value(x));
  }
  return c;
}

double signal(double t) { return Pulse{}.value(t); }

Plot time_plot(const Samples& samples) {
  Plot plot{.x = {"time (s)", -shown_seconds, shown_seconds}, .y = {"signal", -0.3, 1.1}};
  Curve stems{.name = "samples", .mark = Curve::Mark::Stems, .color = 1};
  for (std::size_t i = 0; i < samples.values.size(); ++i)
    if (std::abs(samples.time(i)) <= shown_seconds) stems.points.emplace_back(samples.time(i), samples.values[i]);
  Curve original = curve("signal", shown_seconds, 400, signal);
  original.color = Curve::grey;
  Curve back = curve("reconstructed", shown_seconds, 400, [&](double t) { return rebuilt(samples, t); });
  back.color = 0;
  plot.curves = {original, stems, back};
  return plot;
}

Plot spectrum_plot(const Way& way, const Samples& samples) {
  Plot plot{.x = {"frequency (Hz)", -shown_hertz, shown_hertz}, .y = {"spectrum", 0, 1.2}};
  Curve own = curve("signal", shown_hertz, 200, [](double f) { return Pulse{}.spectrum(f); });
  own.mark = Curve::Mark::Area, own.color = Curve::grey;
  plot.curves.push_back(own);
  const Pulse pulse = way.pulse();
  for (int copy = -8; copy <= 8; ++copy) {
    const double at = copy * way.rate, edge = pulse.spectrum(pulse.limit);
    if (copy == 0 || std::abs(at) > shown_hertz + bandwidth) continue;
    Curve c{.name = copy == 1 ? "copies" : "", .mark = Curve::Mark::Dashed, .color = 1};
    c.points = {{at - pulse.limit, 0},
                {at - pulse.limit, edge},
                {at, pulse.spectrum(0)},
                {at + pulse.limit, edge},
                {at + pulse.limit, 0}};
    plot.curves.push_back(c);
  }
  Curve sum = curve("samples", shown_hertz, 400, [&](double f) { return spectrum_of(samples, f); });
  sum.color = 0;
  plot.curves.push_back(sum);
  const double half = samples.rate / 2;
  for (const double at : {-half, half})
    plot.curves.push_back({.name = at > 0 ? "half the rate" : "",
                           .points = {{at, 0}, {at, 1.2}},
                           .mark = Curve::Mark::Dashed,
                           .color = Curve::grey});
  return plot;
}

/// The root mean square error of the reconstruction, relative to the signal.
double error_of(const Samples& samples) {
  double error = 0, all = 0;
  constexpr int points = 400;
  for (int i = 0; i <= points; ++i) {
    const double t = shown_seconds * (2.0 * i / points - 1), s = signal(t), d = rebuilt(samples, t) - s;
    error += d * d, all += s * s;
  }
  return std::sqrt(error / all);
}

std::string words_of(const Way& way) {
  if (way.is_filtered)
    return "They touch but do not overlap: frequencies above half the rate were removed before sampling.";
  const Band band = overlap_of_copies(bandwidth, way.rate);
  if (band.low < band.high)
    return fmt::format("They overlap from {} to {}\u00a0Hz and add up: there they cannot be separated.",
                       number(band.low, 1), number(band.high, 1));
  return way.rate > 2 * bandwidth ? "They are separate: a low-pass at half the rate restores the signal."
                                  : "They touch: twice the bandwidth is the minimum rate.";
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int width = 2 * size.panel, height = size.panel * 3 / 4;
  Figure figure{.title = "Sampling repeats the spectrum: at too low a rate the copies overlap"};
  for (const Way& way : ways_of(settings.number("rate"))) {
    const Samples samples = taken(way);
    const std::string rate = number(way.rate, way.rate < 2 ? 1 : 0);
    figure.rows.push_back(
        {plot_panel(time_plot(samples), width, height,
                    fmt::format("{} samples per second{}\nReconstructed with an error of {}\u00a0%{}.", rate,
                                way.is_filtered ? ", filtered first" : "", number(100 * error_of(samples), 1),
                                way.is_filtered ? ", without aliases" : "")),
         plot_panel(spectrum_plot(way, samples), width, height,
                    fmt::format("Copies {}\u00a0Hz apart\n{}", rate, words_of(way)))});
  }
  figure.text = fmt::format(
      "A pulse with frequencies up to {}\u00a0Hz. The spectrum of its samples is the pulse's spectrum, repeated at "
      "every "
      "multiple of the sampling rate: computed from the samples (blue), and as the sum of shifted copies. Half the "
      "rate "
      "is the Nyquist frequency; frequencies above it appear as lower ones.",
      number(bandwidth, 0));
  return {.frames = {figure}};
}

}  // namespace
}  // namespace sampling_lesson

Demo demo_sampling() {
  return {"sampling", "the spectrum of a signal's samples at different rates", sampling_lesson::make,
          sampling_lesson::params};
}

}  // namespace zoneplate::lessons
