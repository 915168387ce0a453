// SPDX-License-Identifier: Apache-2.0
// Aliases: different waves with the same samples, and the suppression of aliases by each filter.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/signal/filter/aliasing.h"
#include "zoneplate/signal/filter/resample.h"
#include "zoneplate/signal/fourier/series.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::lessons {
namespace aliases_lesson {
namespace {

constexpr int shown_samples = 10;

std::span<const Param> alias_params() {
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> out;
    for (const KernelEntry& kernel : kernels()) out.push_back(kernel.name);
    return out;
  }();
  static const Param params[] = {{.name = "frequency",
                                  .meaning = "of the faster wave, in cycles per sample",
                                  .value = 0.9,
                                  .low = 0.6,
                                  .high = 2.4,
                                  .decimals = 1},
                                 {.name = "kernel",
                                  .meaning = "of the filtered zone plates",
                                  .value = static_cast<double>(std::ranges::find(names, "lanczos3") - names.begin()),
                                  .names = names}};
  return params;
}

/// A reduction of a zone plate.
struct Reduction {
  int from, to;
  double factor() const { return static_cast<double>(from) / to; }
};
/// The measured reductions; smaller ones at small sizes.
std::array<Reduction, 2> reductions(const DemoSize& size) {
  const int share = size.panel < 200 ? 1 : 2;
  return {{{128 * share, 64 * share}, {185 * share, 50 * share}}};
}

Plot waves_plot(double frequency) {
  const double seen = apparent_frequency(frequency, 1);
  Plot plot{.x = {"position (samples)", 0, shown_samples}, .y = {"value", -1.25, 1.25}};
  Curve fast{.name = fmt::format("{} cycles per sample", number(frequency, 1)), .color = Curve::grey};
  Curve slow{.name = number(std::abs(seen), 1) + " cycles per sample", .color = 0};
  Curve samples{.name = "samples of both", .mark = Curve::Mark::Points, .color = 1};
  constexpr int fine = 60;
  for (int i = 0; i <= shown_samples * fine; ++i) {
    const double x = static_cast<double>(i) / fine;
    fast.points.emplace_back(x, cos_pi(2 * frequency * x));
    slow.points.emplace_back(x, cos_pi(2 * seen * x));
    if (i % fine == 0) samples.points.emplace_back(x, cos_pi(2 * frequency * x));
  }
  plot.curves = {fast, slow, samples};
  return plot;
}

Plot folding_plot(double frequency) {
  Plot plot{.x = {"true frequency (cycles per sample)", 0, 2.5}, .y = {"apparent frequency", 0, 0.6}};
  Curve folded{.name = "apparent", .color = 0}, same{.name = "true", .mark = Curve::Mark::Dashed, .color = Curve::grey};
  for (int i = 0; i <= 25; ++i) folded.points.emplace_back(i / 10.0, folded_frequency(i / 10.0, 1));
  same.points = {{0, 0}, {0.6, 0.6}};
  Curve family{.name = fmt::format("aliases of {}", number(folded_frequency(frequency, 1), 1)),
               .mark = Curve::Mark::Points,
               .color = 1};
  const double seen = folded_frequency(frequency, 1);
  family.points.emplace_back(seen, seen);
  for (const double f : aliases_of(seen, 1, 2.5)) family.points.emplace_back(f, folded_frequency(f, 1));
  plot.curves = {same, folded, family};
  return plot;
}

std::string decibels(double db) { return db <= -399 ? "−∞" : number(db, 1); }

Table kernel_table(const std::array<Reduction, 2>& measured) {
  Table table;
  table.head = {"kernel"};
  for (const Reduction& r : measured) {
    const std::string by = "÷" + number(r.factor(), r.factor() > 3 ? 1 : 0);
    for (const char* what : {": all", "theory", "far", "theory"})
      table.head.push_back((what[0] == ':' ? by : std::string()) + what);
  }
  std::vector<Plane<float>> plates;
  for (const Reduction& r : measured) plates.push_back(zone_plate(r.from));
  for (const KernelEntry& entry : kernels()) {
    const Kernel kernel = make_kernel(entry.name);
    std::vector<std::string> row(1, std::string(entry.name));
    for (std::size_t i = 0; i < plates.size(); ++i) {
      const AliasFigures found = measure_aliases(plates[i], measured[i].to, measured[i].to, kernel);
      const AliasFigures expected = predict_aliases(kernel, measured[i].factor());
      for (const double db : {found.all_db, expected.all_db, found.far_db, expected.far_db})
        row.push_back(decibels(db));
    }
    // Kernels of two names, such as lanczos and lanczos3, have one row.
    const auto is_same = [&](const std::vector<std::string>& other) {
      return std::equal(row.begin() + 1, row.end(), other.begin() + 1);
    };
    if (const auto same = std::ranges::find_if(table.rows, is_same); same != table.rows.end())
      same->front() += ", " + row.front();
    else
      table.rows.push_back(std::move(row));
  }
  return table;
}

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel, gap = size.style().gap_px, tenths = (side + 2 * seam) / 10;
  const int width = 2 * side + gap, height = side * 9 / 10;
  Figure figure{.title = "Aliases: different waves with the same samples"};
  const double frequency = settings.number("frequency"), seen = std::abs(apparent_frequency(frequency, 1));
  const std::string shown_kernel(settings.chosen("kernel"));
  figure.rows.push_back(
      {plot_panel(waves_plot(frequency), width, height,
                  fmt::format("Indistinguishable waves\nWaves of {} and of {} cycles per sample agree at every sample; "
                              "reconstruction gives the lower frequency.",
                              number(frequency, 1), number(seen, 1))),
       plot_panel(
           folding_plot(frequency), width, height,
           "Frequencies fold at ½\nHalf a cycle per sample is the Nyquist frequency: a higher frequency appears as a "
           "lower "
           "one, its alias.")});

  const Kernel kernel = make_kernel(shown_kernel);
  std::vector<Panel>& row = figure.rows.emplace_back();
  for (const Reduction& r : {Reduction{20 * tenths, 10 * tenths}, Reduction{37 * tenths, 10 * tenths}}) {
    const Plane<float> plate = zone_plate(r.from);
    const std::string factor = number(r.factor(), r.factor() > 3 ? 1 : 0);
    row.push_back({shown(inside(resample_nearest(plate, r.to, r.to))),
                   fmt::format("{} times smaller, unfiltered\nOnly the rings around the centre are real.", factor)});
    row.push_back(
        {shown(inside(resample(plate, r.to, r.to, kernel, {.border = Border::Wrap}))),
         fmt::format("{} times smaller, {}\nFrequencies above the Nyquist limit are grey.", factor, shown_kernel)});
  }

  const auto measured = reductions(size);
  const Table table = kernel_table(measured);
  figure.rows.push_back({{table_picture(table, size.style(), 4 * side + 3 * gap), ""}});
  figure.text = fmt::format(
      "Energy of aliases after each kernel when zone plates of {} and {} pixels are reduced, in dB relative to no "
      "filter: measured in the image, and theory from the kernel’s frequency response. Far: aliases of frequencies "
      "above 1.5 times the new Nyquist frequency, which form coarse patterns. Lower is better, but a wide kernel also "
      "attenuates detail below the Nyquist limit.",
      measured[0].from, measured[1].from);
  return {.frames = {figure}, .tables = {table}};
}

}  // namespace
}  // namespace aliases_lesson

Demo demo_aliases() {
  return {"aliases", "waves with the same samples, and the suppression of aliases by each kernel", aliases_lesson::make,
          aliases_lesson::alias_params()};
}

}  // namespace zoneplate::lessons
