// SPDX-License-Identifier: Apache-2.0
// zoneplate filter: post-process antialiasing and upscaling of existing images, without a scene.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/common_options.h"
#include "zoneplate/cli/confined.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/codec/system/encoder_library.h"
#include "zoneplate/imaging/filter/filter.h"
#include "zoneplate/imaging/filter/frames.h"
#include "zoneplate/imaging/filter/items.h"
#include "zoneplate/imaging/filter/sequence.h"
#include "zoneplate/job/option/tone_args.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/output/frame_name.h"
#include "zoneplate/metrics/file/picture_set.h"
#include "zoneplate/os/file.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

struct FilterArgs : FilterOptions {
  std::string output, motion, depth;
  int threads = 0;
  bool replaces_inputs = false;
  std::optional<ProgressKind> progress;  ///< none: a bar on a terminal
  ReadingLimits limits;
};

/// The method with history that the arguments select; empty: filters of single images.
std::string sequence_method(const FilterArgs& args) {
  const Upscaler* const upscaler =
      args.upscaler.empty() ? nullptr : &parse_spec("upscaler", upscale::upscalers(), args.upscaler).row;
  const bool is_temporal = upscaler && upscaler->make_temporal;
  if (is_temporal && !filters_sequences(args.upscaler))
    throw Error(ErrorKind::Usage,
                fmt::format("--upscale: {} needs a scene, expected one of {}", args.upscaler, image_upscaler_list()));
  const bool has_history = !args.method.empty() && filters_sequences(args.method);
  if (is_temporal && !args.method.empty())
    throw Error(ErrorKind::Usage,
                fmt::format("--upscale {}: it antialiases itself, give no --anti-aliasing", args.upscaler));
  if (has_history && upscaler)
    throw Error(ErrorKind::Usage, fmt::format("--anti-aliasing {}: filters a sequence; upscale its output in a second "
                                              "step, or give a temporal upscaler alone",
                                              args.method));
  if ((is_temporal || has_history) && args.is_display_transform())
    throw Error(
        ErrorKind::Usage,
        "--tone-mapping and --exposure do not go with methods with history: show their output in a second step");
  const bool has_data = !args.motion.empty() || !args.depth.empty() || !args.jitter.empty();
  if (has_data && !is_temporal && !has_history)
    throw Error(ErrorKind::Usage,
                "--motion, --depth and --jitter are for methods with history: --aa taa or --upscale "
                "fsr2, fsr3, sgsr2, taau, learned or learned-table");
  return is_temporal ? args.upscaler : has_history ? args.method : "";
}

float2 parse_pair(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == text.npos) throw Error(ErrorKind::Usage, fmt::format("is '{}', expected two numbers x,y", text));
  constexpr double most = 1e6;
  return {static_cast<float>(parse_number(text.substr(0, comma), -most, most)),
          static_cast<float>(parse_number(text.substr(comma + 1), -most, most))};
}

