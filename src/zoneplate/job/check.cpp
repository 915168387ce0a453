// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "zoneplate/base/error.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/codec/system/encoder_library.h"
#include "zoneplate/job/output/film.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

/// Appends the upscaler to the method. A temporal one jitters its own samples: it follows `none`.
void append_upscaler(Job& job) {
  if (job.upscaler.empty()) {
    if (job.render_scale) throw Error(ErrorKind::Usage, "--render-scale requires --upscale, for example fsr1");
    return;
  }
  const Upscaler* const row = find_row(upscale::upscalers(), job.upscaler);
  if (row != nullptr && row->make_temporal && !job.has_method) job.method = "none";
  job.method += '+' + job.upscaler;
  if (job.render_scale)
    job.method += fmt::format("{}scale={}", job.upscaler.find(':') == std::string::npos ? ':' : ',', *job.render_scale);
  job.upscaler.clear(), job.render_scale.reset();
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
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

void check_environment(Job& job) {
  if (job.options.background) {
    if (job.display.is_transparent)
      throw Error(ErrorKind::Usage, "--background environment is opaque: it does not go with --no-background");
    job.options.background->blur = job.background_blur;
  } else if (job.background_blur > 0) {
    throw Error(ErrorKind::Usage, "--background-blur requires --background environment");
  }
  if (job.environment_color) job.lighting.environment = Environment{.color = *job.environment_color};
  if (job.is_in_studio) job.lighting.environment = Environment{.color = {1, 1, 1}, .is_in_camera_space = true};
  if (job.hdri_file.empty()) {
    if (job.hdri_rotation != 0 || job.hdri_intensity != 1 || job.hdri_layout)
      throw Error(ErrorKind::Usage, "--hdri-rotation, --hdri-intensity and --hdri-layout require --hdri-file");
    return;
  }
  if (job.environment_color || job.is_in_studio)
    throw Error(ErrorKind::Usage, "--environment and --hdri-file both name an environment: give one of them");
  job.lighting.environment =
      Environment{.color = {1, 1, 1}, .rotation = job.hdri_rotation, .strength = job.hdri_intensity};
}

void check_output_name(const std::string& output) {
  std::error_code ignored;
  if (std::filesystem::is_directory(output, ignored))
    throw Error(ErrorKind::Output, output + ": is a directory; write into it with a / at its end");
  if (!is_video(output)) check_picture_ending(output);
  open_encoder_library(extension_of(output), output);
}

std::optional<std::int64_t> SequenceArgs::last_frame() const {
  if (last) return *last;
  if (count) return first_frame() + std::int64_t{*count - 1} * jump;
  if (turntable) return std::int64_t{*turntable} - 1;
  if (!views.empty()) return static_cast<std::int64_t>(views.size()) - 1;
  if (camera_path) return static_cast<std::int64_t>(camera_path->keys.back().time * rate + 1e-6);
  return std::nullopt;
}

void check_effects(const Job& job) {
  const std::string ending = extension_of(job.named_output());
  const auto refuse = [](const std::string& cause) { throw Error(ErrorKind::Usage, cause); };
  SequenceArgs sequence = job.sequence;
  sequence.is_film = is_video(job.output) || job.frame_place;
  const bool is_linear = ending == ".exr" || ending == ".pfm";
  if (job.file.jpeg_quality && ending != ".jpg" && ending != ".jpeg")
    refuse("--jpeg-quality is for .jpg; --webp-quality is for .webp, and --png-compression for .png");
  if (job.file.webp_quality && ending != ".webp") refuse("--webp-quality is for .webp");
  if (job.file.is_small_png && ending != ".png") refuse("--png-compression is for .png");
  if (job.file.exr_compression && ending != ".exr") refuse("--exr-compression is for .exr");
  if (job.tone_mapping.value_or(ToneMapping::None) != ToneMapping::None && is_linear)
    refuse("--tone-mapping: .exr and .pfm contain linear light, before tone mapping");
  if (job.tone_mapping.value_or(ToneMapping::None) != ToneMapping::None && job.display.raw)
    refuse("--tone-mapping does not go with --color-management raw");
  if (job.default_material.height_scale && job.default_material.height_map.empty())
    refuse("--height-scale requires --height-map");
  if (job.section.color && job.section.planes.empty())
    refuse("--section-color requires --section, for example 1,0,0,0");
  if (job.options.edges.color && job.options.edges.kind == EdgeKind::None)
    refuse("--edge-color requires --edges, for example features");
  if ((job.default_material.metallic || job.default_material.roughness) &&
      job.shading_model.value_or(ShadingModel::MetallicRoughness) != ShadingModel::MetallicRoughness)
    refuse("--metallic and --roughness are those of --shading-model pbr");
  if (!sequence.is_sequence() && sequence.rate != SequenceArgs{}.rate)
    refuse("--frame-rate requires a sequence: --frames, --frame-start, --frame-end or --turntable");
  if (!sequence.shutter && sequence.shutter_samples != SequenceArgs{}.shutter_samples)
    refuse("--shutter-samples requires --shutter");
}

void check_job(Job& job) {
  append_upscaler(job);
  job.sequence.is_film = is_video(job.output) || job.frame_place;
  check_environment(job);
  job.view.lens = job.lens.lens(job.options.width, job.options.height);
  if (job.view.lens && (job.view.view_angle || job.view.is_orthographic))
    throw Error(ErrorKind::Usage,
                "--camera-intrinsics and --camera-calibration go with neither --camera-view-angle nor "
                "--camera-orthographic");
  const std::string ending = extension_of(job.named_output());
  if (ending == ".exr" && !job.background && !job.options.background) job.display.is_transparent = true;
  if (job.options.opaque_glass && !job.display.is_transparent)
    throw Error(ErrorKind::Usage, "--opaque-glass requires a transparent background (--no-background)");
  if (job.options.ground == GroundKind::Shadow && !has_visibility(job.options))
    throw Error(ErrorKind::Usage, "--ground shadow requires --shadows or --ambient-occlusion");
  if (job.bit_depth == 16 && ending != ".png" && ending != ".rgba")
    throw Error(ErrorKind::Usage, "--bit-depth: only .png and .rgba have 16 bits");
  if (job.display.is_transparent || (job.background && job.background->w < 1)) check_alpha(ending, job.named_output());
  if (job.dithers && (job.bit_depth == 16 || ending == ".pfm" || ending == ".exr"))
    throw Error(ErrorKind::Usage, "--dither is for 8 bits a channel");
  if (job.sequence.jump != 1 && !job.sequence.is_sequence())
    throw Error(ErrorKind::Usage,
                "--frame-jump requires a sequence: --frames, --frame-start, --frame-end or --turntable");
  const int paths = int{job.sequence.turntable.has_value()} + int{!job.sequence.views.empty()} +
                    int{job.sequence.camera_path.has_value()};
  if (paths > 1)
    throw Error(ErrorKind::Usage, "--turntable, --views and --camera-path each move the camera: give one of them");
  if (!job.sequence.views.empty() && (job.sequence.shutter || job.view.index || job.view.position))
    throw Error(ErrorKind::Usage,
                "--views are of the whole scene: they go with none of --shutter, --camera-index and "
                "--camera-position");
  if (job.sequence.shutter && !job.sequence.is_sequence())
    throw Error(ErrorKind::Usage, "--shutter requires a sequence: --frames, --frame-start, --frame-end or --turntable");
  if (job.sequence.shutter && (!job.aovs.empty() || job.options.crop))
    throw Error(ErrorKind::Usage, "--shutter goes with neither --aov nor --crop");
  if (job.sequence.shutter_filter != ShutterFilter::Box && !job.sequence.shutter)
    throw Error(ErrorKind::Usage, "--shutter-filter requires --shutter");
  for (const Aov* aov : job.aovs) {
    if ((aov->plane == &Planes::motion || aov->plane == &Planes::flow) && !job.sequence.is_sequence())
      throw Error(ErrorKind::Usage,
                  fmt::format("--aov {} requires a sequence, or a frame of one: -s 5 -e 5", aov->name));
    if (aov->plane == &Planes::sample_triangles && ending == ".pfm")
      throw Error(ErrorKind::Usage,
                  fmt::format("--aov {} requires an .exr, or an image format such as .png", aov->name));
  }
  const bool has_animation = job.load.choice.animation || !job.load.choice.animation_name.empty();
  if (job.has_animation_time && !has_animation && !job.sequence.is_sequence()) job.load.choice.animation = 0;
  if (const auto& crop = job.options.crop)
    if (crop->x + crop->width > job.options.width || crop->y + crop->height > job.options.height)
      throw Error(ErrorKind::Usage, fmt::format("--crop: the rectangle is not inside the image of {}x{}",
                                                job.options.width, job.options.height));
}

}  // namespace zoneplate
