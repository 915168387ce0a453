// SPDX-License-Identifier: Apache-2.0
// The benchmark scenes drawn by Mesa's software OpenGL and by Zoneplate, in turns, in one run: times, their ratio, and
// how far the two pictures are from each other. bench/peers/run builds and starts it.
#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mesa.h"
#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::peers {
namespace {

struct Case {
  const char* scene;
  int anisotropy;
  float3 background;
};
constexpr float3 dusk{0.10f, 0.12f, 0.15f}, sky{0.45f, 0.60f, 0.80f};
constexpr Case cases[] = {{"tri1m", 1, dusk}, {"fill", 1, dusk},          {"fillblend", 1, dusk},
                          {"city", 8, sky},   {"city-trilinear", 1, sky}, {"micro", 1, dusk}};

struct Times {
  double least, median;
};
Times times_of(std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  return {ms.front(), ms[ms.size() / 2]};
}

/// At least three frames, and no new one after so many milliseconds.
template <class Frame>
Times time_frames(double budget_ms, const Frame& frame) {
  frame();
  std::vector<double> ms;
  const Stopwatch whole;
  while (ms.size() < 3 || (whole.ms() < budget_ms && ms.size() < 40)) {
    const Stopwatch watch;
    frame();
    ms.push_back(watch.ms());
  }
  return times_of(ms);
}

/// Mean and greatest distance of the colour channels, in steps of 1 / 255.
struct Distance {
  double mean = 0;
  int most = 0;
};
Distance distance(const Rgba8Image& p, const Rgba8Image& q) {
  Distance out;
  for (std::size_t i = 0; i < p.values().size(); ++i) {
    const Rgba8 a = p.values()[i], b = q.values()[i];
    for (const int d : {a.r - b.r, a.g - b.g, a.b - b.b}) {
      out.mean += std::abs(d);
      out.most = std::max(out.most, std::abs(d));
    }
  }
  out.mean /= 3 * static_cast<double>(p.values().size());
  return out;
}

void compare(const Case& c, int samples, double budget_ms, const std::string& pictures) {
  const Scene scene = *make_builtin_scene(c.scene);
  const Work work{.samples = samples, .anisotropy = c.anisotropy, .background = c.background};
  Mesa mesa(scene, work);
  // llvmpipe 22.3 does not come back from anisotropic filtering with several samples.
  const bool is_drawn_by_mesa = samples == 1 || c.anisotropy == 1;
  Times theirs{};
  if (is_drawn_by_mesa) theirs = time_frames(budget_ms, [&] { mesa.frame(); });

  Renderer renderer(PreparedScene(scene, {.raw_colors = true}),
                    make_resolver(antialias::methods(), samples == 1 ? "none" : fmt::format("msaa:n={}", samples)));
  const RenderSettings settings{
      .options = {.width = work.width,
                  .height = work.height,
                  .display = {.background = {c.background.x, c.background.y, c.background.z, 1}, .raw = true}}};
  RenderedImage image;
  const Times ours = time_frames(budget_ms, [&] { image = renderer.render(scene.cameras.front(), settings); });

  const auto ms = [](Times t) { return fmt::format("{:8.1f} {:8.1f}", t.least, t.median); };
  fmt::print("{:<15}{}x  {}  {}  ", c.scene, samples, is_drawn_by_mesa ? ms(theirs) : fmt::format("{:>17}", "-"),
             ms(ours));
  if (is_drawn_by_mesa) {
    const Distance d = distance(mesa.picture(), image.display);
    fmt::print("{:6.1f} {:6.1f}   {:.4f} {:3}", theirs.least / ours.least, theirs.median / ours.median, d.mean, d.most);
  }
  fmt::print("\n");
  std::fflush(stdout);
  if (pictures.empty()) return;
  const std::string name = fmt::format("{}/{}-{}x", pictures, c.scene, samples);
  if (is_drawn_by_mesa) save_bytes(name + "-mesa.png", encode_png(mesa.picture(), {.has_alpha = false}));
  save_bytes(name + "-zoneplate.png", encode_png(image.display, {.has_alpha = false}));
}

/// One thread means one processor: Mesa's main thread would use a second one.
void set_threads(int threads) {
  ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  if (threads > 1) return;
  cpu_set_t first;
  CPU_ZERO(&first);
  CPU_SET(0, &first);
  ::sched_setaffinity(0, sizeof first, &first);
}

void run(int threads, const std::string& only, double budget_ms, const std::string& pictures) {
  set_threads(threads);
  fmt::print("1920x1080, {} thread{}: milliseconds a frame, least and median of several\n", threads,
             threads == 1 ? "" : "s");
  fmt::print("{:<19}{:>17}  {:>17}  {:>13}   picture: mean, most of 255\n", "", "Mesa", "Zoneplate", "ratio");
  with_threads(threads, [&] {
    for (const Case& c : cases)
      for (const int samples : {1, 4})
        if (only.empty() || only == c.scene) compare(c, samples, budget_ms, pictures);
  });
}

}  // namespace
}  // namespace zoneplate::peers

int main(int argc, char** argv) {
  int threads = 1;
  double budget_ms = 2000;
  std::string only, pictures;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--threads") threads = std::atoi(argv[i + 1]);
    if (name == "--budget-ms") budget_ms = std::atof(argv[i + 1]);
    if (name == "--scene") only = argv[i + 1];
    if (name == "--pictures") pictures = argv[i + 1];
  }
  if (argc % 2 == 0 || threads < 1) {
    std::fputs("usage: peers [--threads N] [--budget-ms MS] [--scene NAME] [--pictures FOLDER]\n", stderr);
    return 2;
  }
  try {
    zoneplate::peers::run(threads, only, budget_ms, pictures);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "peers: %s\n", error.what());
    return 1;
  }
}
