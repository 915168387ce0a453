// SPDX-License-Identifier: Apache-2.0
// zoneplate dataset: sequences with ground truth, for training and measuring upscalers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/batch/shard.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/common_options.h"
#include "zoneplate/cli/confined.h"
#include "zoneplate/cli/environment_cache.h"
#include "zoneplate/cli/progress.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/evaluate/dataset/sequence.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/options.h"
#include "zoneplate/os/file.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

struct DatasetArgs {
  DatasetSequence sequence{.reference = "converged:samples=256", .ratios = {2}};
  std::vector<std::string> scenes;
  int sequences = 24, threads = 0;
  bool has_layout = false;
  Shard shard;
  std::optional<ProgressKind> progress;
  ReadingLimits limits;
};

/// Static and moving, thin, bright, textured and hidden surfaces: what users complain of.
constexpr const char* default_scenes[] = {"panning-wires", "passing-fence", "teleport", "disocclusion",
                                          "light-switch",  "foliage",       "stars",    "near-axis",
                                          "metal",         "tiles",         "sun-roof", "teapot"};

std::vector<double> parse_ratios(const std::string& text) {
  std::vector<double> out;
  for (const std::string& item : split_specs(text)) {
    const double ratio = parse_number(item, 1, 4);
    if (std::abs(ratio * 10 - std::round(ratio * 10)) > 1e-9)
      throw Error(ErrorKind::Usage, fmt::format("is '{}', expected a number with one decimal, such as 1.5", item));
    if (std::ranges::find(out, ratio) == out.end()) out.push_back(ratio);
  }
  return out;
}

DatasetPasses parse_passes(const std::string& text) {
  DatasetPasses out;
  for (const std::string& item : split_specs(text)) {
    bool DatasetPasses::*const passes[] = {&DatasetPasses::ids, &DatasetPasses::visible, &DatasetPasses::count};
    out.*passes[parse_choice(item, {"object-id", "was-visible", "count"})] = true;
  }
  return out;
}

Syntax make_syntax(DatasetArgs& args) {
  DatasetSequence& s = args.sequence;
  Syntax syntax{
      .verb = "dataset",
      .summary = "Render sequences with ground truth, to train and measure upscalers",
      .operands = "[SCENE...] --layout nss|npy|exr -o DIR",
      .examples =
          "  zoneplate dataset --layout nss -o data --sequences 2 --frames 16 --size 640x360\n"
          "  zoneplate dataset city.glb --layout npy -o data --ratio 2,1.5 --sequences 100 --frames 100\n"
          "  zoneplate dataset --layout nss -o data --shard 3/8      one of eight machines, same folder\n"
          "  zoneplate dataset teleport --layout exr -o films --sequences 1 --frames 24 --rate 24 --size 160x120 \\\n"
          "      --start 0 --camera own      the frames that compare --frames 24 renders\n",
      .notes =
          "The layout nss is that of Arm's neural-graphics-model-gym: ground_truth/, motion_gt/ and, for each ratio\n"
          "(x2, x1_5), color/, depth/ and motion/, with one EXR image per frame and one JSON file per sequence:\n"
          "scene-linear colours, depth from 0 (near) to 1, motion as part of the image from the last frame to this\n"
          "one, camera and jitter. Frames of the ratios have one jittered sample per pixel. The ground truth is the\n"
          "mean of linear light, so that its --linear-truth is to be given to the gym's converter. Cameras are\n"
          "perspective ones: an orthographic one is replaced by one that shows the same height of the scene.\n"
          "\n"
          "The layout npy has the same folders, with one array of NumPy per frame, of 32-bit floats by row, column "
          "and\n"
          "channel: depth is the distance along the view axis, infinite where nothing is, motion is in pixels, +x\n"
          "right, +y down. Orthographic cameras stay. jitter/ has a text file per sequence. The layout exr has these\n"
          "planes as EXR images, which zoneplate filter reads:\n"
          "  zoneplate filter films/x2/color/0000 --depth films/x2/depth/0000 --motion films/x2/motion/0000 \\\n"
          "      --jitter films/jitter/0000.txt --upscale taau:scale=2 -o out\n"
          "\n"
          "Sequence k shows scene k modulo their number, from another moment, with a camera that moves on a path of\n"
          "its own; every fourth camera rests. All follows from --seed: shards and repetitions make the same bytes.\n"
          "The JSON file of a sequence is written last. A run skips complete sequences, and thus continues one that\n"
          "was interrupted.\n"};
  const std::string group = "Options";
  syntax.options = {
      {"--output,-o", "DIR", "Folder of the data set, which other shards may write to as well", group, true,
       [&](auto& text) { s.folder = text; }},
      {"--layout", "NAME", "Names and formats of the files: nss, npy or exr", group, true,
       [&](auto& text) {
         s.layout = static_cast<DatasetLayout>(parse_choice(text, {"nss", "npy", "exr"}));
         args.has_layout = true;
       }},
      {"--ratio", "LIST", "Width of the ground truth over that of the frames, 1 to 4, such as 2,1.5; default 2", group,
       false, [&](auto& text) { s.ratios = parse_ratios(text); }},
      {"--size", "W,H", "Size of the ground truth; default 1920x1080", group, false,
       [&](auto& text) { s.size = parse_size(text, 16384); }},
      {"--sequences", "N", "Number of sequences of all shards; default 24", group, false,
       [&](auto& text) { args.sequences = parse_whole(text, 1, 9999); }},
      {"--frames", "N", "Frames of a sequence; default 60", group, false,
       [&](auto& text) { s.frames = parse_whole(text, 2, 9999); }},
      {"--rate", "N", "Frames per second; default 30", group, false,
       [&](auto& text) { s.rate = parse_whole(text, 1, 1000); }},
      {"--start", "SECONDS", "Moment of the animation at which every sequence begins; default: chosen by the seed",
       group, false, [&](auto& text) { s.start = parse_number(text, 0, 1e6); }},
      {"--camera", "KIND", "path, the default: moved by the seed; own: the scene's, as it is", group, false,
       [&](auto& text) {
         s.keeps_camera = parse_choice(text, {"path", "own"}) == 1;
       }},
      {"--bias", "N",
       "Mip levels by which textures of the frames are blurrier (negative: sharper) than the ground truth's pixels "
       "require, -4 to 2; default 0",
       group, false, [&](auto& text) { s.bias = parse_number(text, -4, 2); }},
      {"--passes", "LIST",
       "Further planes, of npy and exr: object-id, was-visible (1 where the last camera saw the surface) and count "
       "(the "
       "frames in which it has been visible without a break)",
       group, false, [&](auto& text) { s.passes = parse_passes(text); }},
      {"--jitter-length", "N", "Positions of the jitter, a Halton sequence; default 32", group, false,
       [&](auto& text) { s.positions = parse_whole(text, 1, 1024); }},
      {"--reference", "METHOD", "Method of the ground truth; default converged:samples=256", group, false,
       [&](auto& text) { s.reference = text; }},
      {"--seed", "N", "Chooses moments and camera paths; default 1", group, false,
       [&](auto& text) { s.seed = static_cast<std::uint32_t>(parse_whole(text, 0, 1 << 30)); }},
      {"--shard", "I/N",
       "Make every Nth sequence, beginning with number I; auto/N: I is the index of the task in an array, as of Slurm",
       group, false, [&](auto& text) { args.shard = parse_shard(text); }},
      {"--threads,-t", "N", "Maximum number of threads; 0, the default: the CPUs allowed by affinity and quota", group,
       false, [&](auto& text) { args.threads = parse_whole(text, 0, 1024); }},
      {"--progress", "KIND", "Progress on stderr: auto (a bar on a terminal), bar, json (one line per frame) or none",
       group, false, [&](auto& text) { args.progress = parse_progress(text); }},
      allow_path_option(args.limits.load)};
  for (Option& option : limit_options(args.limits, "a sequence")) syntax.options.push_back(std::move(option));
  return syntax;
}

