// zoneplate bench: frames of the benchmark scenes, timed stage by stage.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/usage.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/raster/rasterize.h"
#include "zoneplate/render/render.h"
#include "zoneplate/report/json.h"
#include "zoneplate/scene/builtin.h"
#include "zoneplate/shade/material_plan.h"
#include "zoneplate/version.h"

namespace zoneplate::cli {
namespace {

struct BenchArgs {
  std::vector<std::string> scenes;
  int samples = 0;  // 0: 1 and 4
  int threads = 0, frames = 30, warm_up = 2;
  int2 size{1920, 1080};
  double budget_ms = 4000;
  int anisotropy = 0;  // taken for the sake of the harness: a scene has its own
  std::string peer = "zoneplate";
  bool wants_json = false;
};

constexpr std::string_view bench_scenes[] = {"tri1m", "fill", "fillblend", "city", "city-trilinear", "micro"};

// Busy time of all processors, from /proc/stat in hundredths of a second; 0 where there is none.
double machine_busy_ms() {
  std::ifstream stat("/proc/stat");
  std::string name;
  double user = 0, nice = 0, system = 0, idle = 0, wait = 0, irq = 0, soft = 0, steal = 0;
  stat >> name >> user >> nice >> system >> idle >> wait >> irq >> soft >> steal;
  return (user + nice + system + irq + soft + steal) * 10;
}

struct Timing {
  std::vector<double> frame_ms, geometry_ms, tiles_ms;
  double first_ms = 0, processor_ms = 0, others_busy = 0;
  RenderCounts counts;
};

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

// A frame is everything from a scene that is ready to its 8-bit picture in memory.
Timing measure(const BenchArgs& args, const std::string& name, int samples) {
  std::optional<Scene> found = make_builtin_scene(name);
  if (!found) throw Error(Trouble::Input, name + ": no such built-in scene (zoneplate list scenes)");
  const Scene& scene = *found;
  RenderOptions options{.width = args.size.x, .height = args.size.y, .raw_colors = true};
  const TextureSet textures(scene, options.raw_colors);
  options.textures = &textures;
  const std::unique_ptr<Resolver> resolver =
      make_resolver(antialias::methods(), samples == 1 ? "none" : fmt::format("msaa:n={}", samples));
  const DisplayOptions display{.background = {0, 0, 0, 1}, .raw = true};
  options.shown = &display;
  RasterMemory memory;
  options.memory = &memory;
  Timing timing;
  const auto frame = [&] {
    RenderCounts counts;
    const Stopwatch whole;
    const Frame rendered = render(scene, scene.cameras.front(), resolver->ask(0), options, &counts);
    timing.frame_ms.push_back(whole.ms());
    timing.geometry_ms.push_back(counts.geometry_ms);
    timing.tiles_ms.push_back(counts.tiles_ms);
    timing.counts = counts;
  };
  frame();
  timing.first_ms = timing.frame_ms.front();
  for (int i = 1; i < args.warm_up; ++i) frame();
  for (auto* list : {&timing.frame_ms, &timing.geometry_ms, &timing.tiles_ms}) list->clear();

  const Stopwatch wall;
  const double processor = processor_ms(), busy = machine_busy_ms();
  for (int i = 0; i < args.frames && (i < 3 || wall.ms() < args.budget_ms); ++i) frame();
  const double used = processor_ms() - processor;
  timing.processor_ms = used / static_cast<double>(timing.frame_ms.size());
  timing.others_busy = std::max(0.0, (machine_busy_ms() - busy - used) / wall.ms());
  return timing;
}

Json timing_json(const BenchArgs& args, const std::string& scene, int samples, const Timing& t) {
  return Json::Object{
      {"peer", args.peer},
      {"api", "zoneplate"},
      {"renderer", name_of(best_isa())},
      {"version", version},
      {"scene", scene},
      {"w", args.size.x},
      {"h", args.size.y},
      {"samples", samples},
      {"max_samples", 16},
      {"aniso", args.anisotropy},
      {"triangles", t.counts.triangles},
      {"threads", thread_limit()},
      {"frames", static_cast<std::uint64_t>(t.frame_ms.size())},
      {"min_ms", least(t.frame_ms)},
      {"median_ms", median(t.frame_ms)},
      {"mean_ms", mean(t.frame_ms)},
      {"readback_ms", 0},
      {"first_frame_ms", t.first_ms},
      {"cpu_ms_per_frame", t.processor_ms},
      {"other_cores_busy", t.others_busy},
      {"shaded", t.counts.shaded},
      {"triangles_set_up", t.counts.triangles_set_up},
      {"min_ms_by_stage", Json::Object{{"geometry", least(t.geometry_ms)}, {"tiles", least(t.tiles_ms)}}}};
}

std::string timing_text(const std::string& scene, int samples, const Timing& t) {
  const double shaded = std::max(1.0, static_cast<double>(t.counts.shaded));
  const double triangles = std::max(1.0, static_cast<double>(t.counts.triangles));
  return fmt::format(
      "{:<15}{}x  frame {:8.2f} ms  processor {:8.2f} ms  geometry {:7.2f} ({:5.1f} ns a triangle)  tiles {:8.2f} "
      "({:5.1f} ns a point)\n",
      scene, samples, least(t.frame_ms), t.processor_ms, least(t.geometry_ms), 1e6 * least(t.geometry_ms) / triangles,
      least(t.tiles_ms), 1e6 * least(t.tiles_ms) / shaded);
}

Syntax syntax_of(BenchArgs& args) {
  Syntax syntax{.verb = "bench",
                .summary = "Time frames of the benchmark scenes, from a scene in memory to its 8-bit picture",
                .operands = "[SCENE]...",
                .examples =
                    "  zoneplate bench\n"
                    "  zoneplate bench fill --samples 4 --threads 1\n"
                    "  zoneplate bench tri1m --json\n"};
  syntax.notes =
      "The least of all frames is shown: what the work takes when nothing else runs. Scenes by default: tri1m, fill,\n"
      "fillblend, city, city-trilinear, micro. Reading, and making textures' levels, are done before the clock "
      "starts.\n";
  const auto whole = [](int& to, int low, int high) {
    return [&to, low, high](const std::string& text) { to = parse_whole(text, low, high); };
  };
  syntax.options = {
      {"--scene", "NAME", "A scene to time; the result is then a line of JSON, as harnesses want it", "Work", false,
       [&](const std::string& text) { args.scenes.push_back(text); }},
      {"--samples", "N", "Samples a pixel: 1, 2, 4, 8 or 16; default both 1 and 4", "Work", true,
       whole(args.samples, 1, 16)},
      {"--size", "WxH", "Size of the picture; default 1920x1080", "Work", true,
       [&](const std::string& text) { args.size = parse_size(text, 16384); }},
      {"--threads", "N", "Threads; default: as many as there are processors", "Work", true,
       whole(args.threads, 1, 1024)},
      {"--frames", "N", "Frames at most; default 30", "Work", true, whole(args.frames, 1, 1000000)},
      {"--warmup", "N", "Frames before the clock starts; default 2", "Work", false, whole(args.warm_up, 1, 1000)},
      {"--budget-ms", "MS", "No new frame after this time (three are drawn in any case); default 4000", "Work", false,
       [&](const std::string& text) { args.budget_ms = parse_number(text, 1, 1e7); }},
      {"--aniso", "N", "Noted in the result only: a scene has its own filters", "Result", false,
       whole(args.anisotropy, 0, 16)},
      {"--peer", "NAME", "How the result calls this program; default zoneplate", "Result", false,
       [&](const std::string& text) { args.peer = text; }},
      {"--json", "", "One line of JSON a scene", "Result", true, [&](auto&) { args.wants_json = true; }}};
  return syntax;
}

}  // namespace

void run_bench(std::span<const std::string> arguments) {
  BenchArgs args;
  Syntax syntax = syntax_of(args);
  if (!parse(syntax, arguments)) return;
  const bool names_one = !args.scenes.empty();
  args.scenes.insert(args.scenes.end(), syntax.found_operands.begin(), syntax.found_operands.end());
  if (args.scenes.empty()) args.scenes.assign(std::begin(bench_scenes), std::end(bench_scenes));
  const std::vector<int> counts = args.samples ? std::vector{args.samples} : std::vector{1, 4};
  with_threads(args.threads, [&] {
    for (const std::string& scene : args.scenes)
      for (const int samples : counts) {
        const Timing timing = measure(args, scene, samples);
        print(args.wants_json || names_one ? timing_json(args, scene, samples, timing).text() + '\n'
                                           : timing_text(scene, samples, timing));
      }
  });
}

}  // namespace zoneplate::cli
