// SPDX-License-Identifier: Apache-2.0
// zoneplate filter: post-process antialiasing and upscaling of existing images, without a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/filter/color.h"
#include "zoneplate/cli/filter/frames.h"
#include "zoneplate/cli/filter/items.h"
#include "zoneplate/cli/filter/sequence.h"
#include "zoneplate/cli/filter/still.h"
#include "zoneplate/cli/process/confined.h"
#include "zoneplate/cli/process/exr_layer.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/codec/system/encoder_library.h"
#include "zoneplate/image/auto_exposure.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/job/output/frame_name.h"
#include "zoneplate/job/tone_args.h"
#include "zoneplate/job/values.h"
#include "zoneplate/metrics/backdrop.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/file/picture_set.h"
#include "zoneplate/os/file.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

struct FilterArgs {
  std::string output, method, upscaler, motion, depth, jitter, layer;
  float2 motion_scale{1, 1};
  double fov = 60;
  std::optional<int2> size;  ///< of the upscaled images
  int bit_depth = 8, threads = 0;
  bool replaces_inputs = false;
  std::optional<float4> background;
  std::optional<ToneMapping> tone_mapping;
  std::optional<float> exposure;  ///< a factor
  bool meters_exposure = false;
  std::optional<ProgressKind> progress;  ///< none: a bar on a terminal
  ReadingLimits limits;

  /// Whether scene-linear images become display-referred ones.
  bool is_display_transform() const { return tone_mapping || exposure || meters_exposure; }
};

/// True for a method that only needs the display-referred image of a frame.
bool reads_image_alone(Resolver& method) {
  const Request request = method.request({});
  return request.is_display_referred && request.samples.size() == 1 && !request.draw && !request.planes.any();
}

std::string filter_names() {
  std::string names;
  for (const Method& method : antialias::methods())
    if (reads_image_alone(*make_resolver(antialias::methods(), method.name)) ||
        filters_sequences(std::string(method.name)))
      names += fmt::format("{}{}", names.empty() ? "" : ", ", method.name);
  return names;
}

std::string upscaler_names() {
  std::string names;
  for (const Upscaler& row : upscale::upscalers())
    if (row.make_spatial || filters_sequences(std::string(row.name)))
      names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  return names;
}

/// What is done to each image: antialiasing, upscaling, or the one and then the other.
struct Filters {
  std::unique_ptr<Resolver> antialiasing;     ///< or null
  std::unique_ptr<SpatialUpscaler> upscaler;  ///< or null
  std::optional<int2> size;                   ///< of the upscaled image; none: that of the input times `scale`
  double scale = 1;
};

std::unique_ptr<Resolver> make_filter(const std::string& method) {
  std::unique_ptr<Resolver> filter = make_resolver(antialias::methods(), method);
  if (!reads_image_alone(*filter))
    throw Error(ErrorKind::Usage, fmt::format("--anti-aliasing: {} needs a scene, expected a filter of images: {}",
                                              method, filter_names()));
  return filter;
}

Filters make_filters(const FilterArgs& args) {
  if (args.method.empty() && args.upscaler.empty() && !args.is_display_transform())
    throw Error(ErrorKind::Usage,
                fmt::format("--anti-aliasing, --upscale or --tone-mapping is missing: one of {}, or one of {}",
                            filter_names(), upscaler_names()));
  Filters filters;
  if (!args.method.empty()) filters.antialiasing = make_filter(args.method);
  if (args.upscaler.empty()) {
    if (args.size) throw Error(ErrorKind::Usage, "--size requires --upscale: one of " + upscaler_names());
    return filters;
  }
  const Spec<Upscaler> spec = parse_spec("upscaler", upscale::upscalers(), args.upscaler);
  filters.upscaler = upscale::make_spatial_upscaler(args.upscaler);
  filters.size = args.size, filters.scale = spec.settings.number("scale");
  return filters;
}

