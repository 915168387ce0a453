// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/cli/batch/frame_name.h"
#include "zoneplate/cli/batch/input_names.h"
#include "zoneplate/cli/batch/ledger.h"
#include "zoneplate/cli/batch/output_name.h"
#include "zoneplate/cli/config/config.h"
#include "zoneplate/cli/render/args.h"
#include "zoneplate/cli/render/film.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/codec/system/encoder_library.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

/// Appends the upscaler to the method. A temporal one jitters its own samples: it follows `none`.
void append_upscaler(RenderArgs& args) {
  if (args.upscaler.empty()) {
    if (args.render_scale) throw Error(ErrorKind::Usage, "--render-scale requires --upscale, for example fsr1");
    return;
  }
  const Upscaler* const row = find_row(upscale::upscalers(), args.upscaler);
  if (row != nullptr && row->make_temporal && !args.has_method) args.method = "none";
  args.method += '+' + args.upscaler;
  if (args.render_scale)
    args.method +=
        fmt::format("{}scale={}", args.upscaler.find(':') == std::string::npos ? ':' : ',', *args.render_scale);
  args.upscaler.clear(), args.render_scale.reset();
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

void check_output(RenderArgs& args) {
  if (args.output.empty()) throw Error(ErrorKind::Usage, "no output: give -o OUT.png, or -o - for stdout");
  const bool is_film = extension_of(args.output) == ".apng" || is_encoded_by_ffmpeg(args.output);
  args.sequence.is_film = is_film || args.frame_place;
  if (args.output == "-") {
    if (!args.aovs.empty() && args.stdout_format != "exr")
      throw Error(ErrorKind::Usage, "--aov writes files next to OUT, which cannot be -; an .exr contains the passes");
    if (args.sequence.is_sequence()) throw Error(ErrorKind::Usage, "several frames cannot be written to -");
    return;
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(args.output, ignored))
    throw Error(ErrorKind::Output, args.output + ": is a directory; write into it with a / at its end");
  if (!is_film) check_picture_ending(args.output);
  open_encoder_library(extension_of(args.output), args.output);
}

// Refuses options of the command line that change nothing for this kind of output. Those of the configuration are for
// all kinds.
void check_effects(const RenderArgs& args, const std::string& ending) {
  const auto refuse = [](const std::string& cause) { throw Error(ErrorKind::Usage, cause); };
  const SequenceArgs& sequence = args.sequence;
  const bool is_linear = ending == ".exr" || ending == ".pfm";
  if (args.file.jpeg_quality && ending != ".jpg" && ending != ".jpeg")
    refuse("--jpeg-quality is for .jpg; --webp-quality is for .webp, and --png-compression for .png");
  if (args.file.webp_quality && ending != ".webp") refuse("--webp-quality is for .webp");
  if (args.file.is_small_png && ending != ".png") refuse("--png-compression is for .png");
  if (args.file.exr_compression && ending != ".exr") refuse("--exr-compression is for .exr");
  if (args.tone_mapping.value_or(ToneMapping::None) != ToneMapping::None && is_linear)
    refuse("--tone-mapping: .exr and .pfm contain linear light, before tone mapping");
  if (args.tone_mapping.value_or(ToneMapping::None) != ToneMapping::None && args.display.raw)
    refuse("--tone-mapping does not go with --color-management raw");
  if (args.default_material.height_scale && args.default_material.height_map.empty())
    refuse("--height-scale requires --height-map");
  if (args.section.color && args.section.planes.empty())
    refuse("--section-color requires --section, for example 1,0,0,0");
  if (args.options.edges.color && args.options.edges.kind == EdgeKind::None)
    refuse("--edge-color requires --edges, for example features");
  if ((args.default_material.metallic || args.default_material.roughness) &&
      args.shading_model.value_or(ShadingModel::MetallicRoughness) != ShadingModel::MetallicRoughness)
    refuse("--metallic and --roughness are those of --shading-model pbr");
  if (!sequence.is_sequence() && sequence.rate != SequenceArgs{}.rate)
    refuse("--frame-rate requires a sequence: --frames, --frame-start, --frame-end or --turntable");
  if (!sequence.shutter && sequence.shutter_samples != SequenceArgs{}.shutter_samples)
    refuse("--shutter-samples requires --shutter");
}

// A single operand that is a list of jobs is the manifest.
void take_manifest(RenderArgs& args, std::vector<std::string>& operands) {
  if (operands.size() != 1 || extension_of(operands.front()) != ".jsonl") return;
  if (!args.manifest.empty())
    throw Error(ErrorKind::Usage, fmt::format("two manifests: {} and {}", args.manifest, operands.front()));
  args.manifest = std::move(operands.front());
  operands.clear();
}

// The shard of the options; the ledger, if there is one, pins their number.
Shard shard_of(const RenderArgs& args) {
  if (args.shard_text.empty()) return {};
  try {
    const std::optional<BatchPin> pinned = args.ledger.empty() ? std::nullopt : find_pin(args.ledger, args.load.limits);
    return parse_shard(args.shard_text, pinned ? std::optional(pinned->shards) : std::nullopt);
  } catch (const Error& error) {
    throw Error(error.kind(), std::string(error.kind() == ErrorKind::Usage ? "--shard: " : "") + error.what());
  }
}

// Several inputs, and one file for all of them. After `convert in out` an output without -o is a likely mistake.
[[noreturn]] void refuse_single_output(const RenderArgs& args) {
  const std::string& last = args.inputs.back();
  if (args.output.empty() &&
      (is_encoded_by_ffmpeg(last) ||
       is_one_of(extension_of(last), {".png", ".jpg", ".jpeg", ".webp", ".avif", ".jxl", ".pfm", ".exr"})))
    throw Error(ErrorKind::Usage, fmt::format("no output: did you mean -o {}?", last));
  throw Error(
      ErrorKind::Usage,
      "several inputs require a folder as output, as pictures/, or {model} in its name, as pictures/{model}.png");
}

}  // namespace

