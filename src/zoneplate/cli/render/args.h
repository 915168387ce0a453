// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/base/isa.h"
#include "zoneplate/cli/aov.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/batch/frame_name.h"
#include "zoneplate/cli/batch/shard.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/look/default_material.h"
#include "zoneplate/cli/look/lens_args.h"
#include "zoneplate/cli/look/section_args.h"
#include "zoneplate/cli/look/view_args.h"
#include "zoneplate/cli/progress.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/render/lighting.h"
#include "zoneplate/render/render.h"
#include "zoneplate/render/sequence.h"
#include "zoneplate/render/view.h"
#include "zoneplate/scene/usual_options.h"
#include "zoneplate/shade/environment/layout.h"

namespace zoneplate::cli {

/// The most frames of a sequence.
inline constexpr int most_frames = 100'000;

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

  bool is_sequence() const { return requests_frames() || is_film; }
  /// Whether the options request frames, whatever the output is.
  bool requests_frames() const { return turntable || count || first || last || !views.empty() || camera_path; }
  std::int64_t first_frame() const { return first.value_or(0); }
  /// The last frame, if it does not depend on the animation.
  std::optional<std::int64_t> last_frame() const;
};

/// How files of encoded images are compressed.
struct FileOptions {
  std::optional<int> jpeg_quality;                ///< 1 to 100; none: usual_jpeg_quality
  std::optional<int> webp_quality;                ///< 0 to 100; none: lossless
  bool is_small_png = false;                      ///< slower, smaller
  std::optional<ExrCompression> exr_compression;  ///< none: Zip
};

/// The arguments of `zoneplate render`.
struct RenderArgs {
  std::string input, output;
  std::uint64_t number = 0;               ///< of the item in its batch
  std::optional<FramePlace> frame_place;  ///< of the frame number in `output`
  std::vector<std::string> inputs;        ///< all inputs; `input` is the first
  std::string manifest;
  bool has_placeholders = false;  ///< the output's name depends on its input
  std::string shard_text;         ///< --shard as it is given; empty: all items
  Shard shard;                    ///< set from it by parse_render_args
  bool skip_existing = false;
  std::string ledger;  ///< folder of cli/batch/ledger.h; empty: none is kept
  int retries = 0;     ///< of an item whose failure need not happen again
  double grace = 0;    ///< seconds after SIGTERM in which an item may be finished
  std::string given;   ///< the options that determine the images, as they were given, in lines "--size=512"
  SequenceArgs sequence;
  bool has_animation_time = false;
  int bit_depth = 8;
  bool dithers = false;
  FileOptions file;
  std::string stdout_format = "png";
  std::string method = usual_method;
  bool has_method = false;                   ///< --anti-aliasing is given
  std::string upscaler;                      ///< follows the method; check_args appends it to `method`
  std::optional<double> render_scale;        ///< of `upscaler`
  RenderOptions options;                     ///< `anisotropy` and `point_size` are set by set_usual_options
  std::optional<int> anisotropy;             ///< none: usual_anisotropy, or the own one of a built-in scene
  std::optional<float> point_size;           ///< none: usual_point_size
  DisplayOptions display;                    ///< `mapping` is set from `tone_mapping`, by the scene's light
  std::optional<ToneMapping> tone_mapping;   ///< none: that of the light, see Lighting
  bool meters_exposure = false;              ///< --exposure auto: `display.exposure` is set by metered_exposure
  bool has_own_brightness = false;           ///< --exposure or --light-intensity is given
  float light_dimming = 1;                   ///< of the lights of a file; set by set_light_dimming
  std::optional<float4> background;          ///< sRGB code; none: that of the quality, the scene's own or the usual one
  std::optional<float4> quality_background;  ///< of --quality best; .exr stays transparent
  float background_blur = 0;
  View view;  ///< its lens is set from `lens` by check_args
  LensArgs lens;
  MipOptions mips;                            ///< how images are decoded and reduced
  std::optional<ShadingModel> shading_model;  ///< for every material
  std::optional<float> displacement;          ///< DisplacementOptions::tolerance; none: height textures are bumps
  DefaultMaterial default_material;
  SectionArgs section;
  std::string solid_texture;  ///< of every material, in the form of cli/look/solid_texture.h
  LightingOptions lighting;
  std::optional<float3> environment_color;       ///< linear radiance of --environment
  std::string cache;                             ///< folder of prepared environments; empty: none is kept
  bool is_in_studio = false;                     ///< --environment studio
  std::string hdri_file;                         ///< the image of `lighting.environment`; empty: none
  std::optional<EnvironmentLayout> hdri_layout;  ///< none: by the image's aspect
  float hdri_rotation = 0, hdri_intensity = 1;
  std::vector<const Aov*> aovs;
  LoadOptions load;
  std::optional<float3> up;                                      ///< the scene's up axis; nothing: that of its format
  int threads = 0;                                               ///< 0: usable_processors(), base/processors.h
  Isa isa = current_isa();                                       ///< instruction set of every kernel of the run
  double max_seconds = std::numeric_limits<double>::infinity();  ///< limit of a whole item
  bool is_sandboxed = true;                                      ///< if the kernel supports sandboxes
  bool is_dry_run = false;                                       ///< report the items, and render none
  std::string preset;                                            ///< section of the configuration; empty: none
  bool reads_config = true;
  bool prints_json = false;
  Verbosity verbosity = Verbosity::Normal;
  std::optional<ProgressKind> progress;  ///< nothing: a bar on a terminal

  /// Whether each item is reported by a line of its own: several inputs, a manifest, an output with placeholders, or a
  /// ledger.
  bool is_batch() const { return inputs.size() > 1 || !manifest.empty() || has_placeholders || !ledger.empty(); }
  /// The output's name with an extension for its format, also for stdout.
  std::string named_output() const { return output == "-" ? "stdout." + stdout_format : output; }
};

/// The longest side of an image, in pixels: the range of the rasterizer's fixed-point coordinates.
inline constexpr int max_side = 16384;

/// The options of the verb, which set `args`. The result refers to `args`.
Syntax render_syntax(RenderArgs& args);

/// Checks the arguments of one image or sequence after parsing, and completes them.
///
/// Errors    ErrorKind::Usage.
void check_args(RenderArgs& args);

/// Checks the options of the environment, and completes `args.lighting` and `args.options` by them. Part of check_args.
///
/// Errors    ErrorKind::Usage.
void check_environment(RenderArgs& args);

/// Sets the output of an item from the text of --output, by its input and its number in the batch.
///
/// Errors    those of output_name.
void set_output(RenderArgs& args, const std::string& pattern, std::uint64_t index);

/// True for the endings of images that can be written: ".png" and others.
bool is_picture_ending(const std::string& extension);

/// Errors    ErrorKind::Usage for a name whose ending is not that of an image that can be written.
void check_picture_ending(const std::string& output);

/// Parses and checks the whole command line of the verb; nothing after printing the help. `adapt` makes the options of
/// another verb about the same items of those of `render`.
///
/// Errors    ErrorKind::Usage.
std::optional<RenderArgs> parse_render_args(std::span<const std::string> arguments,
                                            const std::function<void(Syntax&)>& adapt = {});

}  // namespace zoneplate::cli
