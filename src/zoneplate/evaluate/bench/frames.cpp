// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/bench/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/usage.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate {
namespace {

// Busy time of all processors in milliseconds, from /proc/stat, whose unit is 10 ms; 0 if it is not available.
double machine_busy_ms() {
  std::ifstream stat("/proc/stat");
  std::string name;
  double user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, soft = 0, steal = 0;
  stat >> name >> user >> nice >> system >> idle >> wait >> irq >> soft >> steal;
  return (user + nice + system + irq + soft + steal) * 10;
}

// The background colour of other renderers' versions of these scenes.
float4 background_of(const std::string& scene) {
  return scene.starts_with("city") ? float4{0.45f, 0.60f, 0.80f, 1} : float4{0.10f, 0.12f, 0.15f, 1};
}

// The frames of a scene, one after the other.
class Frames {
 public:
  explicit Frames(const BenchWork& work) : Frames(work, scene_of(work)) {}

  int anisotropy() const { return anisotropy_; }
  const Rgba8Image& picture() const { return picture_; }

  // Renders one frame; its time and the counts of its work.
  std::pair<double, RenderCounts> render() {
    renderer_.recycle(std::move(picture_));
    const Stopwatch watch;
    RenderedImage image = renderer_.render(camera_, settings_);
    const double ms = watch.ms();
    picture_ = std::move(image.display);
    return {ms, image.counts};
  }

 private:
  static Scene scene_of(const BenchWork& work) {
    std::optional<Scene> scene = make_builtin_scene(work.scene);
    if (!scene) throw Error(ErrorKind::Input, work.scene + ": no such built-in scene (zoneplate list scenes)");
    if (scene->cameras.empty()) throw Error(ErrorKind::Input, work.scene + ": has no camera of its own");
    for (Material& material : scene->materials)
      if (work.anisotropy > 0) material.base_color_texture.sampler.anisotropy = work.anisotropy;
    return std::move(*scene);
  }

  Frames(const BenchWork& work, Scene scene)
      : camera_(scene.cameras.front()),
        settings_{.options = {.width = work.size.x,
                              .height = work.size.y,
                              .display = {.background = background_of(work.scene), .raw = true}}},
        anisotropy_(anisotropy_of(scene)),
        renderer_(
            PreparedScene(std::move(scene), {.raw_colors = true}),
            make_resolver(antialias::methods(), work.samples == 1 ? "none" : fmt::format("msaa:n={}", work.samples))) {}

  static int anisotropy_of(const Scene& scene) {
    int most = 1;
    for (const Material& material : scene.materials)
      most = std::max(most, material.base_color_texture.sampler.anisotropy);
    return most;
  }

  Camera camera_;
  RenderSettings settings_;
  int anisotropy_;
  Renderer renderer_;
  Rgba8Image picture_;
};

}  // namespace

BenchTiming time_frames(const BenchWork& work) {
  Frames frames(work);
  BenchTiming timing;
  timing.anisotropy = frames.anisotropy();
  const auto frame = [&] {
    const auto [ms, counts] = frames.render();
    if (timing.frame_ms.empty() || ms < least(timing.frame_ms)) timing.best = counts;
    timing.frame_ms.push_back(ms);
    timing.geometry_ms = std::min(timing.geometry_ms, counts.geometry_ms);
    timing.tiles_ms = std::min(timing.tiles_ms, counts.tiles_ms);
  };
  frame();
  timing.first_ms = timing.frame_ms.front();
  for (int i = 1; i < work.warm_up; ++i) frame();
  timing.frame_ms.clear();
  timing.geometry_ms = timing.tiles_ms = std::numeric_limits<double>::max();

  const Stopwatch wall;
  const double processor = processor_ms(), busy = machine_busy_ms();
  for (int i = 0; i < work.frames && (i < 3 || wall.ms() < work.budget_ms); ++i) frame();
  const double used = processor_ms() - processor;
  timing.processor_ms = used / static_cast<double>(timing.frame_ms.size());
  timing.others_busy = std::max(0.0, (machine_busy_ms() - busy - used) / wall.ms());

  std::vector<double> encode;
  for (int i = 0; i < 3; ++i) {
    const Stopwatch watch;
    encode_png(frames.picture(), {.has_alpha = false});
    encode.push_back(watch.ms());
  }
  timing.encode_ms = least(encode);
  return timing;
}

WorkTimes time_frame_loops(const BenchWork& work) {
  Frames frames(work);
  std::optional<WorkTimes> best;
  const Stopwatch wall;
  for (int i = 0; i < work.warm_up + work.frames && (i < work.warm_up + 3 || wall.ms() < work.budget_ms); ++i) {
    WorkTimes times = time_loops([&] { frames.render(); });
    if (i >= work.warm_up && (!best || times.total < best->total)) best = std::move(times);
  }
  return std::move(*best);
}

double least(const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); }
double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.size() % 2 ? v[v.size() / 2] : (v[v.size() / 2 - 1] + v[v.size() / 2]) / 2;
}
double mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

}  // namespace zoneplate