bool is_picture_ending(const std::string& extension) {
  return is_one_of(extension, {".png", ".jpg", ".jpeg", ".webp", ".avif", ".jxl", ".pfm", ".exr", ".rgba"});
}

void check_picture_ending(const std::string& output) {
  if (output != "-" && !is_picture_ending(extension_of(output)))
    throw Error(
        ErrorKind::Usage,
        fmt::format(
            "--output: {} is not a format that can be written (images: .png, .jpg, .webp, .avif, .jxl, .exr, .pfm, "
            ".rgba; videos: .apng, .webp, .gif, .mp4, .mov, .mkv, .webm)",
            output));
}

void check_environment(RenderArgs& args) {
  if (args.options.background) {
    if (args.display.is_transparent)
      throw Error(ErrorKind::Usage, "--background environment is opaque: it does not go with --no-background");
    args.options.background->blur = args.background_blur;
  } else if (args.background_blur > 0) {
    throw Error(ErrorKind::Usage, "--background-blur requires --background environment");
  }
  if (args.environment_color) args.lighting.environment = Environment{.color = *args.environment_color};
  if (args.is_in_studio) args.lighting.environment = Environment{.color = {1, 1, 1}, .is_in_camera_space = true};
  if (args.hdri_file.empty()) {
    if (args.hdri_rotation != 0 || args.hdri_intensity != 1 || args.hdri_layout)
      throw Error(ErrorKind::Usage, "--hdri-rotation, --hdri-intensity and --hdri-layout require --hdri-file");
    return;
  }
  if (args.environment_color || args.is_in_studio)
    throw Error(ErrorKind::Usage, "--environment and --hdri-file both name an environment: give one of them");
  args.lighting.environment =
      Environment{.color = {1, 1, 1}, .rotation = args.hdri_rotation, .strength = args.hdri_intensity};
}

std::optional<std::int64_t> SequenceArgs::last_frame() const {
  if (last) return *last;
  if (count) return first_frame() + std::int64_t{*count - 1} * jump;
  if (turntable) return std::int64_t{*turntable} - 1;
  if (!views.empty()) return static_cast<std::int64_t>(views.size()) - 1;
  if (camera_path) return static_cast<std::int64_t>(camera_path->keys.back().time * rate + 1e-6);
  return std::nullopt;
}

void set_output(RenderArgs& args, const std::string& pattern, std::uint64_t index) {
  OutputName name = output_name(pattern, args.input, index, args.sequence.requests_frames());
  args.output = std::move(name.text), args.frame_place = name.frame;
}

