// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/sample.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

constexpr int wave_steps = 1500;  // points of a curve
constexpr int aliases_shown = 6;

// Two periods of the slower wave, limited so that there are some samples and the faster wave remains legible.
double duration_of(const SampleOptions& args) {
  const double slow = std::abs(args.apparent());
  const double preferred = slow > 0 ? 2 / slow : 8 / args.rate;
  return std::max(std::min(preferred, 14 / args.frequency), 6 / args.rate);
}

Curve wave_curve(const std::string& name, double frequency, double duration, int color) {
  Curve curve{name, {}, Curve::Mark::Line, color};
  for (int i = 0; i <= wave_steps; ++i) {
    const double t = duration * i / wave_steps;
    curve.points.emplace_back(t, sin_pi(2 * frequency * t));
  }
  return curve;
}

Plot waves_plot(const SampleOptions& args) {
  const double duration = duration_of(args);
  Curve samples{args.is_aliased() ? "samples of both" : "its samples", {}, Curve::Mark::Points, 6};
  for (int i = 0; i / args.rate <= duration; ++i)
    samples.points.emplace_back(i / args.rate, sin_pi(2 * args.frequency * i / args.rate));
  Plot plot{.title = fmt::format("{:g} Hz, sampled at {:g} Hz", args.frequency, args.rate),
            .x = {"time (seconds)", 0, duration},
            .y = {"value", -1.2, 1.2},
            .curves = {wave_curve(fmt::format("{:g} Hz", args.frequency), args.frequency, duration, 0)}};
  if (args.is_aliased())
    plot.curves.push_back(
        wave_curve(fmt::format("{}{:g} Hz", args.apparent() < 0 ? "−" : "", std::abs(args.apparent())), args.apparent(),
                   duration, 1));
  plot.curves.push_back(samples);
  return plot;
}

// The spectrum of the example: a triangle whose bandwidth is the frequency.
double spectrum_at(const SampleOptions& args, double f) { return std::max(0.0, 1 - std::abs(f) / args.frequency); }

Plot copies_plot(const SampleOptions& args) {
  const double edge = 1.5 * args.rate;
  Curve base{fmt::format("spectrum up to {:g} Hz", args.frequency), {}, Curve::Mark::Area, 0};
  Curve copies{"its replicas", {}, Curve::Mark::Area, 5}, overlap{"where they overlap", {}, Curve::Mark::Area, 1, 0.6};
  const int reach = 2 + static_cast<int>(std::min(100.0, args.frequency / args.rate));
  double most = 0;
  for (int i = 0; i <= wave_steps; ++i) {
    const double f = -edge + 2 * edge * i / wave_steps, own = spectrum_at(args, f);
    double others = 0;
    for (int k = -reach; k <= reach; ++k)
      if (k != 0) others = std::max(others, spectrum_at(args, f - k * args.rate));
    base.points.emplace_back(f, own), copies.points.emplace_back(f, others),
        overlap.points.emplace_back(f, std::min(own, others));
    most = std::max(most, std::min(own, others));
  }
  Plot plot{.title = most > 0
                         ? "Sampling replicates a spectrum at every multiple of the rate: here the replicas overlap"
                         : "Sampling replicates a spectrum at every multiple of the rate: here without overlap",
            .x = {"frequency (Hz)", -edge, edge},
            .y = {"magnitude", 0, 1.1},
            .curves = {copies, base}};
  if (most > 0) plot.curves.push_back(overlap);
  const double half = args.rate / 2;
  plot.curves.push_back({"half the rate",
                         {{-half, 0}, {-half, 1.1}, {-half, NAN}, {half, 0}, {half, 1.1}},
                         Curve::Mark::Dashed,
                         Curve::grey});
  return plot;
}

std::vector<double> others_of(const SampleOptions& args) {
  std::vector<double> list = aliases_of(args.frequency, args.rate, args.frequency + 3 * args.rate);
  std::erase_if(list, [&](double f) { return std::abs(f - args.frequency) < 1e-9 * args.rate; });
  if (list.size() > aliases_shown) list.resize(aliases_shown);
  return list;
}

std::string text_of(const SampleOptions& args) {
  std::string others;
  for (const double f : others_of(args)) others += fmt::format("{}{:g}", others.empty() ? "" : ", ", f);
  const double seen = args.apparent();
  std::string text =
      fmt::format("{:g} Hz sampled at {:g} Hz: half the rate is {:g} Hz\n", args.frequency, args.rate, args.rate / 2);
  if (args.is_aliased())
    text += fmt::format("  aliased: the samples equal those of {:g} Hz{}\n", std::abs(seen),
                        seen < 0 ? ", running backwards" : "");
  else if (args.frequency == args.rate / 2)
    text += "  exactly half the rate: the samples depend on the phase; they may all be 0\n";
  else
    text += "  not aliased: below half the rate no other frequency has the same samples\n";
  text += fmt::format("  the same samples: {}, ... Hz\n", others);
  const Band band = overlap_of_copies(args.frequency, args.rate);
  return text + (band.low < band.high
                     ? fmt::format("  replicas of a spectrum of bandwidth {:g} Hz overlap from {:g} to {:g} Hz\n",
                                   args.frequency, std::max(0.0, band.low), band.high)
                     : fmt::format("  replicas of a spectrum of bandwidth {:g} Hz are {:g} Hz apart\n", args.frequency,
                                   band.low - band.high));
}

Json::Object json_of(const SampleOptions& args) {
  Json::Array others;
  for (const double f : others_of(args)) others.emplace_back(f);
  const Band band = overlap_of_copies(args.frequency, args.rate);
  Json::Object json{{"frequency", args.frequency}, {"rate", args.rate},
                    {"output", args.output},       {"is_aliased", args.is_aliased()},
                    {"apparent", args.apparent()}, {"same_samples", std::move(others)}};
  json.emplace_back("overlap", band.low < band.high
                                   ? Json(Json::Object{{"low", std::max(0.0, band.low)}, {"high", band.high}})
                                   : Json());
  return json;
}

}  // namespace

void plot_sampling(const SampleOptions& args, Delivery& out) {
  if (!args.output.empty())
    out.save_plots(args.output, std::vector{waves_plot(args), copies_plot(args)}, 1, {.width = 1000, .height = 380});
  print_result(args, text_of(args), json_of(args), out);
}

}  // namespace zoneplate