Syntax make_syntax(FilterArgs& args) {
  Syntax syntax{
      .verb = "filter",
      .summary = "Antialias, upscale and tone-map existing images and frames of any renderer",
      .operands = "IMAGES",
      .examples =
          "  zoneplate filter shot.png --aa smaa -o smooth.png\n"
          "  zoneplate filter shot.png --aa fxaa:preset=39,mix=light -o smooth.webp\n"
          "  zoneplate filter shots/ --aa cmaa2 -o smooth/\n"
          "  zoneplate filter shot.exr --tone-mapping agx --exposure auto -o shot.png\n"
          "  zoneplate filter shot.png --aa smaa --upscale fsr1 --size 1920x1080 -o large.png\n"
          "  zoneplate filter frames/a.####.png --aa mlaa -o smooth/\n"
          "  zoneplate filter film.apng --aa smaa -o smooth.apng\n"
          "  zoneplate filter c.####.exr --depth z.####.exr --motion v.####.exr --aa taa --jitter offsets.txt -o out/\n"
          "  zoneplate filter c.####.png --depth z.####.exr --motion v.####.exr --motion-scale -960,540 \\\n"
          "      --upscale fsr2 --size 1920x1080 --jitter offsets.txt -o out/\n",
      .notes =
          "IMAGES is a PNG, JPEG, WebP, GIF, TIFF, AVIF, JPEG XL, BMP or TGA file, a folder of them, or a sequence\n"
          "(name.####.png), or a scene-linear .hdr, .exr, .pfm, .tif or .jxl file, of which .exr and .pfm files are\n"
          "written, and by antialiasing or --tone-mapping also display-referred ones. An animated PNG, GIF or WebP, or "
          "a video (.mp4,\n"
          ".m4v, .mov, .mkv, .webm, .avi; by ffmpeg) is the sequence of its frames: the output is another animation,\n"
          "whose frames have the same times, or images, as out.####.png or in a folder.\n"
          "A file that is read is not replaced without --force.\n"
          "Antialiasing filters work on 8-bit sRGB values. Pixels that the filter does not blend keep their exact "
          "value;\n"
          "images with alpha are filtered premultiplied. What has no alpha refuses them without a --background: JPEG, "
          "PFM,\n"
          "fsr2, fsr3, sgsr2, taau and learned. Of scene-linear images, the sRGB codes of their light are filtered.\n"
          "Colour profiles are kept: filters work on the codes as they are. An image is turned as its Exif orientation "
          "says.\n"
          "\n"
          "Methods with history (taa, history-guided, fsr2, fsr3, sgsr2, taau, learned) filter the frames of a "
          "sequence in "
          "order, as one shot "
          "without a cut. Each frame\n"
          "has one sample per pixel, jittered: --jitter is a text file with one line per frame, the sample's offset "
          "from\n"
          "the pixel's centre in pixels, +x right, +y down. Motion is the position now minus the one in the last "
          "frame, in\n"
          "pixels of the frame, without jitter, in channels motion.X and motion.Y, X and Y, or R and G; depth is the\n"
          "distance along the view axis in channel Z, R or Y. Frames of zoneplate render --aov depth,motion,object-id\n"
          "contain both, and object ids, by which history of another object is dropped. Frames, depth and motion are\n"
          "paired by their numbers; a number that one of them lacks is an error. The images are written in\n"
          "scene-linear light for .exr frames, and as .png for .png frames, whose colours are averaged in linear "
          "light.\n"};
  syntax.options = {
      {"--output,-o", "FILE",
       "The image to write: .png, .jpg, .webp, .avif or .jxl, or .exr or .pfm for a scene-linear one; for an animation "
       ".apng, .png, .webp, .gif, .mp4, .mov, .mkv or .webm; for several inputs a folder, which receives .png files "
       "(.exr of scene-linear ones), or a name with a frame number, as out.####.png",
       "Options", true, [&](auto& text) { args.output = text; }},
      {"--anti-aliasing,--aa", "METHOD", "Filter, such as smaa or fxaa:preset=39: one of " + image_filter_list(),
       "Options", true, [&](auto& text) { args.method = text; }},
      {"--upscale", "METHOD",
       "Upscaler, after the filter if both are given, such as fsr1 or lanczos:lobes=2: one of " + image_upscaler_list(),
       "Options", true, [&](auto& text) { args.upscaler = text; }},
      {"--size", "W,H", "Size of the upscaled image; default: that of the image times the upscaler's scale, 1.5",
       "Options", true, [&](auto& text) { args.size = parse_size(text, 32768); }},
      {"--background", "COLOR",
       "Background under images with alpha, for methods and formats without it; default: none, they keep alpha",
       "Options", false, [&](auto& text) { args.background = parse_color(text); }},
      tone_mapping_option(args.tone_mapping, "shows scene-linear images, before the filters; default none", "Options"),
      {"--exposure",
       "STOPS",
       "Exposure of scene-linear images that are shown, in stops, or auto: 95 % of the pixels have no channel above "
       "0.8; "
       "default 0",
       "Options",
       false,
       [&](auto& text) {
         args.exposure = parse_exposure(text);
         args.meters_exposure = !args.exposure;
       },
       {"auto"}},
      {"--motion", "FILES", "EXR sequence with the motion of the frames; default: channels of the frames themselves",
       "Sequences", true, [&](auto& text) { args.motion = text; }},
      {"--motion-scale", "X,Y",
       "Factors from the unit of the motion to pixels; -960,540 for (last - now) in units of 960 x 540 pixels, y up",
       "Sequences", false, [&](auto& text) { args.motion_scale = parse_pair(text); }},
      {"--depth", "FILES", "EXR sequence with the depth of the frames; default: channels of the frames themselves",
       "Sequences", true, [&](auto& text) { args.depth = text; }},
      {"--jitter", "FILE.txt", "Sample of each frame; default: the sequence of the method", "Sequences", true,
       [&](auto& text) { args.jitter = text; }},
      {"--fov", "DEG", "Vertical field of view, for tests of depth in fsr2 and sgsr2; default 60", "Sequences", false,
       [&](auto& text) { args.fov = parse_number(text, 1, 179); }},
      layer_option(args.layer),
      {"--bit-depth", "N", "Bits per channel of .png: 8, the default, or 16", "Options", false,
       [&](auto& text) {
         args.bit_depth = parse_choice(text, {"8", "16"}) == 0 ? 8 : 16;
       }},
      {"--force", "", "Replace inputs: the output may be a file that is read", "Options", false,
       [&](auto&) { args.replaces_inputs = true; }},
      {"--threads,-t", "N", "Maximum number of threads; 0, the default: the CPUs allowed by affinity and quota",
       "Options", false, [&](auto& text) { args.threads = parse_whole(text, 0, 1024); }},
      {"--progress", "KIND", "Progress on stderr: auto (a bar on a terminal), bar, json (one line per image) or none",
       "Options", false, [&](auto& text) { args.progress = parse_progress(text); }}};
  for (Option& option : limit_options(args.limits)) syntax.options.push_back(std::move(option));
  return syntax;
}

