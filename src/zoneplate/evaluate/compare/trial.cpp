// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/compare/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/os/usage.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

constexpr double budget_ms = 1500;  // no further turn of a method starts after this time
constexpr int worst_count = 3;

Rgba8Image opaque(Rgba8Image image) {
  for (Rgba8& c : image.values()) c.a = 255;
  return image;
}

metrics::Picture picture_of(const Rgba8Image& codes) {
  DisplayImage display(codes.width(), codes.height());
  std::ranges::transform(codes.values(), display.values().begin(), [](Rgba8 c) {
    const auto share = [](std::uint8_t v) { return static_cast<float>(v) / 255; };
    return Display{share(c.r), share(c.g), share(c.b), share(c.a)};
  });
  return metrics::make_picture(std::move(display));
}

/// The settings of frame `index` of `count`, which reports its part of the progress.
RenderSettings frame_settings(const TrialSetup& stage, int index, int count,
                              const std::function<void(double)>& progress) {
  RenderSettings settings = stage.settings;
  settings.options.progress = [index, count, &progress](double done) { progress((index + done) / count); };
  return settings;
}

/// Renders the turns of one method, like consecutive frames of a program. `error`: takes its estimate of its error.
Trial rendered(const TrialSetup& stage, const std::string& method, int turns,
               const std::function<void(double)>& progress, Plane<float>* error = nullptr) {
  Trial trial{.method = method};
  std::optional<Renderer> renderer;
  double sum_ms = 0;
  for (int turn = 0; turn < turns && (turn == 0 || sum_ms < budget_ms); ++turn) {
    const MemoryWatch memory_watch(stage.memory);
    const double used_before = processor_ms();
    const Stopwatch watch;
    if (!renderer) renderer.emplace(stage.scene, upscale::make_method(method));
    RenderSettings settings = frame_settings(stage, turn, turns, progress);
    settings.planes.error = error != nullptr;
    RenderedImage image = renderer->render_still(stage.camera, settings);
    const double ms = watch.ms();
    trial.frames = renderer->still_frames();
    if (turn == 0 || ms / trial.frames < trial.ms()) trial.counts = image.counts;
    trial.frame_ms.push_back(ms / trial.frames);
    trial.processor_ms.push_back((processor_ms() - used_before) / trial.frames);
    sum_ms += ms;
    if (turn > 0) continue;
    if (error) *error = std::move(image.data.error);
    trial.memory = memory_watch.rise();
    trial.picture = opaque(std::move(image.display));
    trial.pixels = trial.picture.values().size();
  }
  return trial;
}

void add(RenderCounts& sum, const RenderCounts& c) {
  sum.prepare_ms += c.prepare_ms, sum.geometry_ms += c.geometry_ms, sum.tiles_ms += c.tiles_ms;
  sum.resolve_ms += c.resolve_ms, sum.display_ms += c.display_ms, sum.filter_ms += c.filter_ms;
  sum.triangles = c.triangles, sum.shaded += c.shaded;
}

/// Renders a sequence by one method. `error` is that of the last frame.
Trial filmed(const TrialSetup& stage, const std::string& method, const std::function<void(double)>& progress,
             Plane<float>* error = nullptr) {
  Trial trial{.method = method, .is_sequence = true, .frames = stage.frames};
  const MemoryWatch memory_watch(stage.memory);
  std::optional<Renderer> renderer;
  for (int i = 0; i < stage.frames; ++i) {
    SceneView view = stage.view(i);
    if (renderer)
      renderer->set_scene(std::move(view.scene));
    else
      renderer.emplace(std::move(view.scene), upscale::make_method(method));
    const double used_before = processor_ms();
    const Stopwatch watch;
    RenderSettings settings = frame_settings(stage, i, stage.frames, progress);
    settings.planes.error = error != nullptr;
    RenderedImage image = renderer->render(view.camera, settings);
    trial.frame_ms.push_back(watch.ms());
    add(trial.counts, image.counts);
    if (error) *error = std::move(image.data.error);
    trial.processor_ms.push_back(processor_ms() - used_before);
    trial.film.push_back(opaque(std::move(image.display)));
  }
  trial.memory = memory_watch.rise();
  trial.picture = trial.film.back();
  trial.pixels = trial.picture.values().size();
  return trial;
}