UpscaleGrid grid_of(const Filters& filters, int width, int height, const std::string& input) {
  constexpr int max_side = 32768;
  const auto scaled = [&](int side) { return static_cast<int>(std::floor(side * filters.scale + 0.5)); };
  const int2 size = filters.size.value_or(int2{scaled(width), scaled(height)});
  if (size.x < width || size.y < height)
    throw Error(ErrorKind::Usage, fmt::format("--size {}x{}: is smaller than {}, which has {}x{} pixels, and upscalers "
                                              "only enlarge; zoneplate signal resample reduces",
                                              size.x, size.y, input, width, height));
  if (size.x > max_side || size.y > max_side)
    throw Error(ErrorKind::Usage, fmt::format("{}: upscaled to {}x{} pixels, expected at most {} along each side",
                                              input, size.x, size.y, max_side));
  return {width, height, 0, 0, {size.x, size.y, std::nullopt}};
}

DisplayImage filtered(DisplayImage image, const Filters& filters, const std::string& input) {
  if (filters.antialiasing) image = filters.antialiasing->post_process(std::move(image), Frame());
  if (filters.upscaler)
    image = filters.upscaler->upscale(image, grid_of(filters, image.width(), image.height(), input));
  return image;
}

bool is_clamped(const Linear& c) {
  const auto is_outside = [&](float v) { return v < 0 || v > std::max(c.a, 0.0f); };
  return is_outside(c.r) || is_outside(c.g) || is_outside(c.b);
}

void warn_of_clamped(const std::string& input, std::ptrdiff_t pixels, const char* what, Delivery& out) {
  if (pixels > 0)
    out.warn(fmt::format("{}: {} {}{} light outside 0 to 1, which is clamped", input, pixels, what,
                         pixels == 1 ? "pixel has" : "pixels have"));
}

/// Antialiases the sRGB codes of an image, with light of any primaries. Pixels that the filter does not blend keep
/// their light.
void antialias_linear(const FilterItem& item, metrics::Picture& picture, Resolver& filter, Delivery& out) {
  const DisplayImage filtered = filter.post_process(picture.display, Frame());
  std::ptrdiff_t clamped = 0;
  for (std::size_t i = 0; i < filtered.values().size(); ++i) {
    const Display& c = filtered.values()[i];
    if (c == picture.display.values()[i]) continue;
    Linear& light = picture.linear.values()[i];
    clamped += is_clamped(light);
    light = {decode_srgb(c.r) * c.a, decode_srgb(c.g) * c.a, decode_srgb(c.b) * c.a, c.a};
  }
  warn_of_clamped(item.input, clamped, "blended ", out);
}

/// Says what a filter of display-referred values cannot represent of scene-linear ones.
void warn_of_lost_light(const FilterItem& item, const upscale::UpscaledLight& light, Delivery& out) {
  std::string text;
  const auto add = [&](bool is_lost, const std::string& what) {
    if (is_lost) text += (text.empty() ? "" : ", ") + what;
  };
  add(light.negative > 0, fmt::format("{} below 0, which count as 0", light.negative));
  add(light.bright > 0, fmt::format("{} above 32768, which count as that", light.bright));
  add(light.additive > 0, fmt::format("{} with light at alpha 0, which counts as none", light.additive));
  constexpr float accepted = 0.02f;
  if (std::abs(light.constant - light.brightest) > accepted * light.brightest)
    add(true, fmt::format("those of the brightest light, {:.4g}, which becomes {:.4g} where it is constant",
                          light.brightest, light.constant));
  if (!text.empty())
    out.warn(fmt::format("{}: this upscaler maps light to [0, 1], of pixels: {}; bilinear, bicubic and lanczos keep it",
                         item.input, text));
}

