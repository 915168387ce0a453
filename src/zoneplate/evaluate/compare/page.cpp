// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/compare/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "zoneplate/evaluate/compare/report.h"

namespace zoneplate {
namespace {

Json target_of(std::optional<std::size_t> scene, std::size_t trial, bool is_on_front) {
  // Image 0 of a scene is the reference.
  Json::Object out{{"image", std::uint64_t{trial + 1}}, {"is_on_front", is_on_front}};
  if (scene) out.emplace_back("scene", std::uint64_t{*scene});
  return out;
}

Json point_of(const std::string& name, double ms, const Column& column, std::optional<double> value, bool is_on_front,
              const Json& target) {
  return Json::Object{{"name", name},
                      {"x", ms},
                      {"y", value && std::isfinite(*value) ? Json(column.scale * *value) : Json()},
                      {"is_on_front", is_on_front},
                      {"target", target}};
}

Json plot_of(const std::string& title, const Column& column, Json::Array points) {
  return Json::Object{{"title", title},
                      {"x", "CPU time per frame (ms)"},
                      {"y", column.head},
                      {"is_linear", !column.is_error()},
                      {"points", std::move(points)}};
}

/// The table of the means of all scenes.
Json means_table_of(const std::vector<SceneTrials>& scenes, const std::vector<MethodMeans>& means) {
  Json::Array targets;
  for (const std::size_t m : ranked(means, *scenes[0].ranking))
    targets.push_back(target_of(std::nullopt, m, means[m].is_on_front));
  return page_table(means_table(scenes, means), "Means of all scenes, and of the classes of artifacts",
                    std::move(targets));
}

std::string title_of(const std::vector<SceneTrials>& scenes) {
  const std::size_t methods = scenes.at(0).trials.size();
  const std::string what = scenes.size() == 1 ? scenes[0].scene : fmt::format("{} scenes", scenes.size());
  return fmt::format("{}: {} {} compared with {}", what, methods, methods == 1 ? "method" : "methods",
                     scenes[0].reference);
}

}  // namespace

std::size_t ComparisonPage::add(PagePicture picture) {
  pictures_.push_back(std::move(picture));
  return pictures_.size() - 1;
}

/// The frames of a sequence, or the only picture of a still image.
Json::Array ComparisonPage::frames_of(const std::vector<Rgba8Image>& film, const Rgba8Image& picture) {
  Json::Array out;
  for (const Rgba8Image& frame : film) out.push_back(std::uint64_t{add(page_picture(frame))});
  if (film.empty()) out.push_back(std::uint64_t{add(page_picture(picture))});
  return out;
}

Json ComparisonPage::image_of(const Trial& trial, const SceneTrials& scene) {
  Json::Array frames = frames_of(trial.film, trial.picture), errors;
  for (std::size_t i = 0; i + 1 < trial.film.size(); ++i)
    errors.push_back(std::uint64_t{add(page_errors(flip_map(scene.reference_film[i], trial.film[i], scene.ignored)))});
  errors.push_back(std::uint64_t{add(page_errors(trial.error_map))});
  return Json::Object{{"name", trial.method},
                      {"facts", facts_of(scene, trial)},
                      {"frames", std::move(frames)},
                      {"errors", std::move(errors)}};
}

void ComparisonPage::add(const SceneTrials& scene) {
  Json::Array images{Json::Object{{"name", scene.reference},
                                  {"facts", "reference"},
                                  {"frames", frames_of(scene.reference_film, scene.reference_picture)},
                                  {"is_reference", true}}};
  const Column column = ranking_column(*scene.ranking);
  Json::Array points, targets;
  for (std::size_t i = 0; i < scene.trials.size(); ++i) {
    const Trial& t = scene.trials[i];
    images.push_back(image_of(t, scene));
    const Json target = target_of(scenes_.size(), i, t.is_on_front);
    points.push_back(point_of(t.method, t.cpu_ms(), column, t.value(column.name), t.is_on_front, target));
  }
  for (const Trial* t : ranked(scene))
    targets.push_back(target_of(scenes_.size(), static_cast<std::size_t>(t - scene.trials.data()), t->is_on_front));
  // The page starts with the reference, and the first methods of the list.
  Json::Array chosen;
  for (std::size_t i = 0; i < std::min<std::size_t>(4, images.size()); ++i) chosen.emplace_back(std::uint64_t{i});
  Json::Object out{
      {"name", scene.name},
      {"text", scene.failure.empty() ? scene.complaint : scene.failure + ": " + scene.complaint},
      {"images", std::move(images)},
      {"chosen", std::move(chosen)},
      {"fps", trial_frame_rate},
      {"frame", std::uint64_t{std::max<std::size_t>(scene.reference_film.size(), 1) - 1}},
      {"tables", Json::Array{page_table(results_of(scene), scene.scene, std::move(targets))}},
      {"plot", plot_of(fmt::format("{}: {} against cost", scene.scene, column.head), column, std::move(points))}};
  if (scene.common_worst.error > 0)
    out.emplace_back("region",
                     Json::Object{{"x", scene.common_worst.x}, {"y", scene.common_worst.y}, {"size", Place::side}});
  scenes_.push_back(std::move(out));
}

std::string ComparisonPage::text(const std::vector<SceneTrials>& scenes) {
  const std::string title = title_of(scenes);
  Json::Object content{
      {"title", title},
      {"text", fmt::format("Ranked by {}. Times and samples are those of a frame. ● is on the Pareto front: no "
                           "other method has less CPU time and a better value.",
                           ranking_column(*scenes.at(0).ranking).head) +
                   (scenes[0].ignored_texts.empty() ? "" : " Ignored: " + ignored_text(scenes[0]) + ".")},
      {"error_name", "FLIP"},
      {"scenes", std::move(scenes_)}};
  if (scenes.size() > 1) {
    const std::vector<MethodMeans> means = means_of(scenes);
    const Column column = ranking_column(*scenes[0].ranking);
    Json::Array points;
    for (std::size_t m = 0; m < means.size(); ++m) {
      points.push_back(point_of(means[m].method, means[m].cpu_ms, column, means[m].rank(), means[m].is_on_front,
                                target_of(std::nullopt, m, means[m].is_on_front)));
    }
    content.emplace_back("tables", Json::Array{means_table_of(scenes, means)});
    content.emplace_back(
        "plot", plot_of(fmt::format("All scenes: mean {} against mean cost", column.head), column, std::move(points)));
  }
  return html_page(title, content, pictures_);
}

}  // namespace zoneplate
