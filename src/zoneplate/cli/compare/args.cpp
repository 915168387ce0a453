// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/compare/args.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/common_options.h"
#include "zoneplate/evaluate/compare/methods.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/process/exr_layer.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

constexpr const char* examples =
    "  zoneplate compare teapot --aa none,fxaa,smaa,msaa:n=4,ssaa:n=4 -o teapot-compared\n"
    "  zoneplate compare wires stars foliage --aa all --reference ssaa:n=16 -o compared\n"
    "  zoneplate compare all --aa all -o everything         all scenes that show a class of artifacts\n"
    "  zoneplate compare passing-fence disocclusion --frames 24 --aa none,taa,oracle-taa -o films\n"
    "  zoneplate compare wires --aa none,fxaa,msaa:n=8 --html wires.html     only the page, for a browser\n"
    "  zoneplate compare chair.glb --aa msaa:n=8,ssaa:pattern=halton,samples=64 --reference chair-reference.png -o "
    "chair\n";

constexpr const char* notes =
    "SCENE is a file or a built-in scene; `all` selects every built-in scene that shows a class of artifacts. LIST is\n"
    "a comma-separated list of methods, or `all`: every method with its default and with its usual parameters.\n"
    "\n"
    "The folder DIR must not exist, or with --force be that of an earlier comparison without other files, which it\n"
    "replaces; it is created completely or not at all, and no other file changes:\n"
    "  compare.txt, compare.csv, compare.json   the results; the JSON contains all of them, and a version number\n"
    "  compare.md                               all methods on all scenes as a Markdown table\n"
    "  cost.svg                                 mean value of the first metric against mean cost, with the Pareto "
    "front\n"
    "  SCENE/reference.png, SCENE/METHOD.png    the images; METHOD.error.png: FLIP error maps; METHOD.worst.png: the\n"
    "                                           regions of greatest error, enlarged 8 times\n"
    "  SCENE/crops.png, SCENE/cost.svg          the same region by every method; the first metric against cost\n"
    "With --frames, every method renders one sequence of the scene's animation, 24 frames per second; metrics are "
    "those\n"
    "of all frames, images are the last frame, and in addition:\n"
    "  SCENE/METHOD.film.png                    the frames as an animated PNG, those of the reference too\n"
    "  SCENE/METHOD.difference.png              8 times the difference from the reference, about grey, animated\n"
    "  SCENE/METHOD.slice.png                   the middle row of all frames, time running downwards\n"
    "\n"
    "The reference renders the same scene with 256 samples per pixel, each shaded: its cost and its own estimate of "
    "its\n"
    "error (standard error of the mean, root mean square over the pixels, in linear light) are printed next to its\n"
    "name. Where methods are nearer to it than that, take more: --reference converged has 1024 samples, and\n"
    "converged:samples=16384 the most; analytic is exact for edges, but not within textures and highlights.\n"
    "\n"
    "Methods are ranked by the first metric: FLIP, or of sequences the quality in JOD that people would give them.\n"
    "Times and samples are those of a frame. A still image by a method with history is the last of the frames in "
    "which\n"
    "it settles, whose number is in the table. Times are the minimum of several turns, or the median of the frames of "
    "a\n"
    "sequence, from the scene in memory to the 8-bit image; stage times belong to the fastest turn. Compare only "
    "times\n"
    "of the same run. A method whose turns take more than 1.5 s gets fewer turns, as the report states. Memory is the\n"
    "increase of the process's resident memory in the first turn, with the history: a method needs it for each frame.\n"
    "All other results are the same on every machine.\n";

/// The default reference is valid for all scenes, at a quarter of the cost of `converged`. `analytic` is exact for
/// edges, but it shades each surface of a pixel once and tests alpha on a grid, so that textures, highlights and alpha
/// tests are aliased as in the tested methods.
constexpr const char* default_reference = "converged:samples=256";

std::vector<metrics::Choice> metrics_of(const std::string& text, int frames) {
  std::vector<metrics::Choice> out;
  // The first one ranks. The rate of a sequence is that at which it is rendered.
  const std::string usual = frames > 1 ? fmt::format("cvvdp_video:fps={:g},psnr,tpsnr,flicker", trial_frame_rate)
                                       : "flip,psnr,ssim,edge_error";
  for (const std::string& item : split_specs(text.empty() ? usual : text)) {
    out.push_back(metrics::choose_metric(metrics::metrics(), item));
    const metrics::Metric& metric = *out.back().metric;
    const int least = metric.starts_short ? std::min(metric.frames, 2) : metric.frames;
    if (least > frames)
      throw Error(ErrorKind::Usage,
                  fmt::format("--metric {}: it measures sequences: give --frames {} or more", metric.name, least));
  }
  if (std::ranges::none_of(out, [](const auto& c) { return c.metric->name == "flip"; }))
    out.push_back(metrics::choose_metric(metrics::metrics(), "flip"));
  return out;
}

}  // namespace

