// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "zoneplate/cli/common_options.h"
#include "zoneplate/cli/confined.h"
#include "zoneplate/cli/environment_cache.h"
#include "zoneplate/cli/render/args.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/option_values.h"
#include "zoneplate/job/options.h"

namespace zoneplate::cli {
namespace {

constexpr const char* examples =
    "  zoneplate teapot -o teapot.png\n"
    "  zoneplate render chair.glb -o chair.png --size 1024x768 --aa ssaa:n=4\n"
    "  zoneplate render chair.glb -o chair.png --camera-azimuth-angle 120 --no-background\n"
    "  zoneplate render chair.obj -o - --quiet | display\n"
    "  zoneplate render chair.glb -o chair.png --aov depth,normal --json\n";

constexpr const char* notes =
    "IN is a model file (.gltf, .glb, .obj, .ply, .stl or others: zoneplate list formats), - for stdin, or a built-in\n"
    "scene (zoneplate list scenes). Data passes are written next to OUT: chair.png, chair.depth.png.\n"
    "\n"
    "Camera: without camera options the whole scene is in view, three-quarter from above (azimuth 30, elevation 20\n"
    "degrees, view angle 30), or from behind or below where single-sided surfaces would show their backs alone, which\n"
    "are not drawn; built-in scenes that have a camera use it. Cameras of a file are used with --camera-index only.\n"
    "Azimuth and elevation set the direction of the whole-scene view, 0 and 0 being the front;\n"
    "with a position or an index they turn that camera about its focal point.\n"
    "\n"
    "Light: a scene without lights gets a studio made in code, which turns with the camera: soft boxes, which metals\n"
    "reflect, and a key light, displayed by the Neutral tone curve. (Blinn-)Phong materials get a key, a fill and a\n"
    "back light instead. --hdri-file and --environment replace them. A glTF file with lights of its own has\n"
    "the studio's environment at 0.15 without these options, so that nothing is black, and is dimmed if it would be\n"
    "white; --lights file is its light alone, --lights default ignores its lights, --lights both adds the studio, and\n"
    "--exposure auto adapts to lights of any strength.\n"
    "\n"
    "Sequences: frame F has the time F / rate seconds of the animation. OUT contains the frame number, as\n"
    "chair.####.png, chair.@@@@.png, chair.$F4.png, chair%04d.png or chair_{frame:04}.png, or is a video. GIF, MP4 and "
    "WebM require the program\n"
    "ffmpeg; their colours are BT.709, and tagged so.\n"
    "\n"
    ".exr and .pfm: linear light without tone mapping. An .exr is transparent unless --background is given; its "
    "header\n"
    "has the camera, worldToCamera and worldToNDC, and the frame rate of a sequence.\n"
    "\n"
    "Batches: several IN require a folder as OUT, as thumbs/, or a name with placeholders: {model} and {ext} (file "
    "name\n"
    "and extension of IN), {dir} (its folder), {index} or {index:4} (its number). Each item prints one line, which is\n"
    "JSON if stdout is not a terminal. Two items never write the same file. A folder as IN stands for all models in "
    "it\n"
    "and in its folders; the folders of outputs are created.\n"
    "\n"
    "Configuration: lines of the form `size = 512` or `no-background` are options of every run; those after a line\n"
    "[NAME] belong to --preset NAME. Options of the command line take precedence.\n"
    "\n"
    "Colours are sRGB: red, #f80, #ff8800, #ff880080 or 1,0.5,0.\n"
    "\n"
    "Exit codes: 0 success, 1 rendering failed, 2 wrong usage, 3 input missing, corrupt or unsupported,\n"
    "4 output or reports cannot be written, 5 some of several items failed, 128+n terminated by signal n. No partial "
    "files\n"
    "remain.\n";

std::vector<Option> output_options(RenderArgs& a) {
  const std::string group = "Image";
  return {
      {"--output,-o", "OUT",
       "Image to write: .png, .jpg, .webp, .exr, .pfm or .rgba, or - for stdout; or a video: .apng, .webp, .gif, "
       ".mp4, .mov, .mkv, .webm",
       group, true, [&](auto& text) { a.output = text; }},
      choice_option("--output-format", "FORMAT",
                    "Image format on stdout: png, jpg, webp, exr, pfm or rgba; default png", group, false,
                    stdout_formats(), [&](std::size_t i) { a.stdout_format = stdout_formats()[i]; }),
  };
}

std::vector<Option> batch_options(RenderArgs& a) {
  const std::string group = "Batches";
  return {
      {"--manifest", "FILE", "File of jobs, one JSON object per line: input, output, and options by their names", group,
       false, [&](auto& text) { a.manifest = text; }},
      {"--shard", "I/N",
       "Run only every Nth job, from job I (0 to N-1); auto/N: I is the index of the task in an array of Slurm, "
       "Kubernetes, AWS Batch, Cloud Run, Google Batch, PBS, Grid Engine or LSF; auto: N too, where the ledger or the "
       "engine gives it",
       group, false, [&](auto& text) { a.shard_text = text; }},
      {"--skip-existing", "", "Skip jobs, and frames, whose files exist and are whole: the image and its data passes",
       group, false, [&](auto&) { a.skip_existing = true; }},
      {"--ledger", "DIR",
       "Record results, and the digests of files, for zoneplate verify, and pin the number of shards; files that are "
       "recorded and unchanged are skipped, others made anew",
       group, false, [&](auto& text) { a.ledger = text; }},
      {"--retries", "N",
       "Try a job again whose process was killed or took too long, or whose output could not be written; default 0",
       group, false, [&](auto& text) { a.retries = parse_whole(text, 0, 100); }},
      {"--grace", "S",
       "After SIGTERM, finish the job at hand if that takes at most S seconds, then end with exit code 143; "
       "default 0",
       group, false, [&](auto& text) { a.grace = parse_number(text, 0, 1e6); }},
  };
}

std::vector<Option> run_options(RenderArgs& a) {
  const std::string group = "Running";
  std::vector<Option> options = {
      {"--dry-run", "", "Check options, inputs and outputs, and print the items without rendering them", group, false,
       [&](auto&) { a.is_dry_run = true; }},
      {"--preset", "NAME",
       "Apply a preset of the configuration, $XDG_CONFIG_HOME/zoneplate/config or ~/.config/zoneplate/config", group,
       false, [&](auto& text) { a.preset = text; }},
      {"--no-config", "", "Ignore the configuration", group, false, [&](auto&) { a.reads_config = false; }},
      {"--json", "", "Print a report as one line of JSON (to stderr if OUT is -)", group, false,
       [&](auto&) { a.prints_json = true; }},
      {"--progress", "KIND", "Progress on stderr: auto (a bar on a terminal), bar, json or none; default auto", group,
       false, [&](auto& text) { a.progress = parse_progress(text); }, Choices{"auto", "bar", "json", "none"}},
      {"--quiet,-q", "", "Print errors only", group, false, [&](auto&) { a.verbosity = Verbosity::Quiet; }},
      {"--verbose,-v", "", "Print a summary with times", group, false,
       [&](auto&) { a.verbosity = Verbosity::Verbose; }},
      {"--no-cache", "",
       "Neither read nor write filtered environments in $XDG_CACHE_HOME/zoneplate or ~/.cache/zoneplate", group, false,
       [&](auto&) { a.cache.clear(); }}};
  for (Option& option : limit_options(a.load.limits, a.max_seconds, a.is_sandboxed, group, "an item")) {
    if (names_of(option).front() == "--max-memory")
      option.meaning += ". A glTF, OBJ, PLY or STL file that needs more is drawn in parts";
    options.push_back(std::move(option));
  }
  return options;
}

/// Whether the bytes of images depend on the option. They do not depend on how a run is divided, limited and reported;
/// where a file goes is its name. --strict and --allow-path are in job_digest (item_files.h).
bool determines_image(const Option& option) {
  return option.group != "Batches" && option.group != "Running" && names_of(option).front() != "--output";
}

/// Sets an option as before, and notes it in `args.given`, in place of an earlier value unless it repeats.
std::function<void(const std::string&)> noting(RenderArgs& args, const Option& option) {
  return [&args, set = option.set.set, name = names_of(option).front(),
          repeats = option.repeats](const std::string& text) {
    set(text);
    const std::size_t begin = ('\n' + args.given).find('\n' + name + '=');
    if (begin != std::string::npos && !repeats) args.given.erase(begin, args.given.find('\n', begin) + 1 - begin);
    std::string line = text;
    std::ranges::replace(line, '\n', ' ');
    args.given += name + '=' + line + '\n';
  };
}

}  // namespace

Syntax render_syntax(RenderArgs& args) {
  args.cache = environment_cache();
  Syntax syntax{.verb = "render",
                .summary = "Render a model or a built-in scene to an image",
                .operands = "IN -o OUT",
                .examples = examples,
                .notes = notes};
  std::vector<Option>& options = syntax.options;
  const auto append = [&](std::vector<Option> more) { std::ranges::move(more, std::back_inserter(options)); };
  append(output_options(args)), append(job_options(args)), append(run_options(args));
  const auto after_sequences =
      std::ranges::find_if(options.rbegin(), options.rend(), [](const Option& o) { return o.group == "Sequences"; });
  std::vector<Option> batches = batch_options(args);
  options.insert(after_sequences.base(), std::make_move_iterator(batches.begin()),
                 std::make_move_iterator(batches.end()));
  for (Option& option : options)
    if (determines_image(option)) option.set.set = noting(args, option);
  return syntax;
}

}  // namespace zoneplate::cli
