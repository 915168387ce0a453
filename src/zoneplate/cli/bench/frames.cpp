// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/bench/frames.h"

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
#include "zoneplate/cli/usage.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::cli {
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

}  // namespace

BenchTiming time_frames(const BenchWork& work) {
  std::optional<Scene> found = make_builtin_scene(work.scene);
  if (!found) throw Error(ErrorKind::Input, work.scene + ": no such built-in scene (zoneplate list scenes)");
  if (found->cameras.empty()) throw Error(ErrorKind::Input, work.scene + ": has no camera of its own");
  BenchTiming timing;
  for (Material& material : found->materials) {
    int& anisotropy = material.base_color_texture.sampler.anisotropy;
    if (work.anisotropy > 0) anisotropy = work.anisotropy;
    timing.anisotropy = std::max(timing.anisotropy, anisotropy);
  }
  const Camera camera = found->cameras.front();
  const RenderSettings settings{.options = {.width = work.size.x,
                                            .height = work.size.y,
                                            .display = {.background = background_of(work.scene), .raw = true}}};
  constexpr MipOptions mips{.raw_colors = true};
  Renderer renderer(
      PreparedScene(std::move(*found), mips),
      make_resolver(antialias::methods(), work.samples == 1 ? "none" : fmt::format("msaa:n={}", work.samples)));
  Rgba8Image picture;

  const auto frame = [&] {
    renderer.recycle(std::move(picture));
    const Stopwatch whole;
    RenderedImage image = renderer.render(camera, settings);
    const double ms = whole.ms();
    const RenderCounts& counts = image.counts;
    if (timing.frame_ms.empty() || ms < least(timing.frame_ms)) timing.best = counts;
    timing.frame_ms.push_back(ms);
    timing.geometry_ms = std::min(timing.geometry_ms, counts.geometry_ms);
    timing.tiles_ms = std::min(timing.tiles_ms, counts.tiles_ms);
    picture = std::move(image.display);
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
    encode_png(picture, {.has_alpha = false});
    encode.push_back(watch.ms());
  }
  timing.encode_ms = least(encode);
  return timing;
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

}  // namespace zoneplate::cli
