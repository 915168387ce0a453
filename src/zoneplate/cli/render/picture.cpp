// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/picture.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <filesystem>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/size_text.h"
#include "zoneplate/cli/batch/frame_name.h"
#include "zoneplate/cli/look/solid_texture.h"
#include "zoneplate/cli/render/exr_header.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/pfm.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/save.h"
#include "zoneplate/codec/webp_still.h"
#include "zoneplate/image/auto_exposure.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/scene/geometry/displacement.h"
#include "zoneplate/scene/usual_options.h"

namespace zoneplate::cli {
namespace {

// "#333333", the default background of F3D; the scene "triangles" is defined on black.
float4 background_of(const RenderArgs& args) {
  if (args.background) return *args.background;
  if (args.quality_background) return *args.quality_background;
  return args.input == "triangles" ? float4{0, 0, 0, 1} : default_background;
}

bool is_pfm(const std::string& output) { return extension_of(output) == ".pfm"; }
bool is_exr(const std::string& output) { return extension_of(output) == ".exr"; }
bool is_linear(const std::string& output) { return is_pfm(output) || is_exr(output); }

DisplayOptions display_of(const RenderArgs& args) {
  DisplayOptions display = args.display;
  display.background = background_of(args);
  return display;
}

std::vector<std::uint8_t> exr_of(const LinearImage& color, const DataChannels& data, ExrAttributes attributes,
                                 const FileOptions& options) {
  std::vector<ExrChannel> channels = rgba_channels(color);
  add_exr_channels(data, channels);
  attributes.insert(attributes.end(), data.attributes.begin(), data.attributes.end());
  return encode_exr(color.width(), color.height(), std::move(channels), attributes,
                    options.exr_compression.value_or(ExrCompression::Zip));
}

// The encoded values in memory order, rows from the top.
template <class T>
std::vector<std::uint8_t> raw_of(const Plane<T>& image) {
  static_assert(std::endian::native == std::endian::little, "16 bits are written low byte first");
  const auto* first = reinterpret_cast<const std::uint8_t*>(image.values().data());
  return {first, first + image.values().size_bytes()};
}

// Adds the data passes, as separate files or as channels of the image's file.
void add_passes(const RenderArgs& args, const Scene& scene, const Frame& frame, const std::string& output,
                Rendered& out) {
  DataChannels data;
  for (std::size_t i = 0; i < args.aovs.size(); ++i) {
    const Aov* const aov = args.aovs[i];
    if (is_exr(output)) {
      aov->add_channels(frame, scene, data);
      continue;
    }
    std::optional<std::vector<std::uint8_t>> pfm = is_pfm(output) ? encode_data_pfm(*aov, frame, scene) : std::nullopt;
    out.layers.push_back({static_cast<int>(i), pfm ? std::move(*pfm) : encode_data_png(*aov, frame, scene)});
  }
  if (is_exr(output)) out.exr = exr_of(out.linear, data, out.attributes, args.file);
}

// Checks the memory of a frame's planes and of its copies for encoding, in bytes per pixel: see Frame, DisplayImage,
// Rgba8Image.
void check_memory(const RenderArgs& args, const Request& request) {
  constexpr std::uint64_t bytes_per_sample = 24;  // if every sample is stored: colour, depth, triangle
  Planes planes;
  for (const Aov* aov : args.aovs) planes.*(aov->plane) = true;
  const std::uint64_t bytes_per_pixel =
      (planes.any_light() ? 64 : 0) + (args.aovs.empty() ? 44 : 136) +
      (planes.sample_triangles ? 96 + sizeof(std::uint32_t) * request.samples.size() : 0) +
      (request.planes.samples ? bytes_per_sample * request.samples.size() : 0);
  const std::optional<Crop> crop = padded_crop(args.options, request.halo);
  const auto width = static_cast<std::uint64_t>(crop ? crop->width : args.options.width);
  const auto height = static_cast<std::uint64_t>(crop ? crop->height : args.options.height);
  const std::uint64_t need = width * height * bytes_per_pixel;
  if (need > args.load.limits.memory)
    throw Error(ErrorKind::Failed,
                fmt::format("{}: an image of {}x{} needs {} of memory, --max-memory allows {}", args.input, width,
                            height, size_text(need), size_text(args.load.limits.memory)));
}

}  // namespace

std::string aov_path(const std::string& output, std::string_view name) {
  if (is_exr(output)) return output;
  return std::filesystem::path(output).replace_extension(fmt::format(".{}.{}", name, is_pfm(output) ? "pfm" : "png"));
}

std::string output_path(const RenderArgs& args, int frame, int layer) {
  const std::string picture = args.frame_place ? frame_name(args.output, *args.frame_place, frame) : args.output;
  return layer < 0 ? picture : aov_path(picture, args.aovs.at(static_cast<std::size_t>(layer))->name);
}

void check_outputs(const RenderArgs& args) {
  if (args.output == "-" && ::isatty(STDOUT_FILENO) == 1)
    throw Error(ErrorKind::Usage, "an image will not be written to a terminal");
  const int frame = args.sequence.first.value_or(0);
  for (int layer = -1; layer < static_cast<int>(args.aovs.size()); ++layer)
    check_savable(output_path(args, frame, layer));
}

Request request_of(const RenderArgs& args, Resolver& method) {
  return method.request({.image = {args.options.width, args.options.height, args.options.crop}});
}

void check_request(const RenderArgs& args, const Request& request) {
  if (request.is_display_referred && is_linear(args.named_output()))
    throw Error(ErrorKind::Usage, fmt::format("--anti-aliasing: {} works after tone mapping, and {} is scene-linear: "
                                              "write a .png, or use a method such as msaa or ssaa",
                                              args.method, extension_of(args.named_output())));
  check_memory(args, request);
}

void check_passes(const RenderArgs& args, const Request& request) {
  const bool has_error = std::ranges::any_of(args.aovs, [](const Aov* aov) { return aov->plane == &Planes::error; });
  if (has_error && !request.estimates_error)
    throw Error(ErrorKind::Usage,
                "--aov error: " + args.method + " has no estimate of its error; converged and analytic have");
}

void convert_materials(const RenderArgs& args, Scene& scene) {
  set_default_material(args.default_material, args.load.limits, scene);
  cut_scene(scene, args.section.planes, args.section.color);
  if (args.shading_model)
    for (Material& material : scene.materials) convert_material(material, *args.shading_model);
  if (args.displacement) displace_surfaces(scene, {.tolerance = *args.displacement});
  if (!args.solid_texture.empty()) set_solid_texture(args.solid_texture, scene);
}

void set_usual_options(RenderArgs& args, const Scene& scene) {
  RenderOptions& options = args.options;
  options.point_size = args.point_size.value_or(usual_point_size(scene, options.width, options.height));
  options.anisotropy = args.anisotropy.value_or(is_builtin_scene(args.input) ? 1 : usual_anisotropy);
}

Camera choose_own_camera(RenderArgs& args, const Scene& scene) {
  set_usual_options(args, scene);
  args.view.up = args.up.value_or(scene.up);
  args.view.lens = args.lens.lens(args.options.width, args.options.height);
  const bool has_own_view = is_builtin_scene(args.input) && !scene.cameras.empty();
  if (has_own_view && !args.view.index && !args.view.position) args.view.index = 0;
  const float aspect = static_cast<float>(args.options.width) / static_cast<float>(args.options.height);
  return choose_camera(scene, args.view, aspect);
}

ToneMapping set_look(const RenderArgs& args, Scene& scene) {
  convert_materials(args, scene);
  Lighting lighting = make_lighting(scene, args.lighting);
  scene.lights = std::move(lighting.lights);
  scene.environment = lighting.environment;
  scene.ambient_light = lighting.ambient_light;
  return args.tone_mapping.value_or(lighting.tone_mapping);
}

RenderSettings settings_of(const RenderArgs& args, const std::string& output) {
  RenderSettings settings{.options = args.options};
  settings.options.display = display_of(args);
  for (const Aov* aov : args.aovs) settings.planes.*(aov->plane) = settings.planes.depth = true;
  settings.form = is_linear(output)      ? ImageForm::Linear
                  : args.bit_depth == 16 ? ImageForm::Display16
                  : args.dithers         ? ImageForm::Display8Dithered
                                         : ImageForm::Display8;
  return settings;
}

float metered_exposure(const PreparedScene& scene, const Camera& camera, const RenderArgs& args) {
  Renderer renderer(scene, make_resolver(antialias::methods(), "none"));
  return auto_exposure(metered_image(renderer, camera, args.options));
}

std::string set_light_dimming(RenderArgs& args, const PreparedScene& scene, const std::string& output) {
  args.light_dimming = 1;
  if (args.lighting.source != LightSource::Scene || args.lighting.environment || args.has_own_brightness ||
      is_linear(output))
    return {};
  const auto [factor, white] = dimming_of(scene, make_resolver(antialias::methods(), "none"));
  args.light_dimming = factor;
  if (factor == 1) return {};
  return fmt::format(
      "{}: its lights would clip {:.0f} % of the surfaces to white and are dimmed to {:.2g} of their intensity; see "
      "--light-intensity, --exposure and --lights",
      args.input, 100 * white, factor);
}

Rendered finish_picture(const RenderArgs& args, RenderedImage image, const Scene& scene, const Camera& camera,
                        const std::string& output, Summary& summary, std::optional<int> frame) {
  const Stopwatch watch;
  const DisplayOptions display = display_of(args);
  Rendered out;
  out.image = std::move(image.display);
  out.image16 = std::move(image.display16);
  if (is_linear(output)) out.linear = over_background(std::move(image.linear), display);
  if (is_exr(output)) out.attributes = exr_header(args, camera, scene.origin, frame);
  out.has_alpha = display.is_transparent || display.background.w < 1;
  if (!args.aovs.empty()) add_passes(args, scene, image.data, output, out);
  const std::optional<Crop>& crop = args.options.crop;
  summary.width = crop ? crop->width : args.options.width;
  summary.height = crop ? crop->height : args.options.height;
  summary.counts = image.counts;
  summary.times.insert(summary.times.end(), {{"prepare", image.counts.prepare_ms},
                                             {"geometry", image.counts.geometry_ms},
                                             {"tiles", image.counts.tiles_ms},
                                             {"display", image.counts.resolve_ms + image.counts.display_ms +
                                                             image.counts.filter_ms + watch.ms()}});
  return out;
}

std::vector<std::uint8_t> encode_picture(const Rendered& picture, const std::string& output,
                                         const FileOptions& options) {
  const std::string extension = extension_of(output);
  if (extension == ".rgba") return picture.image16.empty() ? raw_of(picture.image) : raw_of(picture.image16);
  if (extension == ".pfm") return encode_pfm(picture.linear);
  if (extension == ".exr")
    return picture.exr.empty() ? exr_of(picture.linear, {}, picture.attributes, options) : picture.exr;
  if (extension == ".jpg" || extension == ".jpeg")
    return encode_jpeg(picture.image, options.jpeg_quality.value_or(usual_jpeg_quality));
  if (extension == ".webp") return encode_webp(picture.image, picture.has_alpha, options.webp_quality);
  if (extension == ".avif" || extension == ".jxl")
    return encode_codes(picture.image, picture.has_alpha, extension, output);
  const PngOptions png{.has_alpha = picture.has_alpha, .is_small = options.is_small_png};
  return picture.image16.empty() ? encode_png(picture.image, png) : encode_png(picture.image16, png);
}

namespace {

Rgba8 background_code(const RenderArgs& args) {
  const float4 b = background_of(args);
  const auto code = [](float x) { return static_cast<std::uint8_t>(x * 255 + 0.5f); };
  return {code(b.x), code(b.y), code(b.z), code(b.w)};
}

/// Whether every pixel is the background.
bool is_background_alone(const RenderArgs& args, const Rendered& picture) {
  const Rgba8 background = background_code(args);
  const auto is_background = [&](Rgba8 c) { return c.a == 0 || c == background; };
  const auto is_clear = [](const Linear& c) { return c.a == 0; };
  if (!picture.image.values().empty()) return std::ranges::all_of(picture.image.values(), is_background);
  return !picture.linear.values().empty() && std::ranges::all_of(picture.linear.values(), is_clear);
}

}  // namespace

std::string clipping(const RenderArgs& args, const Rendered& picture, const std::function<float()>& metered) {
  const Rgba8 background = background_code(args);
  std::size_t surfaces = 0, white = 0;
  for (const Rgba8 c : picture.image.values()) {
    if (c.a == 0 || c == background) continue;
    ++surfaces;
    white += c.r == 255 && c.g == 255 && c.b == 255;
  }
  const double part = static_cast<double>(white) / static_cast<double>(std::max<std::size_t>(surfaces, 1));
  if (part < least_white || !is_well_above_white(args.display.exposure, metered())) return {};
  return fmt::format(
      "{}: {:.0f} % of the surfaces are clipped to white; see --exposure auto, --lights and "
      "--tone-mapping",
      args.input, 100 * part);
}

std::string emptiness(const RenderArgs& args, const RenderCounts& counts, const Rendered& picture) {
  if (counts.triangles == 0) return args.input + ": there is nothing in it to draw";
  if (counts.triangles_set_up == 0) return args.input + ": nothing of it is in view; see the camera options";
  if (args.options.crop || !is_background_alone(args, picture)) return {};
  return args.input + ": nothing of it can be seen: its surfaces are transparent, too small or as the background";
}

}  // namespace zoneplate::cli
