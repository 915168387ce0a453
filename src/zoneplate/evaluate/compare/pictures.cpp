// SPDX-License-Identifier: Apache-2.0
// The images of a comparison: crops of the regions with the greatest error, and plots of error against cost.
#include "zoneplate/evaluate/compare/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "zoneplate/metrics/flip/magma.h"

namespace zoneplate {
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

/// A point of the plot.
struct Dot {
  std::string method;
  double ms;
  std::optional<double> value;  ///< of the ranking metric
  bool is_on_front;
};

/// The least and the greatest value.
std::pair<double, double> range_of(const std::vector<Dot>& dots) {
  const auto value = [](const Dot& d) { return *d.value; };
  const auto [least, most] = std::ranges::minmax_element(dots, {}, value);
  return {*least->value, *most->value};
}

Plot plot_of(const std::string& title, const metrics::Metric& metric, std::vector<Dot> dots) {
  const Column column = ranking_column(metric);
  std::erase_if(dots, [](const Dot& d) { return !d.value || !std::isfinite(*d.value); });
  std::ranges::stable_sort(dots, {}, &Dot::ms);
  // The region to the left of the front, and on its better side, is empty, so that labels fit there.
  Curve front{.name = "Pareto front",
              .mark = Curve::Mark::LineAndPoints,
              .color = 1,
              .labels_are = column.is_error() ? Curve::Beside::LeftBelow : Curve::Beside::LeftAbove};
  Curve others{.name = "other methods", .mark = Curve::Mark::Points, .color = Curve::grey};
  const bool is_logarithmic = column.is_error() && std::ranges::all_of(dots, [](const Dot& d) { return *d.value > 0; });
  const auto [least, most] = dots.empty() ? std::pair(0.0, 0.0) : range_of(dots);
  for (const Dot& d : dots) {
    Curve& curve = d.is_on_front ? front : others;
    curve.points.emplace_back(d.ms, column.scale * *d.value);
    curve.labels.push_back(d.method);
  }
  // The names of many methods would overlap; then only those on the front are labelled.
  constexpr std::size_t few = 16;
  if (dots.size() > few) others.labels.clear();
  Plot plot{.title = title,
            .x = {.label = "CPU time per frame (ms)", .is_logarithmic = true},
            .y = {.label = column.head, .is_logarithmic = is_logarithmic}};
  // Margins for the labels on both sides.
  if (!dots.empty()) plot.x.low = dots.front().ms / 2.5, plot.x.high = dots.back().ms * (dots.size() > few ? 1.3 : 2.5);
  if (is_logarithmic && !dots.empty()) {
    plot.y.low = column.scale * least / 1.5, plot.y.high = column.scale * most * 1.5;
  } else if (most > least) {
    const double margin = 0.1 * (most - least);
    plot.y.low = column.scale * (least - margin), plot.y.high = column.scale * (most + margin);
  }
  if (plot.y.low < plot.y.high) thin_labels({&front, 1}, plot.x, plot.y);
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
  figure.text = facts_of(scene, trial) + ".";
  return compose(figure);
}

Rgba8Image crops_picture(const SceneTrials& scene) {
  constexpr std::size_t columns = 6;
  Figure figure{.title = scene.failure.empty() ? scene.scene : scene.scene + ": " + scene.failure};
  figure.rows.push_back(
      {{with_mark(scene.reference_picture, scene.common_worst),
        fmt::format("Reference ({}); the frame marks the region of greatest mean error", scene.reference)},
       {crop(scene.reference_picture, scene.common_worst), "reference, enlarged"}});
  const std::vector<const Trial*> order = ranked(scene);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i % columns == 0) figure.rows.emplace_back();
    figure.rows.back().push_back({crop(order[i]->picture, scene.common_worst),
                                  heading_of(order[i]->method) + "\n" + facts_of(scene, *order[i])});
  }
  figure.text = fmt::format(
      "{} and CPU time of a frame are those of the whole image; crops of {} pixels, enlarged 8 times, the best first.",
      ranking_column(*scene.ranking).head, static_cast<int>(Place::side));
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
    dots.push_back({t.method, t.cpu_ms(), t.value(scene.ranking->name), t.is_on_front});
  return plot_of(fmt::format("{}: {} against cost", scene.scene, ranking_column(*scene.ranking).head), *scene.ranking,
                 std::move(dots));
}

Plot cost_plot(const std::vector<SceneTrials>& scenes) {
  std::vector<Dot> dots;
  for (const MethodMeans& m : means_of(scenes)) dots.push_back({m.method, m.cpu_ms, m.rank(), m.is_on_front});
  return plot_of(fmt::format("All scenes: mean {} against mean cost", ranking_column(*scenes.at(0).ranking).head),
                 *scenes.at(0).ranking, std::move(dots));
}

}  // namespace zoneplate