void filter_linear(const FilterItem& item, Still still, const Filters& filters, Delivery& out) {
  if (filters.antialiasing) antialias_linear(item, still.picture, *filters.antialiasing, out);
  LinearImage& image = still.picture.linear;
  if (filters.upscaler) {
    const UpscaleGrid grid = grid_of(filters, image.width(), image.height(), item.input);
    upscale::UpscaledLight light = upscale::upscale_linear(*filters.upscaler, image, grid);
    warn_of_lost_light(item, light, out);
    image = std::move(light.image);
  }
  warn_of_left_out(item.output, item.input, save_light(item.output, image, still.file, {}, out), out);
}

/// The display-referred image of scene-linear light, which make_display shows: over the background, or with its alpha.
metrics::Picture displayed(metrics::Picture picture, const FilterArgs& args, const FilterItem& item) {
  if (!picture.is_scene_linear)
    throw Error(ErrorKind::Usage,
                fmt::format("{}: is a display-referred image; --tone-mapping and --exposure are for scene-linear ones",
                            item.input));
  if (is_linear_file(item.output))
    throw Error(ErrorKind::Usage,
                fmt::format("{}: is scene-linear, before --tone-mapping and --exposure: write a .png", item.output));
  picture = metrics::in_srgb(std::move(picture));
  const float exposure = args.meters_exposure ? auto_exposure(picture.linear) : args.exposure.value_or(1.0f);
  const DisplayOptions options{.mapping = args.tone_mapping.value_or(ToneMapping::None),
                               .exposure = exposure,
                               .is_transparent = !args.background,
                               .background = args.background.value_or(float4{0, 0, 0, 1})};
  return metrics::make_picture(make_display(picture.linear, options));
}

void filter_image(const FilterItem& item, const Filters& filters, const FilterArgs& args, Delivery& out) {
  Still still = load_still(item.input, {args.layer, area_for(item.output, !filters.upscaler)}, out);
  metrics::Picture& picture = still.picture;
  if (args.is_display_transform()) picture = displayed(std::move(picture), args, item);
  const bool is_laid = args.background && metrics::has_alpha(picture);
  picture = in_space_of(std::move(picture), is_laid ? FilteredValues::Light : FilteredValues::Codes, item.input,
                        item.output, out);
  if (is_laid) lay_over(picture, *args.background);
  if (picture.is_scene_linear && is_linear_file(item.output))
    return filter_linear(item, std::move(still), filters, out);
  if (picture.is_scene_linear && !filters.antialiasing)
    throw Error(ErrorKind::Usage, fmt::format("{}: is a scene-linear image, and {} is not: write an .exr or a .pfm",
                                              item.input, item.output));
  if (picture.is_scene_linear)
    warn_of_clamped(item.input, std::ranges::count_if(picture.linear.values(), is_clamped), "", out);
  if (!picture.is_scene_linear && is_linear_file(item.output))
    throw Error(ErrorKind::Usage, fmt::format("{}: is a display-referred image, and {} is scene-linear: write a .png",
                                              item.input, item.output));
  const DisplayImage image = filtered(std::move(picture.display), filters, item.input);
  const ColorProfile profile = profile_of(picture.space);
  if (args.bit_depth == 8) return out.save(item.output, encode_image(item.output, quantize8(image), profile));
  out.save(item.output, encode_png(quantize16(image), {.profile = profile}));
}