/// Keeps where the pixels' surfaces were hidden in the last frame: at their centres, for surfaces but not for the
/// background.
class UncoveredPixels : public Resolver {
 public:
  explicit UncoveredPixels(std::vector<Plane<std::uint8_t>>& frames) : frames_(frames) {}
  Request request(const FrameContext& context) override {
    is_first_ = context.is_first;
    Request request;
    request.samples = {SamplePosition{}};
    request.planes.object_id = request.planes.was_visible = true;
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    Plane<std::uint8_t> out(frame.color.width(), frame.color.height());
    for (std::size_t i = 0; i < out.values().size() && !is_first_; ++i)
      out.values()[i] = frame.object_id.values()[i] != Frame::no_id && frame.was_visible.values()[i] == 0 ? 1 : 0;
    frames_.push_back(std::move(out));
    return std::move(frame.color);
  }

 private:
  bool is_first_ = false;
  std::vector<Plane<std::uint8_t>>& frames_;
};

std::vector<Plane<std::uint8_t>> uncovered_pixels(const TrialSetup& stage) {
  std::vector<Plane<std::uint8_t>> out;
  std::optional<Renderer> renderer;
  for (int i = 0; i < stage.frames; ++i) {
    SceneView view = stage.view(i);
    if (renderer)
      renderer->set_scene(std::move(view.scene));
    else
      renderer.emplace(std::move(view.scene), std::make_unique<UncoveredPixels>(out));
    renderer->render(view.camera, stage.settings);
  }
  return out;
}

void judge(Trial& trial, const SceneTrials& scene, const TrialOptions& options) {
  const auto frame_of = [](const std::vector<Rgba8Image>& film, const Rgba8Image& picture, std::size_t i) {
    return picture_of(film.empty() ? picture : film[i]);
  };
  const metrics::Comparands pictures{.count = std::max<std::size_t>(trial.film.size(), 1),
                                     .reference =
                                         [&](std::size_t i) {
                                           metrics::Picture picture =
                                               frame_of(scene.reference_film, scene.reference_picture, i);
                                           metrics::mark_ignored(picture, options.ignored);
                                           if (i < scene.uncovered.size()) picture.is_uncovered = scene.uncovered[i];
                                           return picture;
                                         },
                                     .test = [&](std::size_t i) { return frame_of(trial.film, trial.picture, i); },
                                     .are_frames = !trial.film.empty()};
  metrics::Comparison comparison = metrics::compare(pictures, options.metrics, metrics::Unfit::Leave);
  trial.results = std::move(comparison.results);
  if (!trial.film.empty()) trial.error_map = flip_map(scene.reference_picture, trial.picture, options.ignored);
  for (metrics::Result& result : trial.results)
    if (result.metric->name == "flip" && trial.error_map.empty()) trial.error_map = std::move(result.score.map);
  trial.worst = worst_places(trial.error_map, worst_count);
}

/// Whether a method estimates the error of its own image.
bool estimates_error(const std::string& method, const RenderSettings& settings) {
  FrameContext context;
  context.image = {settings.options.width, settings.options.height};
  return upscale::make_method(method)->request(context).estimates_error;
}

double root_mean_square(const Plane<float>& plane) {
  double sum = 0;
  for (const float v : plane.values()) sum += static_cast<double>(v) * static_cast<double>(v);
  return std::sqrt(sum / static_cast<double>(plane.values().size()));
}

void set_reference(const TrialSetup& stage, const TrialOptions& options, const TrialProgress& progress,
                   SceneTrials& out) {
  out.reference = options.reference;
  if (!options.is_reference_file) {
    const auto step = progress(options.reference);
    Plane<float> error;
    Plane<float>* const estimate = estimates_error(options.reference, stage.settings) ? &error : nullptr;
    Trial trial = stage.frames > 1 ? filmed(stage, options.reference, step, estimate)
                                   : rendered(stage, options.reference, 1, step, estimate);
    if (estimate) out.reference_error = root_mean_square(error);
    out.reference_picture = std::move(trial.picture), out.reference_film = std::move(trial.film);
    trial.picture = {}, trial.film = {};
    out.reference_cost = std::move(trial);
    return;
  }
  out.reference_picture = opaque(quantize8(stage.load_reference().display));
  const auto size = [](int w, int h) { return fmt::format("{}x{}", w, h); };
  const std::string found = size(out.reference_picture.width(), out.reference_picture.height());
  const std::string expected = size(stage.settings.options.width, stage.settings.options.height);
  if (found != expected)
    throw Error(ErrorKind::Input, fmt::format("{}: has {} pixels, the images have {}; give --size {}",
                                              options.reference, found, expected, found));
}

}  // namespace

Plane<float> flip_map(const Rgba8Image& reference, const Rgba8Image& test, const metrics::IgnoredRegions& ignored) {
  const metrics::Choice choice = metrics::choose_metric(metrics::metrics(), "flip");
  metrics::Picture pictures[] = {picture_of(reference), picture_of(test)};
  metrics::mark_ignored(pictures[0], ignored);
  metrics::hide_ignored(pictures[0], pictures[1]);
  return std::move(
      choice.metric->measure(std::span(&pictures[0], 1), std::span(&pictures[1], 1), choice.settings).value().map);
}