Syntax compare_syntax(CompareArgs& args) {
  Syntax syntax{.verb = "compare",
                .summary = "Render scenes with many antialiasing methods and measure each against a reference",
                .operands = "SCENE... --aa LIST -o DIR",
                .examples = examples,
                .notes = notes};
  const std::string group = "Comparison";
  syntax.options = {
      {"--output,-o", "DIR", "Folder to create", group, true, [&](auto& text) { args.render.output = text; }},
      {"--force", "", "Replace DIR if it is the output of an earlier comparison", group, false,
       [&](auto&) { args.replaces = true; }},
      {"--html", "FILE.html",
       "Write one page with all images and frames, for a browser: linked zoom, differences, error maps, values of "
       "pixels",
       group, true, [&](auto& text) { args.page = text; }},
      {"--anti-aliasing,--aa", "LIST",
       "Methods, for example none,msaa:n=4 (zoneplate list methods), or all; default all", group, true,
       [&](auto& text) { args.methods = text; }},
      {"--reference", "REF",
       "Reference: a method (converged, analytic, ssaa:n=16, ...) or an image file; default converged:samples=256",
       group, true, [&](auto& text) { args.reference = text; }},
      layer_option(args.layer),
      {"--metric", "LIST",
       "Metrics (zoneplate metrics --help), of which the first ranks; default flip,psnr,ssim,edge_error, or of "
       "sequences cvvdp_video,psnr,tpsnr,flicker; flip is always included",
       group, false, [&](auto& text) { args.metrics = text; }},
      ignore_option(args.ignored, group),
      {"--frames", "N", "Frames of a sequence that each method renders; default 1, a still image", group, false,
       [&](auto& text) { args.frames = parse_whole(text, 1, 1000); }},
      {"--turns", "N", "Frames rendered by each method, of which the fastest counts; default 3", group, false,
       [&](auto& text) { args.turns = parse_whole(text, 1, 1000); }}};
  constexpr std::string_view left_out[] = {
      "--output",       "--anti-aliasing",   "--no-background",   "--crop",      "--aov",         "--dither",
      "--bit-depth",    "--output-format",   "--preset",          "--no-config", "--dry-run",     "--jpeg-quality",
      "--webp-quality", "--png-compression", "--exr-compression", "--upscale",   "--render-scale"};
  for (Option& option : render_syntax(args.render).options) {
    const std::string first = option.names.substr(0, option.names.find(','));
    if (option.group == "Sequences" || option.group == "Batches") continue;
    if (std::ranges::find(left_out, first) != std::end(left_out)) continue;
    if (first == "--max-seconds") option.meaning = "Time limit of the comparison; default: no limit";
    if (first == "--max-memory") option.meaning = "Memory limit of the comparison, for example 512M; default 4G";
    if (first == "--resolution") option.meaning = "Size in pixels, 640,480 or 640x480; default 640,480";
    if (first == "--json") option.meaning = "Print the JSON report instead of the tables";
    syntax.options.push_back(std::move(option));
  }
  return syntax;
}

TrialOptions trial_options(const CompareArgs& args) {
  TrialOptions out{
      .methods = compared_methods(args.methods), .turns = args.turns, .metrics = metrics_of(args.metrics, args.frames)};
  out.reference = args.reference.empty() ? default_reference : args.reference;
  if (!args.layer.empty() && is_method(out.reference))
    throw Error(ErrorKind::Usage, "--layer: requires --reference with an EXR image");
  std::error_code ignored;
  if (is_method(out.reference))
    upscale::make_method(out.reference);
  else if (std::filesystem::exists(out.reference, ignored))
    out.is_reference_file = true;
  else if (out.reference.find_first_of("./") != std::string::npos)
    throw Error(ErrorKind::Input, out.reference + ": no such file");
  else
    upscale::make_method(out.reference);  // throws with the list of methods
  if (out.is_reference_file && args.frames > 1)
    throw Error(ErrorKind::Usage, "--reference: a sequence needs a method as reference, not an image");
  if (out.is_reference_file && args.scenes.size() > 1)
    throw Error(ErrorKind::Usage, fmt::format("--reference {}: one image is a reference for one scene, not for {}",
                                              out.reference, args.scenes.size()));
  return out;
}

std::vector<std::string> scenes_of(const std::vector<std::string>& operands) {
  std::vector<std::string> out;
  for (const std::string& operand : operands) {
    if (operand != "all") {
      out.push_back(operand);
      continue;
    }
    for (const BuiltinScene& scene : builtin_scenes())
      if (!scene.failure.empty()) out.push_back(scene.name);
  }
  return out;
}

void check_scenes(const CompareArgs& args) {
  std::error_code ignored;
  for (const std::string& name : args.scenes) {
    if (args.render.load.format.empty() && check_builtin_scene(name)) continue;
    if (name != "-" && !std::filesystem::exists(name, ignored))
      load_scene(name, args.render.load);  // throws with the cause
  }
}

}  // namespace zoneplate::cli
