// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/job/look/default_material.h"
#include "zoneplate/job/option/lens_args.h"
#include "zoneplate/job/option/section_args.h"
#include "zoneplate/job/option/view_args.h"
#include "zoneplate/job/output/frame_name.h"
#include "zoneplate/render/aov.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/render.h"
#include "zoneplate/render/sequence.h"
#include "zoneplate/render/view.h"
#include "zoneplate/scene/default_options.h"
#include "zoneplate/shade/environment/layout.h"

namespace zoneplate {

/// The most frames of a sequence.
inline constexpr int max_frames = 100'000;

/// The longest side of an image, in pixels: the range of the rasterizer's fixed-point coordinates.
inline constexpr int max_side = 16384;

/// The frames to be rendered.
struct SequenceArgs {
  std::optional<int> turntable, count, first, last;
  int jump = 1;
  double rate = 24;  ///< frames per second
  bool is_film = false;
  std::optional<double> shutter;  ///< degrees of a frame's time during which the shutter is open
  int shutter_samples = 16;
  ShutterFilter shutter_filter = ShutterFilter::Box;
  int warm_up = 0;  ///< frames before the first that are rendered for a method with history, and not written
  std::vector<ViewDirection> views = {};       ///< of the frames, one after the other
  std::optional<KeyedViews> camera_path = {};  ///< the camera of each frame
  std::vector<int> finished = {};              ///< sorted; frames that are not rendered again
  bool skips_finished = false;                 ///< --skip-existing is given

  bool is_sequence() const { return requests_frames() || is_film; }
  /// Whether the options request frames, whatever the output is.
  bool requests_frames() const { return turntable || count || first || last || !views.empty() || camera_path; }
  std::int64_t first_frame() const { return first.value_or(0); }
  /// The last frame, if it does not depend on the animation.
  std::optional<std::int64_t> last_frame() const;
};

/// How files of encoded images are compressed.
struct FileOptions {
  std::optional<int> jpeg_quality;                ///< 1 to 100; none: default_jpeg_quality
  std::optional<int> webp_quality;                ///< 0 to 100; none: lossless
  bool is_small_png = false;                      ///< slower, smaller
  std::optional<ExrCompression> exr_compression;  ///< none: Zip
};

/// The description of a rendering: a model, its look and light, a view, the frames, the output with its data passes,
/// and limits. Options (job/options.h) set its members; `resolve` (job/resolve.h) decides what is left to the scene.
struct Job {
  std::string input;                      ///< a file or a built-in scene
  std::string output;                     ///< the name of the file, whose ending is its format; "-": stdout
  std::optional<FramePlace> frame_place;  ///< of the frame number in `output`
  std::string stdout_format = "png";
  LoadOptions load;
  bool has_animation_time = false;
  SequenceArgs sequence;
  int bit_depth = 8;
  bool dithers = false;
  FileOptions file;
  std::vector<const Aov*> aovs;
  std::string method = default_method;
  bool has_method = false;                   ///< --anti-aliasing is given
  std::string upscaler;                      ///< follows the method; check_job appends it to `method`
  std::optional<double> render_scale;        ///< of `upscaler`
  RenderOptions options;                     ///< `anisotropy` and `point_size` are set by resolve
  std::optional<int> anisotropy;             ///< none: default_anisotropy, or the own one of a built-in scene
  std::optional<float> point_size;           ///< none: default_point_size
  DisplayOptions display;                    ///< `mapping` and `background` are set by resolve
  std::optional<ToneMapping> tone_mapping;   ///< none: that of the light, see Lighting
  bool meters_exposure = false;              ///< --exposure auto: resolve_brightness sets `display.exposure`
  bool has_own_brightness = false;           ///< --exposure or --light-intensity is given
  float light_dimming = 1;                   ///< of the lights of a file; set by resolve_brightness
  std::optional<float4> background;          ///< sRGB code; none: that of the quality, the scene's own or the usual one
  std::optional<float4> quality_background;  ///< of --quality best; .exr stays transparent
  float background_blur = 0;
  View view;  ///< its lens is set from `lens` by check_job
  LensArgs lens;
  std::optional<float3> up;                   ///< the scene's up axis; nothing: that of its format
  MipOptions mips;                            ///< how images are decoded and reduced
  std::optional<ShadingModel> shading_model;  ///< for every material
  std::optional<float> displacement;          ///< DisplacementOptions::tolerance; none: height textures are bumps
  DefaultMaterial default_material;
  SectionArgs section;
  std::string solid_texture;  ///< of every material, in the form of job/look/solid_texture.h
  LightingOptions lighting;
  std::optional<float3> environment_color;       ///< linear radiance of --environment
  std::string cache;                             ///< folder of prepared environments; empty: none is kept
  bool is_in_studio = false;                     ///< --environment studio
  std::string hdri_file;                         ///< the image of `lighting.environment`; empty: none
  std::optional<EnvironmentLayout> hdri_layout;  ///< none: by the image's aspect
  float hdri_rotation = 0, hdri_intensity = 1;
  int threads = 0;          ///< 0: usable_processors(), base/processors.h
  Isa isa = current_isa();  ///< instruction set of every kernel of the run

  /// The output's name with an extension for its format, also for stdout.
  std::string named_output() const { return output == "-" ? "stdout." + stdout_format : output; }
};

}  // namespace zoneplate