ConfinedRun confined_run(const FilterWork& work, const ReadingLimits& limits) {
  ConfinedRun run{.name = work.items.front().input,
                  .limits = limits,
                  .readable = {work.args.jitter},
                  .outputs = {},
                  .are_results = true};
  for (const FilterItem& item : work.items) run.readable.push_back(item.input), run.outputs.push_back(item.output);
  for (const std::vector<std::string>& files : {work.passes.depth, work.passes.motion})
    run.readable.insert(run.readable.end(), files.begin(), files.end());
  return run;
}

}  // namespace

void run_filter(std::span<const std::string> arguments) {
  FilterArgs args;
  Syntax syntax = make_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.size() != 1)
    throw Error(ErrorKind::Usage, "filter takes one input: an image, a folder or a sequence");
  if (args.output.empty()) throw Error(ErrorKind::Usage, "no output: name a file or folder with -o");
  const std::string method = sequence_method(args);
  const Filters filters = method.empty() ? make_filters(args) : Filters{};
  const std::string& operand = syntax.found_operands.front();
  const std::vector<FilterItem> items = plan_items(operand, args.output);
  FramePasses passes;
  if (!method.empty()) passes = find_passes(operand, items, args.depth, args.motion);
  std::vector<std::string> kept;
  if (!args.replaces_inputs) {
    for (const FilterItem& item : items) kept.push_back(item.input);
    for (const std::vector<std::string>* pass : {&passes.depth, &passes.motion})
      kept.insert(kept.end(), pass->begin(), pass->end());
    if (!args.jitter.empty()) kept.push_back(args.jitter);
  }
  check_outputs(items, kept);
  if (items.front().output != args.output || find_frame_place(fs::path(args.output).filename().string())) {
    const fs::path folder = fs::path(items.front().output).parent_path();
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) throw Error(ErrorKind::Output, args.output + ": " + error.message());
  }
  for (const FilterItem& item : items) {
    check_savable(item.output);
    open_encoder_library(extension_of(item.output), item.output);
  }
  std::optional<metrics::PictureSet> video;
  const ProgramLimits program = video_limits(args.limits);
  if (metrics::is_video_name(operand) && items.size() == 1) {
    video = metrics::open_pictures(operand, program);
    const std::vector<FrameTime> times = metrics::video_times(operand, video->names.size(), program);
    video->time_of = [times](std::size_t i) { return times[i]; };
  }
  if (args.bit_depth == 16 && extension_of(items.front().output) != ".png")
    throw Error(ErrorKind::Usage, "--bit-depth 16 is for .png, not " + items.front().output);
  with_threads(args.threads, [&] {
    Progress progress(args.progress ? *args.progress : parse_progress("auto"));
    const FilterWork work{args, operand, method, items, passes, filters, video};
    ConfinedRun run = confined_run(work, args.limits);
    run.progress = &progress;
    FrameReceiver receiver(items.front(), kept, program);
    if (items.size() == 1)
      run.take = [&](const std::string& name, std::vector<std::uint8_t> bytes) { receiver.take(name, bytes); };
    run_confined(run, [&](Delivery& out) { filter_all(work, out); });
  });
}

}  // namespace zoneplate::cli