namespace {

double time_of(std::vector<double> times, bool is_sequence) {
  const auto place = times.begin() + (is_sequence ? static_cast<std::ptrdiff_t>(times.size() / 2) : 0);
  std::ranges::nth_element(times, place);
  return *place;
}

}  // namespace

double Trial::ms() const { return time_of(frame_ms, is_sequence); }
double Trial::cpu_ms() const { return time_of(processor_ms, is_sequence); }

std::optional<double> Trial::value(std::string_view name) const {
  const std::size_t dot = name.find('.');
  for (const metrics::Result& result : results) {
    if (result.metric->name != name.substr(0, dot)) continue;
    if (dot == std::string_view::npos) return result.value;
    for (const metrics::Figure& figure : result.score.more)
      if (figure.name == name.substr(dot + 1)) return figure.value;
  }
  return std::nullopt;
}

std::vector<Place> worst_places(const Plane<float>& error, int count) {
  constexpr int side = Place::side;
  std::vector<Place> found;
  if (error.width() < side || error.height() < side) return found;
  // A summed-area table: the sum over a square follows from four entries.
  Plane<double> sums(error.width() + 1, error.height() + 1);
  for (int y = 0; y < error.height(); ++y) {
    double row = 0;
    for (int x = 0; x < error.width(); ++x) {
      row += static_cast<double>(error(x, y));
      sums(x + 1, y + 1) = sums(x + 1, y) + row;
    }
  }
  while (static_cast<int>(found.size()) < count) {
    Place best{.error = -1};
    for (int y = 0; y + side <= error.height(); ++y)
      for (int x = 0; x + side <= error.width(); ++x) {
        const double sum = sums(x + side, y + side) - sums(x, y + side) - sums(x + side, y) + sums(x, y);
        if (sum <= best.error) continue;
        const bool is_free = std::ranges::none_of(
            found, [&](const Place& p) { return std::abs(p.x - x) < side && std::abs(p.y - y) < side; });
        if (is_free) best = {x, y, sum};
      }
    if (best.error < 0) break;
    found.push_back(best);
  }
  for (Place& p : found) p.error /= side * side;
  return found;
}

bool is_better(const metrics::Metric& metric, std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return a.has_value() && !b;
  return metric.better == metrics::Better::Lower ? *a < *b : *a > *b;
}

bool is_on_front(const CostPoint& own, std::span<const CostPoint> all, const metrics::Metric& metric) {
  return own.value && std::ranges::none_of(all, [&](const CostPoint& other) {
           const bool is_better_value = is_better(metric, other.value, own.value);
           return !is_better(metric, own.value, other.value) && other.cpu_ms <= own.cpu_ms &&
                  (is_better_value || other.cpu_ms < own.cpu_ms);
         });
}

void mark_front(std::vector<Trial>& trials, const metrics::Metric& metric) {
  std::vector<CostPoint> points;
  for (const Trial& t : trials) points.push_back({t.cpu_ms(), t.value(metric.name)});
  for (std::size_t i = 0; i < trials.size(); ++i) trials[i].is_on_front = is_on_front(points[i], points, metric);
}

SceneTrials run_trials(const TrialSetup& stage, const TrialOptions& options, const TrialProgress& progress) {
  SceneTrials out;
  out.turns = stage.frames > 1 ? stage.frames : options.turns;
  out.ignored = options.ignored, out.ignored_texts = options.ignored_texts;
  out.ranking = options.metrics.at(0).metric;
  set_reference(stage, options, progress, out);
  const bool measures_uncovered = std::ranges::any_of(
      options.metrics, [](const metrics::Choice& choice) { return choice.metric->name == "disocclusion"; });
  if (stage.frames > 1 && measures_uncovered) out.uncovered = uncovered_pixels(stage);
  Plane<float> sum(out.reference_picture.width(), out.reference_picture.height());
  for (const std::string& method : options.methods) {
    const auto step = progress(method);
    Trial trial = stage.frames > 1 ? filmed(stage, method, step) : rendered(stage, method, options.turns, step);
    judge(trial, out, options);
    for (std::size_t i = 0; i < sum.values().size(); ++i) sum.values()[i] += trial.error_map.values()[i];
    out.trials.push_back(std::move(trial));
  }
  if (const std::vector<Place> worst = worst_places(sum, 1); !worst.empty()) {
    out.common_worst = worst[0];
    out.common_worst.error /= static_cast<double>(options.methods.size());
  }
  mark_front(out.trials, *out.ranking);
  return out;
}

}  // namespace zoneplate