/// The method with history that the arguments select; empty: filters of single images.
std::string sequence_method(const FilterArgs& args) {
  const Upscaler* const upscaler =
      args.upscaler.empty() ? nullptr : &parse_spec("upscaler", upscale::upscalers(), args.upscaler).row;
  const bool is_temporal = upscaler && upscaler->make_temporal;
  if (is_temporal && !filters_sequences(args.upscaler))
    throw Error(ErrorKind::Usage,
                fmt::format("--upscale: {} needs a scene, expected one of {}", args.upscaler, upscaler_names()));
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
                "fsr2, fsr3, sgsr2, taau or learned");
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
      {"--anti-aliasing,--aa", "METHOD", "Filter, such as smaa or fxaa:preset=39: one of " + filter_names(), "Options",
       true, [&](auto& text) { args.method = text; }},
      {"--upscale", "METHOD",
       "Upscaler, after the filter if both are given, such as fsr1 or lanczos:lobes=2: one of " + upscaler_names(),
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

/// What is filtered, and how.
struct FilterWork {
  const FilterArgs& args;
  const std::string& operand;
  const std::string& method;  ///< with history; empty: `filters`
  const std::vector<FilterItem>& items;
  const FramePasses& passes;
  const Filters& filters;
  const std::optional<metrics::PictureSet>& video;  ///< its frames and times, if the operand is a video
};

/// The frames of the only item, if it is an animation; null if there are several items, or it is one image.
std::optional<metrics::PictureSet> frames_of(const FilterWork& work, Delivery& out) {
  if (work.video) return work.video;
  const std::string& input = work.items.front().input;
  if (work.items.size() > 1 || input == "-") return std::nullopt;
  std::optional<metrics::PictureSet> frames;
  out.read(input, [&] { frames = metrics::with_frames(metrics::open_pictures(input), out.limits().pixels); });
  return frames->time_of ? std::move(frames) : std::nullopt;
}

void filter_frames(const FilterWork& work, const metrics::PictureSet& frames, Delivery& out) {
  const FilterItem& item = work.items.front();
  FrameSink sink(item, frames, work.args.bit_depth, out);
  for (std::size_t i = 0; i < frames.names.size(); ++i) {
    out.progress(frames.names[i], static_cast<double>(i) / static_cast<double>(frames.names.size()));
    metrics::Picture picture = metrics::in_srgb(load_still(frames.open(i), out));
    if (work.args.background) lay_over(picture, *work.args.background);
    sink.add(filtered(std::move(picture.display), work.filters, item.input), frames.time_of(i));
  }
  sink.finish();
}

void filter_items(const FilterWork& work, Delivery& out) {
  const FilterArgs& args = work.args;
  const std::optional<metrics::PictureSet> frames = frames_of(work, out);
  if (!work.method.empty()) {
    if (const std::string gaps = gaps_in(work.items); !gaps.empty())
      out.warn(fmt::format("{}: has no frame {}: the history goes on without them", work.operand, gaps));
    const double scale =
        args.upscaler.empty() ? 1 : parse_spec("upscaler", upscale::upscalers(), work.method).settings.number("scale");
    return filter_sequence({.method = work.method,
                            .items = work.items,
                            .animation = frames,
                            .passes = work.passes,
                            .jitter = args.jitter,
                            .motion_scale = args.motion_scale,
                            .fov = static_cast<float>(args.fov),
                            .size = args.size,
                            .scale = scale,
                            .layer = args.layer,
                            .bit_depth = args.bit_depth,
                            .background = args.background},
                           out);
  }
  if (frames && args.is_display_transform())
    throw Error(ErrorKind::Usage,
                fmt::format("{}: is display-referred; --tone-mapping and --exposure are for scene-linear images",
                            work.items.front().input));
  if (frames) return filter_frames(work, *frames, out);
  double done = 0;
  for (const FilterItem& item : work.items) {
    out.progress(item.input, done++ / static_cast<double>(work.items.size()));
    filter_image(item, work.filters, args, out);
  }
}

/// Runs in the confined process.
void filter_all(const FilterWork& work, Delivery& out) {
  out.repeat_no_warnings();
  filter_items(work, out);
  out.tell_repeated(work.operand);
}

ConfinedRun confined_run(const FilterWork& work) {
  ConfinedRun run{
      .name = work.items.front().input, .limits = work.args.limits, .readable = {work.args.jitter}, .outputs = {}};
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
    ConfinedRun run = confined_run(work);
    run.progress = &progress;
    FrameReceiver receiver(items.front(), kept, program);
    if (items.size() == 1)
      run.take = [&](const std::string& name, std::vector<std::uint8_t> bytes) { receiver.take(name, bytes); };
    run_confined(run, [&](Delivery& out) { filter_all(work, out); });
  });
}

}  // namespace zoneplate::cli
