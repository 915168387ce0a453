// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/signal/series.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace zoneplate {
namespace {

constexpr int steps_of_period = 2000;  // points of a curve over one period

/// The error of the partial sum of the harmonics 1 to `highest`.
struct PartialSum {
  int highest = 0;
  double greatest = 0;  ///< maximum of the sum; the waves have a maximum of 1
  double rms = 0;       ///< root mean square of the omitted harmonics, by Parseval
};

double jump_of(Wave wave) { return wave == Wave::Triangle ? 0 : 2; }

// The mean square of the waves: 1 for the square, 1/3 for the others.
double mean_square(Wave wave) { return wave == Wave::Square ? 1 : 1.0 / 3; }

// The position of the sum's maximum. The derivative of the sum is a Dirichlet kernel, whose first zero after the jump
// is half a period of the next harmonic away; the triangle's harmonics all have their maximum at its tip.
double summit(Wave wave, int highest) {
  if (wave == Wave::Triangle) return 0.25;
  const int last = wave == Wave::Square && highest % 2 == 0 ? highest - 1 : highest;
  const double away = 0.5 / (last + 1);
  return wave == Wave::Square ? away : 1 - away;
}

PartialSum summarize(Wave wave, int highest) {
  PartialSum sum{highest, partial_sum(wave, highest, summit(wave, highest)), mean_square(wave)};
  for (int n = 1; n <= highest; ++n) sum.rms -= harmonic(wave, n) * harmonic(wave, n) / 2;
  sum.rms = std::sqrt(std::max(0.0, sum.rms));
  return sum;
}

Plot sums_plot(Wave wave, const SeriesOptions& args) {
  Plot plot{.title = fmt::format("A {} wave from its harmonics", name_of(wave)),
            .x = {"position (periods)", 0, 1},
            .y = {"value", -1.3, 1.3},
            .curves = {}};
  Curve whole{"the wave", {}, Curve::Mark::Line, Curve::grey};
  for (int i = 0; i <= steps_of_period; ++i)
    whole.points.emplace_back(static_cast<double>(i) / steps_of_period,
                              wave_value(wave, static_cast<double>(i) / steps_of_period));
  plot.curves.push_back(whole);
  for (std::size_t k = 0; k < args.terms.size(); ++k) {
    Curve curve{fmt::format("harmonics to {}", args.terms[k]), {}, Curve::Mark::Line, static_cast<int>(k)};
    for (int i = 0; i <= steps_of_period; ++i) {
      const double x = static_cast<double>(i) / steps_of_period;
      curve.points.emplace_back(x, partial_sum(wave, args.terms[k], x));
    }
    plot.curves.push_back(std::move(curve));
  }
  return plot;
}

// Limits the number of harmonics to a legible one.
Plot harmonics_plot(Wave wave, const SeriesOptions& args) {
  const int last = std::clamp(*std::max_element(args.terms.begin(), args.terms.end()), 5, 40);
  Curve bars{"amplitude of the harmonic", {}, Curve::Mark::Stems, 0}, fall{"", {}, Curve::Mark::Dashed, Curve::grey};
  for (int n = 1; n <= last; ++n)
    if (harmonic(wave, n) != 0) bars.points.emplace_back(n, std::abs(harmonic(wave, n)));
  const int power = wave == Wave::Triangle ? 2 : 1;
  const double first = std::abs(harmonic(wave, 1));
  fall.name = power == 1 ? "falls as 1/n" : "falls as 1/n²";
  for (int i = 10; i <= 10 * (last + 1); ++i) {
    const double n = i / 10.0;
    fall.points.emplace_back(n, first / (power == 1 ? n : n * n));
  }
  return {.title = "Its spectrum",
          .x = {"frequency (cycles per period)", 0, last + 1.0},
          .y = {"amplitude", 0, std::ceil(first * 5 + 0.5) / 5},
          .curves = {fall, bars}};
}

std::string text_of(Wave wave, const std::vector<PartialSum>& sums) {
  std::string text =
      fmt::format("{} wave between -1 and 1\n  harmonics to   greatest   overshoot   rms error\n", name_of(wave));
  for (const PartialSum& sum : sums) {
    const std::string overshoot =
        jump_of(wave) > 0 ? fmt::format("{:.3f} %", 100 * (sum.greatest - 1) / jump_of(wave)) : "none";
    text += fmt::format("  {:<15}{:<11.6f}{:<12}{:.6f}\n", sum.highest, sum.greatest, overshoot, sum.rms);
  }
  if (jump_of(wave) > 0)
    text +=
        "The overshoot, in per cent of the jump, tends to 8.949 % and not to 0: only its position moves to the jump "
        "(Gibbs phenomenon).\n";
  return text;
}

Json::Object json_of(Wave wave, const SeriesOptions& args, const std::vector<PartialSum>& sums) {
  Json::Array rows, harmonics;
  for (const PartialSum& sum : sums)
    rows.emplace_back(
        Json::Object{{"highest", sum.highest},
                     {"greatest", sum.greatest},
                     {"overshoot_of_jump", jump_of(wave) > 0 ? Json((sum.greatest - 1) / jump_of(wave)) : Json()},
                     {"missing_rms", sum.rms}});
  const int last = *std::max_element(args.terms.begin(), args.terms.end());
  for (int n = 1; n <= last; ++n) harmonics.emplace_back(harmonic(wave, n));
  return {
      {"wave", name_of(wave)}, {"output", args.output}, {"sums", std::move(rows)}, {"harmonics", std::move(harmonics)}};
}

}  // namespace

void plot_series(Wave wave, const SeriesOptions& args, Delivery& out) {
  std::vector<PartialSum> sums;
  for (const int n : args.terms) sums.push_back(summarize(wave, n));
  if (!args.output.empty())
    out.save_plots(args.output, std::vector{sums_plot(wave, args), harmonics_plot(wave, args)}, 2, {});
  print_result(args, text_of(wave, sums), json_of(wave, args, sums), out);
}

}  // namespace zoneplate
