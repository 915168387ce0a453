// SPDX-License-Identifier: Apache-2.0
// zoneplate bench: times the frames of the benchmark scenes, stage by stage.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/evaluate/bench/frames.h"
#include "zoneplate/evaluate/bench/limits.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/report/json.h"
#include "zoneplate/report/report_version.h"
#include "zoneplate/version.h"

namespace zoneplate::cli {
namespace {

struct BenchArgs {
  std::vector<std::string> scenes;
  BenchWork work;   // all but the scene and the samples
  int samples = 0;  // 0: both 1 and 4
  int threads = 0;
  Isa isa = current_isa();
  std::string peer = "zoneplate";
  bool prints_json = false, simulates = false;
};

constexpr std::string_view bench_scenes[] = {"tri1m", "fill", "fillblend", "city", "city-trilinear", "micro"};

Json stages_json(const BenchTiming& t) {
  const StageTimes& s = t.best.stages;
  return Json::Object{{"prepare", t.best.prepare_ms}, {"vertices", s.vertices}, {"triangles", s.triangles},
                      {"visibility", s.visibility},   {"shading", s.shading},   {"blending", s.blending},
                      {"output", s.output},           {"encode", t.encode_ms}};
}

Json timing_json(const BenchArgs& args, const BenchWork& work, const BenchTiming& t) {
  return Json::Object{{"format", "zoneplate-bench"},
                      {"version", report_version},
                      {"peer", args.peer},
                      {"api", "zoneplate"},
                      {"renderer", name_of(current_isa())},
                      {"program", version},
                      {"scene", work.scene},
                      {"w", work.size.x},
                      {"h", work.size.y},
                      {"samples", work.samples},
                      {"max_samples", 16},
                      {"aniso", t.anisotropy},
                      {"triangles", t.best.triangles},
                      {"threads", thread_limit()},
                      {"frames", static_cast<std::uint64_t>(t.frame_ms.size())},
                      {"min_ms", least(t.frame_ms)},
                      {"median_ms", median(t.frame_ms)},
                      {"mean_ms", mean(t.frame_ms)},
                      {"readback_ms", 0},
                      {"first_frame_ms", t.first_ms},
                      {"cpu_ms_per_frame", t.processor_ms},
                      {"other_cores_busy", t.others_busy},
                      {"shaded_samples", t.best.shaded},
                      {"triangles_set_up", t.best.triangles_set_up},
                      {"min_ms_by_stage", Json::Object{{"geometry", t.geometry_ms}, {"tiles", t.tiles_ms}}},
                      {"stages_of_best_ms", stages_json(t)}};
}

// One stage's time and throughput; the time of stages that run on all threads is divided by the number of threads.
std::string stage_text(const char* name, double ms, double count, const char* unit, double bytes,
                       const MachineLimits& limits) {
  std::string text = fmt::format("  {:<11}{:9.3f} ms", name, ms);
  if (count > 0) text += fmt::format(" {:8.2f} ns a {:<9}", 1e6 * ms / count, unit);
  if (bytes > 0)
    text += fmt::format("from memory {:7.3f} ms ({:.1f} MB)", bytes * 1e-6 / limits.read_gb_s, bytes * 1e-6);
  text.erase(text.find_last_not_of(' ') + 1);
  return text + '\n';
}

std::string timing_text(const BenchWork& work, const BenchTiming& t, const MachineLimits& limits) {
  const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
  const double vertices = number(t.best.vertices), triangles = number(t.best.triangles);
  const double pixels = static_cast<double>(work.size.x) * work.size.y, threads = thread_limit();
  const StageTimes& s = t.best.stages;
  std::string text = fmt::format(
      "{} {}x: {:.2f} ms a frame, median {:.2f}, processor {:.2f}; {} vertices, {} triangles ({} in view), {} points\n",
      work.scene, work.samples, least(t.frame_ms), median(t.frame_ms), t.processor_ms, t.best.vertices,
      t.best.triangles, t.best.triangles_set_up, t.best.shaded);
  text += stage_text("prepare", t.best.prepare_ms, 0, "", 0, limits);
  text += stage_text("vertices", s.vertices, vertices, "vertex", 28 * vertices, limits);
  text += stage_text("triangles", s.triangles, triangles, "triangle", 12 * triangles + 16 * vertices, limits);
  text += stage_text("visibility", s.visibility / threads, pixels, "pixel", 0, limits);
  text += stage_text("shading", s.shading / threads, number(t.best.shaded), "fragment", 0, limits);
  if (s.blending / threads > 1e-3)
    text += stage_text("blending", s.blending / threads, number(t.best.shaded), "fragment", 0, limits);
  text += stage_text("output", s.output / threads, pixels, "pixel", 4 * pixels, limits);
  return text + stage_text("(encode)", t.encode_ms, pixels, "pixel", 0, limits);
}

// The efficiency of each loop and of the frame on more threads, simulated from the items' times on one.
std::string schedule_text(const BenchWork& work, const WorkTimes& times) {
  constexpr int max_threads = 64;
  std::string text = fmt::format("{} {}x: {:.2f} ms a frame on one thread\n  {:<22}{:>8}{:>12}", work.scene,
                                 work.samples, times.total, "", "ms", "longest ms");
  for (int threads = 2; threads <= max_threads; threads *= 2) text += fmt::format("{:>5} x", threads);
  const auto add = [&](const std::string& name, double ms, double longest, const auto& ms_on) {
    text += fmt::format("\n  {:<22}{:8.3f}{:12.3f}", name, ms, longest);
    for (int threads = 2; threads <= max_threads; threads *= 2)
      text += fmt::format("{:5.0f} %", 100 * ms / (threads * ms_on(threads)));
  };
  for (const LoopTimes& items : times.loops)
    add(fmt::format("loop over {} items", items.size()), std::accumulate(items.begin(), items.end(), 0.0),
        items.empty() ? 0 : *std::max_element(items.begin(), items.end()),
        [&](int threads) { return scheduled_ms(items, threads); });
  add("outside of loops", times.serial(), times.serial(), [&](int) { return times.serial(); });
  add("frame", times.total, times.total, [&](int threads) {
    double ms = times.serial();
    for (const LoopTimes& items : times.loops) ms += scheduled_ms(items, threads);
    return ms;
  });
  return text + '\n';
}

std::string limits_text(const MachineLimits& l) {
  return fmt::format(
      "{} threads, {}. Memory bandwidth: {:.1f} GB/s read, {:.1f} GB/s write. Clearing 1920x1080 of colour and depth:\n"
      "{:.2f} ms, in new memory {:.1f} ms. Gather of eight words: {:.1f} ns from 8 KiB, {:.1f} from 256 KiB, {:.1f} "
      "from 4 MiB.\n",
      thread_limit(), name_of(current_isa()), l.read_gb_s, l.write_gb_s, l.clear_ms, l.first_touch_ms, l.gather_l1_ns,
      l.gather_l2_ns, l.gather_l3_ns);
}

Syntax syntax_of(BenchArgs& args) {
  Syntax syntax{.verb = "bench",
                .summary = "Measure frame times of the benchmark scenes, from the scene in memory to the 8-bit image",
                .operands = "[SCENE]...",
                .examples =
                    "  zoneplate bench\n"
                    "  zoneplate bench fill --samples 4 --threads 1\n"
                    "  zoneplate bench city --isa avx2\n"
                    "  zoneplate bench tri1m --json\n"};
  syntax.notes =
      "The result is the minimum of all frame times, the time without interference by other programs. The\n"
      "stage times belong to that frame; \"from memory\" is a lower bound, the time to transfer the bytes\n"
      "that a stage needs at the machine's memory bandwidth, without caches. Default scenes: tri1m, fill,\n"
      "fillblend, city, city-trilinear, micro. Loading the scene and making mip levels are not included;\n"
      "PNG encoding is measured separately.\n";
  const auto whole = [](int& to, int low, int high) {
    return [&to, low, high](const std::string& text) { to = parse_whole(text, low, high); };
  };
  syntax.options = {
      {"--scene", "NAME", "Scene to measure; prints one line of JSON, for benchmark harnesses", "Work", false,
       [&](const std::string& text) { args.scenes.push_back(text); }},
      {"--samples", "N", "Samples per pixel: 1, 2, 4, 8 or 16; default both 1 and 4", "Work", true,
       whole(args.samples, 1, 16)},
      {"--resolution,--size", "WxH", "Size of the image; default 1920x1080", "Work", true,
       [&](const std::string& text) { args.work.size = parse_size(text, 16384); }},
      {"--anisotropy,--aniso", "N", "Anisotropy of the base colour's texture filter, 1 to 16; default: the scene's own",
       "Work", false, whole(args.work.anisotropy, 1, 16)},
      {"--threads,-t", "N", "Number of threads; default: all that affinity and CPU quota allow", "Work", true,
       whole(args.threads, 1, 1024)},
      {"--isa", "SET", "Instruction set: scalar, sse4, avx2 or avx512; default: the best available", "Work", false,
       [&](const std::string& text) { args.isa = parse_isa(text); }},
      {"--frames", "N", "Maximum number of frames; default 30", "Work", true, whole(args.work.frames, 1, 1000000)},
      {"--warmup", "N", "Warm-up frames, which are not measured; default 2", "Work", false,
       whole(args.work.warm_up, 1, 1000)},
      {"--budget-ms", "MS", "Time budget: no frame starts after it, except the first three; default 4000", "Work",
       false, [&](const std::string& text) { args.work.budget_ms = parse_number(text, 1, 1e7); }},
      {"--peer", "NAME", "Name of this program in the result; default zoneplate", "Result", false,
       [&](const std::string& text) { args.peer = text; }},
      {"--simulate-threads", "",
       "Print the efficiency on 2 to 64 threads, simulated from the times of tiles and parts on one thread", "Result",
       true, [&](auto&) { args.simulates = true; }},
      {"--json", "", "Print one line of JSON per scene", "Result", true, [&](auto&) { args.prints_json = true; }}};
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
  if (args.simulates && args.prints_json) throw Error(ErrorKind::Usage, "--simulate-threads prints no JSON");
  const bool prints_json = args.prints_json || names_one;
  const auto time_all = [&] {
    MachineLimits limits;
    if (!prints_json && !args.simulates) print_report(limits_text(limits = measure_limits()));
    for (const std::string& scene : args.scenes)
      for (const int samples : counts) {
        BenchWork work = args.work;
        work.scene = scene, work.samples = samples;
        if (args.simulates) {
          print_report(schedule_text(work, time_frame_loops(work)));
          continue;
        }
        const BenchTiming timing = time_frames(work);
        print_report(prints_json ? timing_json(args, work, timing).text() + '\n' : timing_text(work, timing, limits));
      }
  };
  with_isa(args.isa, [&] { with_threads(args.threads, time_all); });
}

}  // namespace zoneplate::cli
