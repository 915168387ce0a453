// SPDX-License-Identifier: Apache-2.0
// The benchmark scenes drawn by Mesa's software OpenGL and Vulkan and by Zoneplate, in turns, in one run: times, their
// ratios, the distance of each image from a supersampled reference, and of each peer's image from Zoneplate's.
// bench/peers/run builds and starts it.
#include <fmt/format.h>
#include <sched.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "peer.h"
#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/metrics/psnr.h"
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

/// Milliseconds a frame: wall-clock time, and that of all processors together.
struct Times {
  double least = 0, median = 0, processor = 0;
};

/// The CPU time of all threads so far.
double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// At least three frames, and no new one after so many milliseconds.
template <class Frame>
Times time_frames(double budget_ms, const Frame& frame) {
  frame();
  std::vector<double> ms;
  const Stopwatch whole;
  const double processor = processor_ms();
  while (ms.size() < 3 || (whole.ms() < budget_ms && ms.size() < 40)) {
    const Stopwatch watch;
    frame();
    ms.push_back(watch.ms());
  }
  const double used = processor_ms() - processor;
  std::sort(ms.begin(), ms.end());
  return {ms.front(), ms[ms.size() / 2], used / static_cast<double>(ms.size())};
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

Rgba8Image render(Renderer& renderer, const Camera& camera, const Work& work) {
  const RenderSettings settings{
      .options = {
          .width = work.width,
          .height = work.height,
          .display = {.background = {work.background.x, work.background.y, work.background.z, 1}, .raw = true}}};
  return renderer.render(camera, settings).display;
}

/// Decibels of a picture against one of `scale` times its width and height, each of whose pixels is a sample.
double psnr(const Rgba8Image& picture, const Rgba8Image& samples, int scale) {
  double sum = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      int r = 0, g = 0, b = 0;
      for (int j = 0; j < scale; ++j)
        for (int i = 0; i < scale; ++i) {
          const Rgba8 s = samples(scale * x + i, scale * y + j);
          r += s.r, g += s.g, b += s.b;
        }
      const Rgba8 p = picture(x, y);
      const double n = scale * scale;
      for (const double d : {p.r - r / n, p.g - g / n, p.b - b / n}) sum += d * d;
    }
  return metrics::psnr_of_mse(sum / (3 * 255.0 * 255.0 * static_cast<double>(picture.values().size())));
}

/// llvmpipe and lavapipe 22.3 do not terminate with anisotropic filtering of several samples; 25.0 do.
bool terminates(const std::string& version) {
  const std::size_t at = version.find("Mesa ");
  return at == std::string::npos || std::atoi(version.c_str() + at + 5) >= 25;
}

struct Api {
  const char* name;
  std::unique_ptr<Peer> (*make)(const Scene&, const Work&);
};
constexpr Api apis[] = {{"llvmpipe", make_llvmpipe}, {"lavapipe", make_lavapipe}};

void print_row(const Case& c, int samples, const char* name, const std::string& cells) {
  fmt::print("{:<15}{}x  {:<10}{}\n", c.scene, samples, name, cells);
  std::fflush(stdout);
}

void compare(const Case& c, double budget_ms, const std::string& pictures) {
  constexpr int scale = 4;
  const Scene scene = *make_builtin_scene(c.scene);
  Work work{.anisotropy = c.anisotropy, .background = c.background};
  const auto renderer_of = [&](int samples) {
    return Renderer(PreparedScene(scene, {.raw_colors = true}),
                    make_resolver(antialias::methods(), samples == 1 ? "none" : fmt::format("msaa:n={}", samples)));
  };
  Work large = work;
  large.width *= scale, large.height *= scale;
  Renderer reference_renderer = renderer_of(1);
  const Rgba8Image reference = render(reference_renderer, scene.cameras.front(), large);

  const auto times_cells = [](Times t) {
    return fmt::format("{:8.1f} {:8.1f} {:8.1f}", t.least, t.median, t.processor);
  };
  const auto save = [&](const char* name, int samples, const Rgba8Image& picture) {
    if (pictures.empty()) return;
    save_bytes(fmt::format("{}/{}-{}x-{}.png", pictures, c.scene, samples, name),
               encode_png(picture, {.has_alpha = false}));
  };
  for (const int samples : {1, 4}) {
    work.samples = samples;
    Renderer renderer = renderer_of(samples);
    Rgba8Image image;
    const Times ours = time_frames(budget_ms, [&] {
      renderer.recycle(std::move(image));
      image = render(renderer, scene.cameras.front(), work);
    });
    print_row(c, samples, "zoneplate",
              fmt::format("{}  {:>20}  {:6.2f}", times_cells(ours), "", psnr(image, reference, scale)));
    save("zoneplate", samples, image);
    for (const Api& api : apis) {
      const std::unique_ptr<Peer> peer = api.make(scene, work);
      if (samples > 1 && c.anisotropy > 1 && !terminates(peer->version())) {
        print_row(c, samples, api.name, "does not terminate");
        continue;
      }
      const Times theirs = time_frames(budget_ms, [&] { peer->frame(); });
      const Rgba8Image picture = peer->picture();
      const Distance d = distance(picture, image);
      print_row(c, samples, api.name,
                fmt::format("{}  {:6.1f} {:6.1f} {:6.1f}  {:6.2f}   {:.4f} {:3}", times_cells(theirs),
                            theirs.least / ours.least, theirs.median / ours.median, theirs.processor / ours.processor,
                            psnr(picture, reference, scale), d.mean, d.most));
      save(api.name, samples, picture);
    }
  }
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
  const Case& first = cases[0];
  const Scene scene = *make_builtin_scene(first.scene);
  for (const Api& api : apis)
    fmt::print("{}: {}\n", api.name, api.make(scene, {.background = first.background})->version());
  fmt::print("1920x1080, {} thread{}\n", threads, threads == 1 ? "" : "s");
  fmt::print("{:<29}{:>26}  {:>20}  {:>6}   {}\n", "", "ms a frame", "ratios", "dB of", "difference from zoneplate");
  fmt::print("{:<29}{:>8} {:>8} {:>8}  {:>6} {:>6} {:>6}  {:>6}   mean, most of 255\n", "", "least", "median", "cpu",
             "least", "median", "cpu", "16x");
  with_threads(threads, [&] {
    for (const Case& c : cases)
      if (only.empty() || only == c.scene) compare(c, budget_ms, pictures);
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
