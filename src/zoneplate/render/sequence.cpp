// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/sequence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "zoneplate/math/spread_order.h"
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

constexpr int sides = 24;  // of a turntable, from which its scene has to be seen

/// The poses of an animation in one scene, as far as a camera around them needs it: places without looks.
class Poses {
 public:
  explicit Poses(bool has_sides) : cost_of_instance_(has_sides ? 16 * sides : 16) {}

  void add(Scene scene) {
    if (count_++ == 0) all_.cameras = scene.cameras, all_.origin = scene.origin, all_.materials = scene.materials;
    std::vector<int> meshes(scene.meshes.size(), -1);  // of this pose, in all_
    for (Instance instance : scene.instances) {
      int& mesh = meshes[static_cast<std::size_t>(instance.mesh)];
      int& last = last_.try_emplace({instance.object, instance.part}, -1).first->second;
      if (mesh < 0) mesh = kept(scene.meshes[static_cast<std::size_t>(instance.mesh)], last);
      instance.mesh = last = mesh;
      all_.instances.push_back(instance);
    }
    cost_ += cost_of_instance_ * scene.instances.size();
  }

  /// Whether further poses would take too much time or memory.
  bool are_enough() const {
    constexpr std::size_t least = 16, max_cost = 1 << 22, max_kept = 1 << 20;
    return count_ >= least && (cost_ >= max_cost || kept_ >= max_kept);
  }

  Scene take() { return std::move(all_); }

 private:
  /// The number of a mesh in all_, into which it moves unless it is the one that its instance had in the last pose.
  int kept(Mesh& mesh, int last) {
    cost_ += mesh.position.size();
    if (last >= 0) {
      const Mesh& before = all_.meshes[static_cast<std::size_t>(last)];
      if (before.topology == mesh.topology && before.position == mesh.position && before.index == mesh.index)
        return last;
    }
    kept_ += mesh.position.size();
    Mesh& out = all_.meshes.emplace_back();
    out.topology = mesh.topology, out.material = mesh.material, out.position = std::move(mesh.position),
    out.index = std::move(mesh.index);
    return static_cast<int>(all_.meshes.size()) - 1;
  }

  Scene all_;
  std::map<std::pair<int, int>, int> last_;  ///< by object and part of an instance: its last mesh in all_
  std::size_t cost_of_instance_, count_ = 0;
  std::size_t cost_ = 0, kept_ = 0;  ///< vertices that were loaded, and those of all_
};

}  // namespace

Sequence::Sequence(PreparedScene scene, const SequenceTiming& timing) : timing_(timing), scene_(std::move(scene)) {}

Sequence::Sequence(SceneLoader loader, const MipOptions& mips, const SequenceTiming& timing)
    : loader_(std::move(loader)), mips_(mips), timing_(timing) {}

void Sequence::set_view(const View& view, float aspect) {
  view_ = view, aspect_ = aspect;
  // A camera of the scene is chosen anew for each frame, and needs no other pose unless it turns about all of them.
  const bool follows = view.index && !timing_.turntable;
  Scene all = !loader_.load ? scene_->scene() : follows ? loader_.load_shape(timing_.start) : all_poses();
  const Box bounds = all.bounds();
  centre_ = bounds.empty() ? float3{} : bounds.centre();
  if (is_seen_from_all_sides()) {
    view_ = facing_front(all, view, aspect);  // of its first frame: some of the turns are always seen from the front
    add_turns(all);
  }
  still_ = choose_camera(all, view_, aspect);
}

void Sequence::set_views(std::function<View(double)> view_at, float aspect) {
  view_at_ = std::move(view_at), aspect_ = aspect;
  if (loader_.load) poses_ = all_poses();
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

bool Sequence::is_seen_from_all_sides() const { return timing_.turntable && !view_.position && !view_.index; }

Camera Sequence::camera(const Scene& scene, double frame) const {
  if (view_at_) {
    const View view = view_at_(frame);
    const Camera camera = choose_camera(loader_.load && !view.index ? poses_ : scene, view, aspect_);
    return view.index ? camera : enclosing(camera, scene);
  }
  Camera camera = view_.index && loader_.load ? choose_camera(scene, view_, aspect_) : still_;
  if (timing_.turntable)
    camera.world_from_camera = turned(static_cast<float>(tau * frame / *timing_.turntable)) * camera.world_from_camera;
  const bool is_new = loader_.load || (timing_.turntable && !is_seen_from_all_sides());
  return is_new && !view_.index ? enclosing(std::move(camera), scene) : camera;
}

/// The times of poses that the camera has to see, the most important first: evenly spaced ones, the loader's key times,
/// and those of frames.
std::vector<double> Sequence::pose_times() const {
  constexpr int even = 8;
  constexpr std::size_t most = 256;
  std::vector<double> out;
  const auto add = [&](double time) {
    if (out.size() < most && std::ranges::find(out, time) == out.end()) out.push_back(time);
  };
  for (int i = 0; i < even; ++i) add(timing_.start + timing_.duration * i / (even - 1));
  const std::vector<double> keys = loader_.key_times ? loader_.key_times() : std::vector<double>();
  for (const double time : keys)
    if (time > timing_.start && time < timing_.start + timing_.duration) add(time);
  const double frames = std::min(std::floor(timing_.duration * timing_.rate + 1e-6), 1e6);
  for (const std::size_t i : spread_order(static_cast<std::size_t>(frames) + 1, most))
    add(seconds_of(static_cast<double>(i)));
  return out;
}

/// The poses of the animation in one scene. Its bounds do not depend on which frames are rendered.
Scene Sequence::all_poses() const {
  Poses poses(is_seen_from_all_sides());
  for (const double time : pose_times()) {
    if (poses.are_enough()) break;
    poses.add(loader_.load_shape(time));
  }
  return poses.take();
}

float4x4 Sequence::turned(float angle) const {
  return translation(centre_) * rotation(view_.up, angle) * translation(-centre_);
}

/// Adds the scene as seen from all positions of the turntable, relative to its first one.
void Sequence::add_turns(Scene& all) const {
  const std::vector<Instance> once = all.instances;
  for (int i = 1; i < sides; ++i)
    for (Instance instance : once) {
      instance.world_from_object = turned(static_cast<float>(tau * i / sides)) * instance.world_from_object;
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
