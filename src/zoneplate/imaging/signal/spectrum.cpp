// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/spectrum.h"

#include <fmt/format.h>
#include <cmath>
#include <numbers>

#include "zoneplate/base/utf8.h"
#include "zoneplate/imaging/signal/load.h"
#include "zoneplate/imaging/signal/show.h"
#include "zoneplate/report/figure.h"
#include "zoneplate/report/plot.h"
#include "zoneplate/signal/fourier/periodic_smooth.h"
#include "zoneplate/signal/fourier/spectrum.h"
#include "zoneplate/signal/fourier/window.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

/// The strongest wave of a spectrum, without the mean.
struct StrongestWave {
  double fx = 0, fy = 0, amplitude = 0;

  double frequency() const { return std::sqrt(fx * fx + fy * fy); }
  double degrees() const { return angle_of(fy, fx) * 180 / std::numbers::pi; }
};

/// The statistics of an image.
struct SpectrumSummary {
  double mean = 0, deviation = 0;  ///< of the transformed luminance
  /// Fractions of the variance: below ¼, from ¼ to ½, above ½ cycle per pixel.
  double coarse = 0, fine = 0, corner = 0;
  StrongestWave strongest;
};

struct Analysis {
  Plane<float> plane;  ///< the input of the transform
  Spectrum spectrum;
  SpectrumSummary summary;
};

// A window spreads the mean over the bins next to frequency 0, which therefore are not waves. Four bins are sufficient
// for all windows.
constexpr int window_reach = 4;

StrongestWave strongest_wave(const Spectrum& spectrum, bool is_windowed, double gain) {
  StrongestWave wave;
  double greatest = 0;
  const int reach = is_windowed ? window_reach : 0;
  for (int y = 0; y < spectrum.height(); ++y)
    for (int x = 0; x < spectrum.half.width(); ++x) {
      const Complex z = spectrum.half(x, y);
      const double power = z.real() * z.real() + z.imag() * z.imag();
      const int ky = std::min(y, spectrum.height() - y);
      if ((x <= reach && ky <= reach) || power <= greatest) continue;
      greatest = power;
      const double pixels = static_cast<double>(spectrum.width) * spectrum.height();
      const bool is_alone = (2 * x == spectrum.width || x == 0) && (2 * ky == spectrum.height() || ky == 0);
      wave = {bin_frequency(x, spectrum.width), bin_frequency(y, spectrum.height()),
              (is_alone ? 1 : 2) * std::sqrt(power) / pixels / gain};
    }
  return wave;
}

SpectrumSummary summarize(const Spectrum& spectrum, bool is_windowed, double gain) {
  const double pixels = static_cast<double>(spectrum.width) * spectrum.height();
  SpectrumSummary out;
  out.mean = spectrum.at(0, 0).real() / pixels;
  const double mean_square = out.mean * out.mean;
  const auto between = [&](double low, double high) { return energy_between(spectrum, low, high); };
  const double coarse = std::max(0.0, between(0, 0.25) - mean_square), fine = between(0.25, 0.5),
               corner = between(0.5, 1);
  const double variance = coarse + fine + corner;
  out.deviation = std::sqrt(variance);
  if (variance > 0) out.coarse = coarse / variance, out.fine = fine / variance, out.corner = corner / variance;
  out.strongest = strongest_wave(spectrum, is_windowed, gain);
  return out;
}

Analysis analyse(const SpectrumOptions& args, const LinearImage& image) {
  Analysis out;
  out.plane = luminance(image);
  const Window window = make_window(args.window);
  const bool is_windowed = args.window != "none";
  double gain = 1;
  if (is_windowed) {
    gain = coherent_gain(sampled(window, out.plane.width())) * coherent_gain(sampled(window, out.plane.height()));
    out.plane = windowed(out.plane, window);
  }
  if (args.is_periodic) out.plane = split_periodic_smooth(out.plane).periodic;
  out.spectrum = fourier(out.plane);
  out.summary = summarize(out.spectrum, is_windowed, gain);
  return out;
}

RadialProfile profile_of(const Spectrum& spectrum) {
  return radial_profile(spectrum, std::clamp(std::min(spectrum.width, spectrum.height()) / 2, 1, 256));
}

double decibels(double power) { return 10 / std::numbers::ln10 * natural_log(power); }

Plot radial_plot(const RadialProfile& profile, double range_db) {
  Curve curve{"mean of each ring", {}, Curve::Mark::Line};
  double strongest = -HUGE_VAL;
  for (std::size_t ring = 0; ring < profile.power.size(); ++ring) {
    if (profile.bins[ring] == 0 || !(profile.power[ring] > 0)) continue;
    curve.points.emplace_back((static_cast<double>(ring) + 0.5) * profile.ring_width, decibels(profile.power[ring]));
    strongest = std::max(strongest, curve.points.back().second);
  }
  // Values below the displayed range are rounding errors, and would compress the plot.
  const double high = curve.points.empty() ? 0 : 10 * std::ceil(strongest / 10 + 0.2), low = high - range_db - 40;
  std::erase_if(curve.points, [&](const auto& p) { return p.second < low; });
  return {.title = "Radial profile",
          .x = {"frequency (cycles per pixel)", 0, std::numbers::sqrt2 / 2},
          .y = {"power (dB)", low, high},
          .curves = {curve, {"Nyquist frequency", {{0.5, low}, {0.5, high}}, Curve::Mark::Dashed, Curve::grey}}};
}

