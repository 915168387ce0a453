// SPDX-License-Identifier: Apache-2.0
// The images of a comparison: crops of the regions with the greatest error, and plots of error against cost.
#include "zoneplate/cli/compare/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/metrics/flip/magma.h"

namespace zoneplate::cli {
namespace {

constexpr int factor = 8;
constexpr Rgba8 mark_color{255, 196, 0, 255};

Rgba8Image crop(const Rgba8Image& picture, const Place& place) {
  const int w = std::min(Place::side, picture.width()), h = std::min(Place::side, picture.height());
  Rgba8Image part(w, h);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) part(x, y) = picture(place.x + x, place.y + y);
  return enlarged(part, factor);
}

Rgba8Image with_mark(Rgba8Image picture, const Place& place) {
  const auto set = [&](int x, int y) {
    if (x >= 0 && y >= 0 && x < picture.width() && y < picture.height()) picture(x, y) = mark_color;
  };
  for (int i = -1; i <= Place::side; ++i) {
    set(place.x + i, place.y - 1), set(place.x + i, place.y + Place::side);
    set(place.x - 1, place.y + i), set(place.x + Place::side, place.y + i);
  }
  return picture;
}

/// The FLIP error map in false colours; large errors are bright.
Rgba8Image painted(const Plane<float>& map) { return metrics::paint_magma(map); }

/// The method's text with spaces after commas, where lines may break.
std::string heading_of(std::string method) {
  for (std::size_t at = 0; (at = method.find(',', at)) != std::string::npos; at += 2) method.insert(at + 1, " ");
  return method;
}

std::string figures_of(const Trial& t) {
  return fmt::format("FLIP {:.2f}, PSNR {:.1f} dB, {:.1f} ms", 1000 * t.value("flip").value_or(0),
                     t.value("psnr").value_or(0), t.least_processor_ms());
}

/// A point of the plot.
struct Dot {
  std::string method;
  double ms, error;
  bool is_on_front;
};

Plot plot_of(const std::string& title, std::vector<Dot> dots) {
  std::ranges::stable_sort(dots, {}, &Dot::ms);
  // The region to the left of and below the front is empty, so that labels fit there.
  Curve front{
      .name = "Pareto front", .mark = Curve::Mark::LineAndPoints, .color = 1, .labels_are = Curve::Beside::LeftBelow};
  Curve others{.name = "other methods", .mark = Curve::Mark::Points, .color = Curve::grey};
  constexpr double lower = 0.94, later = 1.4;  // ratios of errors and of times at which names do not overlap
  double last_error = HUGE_VAL, last_ms = 0;
  for (const Dot& d : dots) {
    Curve& curve = d.is_on_front ? front : others;
    curve.points.emplace_back(d.ms, 1000 * d.error);
    const bool is_named = !d.is_on_front || d.error <= lower * last_error || d.ms >= later * last_ms;
    curve.labels.push_back(is_named ? d.method : "");
    if (d.is_on_front && is_named) last_error = d.error, last_ms = d.ms;
  }
  // The names of many methods would overlap; then only those on the front are labelled.
  constexpr std::size_t few = 16;
  if (dots.size() > few) others.labels.clear();
  const bool is_logarithmic = std::ranges::all_of(dots, [](const Dot& d) { return d.error > 0; });
  Plot plot{.title = title,
            .x = {.label = "CPU time per frame (ms)", .is_logarithmic = true},
            .y = {.label = "mean FLIP × 1000", .is_logarithmic = is_logarithmic}};
  // Margins for the labels on both sides.
  if (!dots.empty()) plot.x.low = dots.front().ms / 2.5, plot.x.high = dots.back().ms * (dots.size() > few ? 1.3 : 2.5);
  if (is_logarithmic && !dots.empty()) {
    const auto [least, most] = std::ranges::minmax(dots, {}, &Dot::error);
    plot.y.low = 1000 * least.error / 1.5, plot.y.high = 1000 * most.error * 1.5;
  }
  plot.curves = {std::move(others), std::move(front)};
  return plot;
}

}  // namespace

Rgba8Image worst_picture(const SceneTrials& scene, const Trial& trial) {
  Figure figure{.title = trial.method + " on " + scene.scene, .rows = {{}, {}, {}}, .text = {}};
  const Rgba8Image errors = painted(trial.error_map);
  for (const Place& p : trial.worst) {
    figure.rows[0].push_back({crop(scene.reference_picture, p), fmt::format("reference, at {}, {}", p.x, p.y)});
    figure.rows[1].push_back({crop(trial.picture, p), trial.method});
    figure.rows[2].push_back({crop(errors, p), fmt::format("FLIP, mean {:.3f}", p.error)});
  }
  figure.text = figures_of(trial) + ".";
  return compose(figure);
}

Rgba8Image crops_picture(const SceneTrials& scene) {
  constexpr std::size_t columns = 6;
  Figure figure{.title = scene.failure.empty() ? scene.scene : scene.scene + ": " + scene.failure};
  figure.rows.push_back(
      {{with_mark(scene.reference_picture, scene.common_worst),
        fmt::format("Reference ({}); the frame marks the region of greatest mean error", scene.reference)},
       {crop(scene.reference_picture, scene.common_worst), "reference, enlarged"}});
  std::vector<const Trial*> order;
  for (const Trial& t : scene.trials) order.push_back(&t);
  std::ranges::stable_sort(order, {}, [](const Trial* t) { return t->value("flip").value_or(0); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i % columns == 0) figure.rows.emplace_back();
    figure.rows.back().push_back(
        {crop(order[i]->picture, scene.common_worst), heading_of(order[i]->method) + "\n" + figures_of(*order[i])});
  }
  figure.text = "FLIP × 1000 and CPU time are those of the whole image; crops of " + std::to_string(Place::side) +
                " pixels, enlarged 8 times, in ascending order of error.";
  if (!scene.complaint.empty()) figure.text += "\n" + scene.complaint;
  return compose(figure);
}

Rgba8Image slice_in_time(const std::vector<Rgba8Image>& film, int y) {
  Rgba8Image out(film[0].width(), static_cast<int>(film.size()));
  for (int i = 0; i < out.height(); ++i)
    std::ranges::copy(film[static_cast<std::size_t>(i)].row(y), out.row(i).begin());
  return out;
}

std::vector<Rgba8Image> difference_film(const std::vector<Rgba8Image>& reference, const std::vector<Rgba8Image>& test) {
  std::vector<Rgba8Image> out = test;
  const auto difference = [](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(std::clamp(128 + 8 * (int{b} - int{a}), 0, 255));
  };
  for (std::size_t i = 0; i < out.size(); ++i)
    std::ranges::transform(reference[i].values(), test[i].values(), out[i].values().begin(),
                           [&](const Rgba8& a, const Rgba8& b) {
                             return Rgba8{difference(a.r, b.r), difference(a.g, b.g), difference(a.b, b.b), 255};
                           });
  return out;
}

Plot cost_plot(const SceneTrials& scene) {
  std::vector<Dot> dots;
  for (const Trial& t : scene.trials)
    dots.push_back({t.method, t.least_processor_ms(), t.value("flip").value_or(0), t.is_on_front});
  return plot_of(scene.scene + ": error against cost", std::move(dots));
}

Plot cost_plot(const std::vector<MethodMeans>& means) {
  std::vector<Dot> dots;
  for (const MethodMeans& m : means) {
    dots.push_back({m.method, m.processor_ms, m.error, is_on_front(m, means)});
  }
  return plot_of("All scenes: mean error against mean cost", std::move(dots));
}

}  // namespace zoneplate::cli