/// Makes a sequence in a confined process, and its folders as its files arrive. `done_of(frame)` is the part of all
/// work that is done before a frame.
void make_sequence(const DatasetArgs& args, const DatasetSequence& sequence, Progress& progress,
                   const std::function<double(int frame)>& done_of) {
  const std::vector<std::string> listed = dataset_paths(sequence);
  const std::set<std::string> paths(listed.begin(), listed.end());
  ConfinedRun run{
      .name = sequence.scene, .limits = args.limits, .readable = readable_paths(sequence.scene, sequence.load)};
  run.readable.push_back(dataset_json_path(sequence));
  run.progress = &progress;
  run.take = [&](const std::string& path, const std::vector<std::uint8_t>& bytes) {
    if (!paths.contains(path)) throw Error(ErrorKind::Failed, path + ": is no file of the sequence");
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw Error(ErrorKind::Output, folder.string() + ": " + error.message());
    save_bytes(path, bytes);
  };
  run_confined(run, [&](Delivery& out) {
    const std::string stage = fmt::format("{:04} {}", sequence.number, sequence.scene);
    make_dataset_sequence(
        sequence, [&](int frame) { out.progress(stage, done_of(frame)); }, out);
  });
}

}  // namespace

void run_dataset(std::span<const std::string> arguments) {
  DatasetArgs args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  args.scenes = syntax.found_operands;
  if (args.scenes.empty()) args.scenes.assign(std::begin(default_scenes), std::end(default_scenes));
  if (args.sequence.folder.empty()) throw Error(ErrorKind::Usage, "no output: name a folder with -o");
  if (!args.has_layout) throw Error(ErrorKind::Usage, "--layout is missing: nss, npy or exr");
  if (args.sequence.layout == DatasetLayout::Nss && args.sequence.passes.any())
    throw Error(ErrorKind::Usage, "--passes: the layout nss has no further planes; choose npy or exr");
  upscale::make_method(args.sequence.reference);  // throws if it is invalid
  std::error_code ignored;
  for (const std::string& scene : args.scenes)
    if (!check_builtin_scene(scene) && !std::filesystem::exists(scene, ignored))
      throw Error(ErrorKind::Input, scene + ": is neither a file nor a built-in scene (zoneplate list scenes)");
  with_threads(args.threads, [&] {
    Progress progress(args.progress ? *args.progress : parse_progress("auto"));
    double done = 0;
    args.sequence.studio = prepared_studio(environment_cache());  // once for the processes of all sequences
    const double count =
        static_cast<double>(args.shard.size_of(static_cast<std::uint64_t>(args.sequences))) * args.sequence.frames;
    for (int number = 0; number < args.sequences; ++number) {
      if (!args.shard.has(static_cast<std::uint64_t>(number))) continue;
      DatasetSequence sequence = args.sequence;
      sequence.number = number;
      sequence.scene = args.scenes[static_cast<std::size_t>(number) % args.scenes.size()];
      sequence.load.limits = args.limits.load;
      make_sequence(args, sequence, progress, [&](int frame) { return (done + frame) / count; });
      done += sequence.frames;
    }
  });
}

}  // namespace zoneplate::cli