void check_args(RenderArgs& args) {
  append_upscaler(args);
  check_output(args);
  check_environment(args);
  args.view.lens = args.lens.lens(args.options.width, args.options.height);
  if (args.view.lens && (args.view.view_angle || args.view.is_orthographic))
    throw Error(ErrorKind::Usage,
                "--camera-intrinsics and --camera-calibration go with neither --camera-view-angle nor "
                "--camera-orthographic");
  const std::string ending = extension_of(args.named_output());
  if (ending == ".exr" && !args.background && !args.options.background) args.display.is_transparent = true;
  if (args.options.opaque_glass && !args.display.is_transparent)
    throw Error(ErrorKind::Usage, "--opaque-glass requires a transparent background (--no-background)");
  if (args.output != "-" && args.stdout_format != "png")
    throw Error(ErrorKind::Usage, "--output-format requires -o -: otherwise the extension of OUT selects the format");
  if (args.options.ground == GroundKind::Shadow && !has_visibility(args.options))
    throw Error(ErrorKind::Usage, "--ground shadow requires --shadows or --ambient-occlusion");
  if (args.bit_depth == 16 && ending != ".png" && ending != ".rgba")
    throw Error(ErrorKind::Usage, "--bit-depth: only .png and .rgba have 16 bits");
  if (args.display.is_transparent || (args.background && args.background->w < 1))
    check_alpha(ending, args.named_output());
  if (args.dithers && (args.bit_depth == 16 || ending == ".pfm" || ending == ".exr"))
    throw Error(ErrorKind::Usage, "--dither is for 8 bits a channel");
  if (args.sequence.jump != 1 && !args.sequence.is_sequence())
    throw Error(ErrorKind::Usage,
                "--frame-jump requires a sequence: --frames, --frame-start, --frame-end or --turntable");
  const int paths = int{args.sequence.turntable.has_value()} + int{!args.sequence.views.empty()} +
                    int{args.sequence.camera_path.has_value()};
  if (paths > 1)
    throw Error(ErrorKind::Usage, "--turntable, --views and --camera-path each move the camera: give one of them");
  if (!args.sequence.views.empty() && (args.sequence.shutter || args.view.index || args.view.position))
    throw Error(ErrorKind::Usage,
                "--views are of the whole scene: they go with none of --shutter, --camera-index and "
                "--camera-position");
  if (args.sequence.shutter && !args.sequence.is_sequence())
    throw Error(ErrorKind::Usage, "--shutter requires a sequence: --frames, --frame-start, --frame-end or --turntable");
  if (args.sequence.shutter && (!args.aovs.empty() || args.options.crop))
    throw Error(ErrorKind::Usage, "--shutter goes with neither --aov nor --crop");
  if (args.sequence.shutter_filter != ShutterFilter::Box && !args.sequence.shutter)
    throw Error(ErrorKind::Usage, "--shutter-filter requires --shutter");
  for (const Aov* aov : args.aovs) {
    if ((aov->plane == &Planes::motion || aov->plane == &Planes::flow) && !args.sequence.is_sequence())
      throw Error(ErrorKind::Usage,
                  fmt::format("--aov {} requires a sequence, or a frame of one: -s 5 -e 5", aov->name));
    if (aov->plane == &Planes::sample_triangles && ending == ".pfm")
      throw Error(ErrorKind::Usage,
                  fmt::format("--aov {} requires an .exr, or an image format such as .png", aov->name));
  }
  const bool has_animation = args.load.choice.animation || !args.load.choice.animation_name.empty();
  if (args.has_animation_time && !has_animation && !args.sequence.is_sequence()) args.load.choice.animation = 0;
  if (const auto& crop = args.options.crop)
    if (crop->x + crop->width > args.options.width || crop->y + crop->height > args.options.height)
      throw Error(ErrorKind::Usage, fmt::format("--crop: the rectangle is not inside the image of {}x{}",
                                                args.options.width, args.options.height));
}

std::optional<RenderArgs> parse_render_args(std::span<const std::string> arguments,
                                            const std::function<void(Syntax&)>& adapt) {
  // The command line is parsed twice: first for the choice of a preset, then on top of the configuration.
  RenderArgs first;
  Syntax first_syntax = render_syntax(first);
  if (adapt) adapt(first_syntax);
  if (!parse(first_syntax, arguments)) return std::nullopt;
  RenderArgs args;
  Syntax syntax = render_syntax(args);
  if (adapt) adapt(syntax);
  if (!first.reads_config && !first.preset.empty())
    throw Error(ErrorKind::Usage, "--preset requires the configuration, which --no-config ignores");
  if (first.reads_config) apply_config(user_config(), first.preset, syntax);
  parse(syntax, arguments);
  take_manifest(args, syntax.found_operands);
  args.shard = shard_of(args);
  args.inputs = with_folders_listed(syntax.found_operands);
  if (!args.manifest.empty()) {
    if (!args.inputs.empty())
      throw Error(ErrorKind::Usage, "--manifest lists the inputs: remove " + args.inputs.front());
    return args;
  }
  if (args.inputs.empty()) throw Error(ErrorKind::Usage, "no input: give a model or a built-in scene");
  args.has_placeholders = names_input(args.output);
  if (args.inputs.size() > 1 && !args.has_placeholders) refuse_single_output(args);
  args.input = args.inputs.front();
  RenderArgs item = args;
  set_output(item, args.output, 0);
  first.output = item.output, first.frame_place = item.frame_place;
  check_effects(first, extension_of(item.named_output()));
  if (!args.is_batch() && (first.grace > 0 || first.retries > 0))
    throw Error(ErrorKind::Usage,
                "--grace and --retries are for batches: give several inputs, a manifest or a --ledger");
  check_args(item);
  return args.is_batch() ? args : item;  // each item of a batch is checked by its own name
}

}  // namespace zoneplate::cli
