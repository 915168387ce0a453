// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/dataset/shots.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/render/lighting.h"
#include "zoneplate/render/renderer.h"

namespace zoneplate {
namespace {

class NearestOfSixteen : public Resolver {
 public:
  Request request(const FrameContext&) override { return {.samples = standard_pattern(16), .content = Content::Data}; }
};

/// The distance that a quarter of a view's surfaces do not reach; 1 without surfaces.
float typical_distance(const SceneView& view, float aspect) {
  RenderSettings settings{.form = ImageForm::Linear};
  settings.options.width = 64, settings.options.height = 36, settings.options.aspect = aspect;
  settings.planes.depth = true;
  std::vector<float> found;
  const Frame data = Renderer(view.scene, nearest_of_sixteen()).render(view.camera, settings).data;
  for (const float depth : data.depth.values())
    if (std::isfinite(depth)) found.push_back(depth);
  if (found.empty()) return 1;
  const auto quarter = found.begin() + static_cast<std::ptrdiff_t>(found.size() / 4);
  std::nth_element(found.begin(), quarter, found.end());
  return *quarter;
}

}  // namespace

std::unique_ptr<Resolver> nearest_of_sixteen() { return std::make_unique<NearestOfSixteen>(); }

Shots::Shots(const DatasetSequence& sequence, SceneSource& source)
    : sequence_(sequence),
      source_(source),
      path_(sequence.seed, static_cast<std::uint32_t>(sequence.number)),
      frames_(frames_of()) {
  const Scene first = at(0);
  View view{.up = first.up};
  if (!first.cameras.empty()) view.index = 0;
  frames_.set_view(view, sequence.aspect());
  distance_ = typical_distance(frames_.view(0), sequence.aspect());
}

SceneView Shots::view(int frame) {
  SceneView out = frames_.view(frame);
  out.camera = moved(out.camera, frame);
  return out;
}

Camera Shots::moved(const Camera& camera, int frame) const {
  // The layout has fields of view alone, no heights of parallel projections.
  const Camera own = sequence_.layout == DatasetLayout::Nss ? as_perspective(camera, distance_) : camera;
  return sequence_.keeps_camera ? own : path_.at(own, distance_, frame);
}

Scene Shots::at(double seconds) {
  choice_.time = seconds;
  Scene scene = source_.load(choice_);
  light_unlit(scene, {.studio = sequence_.studio});
  return scene;
}

Sequence Shots::frames_of() {
  const Scene scene = source_.load({});
  if (!scene.animations.empty()) choice_.animation = 0;
  const auto load = [this](double seconds) { return at(seconds); };
  const auto shape = [this](double seconds) {
    choice_.time = seconds;
    return source_.load_shape(choice_);
  };
  const auto key_times = [this] { return source_.key_times(choice_); };
  // A sequence begins early enough to end within the animation, if it is long enough.
  double duration = 0;
  for (const auto& animation : scene.animations) duration = std::max(duration, static_cast<double>(animation.end));
  const double rate = sequence_.rate, length = static_cast<double>(sequence_.frames) / rate;
  start_ = sequence_.start.value_or(std::max(0.0, duration - length) * static_cast<double>(path_.start()));
  return {{load, shape, key_times}, {}, {.rate = rate, .start = start_, .duration = length}};
}

}  // namespace zoneplate
