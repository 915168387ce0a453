// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/sequence.h"

#include <cmath>
#include <utility>
#include <vector>

#include "zoneplate/math/transform.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate {
namespace {

constexpr double tau = 6.28318530717958647692;

constexpr double widths_per_deviation = 2.35482004503094938;  // √(8 ln 2), of a Gaussian's width at half its height

/// The integral of exp(-x² / 2) from -4 to x, by Simpson's rule.
double bell_integral(double x) {
  constexpr int steps = 128;
  const double step = (x + 4) / steps;
  double sum = 0;
  for (int k = 0; k <= steps; ++k) {
    const double at = -4 + k * step;
    sum += natural_exp(-at * at / 2) * (k == 0 || k == steps ? 1 : k % 2 == 0 ? 2 : 4);
  }
  return sum * step / 3;
}

/// The number of standard deviations below which lies a part of a normal distribution that is cut off at four.
double normal_quantile(double part) {
  const double wanted = part * bell_integral(4);
  double low = -4, high = 4;
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (bell_integral(middle) < wanted ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace

Sequence::Sequence(PreparedScene scene, const SequenceTiming& timing) : timing_(timing), scene_(std::move(scene)) {}

Sequence::Sequence(SceneLoader loader, const MipOptions& mips, const SequenceTiming& timing)
    : loader_(std::move(loader)), mips_(mips), timing_(timing) {}

void Sequence::set_view(const View& view, float aspect) {
  view_ = view, aspect_ = aspect;
  Scene all = loader_.load ? all_poses() : scene_->scene();
  const Box bounds = all.bounds();
  centre_ = bounds.empty() ? float3{} : bounds.centre();
  if (timing_.turntable && !view.position && !view.index) add_turns(all);
  still_ = choose_camera(all, view, aspect);
}

const PreparedScene& Sequence::scene(double frame) {
  if (!loader_.load || (scene_ && frame_ == frame)) return *scene_;
  Scene loaded = loader_.load(seconds_of(frame));
  scene_ = scene_ ? PreparedScene(std::move(loaded), *scene_) : PreparedScene(std::move(loaded), mips_);
  frame_ = frame;
  return *scene_;
}

SceneView Sequence::view(double frame) {
  const PreparedScene& at = scene(frame);
  return {at, camera(at.scene(), frame)};
}

Moment Sequence::moment(double frame) {
  const std::shared_ptr<const Scene> shape =
      loader_.load ? std::make_shared<const Scene>(loader_.load_shape(seconds_of(frame))) : scene_->shared_scene();
  return {shape, camera(*shape, frame)};
}

Camera Sequence::camera(const Scene& scene, double frame) const {
  Camera camera = view_.index && loader_.load ? choose_camera(scene, view_, aspect_) : still_;
  if (!timing_.turntable) return camera;
  camera.world_from_camera = turned(static_cast<float>(tau * frame / *timing_.turntable)) * camera.world_from_camera;
  return camera;
}

/// All poses of the animation in one scene. Its bounds do not depend on which frames are rendered.
Scene Sequence::all_poses() {
  constexpr int poses = 8;
  Scene all;
  for (int i = 0; i < poses; ++i) {
    Scene scene = loader_.load_shape(timing_.start + timing_.duration * i / (poses - 1));
    const auto before = static_cast<int>(all.meshes.size());
    for (Mesh& mesh : scene.meshes) all.meshes.push_back(std::move(mesh));
    for (Instance instance : scene.instances) instance.mesh += before, all.instances.push_back(instance);
    if (i == 0) all.cameras = scene.cameras;
  }
  return all;
}

float4x4 Sequence::turned(float angle) const {
  return translation(centre_) * rotation(view_.up, angle) * translation(-centre_);
}

/// Adds the scene as seen from all positions of the turntable, relative to its first one.
void Sequence::add_turns(Scene& all) const {
  constexpr int steps = 24;
  const std::vector<Instance> once = all.instances;
  for (int i = 1; i < steps; ++i)
    for (Instance instance : once) {
      instance.world_from_object = turned(static_cast<float>(tau * i / steps)) * instance.world_from_object;
      all.instances.push_back(instance);
    }
}

double shutter_time(double frame, double open, int i, int count, ShutterFilter filter) {
  const double part = (i + 0.5) / count;
  if (filter == ShutterFilter::Box) return frame + open * (i + 0.5) / count;
  const double middle = frame + open / 2;
  if (filter == ShutterFilter::Gaussian) return middle + open / widths_per_deviation * normal_quantile(part);
  return middle + (part < 0.5 ? open * (std::sqrt(2 * part) - 1) : open * (1 - std::sqrt(2 * (1 - part))));
}

}  // namespace zoneplate