std::string text_of(const std::string& input, const SpectrumOptions& args, const Analysis& a) {
  const SpectrumSummary& s = a.summary;
  std::string text = fmt::format(
      "{}, {} × {}, {}, window {}{}\n"
      "  mean {:.4g}, standard deviation {:.4g}\n"
      "  variance: {:.1f} % below 1/4 cycle per pixel, {:.1f} % from there to 1/2, {:.1f} % beyond\n",
      printable(input), a.plane.width(), a.plane.height(), args.uses_codes ? "luma of codes" : "luminance", args.window,
      args.is_periodic ? ", periodic part" : "", s.mean, s.deviation, 100 * s.coarse, 100 * s.fine, 100 * s.corner);
  if (s.strongest.amplitude > 0)
    text += fmt::format(
        "  strongest wave: {:.4g} cycles per pixel ({:.4g} pixels long) towards {:.1f} degrees, amplitude {:.4g}\n",
        s.strongest.frequency(), 1 / s.strongest.frequency(), s.strongest.degrees(), s.strongest.amplitude);
  if (args.shown != SpectrumView::Radial) return text;
  const RadialProfile profile = profile_of(a.spectrum);
  text += "  frequency     power (dB)\n";
  for (std::size_t ring = 0; ring < profile.power.size(); ++ring)
    if (profile.bins[ring] > 0)
      text += fmt::format("  {:<14.5f}{}\n", (static_cast<double>(ring) + 0.5) * profile.ring_width,
                          profile.power[ring] > 0 ? fmt::format("{:.2f}", decibels(profile.power[ring])) : "none");
  return text;
}

Json::Object json_of(const std::string& input, const SpectrumOptions& args, const Analysis& a) {
  const SpectrumSummary& s = a.summary;
  Json::Object json{
      {"input", input},
      {"output", args.output},
      {"width", a.plane.width()},
      {"height", a.plane.height()},
      {"of", args.uses_codes ? "luma" : "luminance"},
      {"window", args.window},
      {"periodic", args.is_periodic},
      {"mean", s.mean},
      {"standard_deviation", s.deviation},
      {"variance_shares", Json::Object{{"below_1_4", s.coarse}, {"to_1_2", s.fine}, {"beyond", s.corner}}},
      {"strongest", Json::Object{{"fx", s.strongest.fx},
                                 {"fy", s.strongest.fy},
                                 {"frequency", s.strongest.frequency()},
                                 {"degrees", s.strongest.degrees()},
                                 {"amplitude", s.strongest.amplitude}}}};
  if (args.shown != SpectrumView::Radial) return json;
  const RadialProfile profile = profile_of(a.spectrum);
  Json::Array frequency, power;
  for (std::size_t ring = 0; ring < profile.power.size(); ++ring) {
    if (profile.bins[ring] == 0) continue;
    frequency.emplace_back((static_cast<double>(ring) + 0.5) * profile.ring_width);
    power.emplace_back(profile.power[ring]);
  }
  json.emplace_back("radial", Json::Object{{"frequency", std::move(frequency)}, {"power", std::move(power)}});
  return json;
}

constexpr PlotSize spectrum_size{panel_px, panel_px * 3 / 4};

Figure figure_of(const std::string& input, const SpectrumOptions& args, const Analysis& a) {
  LinearImage grey(a.plane.width(), a.plane.height());
  for (std::size_t i = 0; i < grey.values().size(); ++i) {
    const float v = a.plane.values()[i];
    grey.values()[i] = {v, v, v, 1};
  }
  const Rgba8Image magnitude = magnitude_panel(a.spectrum, {.range_db = args.range_db});
  const std::string how = args.is_periodic        ? "its periodic part"
                          : args.window == "none" ? "as it is"
                                                  : "under the window " + args.window;
  return {
      .title = "Spectrum of " + title_of(input),
      .rows =
          {{{fitted(shown(grey, args.uses_codes)), fmt::format("Image\nIts luminance, {}.", how)},
            {magnitude, fmt::format("Magnitude\nFrequency 0 is in the middle, ½ cycle per pixel at the edges. Palest: "
                                    "the strongest wave; black: {:g} dB weaker.",
                                    args.range_db)}},
           {{phase_panel(a.spectrum),
             "Phase\nPhase of each frequency: white 0, orange a quarter turn, black half a turn, blue three quarters."},
            {{}, "", radial_plot(profile_of(a.spectrum), args.range_db)}}},
      .text = {}};
}

void save(const std::string& input, const SpectrumOptions& args, const Analysis& a, Delivery& out) {
  switch (args.shown) {
    case SpectrumView::Magnitude:
      return save_picture(args.output, paint_magnitude(a.spectrum, {.range_db = args.range_db}), out);
    case SpectrumView::Phase:
      return save_picture(args.output, paint_phase(a.spectrum), out);
    case SpectrumView::Radial:
      return out.save_plots(args.output, std::vector{radial_plot(profile_of(a.spectrum), args.range_db)}, 1, {});
    case SpectrumView::Everything:
      return out.save_figure(args.output, figure_of(input, args, a), spectrum_size);
  }
}

}  // namespace

std::string window_name(const std::string& text) { return make_window(text).name; }

void analyse_spectrum(const std::string& input, const SpectrumOptions& args, Delivery& out) {
  const Analysis analysis = analyse(args, load_signal(input, signal_choice(args), out));
  if (!args.output.empty()) save(input, args, analysis, out);
  print_result(args, text_of(input, args, analysis), json_of(input, args, analysis), out);
}

}  // namespace zoneplate
